"""Invalid arguments, and the check that functions refuse them with an error."""

import inspect
import math
import time
from collections.abc import Callable, Iterator, Mapping
from typing import Any, TypeAlias

import numpy as np

import bspcsg as b

#: What is called, and arguments that it takes.
Row: TypeAlias = tuple[Callable[..., Any], dict[str, Any]]

#: Whatever is wrong for nearly every parameter.
NEVER: dict[str, Any] = {
    "not a number": math.nan,
    "an object": object(),
    "a complex number": 1j,
    "rows of different lengths": [[1, 2], [3]],
    "not numbers": [math.nan] * 3,
    "infinite points": [[math.inf, 0, 0]] * 4,
    "objects": np.array([object()] * 3),
}

#: Values that make sense for some parameters.
AT_TIMES: dict[str, Any] = {
    "infinity": math.inf,
    "a word": "no such word",
    "bytes": b"x",
    "below zero": -1,
    "zero": 0,
    "thousands of digits": 10**5000,
    "a huge number": 1e300,
    "a huge count": 2**40,
    "nothing": None,
    "truth": True,
    "two numbers": [math.nan, math.nan],
    "four numbers": [1, 2, 3, 4],
    "lists in lists": [[[[]]]],
    "an empty list": [],
    "a dictionary": {},
    "a function": lambda *_: math.nan,
    "a solid": b.box(1, 2, 3),
    "a region": b.Region.rectangle(2, 3),
}

#: Processor time that a refusal may take, in seconds.
_SOON = 1.0


def calls(row: Row) -> Iterator[tuple[str, str, dict[str, Any]]]:
    """Yield for each parameter and each bad value: the parameter, the value's name, arguments."""
    for parameter in row[1]:
        for what, bad in {**NEVER, **AT_TIMES}.items():
            yield parameter, what, {**row[1], parameter: bad}


def assert_refused_at_once(name: str, row: Row, taken: Mapping[tuple[str, str], object]) -> None:
    """Assert that bad arguments raise errors with a code, soon; `taken` has the exceptions."""
    for parameter, what, arguments in calls(row):
        begun = time.process_time()
        try:
            row[0](**arguments)
        except b.BspcsgError as error:
            assert error.code.isidentifier() and error.code != "internal", (parameter, what)
            assert error.message[-1] in ".)" and len(error.message) < 500, (parameter, what)
        else:
            sensible = what in AT_TIMES or (name, parameter) in taken
            assert sensible, f"{name}({parameter}={what}) was taken"
        assert time.process_time() - begun < _SOON, (parameter, what)


def parameters_of(value: Any) -> list[str]:
    """Return the names of the parameters of a function or method."""
    return [name for name in inspect.signature(value).parameters if name != "self"]


def methods_of(*kinds: type) -> set[str]:
    """Return the public methods with parameters of classes, as ``Class.method``."""
    return {
        f"{kind.__name__}.{name}"
        for kind in kinds
        for name in dir(kind)
        if not name.startswith("_")
        and callable(getattr(kind, name))
        and parameters_of(getattr(kind, name))
    }


def missing_parameters(rows: Mapping[str, Row], place: Any, apart: set[str]) -> list[str]:
    """Return the parameters of functions and methods for which the rows have no value."""
    given: dict[str, set[str]] = {}
    for name, (_, good) in rows.items():
        given.setdefault(name.split()[0], set()).update(good)
    missing = []
    for name, arguments in given.items():
        owner: Any = place
        for part in name.split("."):
            owner = getattr(owner, part)
        kinds = inspect.signature(owner).parameters.values()
        named = {one.name for one in kinds if one.kind is not one.VAR_POSITIONAL}
        missing += [f"{name}: {one}" for one in sorted(named - apart - arguments)]
    return missing
