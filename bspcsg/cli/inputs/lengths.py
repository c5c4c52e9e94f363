"""Parsing of options that are lengths with a unit, such as 0.01mm."""

import math

import click

#: Millimetres in each unit.
MILLIMETRES = {"mm": 1.0, "cm": 10.0, "m": 1000.0, "in": 25.4, "ft": 304.8, "um": 0.001}


def as_length(context: click.Context, option: click.Parameter, value: str | None) -> float | None:
    """Convert a text such as “2in” to millimetres; without a unit it is in millimetres."""
    if value is None:
        return None
    text = value.strip().lower()
    units = sorted(MILLIMETRES, key=len, reverse=True)
    unit = next((unit for unit in units if text.endswith(unit)), "")
    try:
        length = float(text.removesuffix(unit)) * MILLIMETRES.get(unit, 1.0)
    except ValueError:
        length = math.nan
    if not 0 <= length < math.inf:
        wanted = (
            f"a number of at least 0 and optionally a unit ({', '.join(MILLIMETRES)}), as in 0.01mm"
        )
        raise click.BadParameter(f"{value!r} is not a length; give {wanted}.", context, option)
    return length
