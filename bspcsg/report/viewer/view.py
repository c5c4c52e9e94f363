"""The page of one model: the interactive view, and a picture where that is not to be had."""

from collections.abc import Sequence

from ..assets import rendered
from .faces import OWN
from .landmark import Landmark
from .layer import Layer, bounds_of
from .packing import packed
from .still import still

_SIZE = (800, 600)


def view_page(
    layers: Sequence[Layer],
    title: str,
    *,
    unit: str = "",
    embedded: bool = False,
    paint: str = "",
    landmarks: Sequence[Landmark] = (),
    notes: Sequence[str] = (),
    live: str = "",
    shared: str = "",
) -> str:
    """Return a page that shows meshes, whole in one file.

    Parameters
    ----------
    layers : sequence of Layer
    title : str
    unit : str
        The unit of lengths.
    embedded : bool
        Leave out what a notebook's cell has no room for.
    paint : str
        The name of the paint that is on at first; by default colours and materials, if there are.
    landmarks : sequence of Landmark
        The places that the page offers to look at.
    notes : sequence of str
        Sentences below the title.
    live : str
        The address at which the page asks whether it is out of date, on the server that it is from.
    shared : str
        The name of a viewer that the page around this one holds; by default the page has its own.

    Raises
    ------
    MissingPartError
        If Jinja2 is not installed.
    """
    low, high = bounds_of(layers)
    chosen = paint or _own_colours(layers)
    return rendered(
        "view.html",
        title=title,
        model=packed(layers, quantised=embedded, unit=unit, paint=chosen, landmarks=landmarks),
        picture=still(layers, size=_SIZE),
        notes=notes,
        live=live,
        size=" × ".join(f"{side:.6g}" for side in (high - low).tolist()),
        unit=unit,
        embedded=embedded,
        shared=shared,
    )


def _own_colours(layers: Sequence[Layer]) -> str:
    """Return the paint that shows layers as their files say they look, if one does."""
    names = {paint.name for layer in layers for paint in layer.paints}
    return next((name for name in OWN if name in names), "")
