"""Arguments with a number for each axis, in the three forms in which callers give them."""

from typing import Any

from ..errors import invalid_parameter
from ..parameters import number


def per_axis(given: tuple[Any, ...], name: str, *, missing: float = 0.0, **axes: Any) -> Any:
    """Return the numbers of the axes: from one value, from single numbers, or from named axes.

    Parameters
    ----------
    given : tuple
        One value alone, still unchecked, or one number for each axis.
    name : str
        Of the value, for errors.
    missing : float
        The number of an axis that is not named, if others are.
    **axes : float or None
        The numbers by axis name, in order.

    Raises
    ------
    InvalidParameterError
        If nothing is given, or values are given in two forms.
    """
    named = {axis: number(value, axis) for axis, value in axes.items() if value is not None}
    if bool(given) == bool(named):
        fault = "given twice" if given else "missing"
        ways = " and ".join(f"{axis}=" for axis in axes)
        raise invalid_parameter(
            f"The {name} is {fault}; give one value, or one number for each axis, or {ways}."
        )
    if named:
        return tuple(named.get(axis, missing) for axis in axes)
    return given[0] if len(given) == 1 else given
