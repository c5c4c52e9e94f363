"""Layers and landmarks that show the defects of a mesh: holes, crossings, thin walls."""

from collections.abc import Iterator, Sequence
from dataclasses import replace

import numpy as np

from ..._types import FloatArray, IndexArray
from ...assembly.object_diagnosis import Examination
from ...formats.raw import RawMesh, compacted
from ...repair.defective_elements import DefectiveElements, defective_elements_of
from ...repair.diagnosis import Diagnosis
from .landmark import Landmark
from .layer import RESULT, Layer
from .layer_making import layers_of_file, with_distinct_colours
from .paint import THICKNESS, Scale
from .thickness import thickness

_RED, _VIOLET, _PINK, _ORANGE, _YELLOW = "#e0202f", "#8b3fd1", "#d13fa6", "#f08a24", "#d6b400"

#: The largest number of landmarks for one kind of defect.
_MAX_LANDMARKS_PER_KIND = 30

#: The opacity of a mesh that has marked defects.
_BEHIND = 0.45


def layers_of_defects(
    raw: RawMesh, found: Diagnosis, thin: float | None = None
) -> tuple[list[Layer], list[Landmark]]:
    """Return layers of a mesh and of the defects found in it, and landmarks for the defects.

    Parameters
    ----------
    raw : RawMesh
    found : Diagnosis
        The diagnosis of that mesh.
    thin : float, optional
        Walls thinner than this, in model units, are marked.
    """
    marks = defective_elements_of(raw)
    layers = list(_marked(marks))
    landmarks = [*_holes(marks), *_crossings(marks)]
    walls = thickness(marks.vertices, marks.faces) if found.closed else None
    mesh = Layer("mesh", marks.vertices, marks.faces, RESULT)
    own = layers_of_file(replace(raw, objects=()), "mesh")[0]
    mesh = replace(mesh, paints=own.paints)
    if walls is not None:
        mesh = replace(mesh, paints=(*mesh.paints, Scale("thickness", walls, THICKNESS)))
        layers += _thin_walls(marks, walls, thin)
        landmarks += _thinnest(marks, walls)
    if layers:
        mesh = replace(mesh, opacity=_BEHIND)
    return [mesh, *layers], landmarks


def layers_of_objects(whole: Examination) -> tuple[list[Layer], list[Landmark]]:
    """Return a layer for each object of a file, and a landmark where two objects overlap."""
    layers = with_distinct_colours(layers_of_file(whole.mesh, whole.mesh.name))
    places = [
        Landmark(f"clash: {one.first}, {one.second}", one.place, 2 * one.volume ** (1 / 3))
        for one in whole.clashes[:_MAX_LANDMARKS_PER_KIND]
    ]
    return layers, places


def _marked(marks: DefectiveElements) -> Iterator[Layer]:
    kinds = (
        ("open edges", marks.open, _RED),
        ("turned edges", marks.turned, _PINK),
        ("edges of more than two", marks.crowded, _VIOLET),
    )
    for name, edges, colour in kinds:
        if len(edges):
            used, numbers = np.unique(edges, return_inverse=True)
            none = np.zeros((0, 3), dtype=np.int64)
            lines = numbers.reshape(-1, 2)
            yield Layer(name, marks.vertices[used], none, colour, lines=lines)
    crossing = np.unique(marks.crossings)
    faults = (
        ("crossing triangles", crossing, _ORANGE),
        ("flat triangles", marks.flat, _YELLOW),
        ("repeated triangles", marks.repeated, _VIOLET),
    )
    for name, faces, colour in faults:
        if len(faces):
            yield _outlined(marks, faces, name, colour)


def _outlined(marks: DefectiveElements, faces: IndexArray, name: str, colour: str) -> Layer:
    """Return a layer of the given faces and of their edges as lines, since faces may be flat."""
    used, renumbered = compacted(marks.faces[faces])
    lines = np.stack([renumbered, np.roll(renumbered, -1, axis=1)], axis=-1).reshape(-1, 2)
    return Layer(name, marks.vertices[used], renumbered, colour, lines=lines)


def _thin_walls(marks: DefectiveElements, walls: FloatArray, thin: float | None) -> list[Layer]:
    if thin is None:
        return []
    faces = np.flatnonzero(walls < thin)
    if not len(faces):
        return []
    used, renumbered = compacted(marks.faces[faces])
    return [Layer(f"thinner than {thin:g}", marks.vertices[used], renumbered, _RED)]


def _thinnest(marks: DefectiveElements, walls: FloatArray) -> list[Landmark]:
    if not np.isfinite(walls).any():
        return []
    face = int(np.nanargmin(walls))
    name = f"thinnest: {walls[face]:.4g}"
    return [_around(name, marks.vertices[marks.faces[face]])]


def _holes(marks: DefectiveElements) -> Iterator[Landmark]:
    """Yield landmarks at the holes, those with the most open edges first."""
    if not len(marks.open):
        return
    counts = np.bincount(marks.holes)
    for number, hole in enumerate(
        np.argsort(-counts, kind="stable")[:_MAX_LANDMARKS_PER_KIND].tolist()
    ):
        ends = marks.open[marks.holes == hole]
        yield _around(f"hole {number + 1}: {counts[hole]} edges", marks.vertices[ends.ravel()])


def _crossings(marks: DefectiveElements) -> Iterator[Landmark]:
    for number, pair in enumerate(marks.crossings[:_MAX_LANDMARKS_PER_KIND]):
        corners = marks.vertices[marks.faces[pair].ravel()]
        one, other = pair.tolist()
        yield _around(f"crossing {number + 1}: triangles {one} and {other}", corners)


def _around(name: str, points: FloatArray | Sequence[FloatArray]) -> Landmark:
    places = np.asarray(points)
    low, high = places.min(axis=0), places.max(axis=0)
    return Landmark(name, (low + high) / 2, float(np.linalg.norm(high - low)))
