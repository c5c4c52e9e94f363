"""The help texts are readable: type names in signatures, few options first for commands."""

import inspect
import pydoc
import re
from collections.abc import Callable, Iterator
from typing import Any

import click
import pytest

import bspcsg as b
from bspcsg.cli import main
from support.cli import Capture, ran


def public() -> Iterator[tuple[str, Callable[..., Any]]]:
    """Yield the public functions, and the methods of the main classes, with their names."""
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


@pytest.mark.parametrize("verb", main._VERBS)
def test_verbs_tell_at_most_twelve_options_first(capsys: Capture, verb: str) -> None:
    first, _, more = ran(capsys, verb, "--help")[1].partition("\nMore options:\n")
    first = first.partition("\nOptions:\n")[2]
    names = re.compile(r"^  (-\S+)", re.MULTILINE)
    assert 0 < len(names.findall(first)) <= 12
    with click.Context(main.commands, info_name="bspcsg") as parent:
        command = main.commands.get_command(parent, verb)
        assert command is not None
        options = command.get_params(click.Context(command, parent=parent, info_name=verb))
    known = [one for one in options if isinstance(one, click.Option) and not one.hidden]
    assert len(names.findall(first + more)) == len(known)
