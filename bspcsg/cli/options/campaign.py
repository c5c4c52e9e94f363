"""Parsing of the options of the verb crosscheck."""

import click

ENGINES = ("manifold3d", "pymeshlab", "openscad")
POSES = ("random", "corner", "beside", "copy", "mirror", "turned", "same")

_SUFFIXES = {"": 1, "K": 10**3, "M": 10**6, "G": 10**9, "T": 10**12}


def as_engines(
    context: click.Context, option: click.Parameter, value: str | None
) -> tuple[str, ...]:
    """Convert names of engines, separated by commas, to a tuple."""
    names = tuple(name.strip() for name in (value or "").split(",") if name.strip())
    for name in names:
        if name not in ENGINES:
            known = ", ".join(ENGINES)
            raise click.BadParameter(
                f"{name!r} is not a known engine; choose from {known}.", context, option
            )
    return names


def as_bytes(context: click.Context, option: click.Parameter, value: str) -> int | None:
    """Convert a text such as “4G” to a number of bytes; 0 becomes None, which means no limit."""
    text = value.strip().upper().removesuffix("B")
    suffix = text[-1:] if text[-1:] in _SUFFIXES and not text[-1:].isdecimal() else ""
    try:
        size = float(text.removesuffix(suffix)) * _SUFFIXES[suffix]
    except ValueError:
        size = -1.0
    if not 0 <= size < float("inf"):
        message = f"{value!r} is not a memory size; give a number of bytes, as in 4G or 500M."
        raise click.BadParameter(message, context, option)
    return int(size) or None


def as_shard(
    context: click.Context, option: click.Parameter, value: str | None
) -> tuple[int, int] | None:
    """Convert a text such as “2/8” to the number of a shard and the count of shards."""
    if value is None:
        return None
    number, _, count = value.partition("/")
    if not (number.isdecimal() and count.isdecimal() and 1 <= int(number) <= int(count)):
        message = f"{value!r} is not a shard; give its number and the number of shards, as in 2/8."
        raise click.BadParameter(message, context, option)
    return int(number), int(count)


def as_poses(
    context: click.Context, option: click.Parameter, values: tuple[str, ...]
) -> tuple[tuple[str, int | None], ...]:
    """Convert texts such as “random:17” to a pose's name and the number of its draw or None.

    Repeated poses are dropped.
    """
    return tuple(dict.fromkeys(_pose(context, option, value) for value in values))


def _pose(context: click.Context, option: click.Parameter, value: str) -> tuple[str, int | None]:
    name, colon, number = value.partition(":")
    if name not in POSES or (colon and not number.isdecimal()):
        known = ", ".join(POSES)
        message = (
            f"{value!r} is not a pose; give one of {known}, or one with the number of a draw, as"
            " in random:17."
        )
        raise click.BadParameter(message, context, option)
    return name, int(number) if colon else None


def as_keep(context: click.Context, option: click.Parameter, value: str) -> str:
    """Return the value of ``--keep-meshes``, checked: a word or the number of cases to store."""
    if value not in ("interesting", "all", "none") and not value.isdecimal():
        message = f"{value!r} is not valid here; give interesting, all, none, or a number."
        raise click.BadParameter(message, context, option)
    return value
