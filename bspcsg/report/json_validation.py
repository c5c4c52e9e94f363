"""Checking of JSON values against typed dictionaries."""

import math
from types import NoneType, UnionType
from typing import Any, Union, get_args, get_origin, get_type_hints, is_typeddict


def type_mismatch(value: Any, kind: Any, place: str = "") -> str:
    """Return where and why a JSON value does not have a type, or an empty string if it does.

    Parameters
    ----------
    value : object
    kind : type
        A typed dictionary, or a type that occurs in one.
    place : str
        The name of the value in the returned text.
    """
    if is_typeddict(kind):
        return _mismatch_in_dict(value, kind, place)
    origin, arguments = get_origin(kind), get_args(kind)
    if origin in (Union, UnionType):
        if value is None and NoneType in arguments:
            return ""
        (only,) = (argument for argument in arguments if argument is not NoneType)
        return type_mismatch(value, only, place)
    if origin in (list, dict):
        return _mismatch_in_items(value, origin, arguments[-1], place)
    return _mismatch_of_scalar(value, kind, place)


def _mismatch_in_dict(value: Any, kind: Any, place: str) -> str:
    if not isinstance(value, dict):
        return f"{place} is not a JSON object"
    lacking = sorted(kind.__required_keys__ - value.keys())
    if lacking:
        return f"{place} has no {lacking[0]!r}".strip()
    hints = get_type_hints(kind)
    found = (
        type_mismatch(value[key], hints[key], f"{place}.{key}") for key in hints if key in value
    )
    return next(filter(None, found), "")


def _mismatch_in_items(value: Any, container: type, kind: Any, place: str) -> str:
    if not isinstance(value, container):
        return f"{place} is not of type {container.__name__}"
    given: Any = value
    items = given.items() if container is dict else enumerate(given)
    found = (type_mismatch(item, kind, f"{place}[{key!r}]") for key, item in items)
    return next(filter(None, found), "")


def _mismatch_of_scalar(value: Any, kind: Any, place: str) -> str:
    if not isinstance(kind, type):
        return ""
    if kind is float:
        is_number = isinstance(value, (int, float)) and math.isfinite(value)
        return "" if is_number else f"{place} is not a finite number"
    return "" if isinstance(value, kind) else f"{place} is not of type {kind.__name__}"
