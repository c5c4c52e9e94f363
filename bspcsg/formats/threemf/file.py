"""Reading of 3MF: build items with their components and transforms, in millimetres."""

from collections import Counter
from collections.abc import Sequence
from dataclasses import replace
from functools import partial

import numpy as np

from ..._types import FloatArray
from ...errors import Finding
from ..mesh_placement import PlacedMesh, is_exact, placed_meshes
from ..raw import RawMesh, empty_set
from ..source import Source
from .objects import Objects
from .package import Package, opened
from .part import MILLIMETRES, ModelPart
from .slicers import NEGATIVE, Slicing, apply_slicer_settings

#: The largest number of triangles of all build items together.
_MAX_BUILD_TRIANGLES = 1 << 27


def read(source: Source) -> RawMesh:
    """Read all build items of a 3MF file as one mesh.

    Raises
    ------
    FormatError
        If the archive is damaged or has no model, or the model is not valid or needs an extension
        that is not supported.
    """
    with opened(source) as package:
        root = package.root()
        if package.is_empty_set(root):
            return replace(empty_set(), unit="mm")
        return _assembled(package, root)


def _assembled(package: Package, root: str) -> RawMesh:
    """Return one mesh of all build items of the model part `root`, with findings."""
    part, objects = package.part(root), Objects(package)
    slicing = apply_slicer_settings(package, root)
    pieces, findings = [], list(_unit_finding(part))
    unit = np.eye(4, 3) * MILLIMETRES[part.unit]
    beams = hollow = triangles = 0
    skipped: Counter[str] = Counter()
    built = objects.placed(root, part.items)
    for path, item, transforms in built:
        known = package.part(path).objects[item]
        beams += known.beams
        if not known.is_body and not known.beams:
            hollow += 1
            continue
        if known.kind != "model":
            skipped[known.kind] += 1
            continue
        mesh = objects.mesh(path, item)
        triangles += len(mesh.faces)
        if triangles > _MAX_BUILD_TRIANGLES:
            raise package.source.error(
                f"the build has more than {_MAX_BUILD_TRIANGLES} triangles in all, the largest"
                " number that is read.",
                "too_large",
            )
        pieces.append(_moved(mesh, (*transforms, unit)))
    findings += _other_units(package, part.unit)
    findings += _ignored(beams, "beams")
    for kind, count in skipped.items():
        findings += _ignored(count, f"objects of the type “{kind}”")
    findings += [*slicing.findings, *_left_out(slicing, objects.unmade)]
    findings += _ignored(hollow, "objects without triangles")
    reached = {(path, item) for path, item, _ in built} | objects.used() | slicing.inner
    findings += _ignored(len(_bodies(package) - reached), "objects that the build does not use")
    mesh = placed_meshes(pieces) if triangles or not objects.used() else empty_set()
    dropped = sorted(set().union(*(part.dropped for part in package.parts.values())))
    told = (*mesh.findings, *findings)
    return replace(mesh, findings=told, unit="mm", dropped=tuple(dropped))


def _bodies(package: Package) -> set[tuple[str, str]]:
    """Return part and id of each object with triangles or beams, in the parts already parsed."""
    parts = package.parts.items()
    objects = ((path, item, one) for path, part in parts for item, one in part.objects.items())
    return {(path, item) for path, item, one in objects if one.is_body or one.beams}


def _moved(mesh: RawMesh, transforms: tuple[FloatArray, ...]) -> PlacedMesh:
    """Return a mesh with its transforms, applied in order; mirrored triangles are reversed."""
    moving = [matrix for matrix in transforms if (matrix != np.eye(4, 3)).any()]
    sizes = [float(np.linalg.det(matrix[:3])) for matrix in moving]
    faces, said = mesh.faces, mesh.attributes
    if sum(size < 0 for size in sizes) % 2:
        faces, said = faces[:, ::-1], said and said.reordered([2, 1, 0])
    own = RawMesh(mesh.vertices, faces, mesh.name, attributes=said)
    keeps = 0 in sizes or _round_none(mesh.vertices, moving)
    map_ = b"".join(matrix.tobytes() for matrix in moving)
    return PlacedMesh(own, partial(_images, moving=moving), keeps, map_)


def _round_none(vertices: FloatArray, moving: Sequence[FloatArray]) -> bool:
    for matrix in moving:
        with np.errstate(invalid="ignore", over="ignore"):
            if not is_exact(vertices, matrix[:3].T, matrix[3]):
                return False
        vertices = _image(vertices, matrix)
    return True


def _images(vertices: FloatArray, moving: Sequence[FloatArray]) -> FloatArray:
    for matrix in moving:
        vertices = _image(vertices, matrix)
    return vertices


def _image(vertices: FloatArray, matrix: FloatArray) -> FloatArray:
    x, y, z = vertices.T
    with np.errstate(invalid="ignore", over="ignore"):
        columns = [
            x * matrix[0, k] + y * matrix[1, k] + z * matrix[2, k] + matrix[3, k] for k in range(3)
        ]
    return np.stack(columns, axis=1)


def _unit_finding(part: ModelPart) -> tuple[Finding, ...]:
    if part.unit == "millimeter":
        return ()
    message = (
        f"the unit of the file is {part.unit}; coordinates were multiplied by"
        f" {MILLIMETRES[part.unit]} to get millimetres."
    )
    return (Finding("unit", "note", message, (), 1),)


def _other_units(package: Package, unit: str) -> tuple[Finding, ...]:
    """Return a finding if parts have another unit than the root's, which is used; else nothing."""
    others = [path for path, part in package.parts.items() if part.unit != unit]
    if not others:
        return ()
    told = ", ".join(f"{path} ({package.parts[path].unit})" for path in others)
    message = (
        f"parts of the package have other units than the model ({told}); the unit of the model,"
        f" {unit}, was used for them."
    )
    return (Finding("unit", "warning", message, (), len(others)),)


def _left_out(slicing: Slicing, unmade: list[str]) -> list[Finding]:
    """Return findings about a slicer's parts that are no material: modifiers, negative volumes.

    `unmade` are the reasons why negative volumes could not be subtracted.
    """
    found: list[Finding] = []
    for kind, count in slicing.counts.items():
        if kind != NEGATIVE:
            found += _ignored(count, f"{kind} of a slicer, which are not material,")
        elif slicing.shapes > len(unmade):
            message = f"{count} {kind} of a slicer were subtracted from the parts of their objects."
            found.append(Finding("negative_volumes", "note", message, (), count))
        elif not unmade and not slicing.unmade:
            unmade = ["there is no part to subtract them from."]
    for reason in (*slicing.unmade, *unmade):
        message = (
            f"{NEGATIVE} of a slicer were ignored, because they could not be subtracted: {reason}"
        )
        found.append(Finding("ignored", "warning", message, (), 1))
    return found


def _ignored(count: int, what: str) -> tuple[Finding, ...]:
    if not count:
        return ()
    return (Finding("ignored", "warning", f"{count} {what} were ignored.", (), count),)
