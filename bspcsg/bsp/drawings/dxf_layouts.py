"""The choice of the layout of a DXF drawing to read: its model space or a paper space."""

from collections.abc import Callable
from typing import Any

from .unread_content import UnreadContent

#: The default layer of entities; entities of a block on it lie on the layer of the insertion.
ANY_LAYER = "0"

#: The kind of entities that are windows of a paper space on the model space.
VIEWPORT = "VIEWPORT"


def layout_with_content(
    document: Any, is_wanted: Callable[[str], bool], lost: UnreadContent
) -> Any:
    """Return the model space of a drawing or, if it is empty, the first nonempty paper space.

    Wanted entities of the other spaces are counted in `lost`.
    """
    papers = [layout for layout in document.layouts if layout.is_any_paperspace]
    # The active layout comes first.
    papers.sort(key=lambda layout: not layout.is_active_paperspace)
    model = document.modelspace()
    drawn = [layout for layout in (model, *papers) if any(map(_counts, layout))]
    for other in drawn[1:]:
        for entity in filter(_counts, other):
            if is_wanted(entity.dxf.get("layer") or ANY_LAYER):
                lost.add("entity in paper space")
    return drawn[0] if drawn else model


def _counts(entity: Any) -> bool:
    return bool(entity.dxftype() != VIEWPORT)
