"""Views of solids and regions in a notebook: an interactive 3D view, or a picture."""

from collections.abc import Sequence
from html import escape
from typing import TYPE_CHECKING

from ...errors import BspcsgError, MissingPartError, not_none
from .layer import Layer
from .shared_script import NOTEBOOK, is_notebook, running_cell, viewer_name
from .still_pictures import rough_picture
from .view_page import view_page

if TYPE_CHECKING:
    from ...bsp import Picture, Region
    from ...solid.solid import Solid

#: The largest number of triangles in an interactive view, which then takes about two megabytes.
#: For more triangles a cell shows a picture.
_MAX_VIEW_TRIANGLES = 200_000

#: The largest number of triangles in a picture of a solid; a solid of more is simplified.
_MAX_PICTURE_TRIANGLES = 2_000

#: The largest number of triangles in a picture of a region; a region of more is simplified.
_MAX_REGION_TRIANGLES = 20_000

#: The height of an interactive view in a cell, in pixels.
_HEIGHT = 440

_SIZE = (480, 360)


def solid_html(solid: "Solid") -> str | None:
    """Return HTML with the interactive view of a solid, or a sentence if it cannot be shown.

    Return None if Jinja2 is not installed: the notebook then shows the picture.
    """
    sentence = _obstacle(solid)
    if sentence:
        return _paragraph(sentence)
    layer = _layer(solid)
    count = f"{len(layer.faces):,} triangles"
    if len(layer.faces) > _MAX_VIEW_TRIANGLES:
        said = (
            f"{count} are too many for an interactive view in a notebook; save the solid and run"
            " bspcsg view on the file."
        )
        return _picture(solid).svg + _paragraph(said)
    try:
        return framed([layer], f"solid of {count}")
    except MissingPartError:
        return None


def framed(layers: Sequence[Layer], title: str) -> str:
    """Return HTML with the interactive view of layers, in a frame.

    All views of a notebook share the code of the viewer, which the first view contains.
    """
    cell = running_cell()
    shared = "" if cell is None else viewer_name()
    page = view_page(layers, title, embedded=True, shared=shared)
    frame = (
        f'<iframe srcdoc="{escape(page)}" title="{escape(title)}" class="bspcsg"'
        f' sandbox="allow-scripts" style="width:100%;height:{_HEIGHT}px;border:0"></iframe>'
    )
    return frame if cell is None else frame + NOTEBOOK.script(cell)


def solid_svg(solid: "Solid") -> str | None:
    """Return a picture of a solid as SVG; a solid of too many triangles is simplified.

    Return None in a notebook if PNG can be made, since the notebook would store both.
    """
    sentence = _obstacle(solid)
    if sentence:
        return _words(sentence)
    return None if is_notebook() and _has_pillow() else _picture(solid).svg


def solid_png(solid: "Solid") -> bytes | None:
    """Return a picture of a solid as PNG; None if it cannot be shown, or without Pillow."""
    return None if _obstacle(solid) else _png(_picture(solid))


def region_svg(region: "Region") -> str | None:
    """Return a picture of a region as SVG, or None if it is empty or reaches to infinity."""
    return None if region.is_empty or not region.is_bounded else _figure(region).svg


def region_png(region: "Region") -> bytes | None:
    """Return a picture of a region as PNG.

    Return None if the region is empty or reaches to infinity, or without Pillow.
    """
    return None if region.is_empty or not region.is_bounded else _png(_figure(region))


def _picture(solid: "Solid") -> "Picture":
    return rough_picture(_layer(solid), _SIZE, _MAX_PICTURE_TRIANGLES)


def slab(region: "Region") -> Layer:
    """Return a layer with a region extruded to a slab, whose top has the region's shape."""
    low, high = not_none(region.bounds, "the bounds of a region")
    mesh = region.extrude(float((high - low).max())).to_mesh()
    return Layer("region", mesh.vertices, mesh.faces)


def _figure(region: "Region") -> "Picture":
    return rough_picture(slab(region), _SIZE, _MAX_REGION_TRIANGLES, "top")


def _png(picture: "Picture") -> bytes | None:
    try:
        return picture.png
    except BspcsgError as error:
        if error.code != "missing_dependency":
            raise
        return None


def _has_pillow() -> bool:
    try:
        import PIL  # noqa: F401
    except ImportError:
        return False
    return True


def _obstacle(solid: "Solid") -> str:
    """Return the reason why a solid cannot be shown, or an empty string if it can."""
    if not solid.is_bounded:
        return "This solid reaches to infinity; intersect it with a box to see a part of it."
    return "This solid is empty." if len(solid.to_mesh().faces) == 0 else ""


def _layer(solid: "Solid") -> Layer:
    mesh = solid.to_mesh()
    return Layer("solid", mesh.vertices, mesh.faces)


def _paragraph(sentence: str) -> str:
    return f"<p>{escape(sentence)}</p>"


def _words(sentence: str) -> str:
    return (
        f'<svg xmlns="http://www.w3.org/2000/svg" width="{_SIZE[0]}" height="30">'
        f'<text x="4" y="20" font-family="sans-serif" font-size="13" fill="#808080">'
        f"{escape(sentence)}</text></svg>"
    )
