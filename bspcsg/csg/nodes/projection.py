"""Evaluation of the node projection."""

from ...bsp import Region
from ...solid.solid import Solid
from ..syntax.tree import Node
from .registry import Evaluation, Geometry, node
from .set_operations import union_of
from .signature import Signature


@node("projection", takes=Signature(("cut",)))
def projection(owner: Node, children: list[Geometry], run: Evaluation) -> Geometry:
    """Return the projection of the children onto z = 0; with `cut`, their section at z = 0."""
    arguments = run.arguments(owner)
    body = union_of(owner, run.solids(owner, children), run)
    if not isinstance(body, Solid):
        return None
    if body.is_empty:
        return Region.empty()
    return _section(body) if arguments.flag("cut") else body.project()


def _section(body: Solid) -> Region:
    """Return the section of a solid at z = 0, including faces that lie in the plane."""
    return body.slice(0) | body.mirror((0, 0, 1)).slice(0)
