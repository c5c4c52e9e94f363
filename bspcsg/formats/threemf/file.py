"""3MF, reading: build items with their components and transforms, in millimetres.

A file is a ZIP archive of XML parts. Sizes are limited before anything is unpacked and document
types are refused, so that a small file cannot grow without bound.
"""

import io
import posixpath
import zipfile
import zlib
from collections.abc import Callable, Iterator
from dataclasses import replace
from typing import TypeAlias

import numpy as np

from ..._types import FloatArray
from ...errors import Finding, FormatError
from ..placing import PlacedMesh, is_exact, placed
from ..raw import RawMesh, empty_set
from ..source import Source
from .part import MILLIMETRES, ModelPart, PartReader, PlacedObject, parse_xml
from .properties import properties_of
from .write import NOTHING

#: Most objects that a build may place, and most components that may lie in one another.
_MOST_PLACED = 100_000
_DEEPEST = 64

#: Most triangles that a build may have.
_MOST_TRIANGLES = 1 << 27

#: Parts in an archive: some 16 MB of its directory. The largest projects of slicers have hundreds.
_MOST_PARTS = 1 << 14

#: Most bytes that the parts may unpack to: 64 times the archive, and this much for small ones. The
#: XML of meshes shrinks to a fifth, that of one small part written again and again to a 13th, and
#: a part of nothing but one letter to a thousandth.
_MOST_GROWTH, _SMALL = 64, 1 << 26

#: And 2 GiB in all, some 20 million triangles.
_LARGEST = 1 << 31

#: Bytes that are unpacked at a time.
_CHUNK = 1 << 20

#: The bytes that begin the entry of a part in an archive's directory.
_ENTRY = b"PK\x01\x02"

#: The errors that the standard library raises on damaged archives.
DAMAGES = (
    zipfile.BadZipFile,
    NotImplementedError,
    RuntimeError,
    EOFError,
    zlib.error,
    OSError,
    ValueError,
)

_MODEL = "http://schemas.microsoft.com/3dmanufacturing/2013/01/3dmodel"


def read(source: Source) -> RawMesh:
    """Read every build item as one mesh.

    Raises
    ------
    FormatError
        If the archive is damaged, has no model, or the model is not valid.
    """
    if source.data.count(_ENTRY) > _MOST_PARTS:
        message = f"the archive has more than {_MOST_PARTS:,} parts."
        raise source.error(message, "too_large")
    try:
        with zipfile.ZipFile(io.BytesIO(source.data)) as archive:
            package = Package(source, archive)
            root = package.root()
            if package.is_empty_set(root):
                return replace(empty_set(), unit="mm")
            return package.assemble(root)
    except FormatError:
        raise
    except DAMAGES as error:
        message = f"the archive is damaged or cut off: {error}."
        raise source.error(message, "truncated") from error


#: The part that names an object, the object, and the transforms around it, innermost first.
_Waiting: TypeAlias = tuple[str, PlacedObject, tuple[FloatArray, ...]]


class Package:
    """The parts of one archive, each parsed once."""

    def __init__(self, source: Source, archive: zipfile.ZipFile) -> None:
        self._source = source
        self._archive = archive
        self._parts: dict[str, ModelPart] = {}
        self._pictures: dict[str, bytes] = {}
        self._entries = {entry.filename.lower(): entry for entry in archive.infolist()}
        self._left = min(max(_MOST_GROWTH * len(source.data), _SMALL), _LARGEST)

    def root(self) -> str:
        """Return the name of the part that the package's relationships call its model."""
        targets: list[str] = []

        def start(tag: str, attributes: dict[str, str]) -> None:
            if tag.endswith("Relationship") and attributes.get("Type") == _MODEL:
                targets.append(_part_name(attributes.get("Target", "")))

        if "_rels/.rels" in self._archive.namelist():
            parse_xml(*self._opened("_rels/.rels"), start)
        return targets[0] if targets else "3D/3dmodel.model"

    def is_empty_set(self, root: str) -> bool:
        """Say whether the model is what this package writes for the empty set."""
        entry = self._entries.get(root.lower())
        if entry is None or entry.file_size != len(NOTHING):
            return False
        with self._archive.open(entry) as stream:
            return stream.read(len(NOTHING) + 1) == NOTHING

    def assemble(self, root: str) -> RawMesh:
        """Return the mesh of all build items."""
        part = self.part(root)
        pieces, findings = [], list(_unit_finding(part))
        unit = np.eye(4, 3) * MILLIMETRES[part.unit]
        beams = skipped = triangles = 0
        built = self.placed(root, part.items)
        for path, item, transforms in built:
            model = self.part(path)
            beams += model.objects[item].beams
            if model.objects[item].kind != "model":
                skipped += 1
                continue
            triangles += len(model.objects[item].triangles)
            if triangles > _MOST_TRIANGLES:
                raise self._source.error("the build has too many triangles.", "too_large")
            pieces.append(_moved(model, item, (*transforms, unit), self.picture))
        findings += _ignored(beams, "beams")
        findings += _ignored(skipped, "objects that are support or surface")
        known = {(path, item) for path, item, _ in built}
        findings += _ignored(self._meshes() - len(known), "objects outside the build")
        dropped = sorted(set().union(*(part.dropped for part in self._parts.values())))
        mesh = placed(pieces)
        told = (*mesh.findings, *findings)
        return replace(mesh, findings=told, unit="mm", dropped=tuple(dropped))

    def _meshes(self) -> int:
        """Return how many objects of the parts read so far have a mesh."""
        objects = (one for part in self._parts.values() for one in part.objects.values())
        return sum(bool(one.triangles or one.beams) for one in objects)

    def placed(
        self, root: str, items: list[PlacedObject]
    ) -> list[tuple[str, str, tuple[FloatArray, ...]]]:
        """Return part, object and transforms (innermost first) of all meshes, in file order."""
        found: list[tuple[str, str, tuple[FloatArray, ...]]] = []
        waiting: list[_Waiting] = [(root, item, ()) for item in reversed(items)]
        visited = 0
        while waiting:
            here, placed, outer = waiting.pop()
            visited += 1
            path = placed.path or here
            transforms: tuple[FloatArray, ...] = (placed.transform, *outer)
            if visited > _MOST_PLACED or len(transforms) > _DEEPEST:
                raise self._source.error("the objects contain each other too often.", "too_large")
            known = self.part(path).objects.get(placed.item)
            if known is None:
                message = f"object {placed.item} does not exist in {path}."
                raise self._source.error(message, "index_out_of_range")
            if known.triangles or known.beams:
                found.append((path, placed.item, transforms))
            waiting.extend((path, inner, transforms) for inner in reversed(known.components))
        return found

    def part(self, name: str) -> ModelPart:
        """Return a part, parsed once."""
        if name not in self._parts:
            reader = PartReader(*self._opened(name), _part_name)
            self._parts[name] = reader.read()
        return self._parts[name]

    def picture(self, name: str) -> bytes:
        """Return the bytes of a part, unpacked once; none if there is no such part."""
        if name.lower() not in self._entries:
            return b""
        if name not in self._pictures:
            self._pictures[name] = b"".join(self._opened(name)[1])
        return self._pictures[name]

    def _opened(self, name: str) -> tuple[Source, Iterator[bytes]]:
        """Return what errors about a part name, and its bytes."""
        entry = self._entries.get(name.lower())
        if entry is None:
            raise self._source.error(f"the archive has no part {name}.", "truncated")
        if entry.file_size > self._left:
            raise self._too_large(name)
        return Source(f"{self._source.name}/{name}", b""), self._unpacked(entry)

    def _unpacked(self, entry: zipfile.ZipInfo) -> Iterator[bytes]:
        """Yield the bytes of a part, which may be others than the directory promises."""
        with self._archive.open(entry) as stream:
            while chunk := stream.read(_CHUNK):
                self._left -= len(chunk)
                if self._left < 0:
                    raise self._too_large(entry.filename)
                yield chunk

    def _too_large(self, name: str) -> FormatError:
        message = (
            f"the part {name} unpacks to far more than meshes do: all parts together may have"
            f" {_MOST_GROWTH} times the bytes of the archive, and {_LARGEST >> 30} GiB."
        )
        return self._source.error(message, "too_large")


def _part_name(target: str) -> str:
    return posixpath.normpath(target).lstrip("/")


def _moved(
    part: ModelPart,
    item: str,
    transforms: tuple[FloatArray, ...],
    picture: Callable[[str], bytes],
) -> PlacedMesh:
    """Return the mesh of an object under transforms; a mirrored one is turned right side out."""
    before, faces = part.objects[item].arrays()
    moving = [matrix for matrix in transforms if (matrix != np.eye(4, 3)).any()]
    vertices, mirrored, keeps = before, False, True
    for matrix in moving:
        with np.errstate(invalid="ignore", over="ignore"):
            keeps = keeps and is_exact(vertices, matrix[:3].T, matrix[3])
        vertices = _image(vertices, matrix)
        mirrored ^= bool(np.linalg.det(matrix[:3]) < 0)
    faces = faces[:, ::-1] if mirrored else faces
    said = properties_of(part, part.objects[item], faces, picture)
    if said is not None and mirrored:
        said = said.reordered([2, 1, 0])
    mesh = RawMesh(vertices, faces, part.objects[item].name, attributes=said)
    keeps = keeps or any(np.linalg.det(matrix[:3]) == 0 for matrix in moving)
    map_ = b"".join(matrix.tobytes() for matrix in moving)
    return PlacedMesh(mesh, None if keeps else before, map_)


def _image(vertices: FloatArray, matrix: FloatArray) -> FloatArray:
    x, y, z = vertices.T
    columns = [
        x * matrix[0, k] + y * matrix[1, k] + z * matrix[2, k] + matrix[3, k] for k in range(3)
    ]
    return np.stack(columns, axis=1)


def _unit_finding(part: ModelPart) -> tuple[Finding, ...]:
    if part.unit == "millimeter":
        return ()
    message = (
        f"the file is in {part.unit}s; coordinates were multiplied by {MILLIMETRES[part.unit]}."
    )
    return (Finding("unit", "note", message, (), 1),)


def _ignored(count: int, what: str) -> tuple[Finding, ...]:
    if not count:
        return ()
    return (Finding("ignored", "warning", f"{count} {what} were ignored.", (), count),)
