"""Random files, valid or damaged, and the check of what reading them gives.

A file is made from a known mesh by the package's writers, then changed: either without changing its
meaning, so that the result is known, or arbitrarily, so that it must be read as a sound solid or
refused with an error of the package.
"""

import io
import json
import re
import struct
import warnings
import zipfile
import zlib
from collections.abc import Callable
from dataclasses import dataclass
from fractions import Fraction
from pathlib import Path
from typing import TypeAlias

import numpy as np

import bspcsg as b
from bspcsg import bsp, csg
from bspcsg._core import Tree
from bspcsg.errors import core_errors
from bspcsg.io import RawMesh, encoded
from bspcsg.solid.leaf import TreeLeaf
from bspcsg.solid.solid import from_leaf
from corpus.broken import glb_chunks, glb_of
from support.glb import Scene
from support.shapes import cuboid, joined, octahedron, tetrahedron

from .drawings import random_drawing
from .models import random_model

Rng: TypeAlias = np.random.Generator

#: Formats by their suffixes; text forms of binary ones come apart.
MESHES = [(".stl", False), (".stl", True), (".ply", False), (".ply", True), (".obj", False)]
MESHES += [(".off", False), (".glb", False), (".3mf", False)]
FORMATS = [suffix + ("-text" if text else "") for suffix, text in MESHES]
FORMATS += [".csg", ".json", ".svg", ".dxf", ".snapshot"]

#: The numbers that a damaged one may become.
NUMBERS = [b"0", b"-1", b"1e999", b"nan", b"-inf", b"1e308", b"4294967295", b"9" * 25, b"", b"0.5"]
NUMBERS += [b"1_0", b"0x10", b"1e-320", b"-0", b"2147483648", b"1,5", b"\xd9\xa3"]

#: The bytes with which parts of a file are overwritten.
BYTES = [b"\0\0\0\0", b"\xff\xff\xff\xff", b"\x7f\xff\xff\xff", b"\xff\xff\xff\x7f", b"\x80", b"\0"]
BYTES += [
    b"\x00\x00\xc0\x7f",
    b"\x00\x00\x80\x7f",
    b"<",
    b">",
    b'"',
    b"&e;",
    b"[",
    b"{",
    b"\n",
    b"(",
]

_NUMBER = re.compile(rb"[-+]?\d+\.?\d*(?:[eE][-+]?\d+)?")


@dataclass(frozen=True)
class File:
    """The content of a file; `volume` is its correct volume, or None if any outcome is allowed."""

    format: str
    data: bytes
    volume: Fraction | None = None


def random_file(rng: Rng, format: str) -> File:  # noqa: A002
    """Return a random file of a format: valid, changed without changing its meaning, or damaged."""
    good = good_file(rng, format)
    kind = rng.random()
    if kind < 0.15:
        return good
    if kind < 0.35:
        return same_meaning(rng, good)
    return File(format, damaged(rng, format, good.data))


# Good files


def good_file(rng: Rng, format: str) -> File:  # noqa: A002
    """Return a valid file of a known solid."""
    if format == ".csg":
        text, volume = random_model(rng)
        return File(format, text.encode(), volume)
    if format == ".3mf" and rng.random() < 0.5:
        return _boolean_shape(rng)
    if format == ".glb" and rng.random() < 0.5:
        return _foreign_glb(rng)
    if format in (".svg", ".dxf"):
        return File(format, *random_drawing(rng, format))
    mesh, volume = _known_mesh(rng)
    solid = b.Solid(*mesh)
    if format == ".snapshot":
        cut = solid - b.box((1, 1, 1)).translate(*rng.integers(0, 3, 3).tolist())
        return File(format, cut.tree.dump(), cut.volume_exact)
    if format == ".json":
        return File(format, csg.to_json(csg.parse(solid.to_csg())).encode(), volume)
    suffix, _, text = format.partition("-")
    return File(
        format, b"".join(encoded(RawMesh(*mesh, "x"), "x", suffix, bool(text)).chunks), volume
    )


def _known_mesh(rng: Rng) -> tuple[tuple[np.ndarray, np.ndarray], Fraction]:
    """Return a mesh with coordinates that are exact in single precision, and its volume."""
    kind = int(rng.integers(4))
    if kind == 0:
        size = rng.integers(1, 5, 3)
        return cuboid((0, 0, 0), size), Fraction(int(size.prod()))
    if kind == 1:
        corners = [(0, 0, 0), (1, 0, 0), (0, 2, 0), (0, 0, 3)]
        return tetrahedron(corners), Fraction(1)
    if kind == 2:
        return octahedron(), Fraction(4, 3)
    both = joined(cuboid((0, 0, 0), (1, 1, 1)), cuboid((2, 0, 0), (3, 2, 1)))
    return both, Fraction(3)


def _boolean_shape(rng: Rng) -> File:
    """Return a 3MF file with nested boolean shapes of cuboids; the volume counts unit cubes."""
    operation = ("union", "difference", "intersection")[int(rng.integers(3))]
    size, moves = rng.integers(1, 5, 3), rng.integers(-1, 3, (3, 3))
    moves[0] = 0
    cubes = np.stack(np.meshgrid(*[np.arange(-1, 7)] * 3, indexing="ij"), axis=-1)
    base, *others = (((cubes >= move) & (cubes < move + size)).all(axis=-1) for move in moves)
    for other in others:
        base = {"union": base | other, "difference": base & ~other}.get(operation, base & other)
    operands = [f'<o:boolean objectid="1" {_transform(move)}/>' for move in moves[1:].tolist()]
    head, inner = f'<o:booleanshape objectid="1" operation="{operation}">', ""
    if rng.random() < 0.5:
        inner = f'<object id="2">{head}{operands.pop(0)}</o:booleanshape></object>'
        head = head.replace('"1"', '"2"')
    shape = f'{inner}<object id="3">{head}{"".join(operands)}</o:booleanshape></object>'
    mesh = RawMesh(*cuboid((0, 0, 0), size), "x")
    members = _members(b"".join(encoded(mesh, "x", ".3mf").chunks))
    space = "http://schemas.3mf.io/3dmanufacturing/booleanoperations/2023/07"
    members["3D/3dmodel.model"] = (
        members["3D/3dmodel.model"]
        .replace(b"<model ", f'<model requiredextensions="o" xmlns:o="{space}" '.encode())
        .replace(b"</resources>", f"{shape}</resources>".encode())
        .replace(b'<item objectid="1"', b'<item objectid="3"')
    )
    return File(".3mf", _zipped(members), Fraction(int(base.sum())))


def _transform(move: list[int]) -> str:
    return 'transform="1 0 0 0 1 0 0 0 1 {} {} {}"'.format(*move)


def _foreign_glb(rng: Rng) -> File:
    """Return a GLB file as other programs write it, in metres, which are read as 1000 units."""
    (vertices, faces), volume = _known_mesh(rng)
    kind = ("f4", "i1", "i2")[int(rng.integers(3))]
    points = np.asarray(vertices, kind)
    scene = Scene(points, faces, stride=8 if kind != "f4" else 0)
    if rng.random() < 0.5:
        moved = np.sort(rng.permutation(len(points))[: int(rng.integers(len(points)))])
        scene.replace(0, moved.tolist(), points[moved])
        scene.blur(0, moved.tolist())
    if rng.random() < 0.5:
        count = int(rng.integers(1, 4))
        scale = rng.choice([-2, -1, 1, 2], (count, 3)).astype("f4")
        scene.place(TRANSLATION=64 * np.arange(3 * count, dtype="f4").reshape(-1, 3), SCALE=scale)
        volume *= int(np.abs(scale.prod(axis=1)).sum())
    return File(".glb", scene.bytes(), volume * 1000**3)


# Changes that mean nothing


def same_meaning(rng: Rng, file: File) -> File:
    """Return a file with the same meaning in another notation."""
    changes = _SAME.get(file.format, [])
    if not changes:
        return file
    change = changes[int(rng.integers(len(changes)))]
    return File(file.format, change(rng, file.data), file.volume)


def _line_ends(rng: Rng, data: bytes) -> bytes:
    end = [b"\r\n", b"\n\n", b" \n"][int(rng.integers(3))]
    return data.replace(b"\n", end)


def _windows(rng: Rng, data: bytes) -> bytes:
    del rng
    return data.replace(b"\n", b"\r\n")


def _remark(mark: bytes, after: int) -> Callable[[Rng, bytes], bytes]:
    """Return a change that inserts a comment after line number `after` or later."""

    def change(rng: Rng, data: bytes) -> bytes:
        lines = data.splitlines(keepends=True)
        at = int(rng.integers(after, len(lines) + 1))
        return b"".join([*lines[:at], mark, b" 1 2 3 v f { ; <\n", *lines[at:]])

    return change


def _shuffled_faces(rng: Rng, data: bytes) -> bytes:
    """Return the data with its last lines, which are faces, in random order."""
    lines = data.rstrip(b"\n").split(b"\n")
    start = lines[-1][:2]
    first = next(k for k, line in enumerate(lines) if line[:2] == start and len(line.split()) == 4)
    faces = [lines[first + int(k)] for k in rng.permutation(len(lines) - first)]
    return b"\n".join([*lines[:first], *faces, b""])


def _records(rng: Rng, data: bytes) -> bytes:
    """Return a binary STL with its triangles shuffled, other normals and another header."""
    rows = [data[k : k + 50] for k in range(84, len(data), 50)]
    changed = [
        rng.bytes(12) + rows[int(k)][12:48] + rng.bytes(2) for k in rng.permutation(len(rows))
    ]
    return b"x" + rng.bytes(79) + data[80:84] + b"".join(changed)


def _spaced_json(rng: Rng, data: bytes) -> bytes:
    document = json.loads(data)
    if isinstance(document, dict) and rng.random() < 0.5:
        document = dict(reversed(document.items()))
    return json.dumps(document, indent=int(rng.integers(0, 4))).encode()


def _spaced_glb(rng: Rng, data: bytes) -> bytes:
    document, binary = glb_chunks(data)
    return glb_of(_spaced_json(rng, document), binary)


def _repacked(rng: Rng, data: bytes) -> bytes:
    methods = [zipfile.ZIP_STORED, zipfile.ZIP_DEFLATED]
    members = _members(data)
    names = sorted(members) if rng.random() < 0.5 else list(members)
    return _zipped({name: members[name] for name in names}, methods[int(rng.integers(2))])


def _commented_header(rng: Rng, data: bytes) -> bytes:
    del rng
    return data.replace(b"\nelement vertex", b"\ncomment element face 7\nelement vertex", 1)


_SAME: dict[str, list[Callable[[Rng, bytes], bytes]]] = {
    ".stl": [_records],
    ".stl-text": [_line_ends, _windows],
    ".ply-text": [_commented_header],
    ".obj": [_line_ends, _remark(b"#", 0), _shuffled_faces],
    ".off": [_line_ends, _remark(b"#", 1), _shuffled_faces],
    ".glb": [_spaced_glb],
    ".3mf": [_repacked],
    ".csg": [_line_ends, _remark(b"//", 0)],
    ".json": [_spaced_json],
    ".dxf": [_windows],
}

# Damage


def damaged(rng: Rng, format: str, data: bytes) -> bytes:  # noqa: A002
    """Return the data with one to three random errors, in the structure or anywhere."""
    for _ in range(int(rng.integers(1, 4))):
        if format == ".3mf" and rng.random() < 0.8:
            data = _damaged_member(rng, data)
        elif format == ".glb" and rng.random() < 0.8:
            data = _damaged_glb(rng, data)
        else:
            data = _damaged_bytes(rng, data)
    return data


def _damaged_bytes(rng: Rng, data: bytes) -> bytes:
    if not data:
        return rng.bytes(8)
    change = _DAMAGE[int(rng.integers(len(_DAMAGE)))]
    return change(rng, data)


def _other_number(rng: Rng, data: bytes) -> bytes:
    found = list(_NUMBER.finditer(data))
    if not found:
        return _overwritten(rng, data)
    place = found[int(rng.integers(len(found)))]
    other = NUMBERS[int(rng.integers(len(NUMBERS)))]
    return data[: place.start()] + other + data[place.end() :]


def _overwritten(rng: Rng, data: bytes) -> bytes:
    new = BYTES[int(rng.integers(len(BYTES)))] if rng.random() < 0.7 else rng.bytes(4)
    at = int(rng.integers(len(data)))
    kept = at + len(new) * int(rng.integers(2))
    return data[:at] + new + data[kept:]


def _cut(rng: Rng, data: bytes) -> bytes:
    first, last = sorted(rng.integers(0, len(data) + 1, 2).tolist())
    return data[:first] if rng.random() < 0.4 else data[:first] + data[last:]


def _repeated(rng: Rng, data: bytes) -> bytes:
    first, last = sorted(rng.integers(0, len(data) + 1, 2).tolist())
    return data[:last] + data[first:last] * int(rng.integers(1, 4)) + data[last:]


def _line_moved(rng: Rng, data: bytes) -> bytes:
    lines = data.splitlines(keepends=True)
    line = lines.pop(int(rng.integers(len(lines))))
    at = int(rng.integers(len(lines) + 1))
    return b"".join([*lines[:at], line, *lines[at:]])


_DAMAGE = [_other_number, _other_number, _overwritten, _overwritten, _cut, _repeated, _line_moved]


def _members(data: bytes) -> dict[str, bytes]:
    with zipfile.ZipFile(io.BytesIO(data)) as archive:
        return {name: archive.read(name) for name in archive.namelist()}


def _zipped(members: dict[str, bytes], method: int = zipfile.ZIP_DEFLATED) -> bytes:
    packed = io.BytesIO()
    with zipfile.ZipFile(packed, "w", method) as archive:
        for name, data in members.items():
            archive.writestr(name, data)
    return packed.getvalue()


#: What zipfile raises for archives that earlier damage made unreadable; RuntimeError where a flag
#: says that a member is encrypted.
_UNREADABLE = (zipfile.BadZipFile, zlib.error, ValueError, OSError, RuntimeError, EOFError)


def _damaged_member(rng: Rng, data: bytes) -> bytes:
    try:
        members = _members(data)
    except _UNREADABLE:
        return _damaged_bytes(rng, data)
    if not members:
        return _damaged_bytes(rng, data)
    name = sorted(members)[int(rng.integers(len(members)))]
    if rng.random() < 0.1:
        members[name + "x"] = members.pop(name)
    else:
        members[name] = _damaged_bytes(rng, members[name])
    return _zipped(members)


def _damaged_glb(rng: Rng, data: bytes) -> bytes:
    try:
        document, binary = glb_chunks(data)
    except (struct.error, IndexError):
        return _damaged_bytes(rng, data)
    if rng.random() < 0.7:
        return glb_of(_damaged_bytes(rng, document), binary)
    return glb_of(document, _damaged_bytes(rng, binary))


# Judging


def judge_file(file: File, folder: Path) -> list[str]:
    """Return what is wrong with the outcome of reading a file."""
    path = folder / f"in{file.format.partition('-')[0]}"
    path.write_bytes(file.data)
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")
            found = _held(file, path)
    except b.InternalError as error:
        return [f"internal: {error.message}"]
    except b.BspcsgError as error:
        if file.volume is not None and not _is_nothing(file, error):
            return [f"refused: {error.code}: {error.message}"]
        return [] if error.message and "\n" not in error.message else ["words: not one line"]
    except Exception as error:
        return [f"raw: {type(error).__name__}: {error}"]
    if found < 0 or file.volume not in (None, found):
        return [f"volume: {found}, not {file.volume}"]
    return []


def _is_nothing(file: File, error: "b.BspcsgError") -> bool:
    """Return true if a script with an empty result was refused for being empty."""
    return file.volume == 0 and error.code in ("empty_mesh", "empty_solid", "nothing")


def _held(file: File, path: Path) -> Fraction:
    """Return the exact volume or area of the content of a file."""
    if file.format == ".snapshot":
        return from_leaf(TreeLeaf(_loaded(file.data))).volume_exact
    if file.format in (".svg", ".dxf"):
        read = bsp.load_svg if file.format == ".svg" else bsp.load_dxf
        return Fraction(read(path).area_exact)
    return b.load(path).volume_exact


def _loaded(data: bytes) -> Tree:
    with core_errors():
        return Tree.load(data)
