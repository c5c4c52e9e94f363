"""Plane figures of solids: projection."""

from ...bsp import Region
from ...solid.solid import Solid
from ..syntax.tree import Node
from .registry import Evaluation, Geometry, node
from .sets import union_of
from .signature import Signature


@node("projection", takes=Signature(("cut",)))
def projection(owner: Node, children: list[Geometry], run: Evaluation) -> Geometry:
    """Return the children's shadow on the plane z = 0, or their section by it (`cut`)."""
    arguments = run.arguments(owner)
    body = union_of(owner, run.solids(owner, children), run)
    if not isinstance(body, Solid):
        return None
    if body.is_empty:
        return Region.empty()
    return _section(body) if arguments.flag("cut") else body.project()


def _section(body: Solid) -> Region:
    """Return the section of the closed body, with faces that touch the plane from either side."""
    return body.slice(0) | body.mirror((0, 0, 1)).slice(0)
