"""The page of one model: the interactive view, and a picture where that is not to be had."""

from collections.abc import Sequence

from ..assets import rendered
from .layer import Layer, bounds_of
from .packing import packed
from .still import still

_SIZE = (800, 600)


def view_page(
    layers: Sequence[Layer], title: str, *, unit: str = "", embedded: bool = False
) -> str:
    """Return a page that shows meshes, whole in one file.

    Parameters
    ----------
    layers : sequence of Layer
    title : str
    unit : str
        What lengths are shown in.
    embedded : bool
        Leave out what a notebook's cell has no room for.

    Raises
    ------
    MissingPartError
        If Jinja2 is not installed.
    """
    low, high = bounds_of(layers)
    return rendered(
        "view.html",
        title=title,
        model=packed(layers, quantised=embedded, unit=unit),
        picture=still(layers, size=_SIZE),
        size=" × ".join(f"{side:.6g}" for side in (high - low).tolist()),
        unit=unit,
        embedded=embedded,
    )
