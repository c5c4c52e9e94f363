"""Evaluation of the nodes cube, sphere, cylinder and polyhedron."""

import numpy as np

from ..._types import IndexArray
from ...geometry.polygon import triangulate_face
from ...mesh.weld import welded
from ...shapes.arrays import from_arrays
from ...shapes.primitives import box, cylinder
from ...shapes.sweep import quad_triangles, unit_circle
from ...solid.solid import Solid
from ..making.tessellation import Fineness
from ..syntax.tree import Node
from .registry import Evaluation, Geometry, node
from .signature import Signature


@node("cube", takes=Signature(("size", "center")))
def cube(owner: Node, children: list[Geometry], run: Evaluation) -> Geometry:
    """Make a box; it is empty if an edge has length 0 or less."""
    del children
    arguments = run.arguments(owner)
    size = arguments.vector("size", 3, (1.0, 1.0, 1.0))
    return box(size, arguments.flag("center")) if min(size) > 0 else Solid.empty()


@node("sphere", takes=Signature(("r",), ("d",), (("r", ("d",)),)))
def sphere(owner: Node, children: list[Geometry], run: Evaluation) -> Geometry:
    """Make a sphere of rings at the midpoints of equal steps of latitude, without poles."""
    del children
    arguments = run.arguments(owner)
    r = arguments.number("d") / 2 if "d" in arguments else arguments.number("r", 1.0)
    if r <= 0:
        return Solid.empty()
    around = Fineness.of(arguments).fragments(r)
    rings = (around + 1) // 2
    arguments.limited(around * rings, "this sphere")
    return _sphere(r, arguments.sides(around, "this sphere"), int(rings))


def _sphere(r: float, around: int, rings: int) -> Solid:
    # The midpoints of `rings` equal steps from pole to pole.
    half = unit_circle(4 * rings)[1 : 2 * rings : 2]
    circle = unit_circle(around)
    levels = [np.column_stack([circle * sine, np.full(around, cosine)]) for cosine, sine in half]
    ids = np.arange(around * rings).reshape(rings, around)
    following = np.roll(ids, -1, axis=1)
    # The first ring is the upper one.
    bands = [
        quad_triangles(ids[k + 1], following[k + 1], ids[k], following[k]) for k in range(rings - 1)
    ]
    cap = np.array([(0, k, k + 1) for k in range(1, around - 1)])
    faces = [*bands, cap, cap[:, ::-1] + around * (rings - 1)]
    return from_arrays(np.concatenate(levels) * r, np.concatenate(faces))


_CYLINDER = Signature(
    ("h", "r1", "r2", "center"),
    ("r", "d", "d1", "d2"),
    (
        *(("r", ("d",)), ("r1", ("d1",)), ("r2", ("d2",))),
        # A radius of both ends applies to an end without its own radius.
        *((both, (f"{low}1", f"{high}2")) for both in "rd" for low in "rd" for high in "rd"),
    ),
)


@node("cylinder", takes=_CYLINDER)
def cylinder_node(owner: Node, children: list[Geometry], run: Evaluation) -> Geometry:
    """Make a cylinder or cone; it is empty if the height or both radii are 0 or less."""
    del children
    arguments = run.arguments(owner)
    h = arguments.number("h", 1.0)
    r = arguments.number("d") / 2 if "d" in arguments else arguments.number("r", 1.0)
    low, high = (
        arguments.number(f"d{end}") / 2
        if f"d{end}" in arguments
        else arguments.number(f"r{end}", r)
        for end in "12"
    )
    if h <= 0 or min(low, high) < 0 or max(low, high) <= 0:
        return Solid.empty()
    sides = Fineness.of(arguments).fragments(max(low, high))
    segments = arguments.sides(sides, "this cylinder")
    return cylinder(h, r1=low, r2=high, segments=segments, center=arguments.flag("center"))


_POLYHEDRON = Signature(
    ("points", "faces", "convexity"), ("triangles",), (("triangles", ("faces",)),)
)


@node("polyhedron", takes=_POLYHEDRON)
def polyhedron(owner: Node, children: list[Geometry], run: Evaluation) -> Geometry:
    """Make the solid that polygons bound, all clockwise or all counter-clockwise from outside."""
    del children
    arguments = run.arguments(owner)
    points = np.array(arguments.points("points", 3)).reshape(-1, 3)
    name = "faces" if "faces" in arguments else "triangles"
    faces = [face for face in arguments.index_lists(name, len(points)) if len(face) >= 3]
    if not faces:
        return Solid.empty()
    triangles = np.concatenate([_triangles(points, face[::-1]) for face in faces])
    vertices, same = welded(points)
    triangles = same[triangles]
    proper = (triangles != np.roll(triangles, 1, axis=1)).all(axis=1)
    if not proper.any():
        return Solid.empty()
    if run.lenient and run.on_invalid == "warn" and not run.in_hull:
        # Open edges on one line may cancel each other; OpenSCAD omits such meshes, too.
        count = _open_edges(triangles)
        if count:
            run.warn(
                owner,
                f"its faces do not form a closed surface: {count} edges are open. This node is"
                " left out.",
            )
            return Solid.empty()
    return run.closed_solid(owner, vertices, triangles[proper])


def _open_edges(triangles: IndexArray) -> int:
    """Return the number of edges that triangles use more often in one direction than the other."""
    ends = np.stack([triangles, np.roll(triangles, -1, axis=1)], axis=-1).reshape(-1, 2)
    _, edge = np.unique(np.sort(ends, axis=1), axis=0, return_inverse=True)
    turns = np.bincount(edge.ravel(), np.sign(ends[:, 1] - ends[:, 0]))
    return int(np.count_nonzero(turns))


def _triangles(points: np.ndarray, face: list[int]) -> np.ndarray:
    corners = np.array(face)
    return corners[triangulate_face(points[corners])]
