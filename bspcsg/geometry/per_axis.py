"""Arguments with one number for each axis, as a single value, as numbers or by axis name."""

from typing import Any

from ..errors import invalid_parameter
from ..parameters import number


def per_axis(given: tuple[Any, ...], name: str, *, missing: float = 0.0, **axes: Any) -> Any:
    """Return the argument: one value unchecked, or a tuple with one number for each axis.

    Parameters
    ----------
    given : tuple
        The positional arguments: one value, which is returned unchecked, or one number for each
        axis.
    name : str
        The name of the argument, for error messages.
    missing : float
        The number for axes that are not named, if at least one is.
    **axes : float or None
        The numbers by axis name, in the order of the axes; None for an axis that is not named.

    Raises
    ------
    InvalidParameterError
        If nothing is given, or both positional and named numbers are.
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
