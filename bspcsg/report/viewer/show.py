"""The function `show`: it shows solids, assemblies and regions in a notebook or a browser."""

import sys
from collections.abc import Iterator
from importlib import import_module
from typing import Any

from ...assembly.tree import Assembly
from ...browsing import open_page, temporary_page
from ...bsp import Region
from ...errors import UnboundedError, invalid_parameter
from ...formats.atomic import write_file
from ...solid.solid import Solid
from .layer import Layer
from .layer_making import layers_of_solid, with_distinct_colours
from .notebook import slab
from .shared_script import is_notebook
from .view_page import view_page


def show(*things: Any) -> None:
    """Show solids, assemblies and regions in a notebook or a browser (see `bspcsg.show`)."""
    shown = [_seen(thing) for thing in things]
    if is_notebook():
        display: Any = import_module("IPython.display").display
        for thing in shown:
            display(thing)
    elif shown:
        _open_page([layer for thing in shown for layer in _layers(thing)])


def _seen(thing: Any) -> Solid | Region | Assembly:
    return thing if isinstance(thing, (Solid, Region, Assembly)) else Solid.from_mesh(thing)


def _open_page(layers: list[Layer]) -> None:
    """Open a page with layers in the browser, or print its path on standard error."""
    path = temporary_page("show")
    page = view_page(with_distinct_colours(layers), ", ".join(layer.name for layer in layers))
    write_file(path, [page.encode("utf-8", "replace")])
    reason = open_page(path.as_uri())
    if reason:
        sys.stderr.write(f"{path}: {reason}\n")


def _layers(thing: Solid | Region | Assembly) -> Iterator[Layer]:
    """Yield the layers of a solid, a region or an assembly.

    Raises
    ------
    UnboundedError
        If `thing` reaches to infinity.
    InvalidParameterError
        If `thing` is empty.
    """
    if isinstance(thing, Assembly):
        for part in thing.parts:
            yield from _named(part.solid, part.path)
    elif isinstance(thing, Region):
        _refuse_what_has_no_outline(thing)
        yield slab(thing)
    else:
        yield from _named(thing, "solid")


def _named(solid: Solid, name: str) -> list[Layer]:
    _refuse_what_has_no_outline(solid)
    return layers_of_solid(solid, name)


def _refuse_what_has_no_outline(thing: Solid | Region) -> None:
    if not thing.is_bounded:
        message = (
            f"The {type(thing).__name__} reaches to infinity, so it cannot be shown; intersect it"
            " with a bounded one first."
        )
        raise UnboundedError(message, "unbounded")
    if thing.is_empty:
        kind = type(thing).__name__
        raise invalid_parameter(f"The {kind} is empty, so there is nothing to show.")
