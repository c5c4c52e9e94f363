"""The arguments that a node has, and complaints about other arguments."""

from collections import Counter
from collections.abc import Iterator
from dataclasses import dataclass

from ..syntax.tree import SPECIAL, Argument, Node, Value

#: Arguments that every node may have: the special variables, of which some concern only the
#: preview, and `convexity`.
_COMMON_ARGUMENTS = frozenset(
    {*SPECIAL, "$t", "$preview", "$vpr", "$vpt", "$vpd", "$vpf", "convexity"}
)  # fmt: skip


@dataclass(frozen=True)
class Signature:
    """The arguments that nodes of one name have.

    Parameters
    ----------
    order : tuple of str
        The names of positional arguments, in order.
    named : tuple of str
        The names of arguments that are given only by name.
    overridden_by : tuple of (str, tuple of str)
        Pairs of an argument and the arguments that override it if all of them are given.
    """

    order: tuple[str, ...] = ()
    named: tuple[str, ...] = ()
    overridden_by: tuple[tuple[str, tuple[str, ...]], ...] = ()

    def complaints(self, node: Node) -> Iterator[str]:
        """Yield a complaint for each argument of a node that is ignored."""
        names = self._names(node.arguments)
        given = Counter(name for name in names if name is not None)
        for name, count in given.items():
            if name not in _COMMON_ARGUMENTS and name not in self.order and name not in self.named:
                yield f"it has no argument “{name}”, so this argument is ignored; {self._known()}"
            elif count > 1:
                yield f"its {name} is given {count} times; the last value is used"
        if None in names:
            count = names.count(None)
            yield (
                f"{count} of its unnamed arguments are ignored, because there are too many;"
                f" {self._known()}"
            )
        values = dict(zip(names, (argument.value for argument in node.arguments), strict=True))
        for name, others in self.overridden_by:
            if _is_set(values.get(name)) and all(_is_set(values.get(other)) for other in others):
                yield f"its {name} is ignored in favour of {' and '.join(others)}"

    def _names(self, arguments: tuple[Argument, ...]) -> list[str | None]:
        """Return the names of arguments; None for positional arguments that exceed `order`."""
        left = iter(self.order)
        return [next(left, None) if one.name is None else one.name for one in arguments]

    def _known(self) -> str:
        known = (*self.order, *self.named)
        return f"its arguments are {', '.join(known)}" if known else "it has no arguments"


def _is_set(value: Value) -> bool:
    """Return True if the value of an argument is neither undef nor false."""
    return value is not None and value is not False
