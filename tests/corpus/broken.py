"""Broken files, made from valid ones, with the exit code that each must lead to.

Each valid file contains the cube from the origin to (2, 2, 2). A case changes a few bytes; no files
are stored.
"""

import gzip
import io
import json
import struct
import tempfile
import zipfile
from collections.abc import Callable, Iterator
from dataclasses import dataclass, replace
from functools import partial
from pathlib import Path

import numpy as np

from bspcsg import csg
from bspcsg.bsp import Region
from bspcsg.io import encoded
from support.io import cube_mesh

#: Exit codes of a file that cannot be read, and of one that is read and then is no solid.
UNREADABLE, REFUSED = 3, 4

#: The volume of the good cube.
VOLUME = 8

MESH = cube_mesh(2.0)
BOM = b"\xef\xbb\xbf"


@dataclass(frozen=True)
class Broken:
    """A file that must be refused.

    Parameters
    ----------
    name : str
        A description of what is wrong.
    suffix : str
    data : bytes
    code : int
        The exit code of commands that need a solid.
    """

    name: str
    suffix: str
    data: bytes
    code: int = UNREADABLE

    def __str__(self) -> str:
        """Return the name of the case in test reports."""
        return f"{self.suffix[1:]}: {self.name}"


def good(suffix: str, text: bool = False) -> bytes:
    """Return the bytes of a valid file with the cube."""
    return b"".join(encoded(MESH, "x", suffix, text).chunks)


def swapped(data: bytes, old: bytes, new: bytes, count: int = 1) -> bytes:
    """Return the data with `old`, which must occur, replaced by `new`."""
    assert old in data, old
    return data.replace(old, new, count)


def overwritten(data: bytes, at: int, new: bytes) -> bytes:
    """Return the data with the bytes from position `at` overwritten by `new`."""
    return data[:at] + new + data[at + len(new) :]


def _everywhere(suffix: str, data: bytes) -> Iterator[Broken]:
    """Yield the broken files that are possible in any format."""
    yield Broken("empty", suffix, b"")
    yield Broken("one byte", suffix, data[:1])
    yield Broken("a byte order mark only", suffix, BOM)
    yield Broken("blank lines only", suffix, b"\r\n \n\t\n")
    yield Broken("zeros", suffix, bytes(500))
    yield Broken("ones", suffix, b"\xff" * 500)
    yield Broken("a web page", suffix, b"<!DOCTYPE html><html><body>404</body></html>\n")
    wide = data[:400].decode("latin-1").encode("utf-16-le")
    yield Broken("UTF-16 without a mark", suffix, wide)
    yield Broken("compressed", suffix, gzip.compress(data, mtime=0))


# STL


def _stl_binary() -> Iterator[Broken]:
    data = good(".stl")
    yield from _everywhere(".stl", data)
    for size in (79, 80, 83, 84, 85, 84 + 49, 84 + 50, 84 + 51, len(data) - 1):
        yield Broken(f"cut after {size} bytes", ".stl", data[:size])
    for name, count in (("one more", 13), ("twice as many", 24), ("all there are", 2**32 - 1)):
        yield Broken(f"promises {name}", ".stl", overwritten(data, 80, struct.pack("<I", count)))
    yield Broken("promises none", ".stl", overwritten(data, 80, bytes(4)))
    one_less = overwritten(data, 80, struct.pack("<I", 11))
    yield Broken("promises one less", ".stl", one_less, REFUSED)
    for name, value in (("nan", np.nan), ("inf", np.inf), ("-inf", -np.inf)):
        yield Broken(name, ".stl", overwritten(data, 84 + 12, struct.pack("<f", value)))
    yield Broken("a triangle missing", ".stl", one_less[:-50], REFUSED)
    yield Broken("no triangles", ".stl", data[:80] + bytes(4), REFUSED)


def _stl_text() -> Iterator[Broken]:
    data = good(".stl", text=True)
    lines = data.splitlines(keepends=True)
    for count in range(1, 10):
        yield Broken(f"text cut after {count} lines", ".stl", b"".join(lines[:count]))
    yield Broken("text cut in a number", ".stl", b"".join(lines[:3]) + b"      vertex 0.0 2.")
    yield Broken("text without its end", ".stl", b"".join(lines[:-1]))
    for word in (b"nan", b"inf", b"1e999", b"two", b"0x10", b"1,5", b"", b"1_0", b"\xff", b"1d3"):
        changed = swapped(data, b"vertex 2.0", b"vertex " + word)
        yield Broken(f"text with {word!r} for a number", ".stl", changed)
    fourth = swapped(data, b"endloop", b"vertex 0 0 0\nendloop")
    yield Broken("text with four corners", ".stl", fourth)
    yield Broken("text beyond the lattice", ".stl", data.replace(b" 2.0", b" 1e308"), REFUSED)


# OBJ


def _obj() -> Iterator[Broken]:
    data = good(".obj")
    yield from _everywhere(".obj", data)
    for word in (b"nan", b"inf", b"-1e999", b"two", b"", b"1_0", b"\xff"):
        yield Broken(f"{word!r} for a number", ".obj", swapped(data, b"v 2.0", b"v " + word))
    first = next(line for line in data.splitlines() if line.startswith(b"f "))
    for face in (b"0 1 2", b"1 2 9", b"1 2 -9", b"1 2 999999999999999999999", b"1 2", b"1"):
        yield Broken(f"face {face!r}", ".obj", swapped(data, first, b"f " + face))
    for face in (b"1.5 2 3", b"a b c", b"1_0 2 3", b"", b"- 1 2"):
        yield Broken(f"face {face!r}", ".obj", swapped(data, first, b"f " + face))
    yield Broken("vertices only", ".obj", data[: data.index(b"f ")], REFUSED)
    yield Broken("faces before vertices", ".obj", b"f 1 2 3\n")
    yield Broken("cut in the last face", ".obj", data.rstrip()[:-3])
    yield Broken("cut after a face", ".obj", data[: data.rindex(b"f ")], REFUSED)
    yield Broken("beyond the lattice", ".obj", data.replace(b"2.0", b"1e308"), REFUSED)


# PLY


def _ply_text() -> Iterator[Broken]:
    data = good(".ply", text=True)
    lines = data.splitlines(keepends=True)
    header = lines.index(b"end_header\n") + 1
    for count in (*range(1, header + 1), header + 1, header + 8, header + 9, len(lines) - 1):
        yield Broken(f"text cut after {count} lines", ".ply", b"".join(lines[:count]))
    for word in (b"nan", b"inf", b"1e999", b"two", b"1_0"):
        changed = swapped(data, b"2.0 ", word + b" ")
        yield Broken(f"text with {word!r} for a number", ".ply", changed)
    for old, new in (
        (b"element vertex 8", b"element vertex 9"),
        (b"element vertex 8", b"element vertex 7"),
        (b"element vertex 8", b"element vertex -8"),
        (b"element vertex 8", b"element vertex 99999999999999999999"),
        (b"element vertex 8", b"element vertex x"),
        (b"element vertex 8", b"element vertices 8"),
        (b"element face 12", b"element face 13"),
        (b"format ascii 1.0", b"format utf8 1.0"),
        (b"format ascii 1.0\n", b""),
        (b"property double x", b"property quad x"),
        (b"property double x", b"property double w"),
    ):
        yield Broken(f"text with {new!r}", ".ply", swapped(data, old, new))
    for face in (b"3 0 1 8", b"3 0 1 -1", b"3 0 1 99999999999", b"3 0 1", b"-3 0 1 2", b"x 0 1 2"):
        yield Broken(f"text with the face {face!r}", ".ply", swapped(data, lines[-1].strip(), face))
    fewer = swapped(data, b"element face 12", b"element face 11")
    yield Broken("text with a face missing", ".ply", fewer[: -len(lines[-1])], REFUSED)
    yield Broken("text beyond the lattice", ".ply", data.replace(b"2.0", b"1e308"), REFUSED)


def _ply_binary() -> Iterator[Broken]:
    data = good(".ply")
    yield from _everywhere(".ply", data)
    start = data.index(b"end_header\n") + len(b"end_header\n")
    faces = start + 8 * 24
    for size in (start - 1, start, start + 1, start + 23, faces - 1, faces, faces + 1, faces + 12):
        yield Broken(f"cut after {size} bytes", ".ply", data[:size])
    yield Broken("cut by a byte", ".ply", data[:-1])
    for name, value in (("nan", np.nan), ("inf", np.inf)):
        yield Broken(name, ".ply", overwritten(data, start + 8, struct.pack("<d", value)))
    for count in (0, 1, 2, 255):
        changed = overwritten(data, faces, bytes([count]))
        yield Broken(f"a face of {count}", ".ply", changed)
    for index in (8, -1, 2**31 - 1, -(2**31)):
        changed = overwritten(data, faces + 1, struct.pack("<i", index))
        yield Broken(f"a corner {index}", ".ply", changed)
    for promised in (b"999999999", b"9999999999999999999999"):
        changed = swapped(data, b"element face 12", b"element face " + promised)
        yield Broken(f"promises {promised!r} faces", ".ply", changed)
    huge = overwritten(data, start + 8, struct.pack("<d", 1e308))
    yield Broken("beyond the lattice", ".ply", huge, REFUSED)


# OFF


def _off() -> Iterator[Broken]:
    data = good(".off")
    yield from _everywhere(".off", data)
    lines = data.splitlines(keepends=True)
    for count in (1, 2, 3, 9, 10, 11, len(lines) - 1):
        yield Broken(f"cut after {count} lines", ".off", b"".join(lines[:count]))
    for counts in (
        b"9 12 0",
        b"8 13 0",
        b"-8 12 0",
        b"8",
        b"8.5 12 0",
        b"x y z",
        b"9" * 30 + b" 1",
    ):
        yield Broken(f"counts {counts!r}", ".off", swapped(data, lines[1].strip(), counts))
    for word in (b"nan", b"inf", b"1e999", b"two"):
        yield Broken(f"{word!r} for a number", ".off", swapped(data, b"2.0", word))
    for face in (
        b"3 0 1 8",
        b"3 0 1 -1",
        b"3 0 1 99999999999999999999",
        b"3 0 1",
        b"0",
        b"-3 0 1 2",
    ):
        yield Broken(f"face {face!r}", ".off", swapped(data, lines[-1].strip(), face))
    fewer = swapped(data, b"8 12 ", b"8 11 ")
    yield Broken("a face missing", ".off", fewer[: -len(lines[-1])], REFUSED)
    yield Broken("no faces", ".off", b"OFF\n0 0 0\n", REFUSED)
    yield Broken("beyond the lattice", ".off", data.replace(b"2.0", b"1e308"), REFUSED)


# 3MF

_MODEL = "3D/3dmodel.model"
_RELATIONS = "_rels/.rels"


def repacked(change: Callable[[bytes], bytes], member: str = _MODEL) -> bytes:
    """Return a 3MF file with one member changed; a member that becomes empty is left out."""
    packed = io.BytesIO()
    with (
        zipfile.ZipFile(io.BytesIO(good(".3mf"))) as source,
        zipfile.ZipFile(packed, "w", zipfile.ZIP_DEFLATED) as target,
    ):
        for name in source.namelist():
            data = source.read(name)
            data = change(data) if name == member else data
            if data:
                target.writestr(name, data)
    return packed.getvalue()


def _3mf_models() -> Iterator[tuple[str, Callable[[bytes], bytes]]]:
    """Yield changes of a 3MF file's model, each of which makes it invalid."""
    for old, new in (
        (b'x="2.0"', b'x="nan"'),
        (b'x="2.0"', b'x="inf"'),
        (b'x="2.0"', b'x="1e999"'),
        (b'x="2.0"', b'x="two"'),
        (b'x="2.0"', b'x=""'),
        (b'x="2.0"', b""),
        (b'v1="0"', b'v1="8"'),
        (b'v1="0"', b'v1="-1"'),
        (b'v1="0"', b'v1="99999999999999999999"'),
        (b'v1="0"', b'v1="0.5"'),
        (b'v1="0"', b'v1="0_1"'),
        (b'x="2.0"', b'x="2_0"'),
        (b'v1="0"', b""),
        (b'item objectid="1"', b'item objectid="7"'),
        (b'item objectid="1"', b"item"),
        (b'item objectid="1"', b'item transform="1 0 0" objectid="1"'),
        (b'item objectid="1"', b'item transform="' + b"nan " * 12 + b'" objectid="1"'),
        (b'unit="millimeter"', b'unit="furlong"'),
        (b"</model>", b""),
        (b"<resources>", b"<resources><"),
        (b"<resources>", b"<resources>&undefined;"),
    ):
        yield f"{new.decode()!r} for {old.decode()!r}", partial(swapped, old=old, new=new)
    yield "half a model", lambda data: data[: len(data) // 2]
    yield "a model of zeros", lambda data: bytes(len(data))
    yield "no UTF-8", lambda data: swapped(data, b"<resources>", b"<resources>\xff")


def _entities(system: bool) -> bytes:
    """Return a document type with entities that grow tenfold in nine steps, or that read a file."""
    if system:
        return b'<!DOCTYPE model [<!ENTITY e9 SYSTEM "file:///etc/passwd">]>'
    steps = [f'<!ENTITY e{k} "{f"&e{k - 1};" * 10}">' for k in range(1, 10)]
    return f'<!DOCTYPE model [<!ENTITY e0 "ha">{"".join(steps)}]>'.encode()


def _with_entities(system: bool) -> bytes:
    def change(data: bytes) -> bytes:
        typed = swapped(data, b"<model", _entities(system) + b"<model")
        return swapped(typed, b"<resources>", b"&e9;<resources>")

    return repacked(change)


def _3mf() -> Iterator[Broken]:
    data = good(".3mf")
    yield from _everywhere(".3mf", data)
    for size in (4, 30, 100, len(data) // 2, len(data) - 22, len(data) - 1):
        yield Broken(f"cut after {size} bytes", ".3mf", data[:size])
    for name, change in _3mf_models():
        yield Broken(name, ".3mf", repacked(change))
    yield Broken("entities that multiply", ".3mf", _with_entities(system=False))
    yield Broken("an entity from a file", ".3mf", _with_entities(system=True))
    yield Broken("no model", ".3mf", repacked(lambda _: b""))
    beyond = repacked(lambda _: b"", _RELATIONS)
    yield Broken("no relations and no model", ".3mf", swapped(beyond, b"3dmodel", b"4dmodel", 2))
    away = repacked(lambda d: swapped(d, b"/3D/3dmodel", b"/../../etc/passwd"), _RELATIONS)
    yield Broken("a model outside", ".3mf", away)
    middle = len(data) // 3
    yield Broken("wrong sum", ".3mf", overwritten(data, middle, bytes([data[middle] ^ 255])))
    yield Broken("locked by a password", ".3mf", _locked(data))
    yield Broken("packed in a way nobody knows", ".3mf", _method(data, 77))
    yield Broken("a bomb", ".3mf", _bomb(data))
    gone = repacked(lambda d: swapped(d, b'<triangle v1="0"', b'<nothing v1="0"'))
    yield Broken("a triangle missing", ".3mf", gone, REFUSED)
    huge = repacked(lambda d: d.replace(b'"2.0"', b'"1e308"'))
    yield Broken("beyond the lattice", ".3mf", huge, REFUSED)
    unbuilt = repacked(lambda d: swapped(d, b'<item objectid="1"/>', b""))
    yield Broken("nothing to build", ".3mf", unbuilt, REFUSED)


def _locked(data: bytes) -> bytes:
    """Return an archive whose members all claim to be encrypted."""
    changed = bytearray(data)
    for mark, offset in ((b"PK\x03\x04", 6), (b"PK\x01\x02", 8)):
        at = data.find(mark)
        while at >= 0:
            changed[at + offset] |= 1
            at = data.find(mark, at + 1)
    return bytes(changed)


def _method(data: bytes, method: int) -> bytes:
    changed = bytearray(data)
    for mark, offset in ((b"PK\x03\x04", 8), (b"PK\x01\x02", 10)):
        at = data.find(mark)
        while at >= 0:
            changed[at + offset] = method
            at = data.find(mark, at + 1)
    return bytes(changed)


def _bomb(data: bytes) -> bytes:
    """Return an archive whose model claims to unpack to four gigabytes."""
    changed = bytearray(data)
    at = data.rindex(b"PK\x01\x02")
    changed[at + 24 : at + 28] = struct.pack("<I", 2**32 - 2)
    return bytes(changed)


# GLB

_JSON, _BIN = b"JSON", b"BIN\0"


def glb_of(document: bytes, binary: bytes | None) -> bytes:
    """Return a GLB file with a JSON document and binary data."""
    chunks = [(_JSON, document + b" " * (-len(document) % 4))]
    if binary is not None:
        chunks.append((_BIN, binary + bytes(-len(binary) % 4)))
    body = b"".join(struct.pack("<I", len(data)) + kind + data for kind, data in chunks)
    return b"glTF" + struct.pack("<II", 2, 12 + len(body)) + body


def glb_chunks(data: bytes) -> tuple[bytes, bytes]:
    """Return the JSON document and the binary data of a GLB file."""
    size = struct.unpack("<I", data[12:16])[0]
    return data[20 : 20 + size], data[28 + size :]


def _described(change: Callable[[dict[str, object]], None]) -> bytes:
    described, binary = glb_chunks(good(".glb"))
    document = json.loads(described)
    change(document)
    return glb_of(json.dumps(document).encode(), binary)


def _set(path: str, value: object) -> bytes:
    """Return a GLB file with another value at a path of its JSON, such as ``meshes/0/name``."""

    def change(document: dict[str, object]) -> None:
        *outer, last = [int(word) if word.isdecimal() else word for word in path.split("/")]
        inner: object = document
        for word in outer:
            inner = inner[word]  # type: ignore[index]
        inner[last] = value  # type: ignore[index]

    return _described(change)


def _glb() -> Iterator[Broken]:
    data = good(".glb")
    described, binary = glb_chunks(data)
    yield from _everywhere(".glb", data)
    for size in (4, 11, 12, 19, 20, 21, 20 + len(described), len(data) - 1):
        yield Broken(f"cut after {size} bytes", ".glb", data[:size])
    yield Broken("version 3", ".glb", overwritten(data, 4, struct.pack("<I", 3)))
    for length in (0, len(data) + 1, 2**32 - 1):
        yield Broken(f"length {length}", ".glb", overwritten(data, 8, struct.pack("<I", length)))
    for length in (0, 2**32 - 1):
        changed = overwritten(data, 12, struct.pack("<I", length))
        yield Broken(f"a description of {length} bytes", ".glb", changed)
    yield Broken("data of 0 bytes", ".glb", glb_of(described, b""))
    yield Broken("no data", ".glb", glb_of(described, None))
    yield Broken("half the data", ".glb", glb_of(described, binary[: len(binary) // 2]))
    for document in (b"", b"{", b"[]", b"null", b"\xff", b"[" * 5000):
        yield Broken(f"description {document[:20]!r}", ".glb", glb_of(document, binary))
    yield Broken("a description of nothing", ".glb", glb_of(b"{}", binary), REFUSED)
    for path, values in (
        ("accessors/0/count", (-1, 10**9, 1.5, "x", None)),
        ("accessors/0/bufferView", (-1, 99)),
        ("accessors/0/componentType", (0, 5124)),
        ("accessors/0/type", ("VEC9", 3)),
        ("accessors/0/byteOffset", (-4, 10**12)),
        ("bufferViews/0/byteLength", (-1, 10**12)),
        ("bufferViews/0/byteOffset", (-1, 10**12)),
        ("bufferViews/0/byteStride", (-12, 1)),
        ("bufferViews/0/buffer", (1, -1)),
        ("buffers/0/byteLength", (10**12,)),
        ("buffers/0/uri", ("../../etc/passwd", "http://example.com/x.bin")),
        ("meshes/0/primitives/0/attributes/POSITION", (99, -1)),
        ("nodes/0/children", ([0], [99])),
        ("nodes/0/mesh", (99,)),
        ("scenes/0/nodes", ([99], [-1])),
        ("extensionsRequired", (["KHR_draco_mesh_compression"],)),
    ):
        for value in values:
            yield Broken(f"{path} is {value!r}", ".glb", _set(path, value))
    yield from _glb_numbers()


def _glb_numbers() -> Iterator[Broken]:
    described, binary = glb_chunks(good(".glb"))
    views = json.loads(described)["bufferViews"]
    accessors = json.loads(described)["accessors"]
    for accessor in accessors:
        at = views[accessor["bufferView"]].get("byteOffset", 0)
        if accessor["componentType"] == 5126:
            for value in (np.nan, np.inf):
                changed = overwritten(binary, at, struct.pack("<f", value))
                yield Broken(f"coordinate {value}", ".glb", glb_of(described, changed))
        else:
            for index in (8, 2**32 - 1):
                changed = overwritten(binary, at, struct.pack("<I", index))
                yield Broken(f"corner {index}", ".glb", glb_of(described, changed))


# Scripts

CSG = b"union() {\n  cube(size = [2, 2, 2], center = false);\n}\n"


def _csg() -> Iterator[Broken]:
    # What is blank is a model of nothing.
    for case in _everywhere(".csg", CSG):
        blank = not case.data.removeprefix(BOM).strip()
        yield replace(case, code=REFUSED if blank else UNREADABLE)
    for size in (3, 5, 7, 8, 9, 12, 20, 30, 45, 50, len(CSG) - 2):
        yield Broken(f"cut after {size} bytes", ".csg", CSG[:size])
    for text in (
        b'import(file = "none',
        b"/* a comment",
        b"cube(size = 1e999);",
        b"cube(size = [1, 2]);",
        b"cube(size = [1, 2, [3]]);",
        b'cube(size = "x");',
        b"sphere(r = 1, $fn = 1e9);",
        b"sphere(r = 1, $fn = 1e300);",
        b"cylinder(h = 1, r1 = 1e200, r2 = 1, $fn = 1e8);",
        b"minkowsky() { cube(1); }",
        b"multmatrix([[1, 0, 0, 0], [0, 1, 0, 0], [0, 0, 1]]) { cube(1); }",
        b"multmatrix(7) { cube(1); }",
        b"polyhedron(points = [[0, 0, 0]], faces = [[0, 1, 2]]);",
        b"polyhedron(points = 3, faces = [[0, 1, 2]]);",
        b"polyhedron(points = [[0, 0, 0], [1, 0, 0], [0, 1, 0]], faces = [[0, 1, -1]]);",
        b"polyhedron(points = [[0, 0, 0], [1, 0, 0], [0, 1, 0]], faces = [[0, 1, 1e30]]);",
        b"linear_extrude(height = 1, slices = 1e12, twist = 9) { square(1); }",
        b"rotate_extrude($fn = 1e12) { square(1); }",
        b"square(size = 1);",
        b"cube(size = 1))",
        b"cube(size = 1;",
        b"cube(size == 1);",
        b"cube(" + b"[" * 5000,
        b"\x00cube(1);",
        b"cube(1);\xff",
    ):
        yield Broken(repr(text[:100])[1:], ".csg", text)
    # What is left out leaves nothing.
    for text in (
        b'import(file = "none.stl");',
        b"cube(size = nan);",
        b'surface(file = "none.dat");',
        b'surface(file = ".");',
        b'import(file = ".");',
    ):
        yield Broken(repr(text)[1:], ".csg", text, REFUSED)
    yield Broken("nothing", ".csg", b"union();", REFUSED)
    open_body = b"polyhedron(points = [[0, 0, 0], [1, 0, 0], [0, 1, 0]], faces = [[0, 1, 2]]);"
    yield Broken("an open polyhedron", ".csg", open_body, REFUSED)
    yield Broken("beyond the lattice", ".csg", b"cube(size = 1e308);")
    deep = b"union() {" * 20_000 + b"}" * 19_999
    yield Broken("deep and never closed", ".csg", deep)


def _json_trees() -> Iterator[Broken]:
    data = good_tree()
    yield from _everywhere(".json", data)
    for size in (1, 10, len(data) // 2, len(data) - 1):
        yield Broken(f"cut after {size} bytes", ".json", data[:size])
    head = b'{"format": "bspcsg-csg", "version": 1, "nodes": '
    for nodes in (
        b"{}}",
        b"[3]}",
        b'[{"node": 3}]}',
        b'[{"node": "cu be"}]}',
        b'[{"node": "none_such"}]}',
        b'[{"node": "cube", "arguments": [{"name": "size"}]}]}',
        b'[{"node": "cube", "arguments": [{"name": "size", "value": 1e999}]}]}',
        b'[{"node": "cube", "arguments": [{"name": "size", "value": {}}]}]}',
        b'[{"node": "cube", "modifiers": "?"}]}',
        b'[{"node": "cube", "children": 1}]}',
        b"[" * 100_000,
        b'[{"node": "union", "children": ' * 300 + b"[]" + b"}]" * 300 + b"}",
    ):
        yield Broken(f"nodes {nodes[:70]!r}", ".json", head + nodes)
    for old, new in ((b"bspcsg-csg", b"other"), (b'"version": 1', b'"version": 2')):
        yield Broken(f"{new!r}", ".json", swapped(data, old, new))


# Drawings, as scripts import them


def good_drawing(suffix: str) -> bytes:
    """Return a drawing of the square from the origin to (2, 2)."""
    square = Region.rectangle(2, 2)
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / f"square{suffix}"
        (square.to_svg if suffix == ".svg" else square.to_dxf)(path)
        return path.read_bytes()


def _svg() -> Iterator[Broken]:
    data = good_drawing(".svg")
    # XML may well be in UTF-16.
    yield from (case for case in _everywhere(".svg", data) if not case.name.startswith("UTF"))
    for size in (10, len(data) // 2, len(data) - 3):
        yield Broken(f"cut after {size} bytes", ".svg", data[:size])
    typed = _entities(system=False) + data[data.index(b"<svg") :]
    yield Broken("entities that multiply", ".svg", typed)
    yield Broken("an entity from a file", ".svg", _entities(system=True) + data)
    yield Broken("no drawing", ".svg", b"<html/>")
    yield Broken("only lines", ".svg", b'<svg xmlns="http://www.w3.org/2000/svg"/>', REFUSED)
    for path in (b"M0 0 L1e999 0 L0 1", b"M0 0 Lnan 0 L0 1", b"M0 0 L1e200 0 L0 1e200z"):
        drawn = b'<svg xmlns="http://www.w3.org/2000/svg"><path d="' + path + b'"/></svg>'
        yield Broken(f"path {path!r}", ".svg", drawn, REFUSED)


def _dxf() -> Iterator[Broken]:
    data = good_drawing(".dxf")
    yield from _everywhere(".dxf", data)
    for size in (3, 100, 5000, len(data) // 2):
        yield Broken(f"cut after {size} bytes", ".dxf", data[:size])
    for old, new in ((b"SECTION", b"SELECTION"), (b"  0\n", b"  x\n")):
        yield Broken(f"{new!r} for {old!r}", ".dxf", swapped(data, old, new))


def good_tree() -> bytes:
    """Return a tree with the cube, as JSON."""
    return csg.to_json(csg.parse(CSG.decode())).encode()


def all_broken() -> list[Broken]:
    """Return the broken files of all mesh formats."""
    makers = (_stl_binary, _stl_text, _obj, _ply_text, _ply_binary, _off, _3mf, _glb)
    return [case for make in makers for case in make()]


def all_broken_scripts() -> list[Broken]:
    """Return the broken scripts and trees."""
    return [*_csg(), *_json_trees()]


def all_broken_drawings() -> list[Broken]:
    """Return the broken drawings."""
    return [*_svg(), *_dxf()]
