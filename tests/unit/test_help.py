"""The text of `help` on the public functions can be read: names of types, not what they are."""

import inspect
import pydoc
from collections.abc import Callable, Iterator
from typing import Any

import bspcsg as b


def public() -> Iterator[tuple[str, Callable[..., Any]]]:
    """Yield the public functions, and the methods of the classes that people hold."""
    for name in b.__all__:
        if inspect.isfunction(getattr(b, name)):
            yield name, getattr(b, name)
    for kind in (b.Solid, b.Region, b.Assembly, b.EdgeSelection):
        for name in dir(kind):
            if not name.startswith("_") and callable(getattr(kind, name)):
                yield f"{kind.__name__}.{name}", getattr(kind, name)


def test_signatures_name_types() -> None:
    told = {name: str(inspect.signature(function)) for name, function in public()}
    assert len(told) > 100
    assert [name for name, said in told.items() if "numpy" in said] == []


def test_help_of_a_rotation() -> None:
    first = pydoc.plain(pydoc.render_doc(b.Solid.rotate)).splitlines()[2]
    assert first.startswith("rotate(self, angle: Scalar | Vector | None = None, axis: str | Vector")
    assert str(inspect.signature(b.cone)).startswith("(h: Scalar, r: Scalar | None = None, *,")
