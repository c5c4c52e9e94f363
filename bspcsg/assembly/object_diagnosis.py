"""Diagnoses of files with several objects, of each object and of the volume that objects share.

Objects that touch are separate solids. Objects that share open edges are patches of one surface,
and are diagnosed together.
"""

from collections import Counter
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from typing import TypeVar

import numpy as np

from .._types import IndexArray
from ..errors import Finding
from ..formats.raw import RawMesh, compacted
from ..mesh.certificate import Precision
from ..mesh.mesh import surfaces_of
from ..mesh.weld import welded
from ..operations.setops import union
from ..repair.diagnosis import Diagnosis, EdgeUses, by_severity, diagnose
from ..solid.ledger import uncounted
from ..solid.solid import Solid
from .clashes import Clash, clashes_of
from .tree import Part

_Any = TypeVar("_Any")
_Number = TypeVar("_Number", int, float)

#: The separator between the names of patches that form one object, and the largest number of names
#: in an object's name.
_NAME_SEPARATOR, _MAX_NAMES_SHOWN = " + ", 3

#: The verdicts on an object, from the worst to the best.
_VERDICTS = ("refused", "not closed", "empty", "inside out", "solid")


@dataclass(frozen=True, eq=False)
class ExaminedObject:
    """One object of a file, and its diagnosis.

    Parameters
    ----------
    name : str
        The object's name, unique in its file.
    mesh : RawMesh
        The object's triangles.
    diagnosis : Diagnosis
        The diagnosis of the object alone.
    """

    name: str
    mesh: RawMesh
    diagnosis: Diagnosis


@dataclass(frozen=True, eq=False)
class Examination:
    """The diagnosis of a file and of each of its objects.

    Parameters
    ----------
    mesh : RawMesh
        The contents of the file.
    diagnosis : Diagnosis
        The diagnosis of the whole file: the worst verdict, and the findings about each object.
    objects : tuple of ExaminedObject
        The objects; empty if the file has only one.
    clashes : tuple of Clash
        The pairs of objects that share volume.
    """

    mesh: RawMesh
    diagnosis: Diagnosis
    objects: tuple[ExaminedObject, ...] = ()
    clashes: tuple[Clash, ...] = ()


@uncounted
def examine(raw: RawMesh) -> Examination:
    """Diagnose a mesh as a whole, or each of its objects separately if there are several."""
    groups = _objects_of(raw)
    if len(groups) < 2:
        return Examination(raw, diagnose(raw))
    objects = []
    for name, rows in groups:
        used, faces = compacted(raw.faces[rows])
        attributes = (
            None if raw.attributes is None else raw.attributes.for_faces(rows).with_used_materials()
        )
        mesh = RawMesh(raw.vertices[used], faces, name, unit=raw.unit, attributes=attributes)
        objects.append(ExaminedObject(name, mesh, diagnose(mesh)))
    clashes = _clashes(objects)
    findings = [*raw.findings, *_findings(objects, [rows for _, rows in groups])]
    findings += _clash_finding(clashes)
    return Examination(
        raw, _file_diagnosis(raw, objects, clashes, findings), tuple(objects), tuple(clashes)
    )


def _objects_of(raw: RawMesh) -> list[tuple[str, IndexArray]]:
    """Return the name and the triangle numbers of each object of a mesh.

    Objects that are patches of one surface form one object. The list is empty if the mesh is not
    divided into several objects.
    """
    parts = [(name, count) for name, count in raw.objects if count]
    counts = [count for _, count in parts]
    if len(parts) < 2 or sum(counts) != len(raw.faces):
        return []
    owner = np.repeat(np.arange(len(parts)), counts)
    group = _surfaces(raw, owner, len(parts))
    names = _with_numbers([name or f"part {number}" for number, (name, _) in enumerate(parts, 1)])
    found = []
    for one in dict.fromkeys(group.tolist()):
        members = np.flatnonzero(group == one)
        called = [names[member] for member in members[:_MAX_NAMES_SHOWN].tolist()]
        more = (
            [f"{len(members) - _MAX_NAMES_SHOWN} more"] if len(members) > _MAX_NAMES_SHOWN else []
        )
        found.append((_NAME_SEPARATOR.join([*called, *more]), np.flatnonzero(group[owner] == one)))
    return found


def _surfaces(raw: RawMesh, owner: IndexArray, count: int) -> IndexArray:
    """Return a surface number for each object, (count,), equal for objects with a common open edge.

    `owner` is the object of each triangle.
    """
    vertices, same = welded(raw.vertices)
    edges = EdgeUses(same[raw.faces], len(vertices))
    uses, times = np.unique(edges.edge * count + owner[edges.face], return_counts=True)
    # Open edges of objects, sorted by edge: objects that share one are patches of one surface.
    edge, patch = np.divmod(uses[times == 1], count)
    shared = np.flatnonzero(edge[1:] == edge[:-1])
    links = np.stack([patch[shared], patch[shared + 1]], axis=1)
    alone = np.repeat(np.arange(count)[:, None], 2, axis=1)
    # Write a link as a triangle that repeats a corner.
    return surfaces_of(np.concatenate([alone, links])[:, [0, 1, 1]], count)[:count]


def _with_numbers(names: Sequence[str]) -> list[str]:
    """Return the names, with a number added to each name that repeats an earlier one."""
    seen: Counter[str] = Counter()
    numbered = []
    for name in names:
        seen[name] += 1
        numbered.append(f"{name} ({seen[name]})" if seen[name] > 1 else name)
    return numbered


def _findings(objects: Sequence[ExaminedObject], rows: Sequence[IndexArray]) -> Iterator[Finding]:
    """Yield the findings about each object, with its name and with triangle numbers of the file.

    `rows` are the triangle numbers of each object.
    """
    for one, faces in zip(objects, rows, strict=True):
        for found in one.diagnosis.findings:
            where = tuple(faces[list(found.where)].tolist()) if found.where else ()
            yield replace(found, message=f"“{one.name}”: {found.message}", where=where)


def _clashes(objects: Sequence[ExaminedObject]) -> list[Clash]:
    """Return the pairs of objects that share volume; objects that are not solids are ignored."""
    solids = [one for one in objects if one.diagnosis.is_solid]
    boxes = np.array([one.diagnosis.bounds for one in solids]).reshape(-1, 2, 3)
    near: set[int] = set()
    for number, (low, high) in enumerate(boxes):
        meets = (boxes[number + 1 :, 0] < high) & (boxes[number + 1 :, 1] > low)
        others = np.flatnonzero(meets.all(axis=1)) + number + 1
        near.update(others.tolist(), [number] * bool(len(others)))
    parts = [_part(solids[number]) for number in sorted(near)]
    return clashes_of(parts, 0.0)


def _part(one: ExaminedObject) -> Part:
    solid = Solid(one.mesh.vertices, one.mesh.faces)
    return Part(one.name, one.name, solid, (), None, None)


def _clash_finding(clashes: Sequence[Clash]) -> Iterator[Finding]:
    if clashes:
        first = clashes[0]
        pairs = (
            "1 pair of objects has"
            if len(clashes) == 1
            else f"{len(clashes)} pairs of objects have"
        )
        place = "({:.6g}, {:.6g}, {:.6g})".format(*first.place.tolist())
        message = (
            f"{pairs} volume in common; the first pair is “{first.first}” and"
            f" “{first.second}”, with a common volume of {first.volume:.6g} near {place}"
        )
        yield Finding("clash", "warning", message, (), len(clashes))


def _file_diagnosis(
    raw: RawMesh,
    objects: Sequence[ExaminedObject],
    clashes: Sequence[Clash],
    findings: Sequence[Finding],
) -> Diagnosis:
    """Return the diagnosis of a file, summed up from the diagnoses of its objects."""
    each = [one.diagnosis for one in objects]
    overlaps = _all_known([one.self_overlapping for one in each])
    boxes = np.array([one.bounds for one in each])
    low, high = boxes[:, 0].min(axis=0).tolist(), boxes[:, 1].max(axis=0).tolist()
    return Diagnosis(
        triangles=len(raw.faces),
        vertices=len(raw.vertices),
        closed=all(one.closed for one in each),
        oriented=all(one.oriented for one in each),
        manifold=all(one.manifold for one in each),
        self_overlapping=None if overlaps is None else any(overlaps) or bool(clashes),
        precision=_coarsest_precision(each),
        crossings=_sum([one.crossings for one in each]),
        verdict=min((one.verdict for one in each), key=_VERDICTS.index),
        findings=by_severity(findings),
        signed_volume=sum(one.signed_volume for one in each),
        area=sum(one.area for one in each),
        volume=_union_volume(objects, clashes),
        surfaces=sum(one.surfaces for one in each),
        genus=_sum([one.genus for one in each]),
        bounds=(tuple(low), tuple(high)),
    )


def _coarsest_precision(each: Sequence[Diagnosis]) -> Precision | None:
    """Return the coarsest precision that represents all objects; None if one has none."""
    found = {one.precision for one in each}
    if None in found:
        return None
    return "double" if "double" in found else "single"


def _union_volume(objects: Sequence[ExaminedObject], clashes: Sequence[Clash]) -> float | None:
    """Return the volume of the union of all objects; None if an object's volume is unknown."""
    total = _sum([one.diagnosis.volume for one in objects])
    if total is None or not clashes:
        return total
    return union(*(_part(one).solid for one in objects if one.diagnosis.is_solid)).volume


def _all_known(values: "Sequence[_Any | None]") -> "list[_Any] | None":
    """Return the values, or None if one of them is None."""
    known = [value for value in values if value is not None]
    return known if len(known) == len(values) else None


def _sum(values: "Sequence[_Number | None]") -> "_Number | None":
    known = _all_known(values)
    return None if known is None else sum(known)
