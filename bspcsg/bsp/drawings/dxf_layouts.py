"""The choice of the space of a DXF drawing that is read."""

from collections.abc import Callable
from typing import Any

from .left_out import LeftOut

#: The layer of what names none; what a block has there lies on the layer of each insertion.
ANY_LAYER = "0"

#: Windows of a paper space on the model.
WINDOW = "VIEWPORT"


def drawn_layout(document: Any, is_wanted: Callable[[str], bool], lost: LeftOut) -> Any:
    """Return the model space of a drawing or, if it is empty, the first nonempty paper space.

    Entities of other spaces on wanted layers count as left out.
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
    return bool(entity.dxftype() != WINDOW)
