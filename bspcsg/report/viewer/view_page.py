"""The page with the interactive 3D view of one model, and a picture as a fallback."""

from collections.abc import Sequence

from ..assets import rendered
from .face_colours import OWN
from .landmark import Landmark
from .layer import Layer, bounds_of
from .packing import packed
from .still_pictures import still_picture

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
    """Return a page that shows meshes, as one self-contained file.

    Parameters
    ----------
    layers : sequence of Layer
    title : str
    unit : str
        The unit of lengths.
    embedded : bool
        True to omit the parts for which a notebook cell has no room.
    paint : str
        The name of the initial paint; by default that of materials or colours, if there is one.
    landmarks : sequence of Landmark
        The points of interest that the page offers.
    notes : sequence of str
        Sentences below the title.
    live : str
        The address on its server at which the page checks whether it is out of date.
    shared : str
        The name of a viewer in the enclosing page; by default the page contains the viewer's code.

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
        picture=still_picture(layers, size=_SIZE),
        notes=notes,
        live=live,
        size=" × ".join(f"{side:.6g}" for side in (high - low).tolist()),
        unit=unit,
        embedded=embedded,
        shared=shared,
    )


def _own_colours(layers: Sequence[Layer]) -> str:
    """Return the name of the paint with the files' own materials or colours, or an empty string."""
    names = {paint.name for layer in layers for paint in layer.paints}
    return next((name for name in OWN if name in names), "")
