"""Values that are computed once and then shared by all threads.

No lock is held during the computation, because a process forked meanwhile would have it locked
forever. Several threads may compute a value at the same time; all get the value that was ready
first.
"""

from collections.abc import Callable
from typing import Generic, TypeVar

_Key = TypeVar("_Key")
_Value = TypeVar("_Value")


class LazyValue(Generic[_Value]):
    """A value that is computed on first use, and then shared by all threads."""

    __slots__ = ("_made",)

    def __init__(self) -> None:
        self._made: list[_Value] = []

    def get(self, make: Callable[[], _Value]) -> _Value:
        """Return the value; compute it by `make` if this is the first call."""
        if not self._made:
            # Appending is atomic, so the first entry remains the first for all threads.
            self._made.append(make())
            del self._made[1:]
        return self._made[0]


class LastValueCache(Generic[_Key, _Value]):
    """A cache of one entry: the last value, and its key."""

    __slots__ = ("_kept",)

    def __init__(self) -> None:
        self._kept: dict[_Key, _Value] = {}

    def get(self, key: _Key) -> _Value | None:
        """Return the stored value if it has this key, else None."""
        return self._kept.get(key)

    def keep(self, key: _Key, value: _Value) -> _Value:
        """Store a value as the only entry, and return it.

        If another thread has already stored a value for this key, return that value instead.
        """
        kept = self._kept.setdefault(key, value)
        for other in list(self._kept):
            if other != key:
                self._kept.pop(other, None)
        return kept
