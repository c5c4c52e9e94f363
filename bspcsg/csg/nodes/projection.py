"""Plane figures of solids: projection."""

import numpy as np

from ...bsp import Region
from ...solid.solid import Solid
from ..syntax.tree import Node
from .registry import Evaluation, Geometry, node
from .sets import union_of


@node("projection")
def projection(owner: Node, children: list[Geometry], run: Evaluation) -> Geometry:
    """Return the children's shadow on the plane z = 0, or their section by it (`cut`)."""
    arguments = run.arguments(owner, ("cut",))
    body = union_of(owner, children, run)
    if isinstance(body, Region):
        run.warn(owner, "its children are plane figures; they are ignored")
        return None
    if body is None:
        return None
    if body.is_empty:
        return Region.empty()
    return _section(body) if arguments.flag("cut") else shadow(body)


def _section(body: Solid) -> Region:
    """Return the section of the closed body: what touches the plane from either side counts."""
    return body.slice(0) | body.mirror((0, 0, 1)).slice(0)


def shadow(body: Solid) -> Region:
    """Return the projection of a solid along z.

    It is what the triangles cover that face upwards; the edges they share with each other cancel.
    """
    mesh = body.normalized().to_mesh()
    a, b, c = (mesh.vertices[mesh.faces[:, k]][:, :2] for k in range(3))
    p, q = b - a, c - a
    faces = mesh.faces[p[:, 0] * q[:, 1] - p[:, 1] * q[:, 0] > 0]
    edges = np.concatenate([faces[:, [0, 1]], faces[:, [1, 2]], faces[:, [2, 0]]])
    keys = edges[:, 0] * len(mesh.vertices) + edges[:, 1]
    back = edges[:, 1] * len(mesh.vertices) + edges[:, 0]
    segments = mesh.vertices[edges[~np.isin(keys, back)]][:, :, :2]
    proper = (segments[:, 0] != segments[:, 1]).any(axis=1)
    return Region.from_segments(segments[proper], pitch=body.tree.pitch)
