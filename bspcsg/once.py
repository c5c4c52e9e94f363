"""Values that are made once and then shared by all threads.

No lock is held while a value is made, because a process forked meanwhile would keep it locked
forever. Threads may make a value at the same time; all get the one that was ready first.
"""

from collections.abc import Callable
from typing import Generic, TypeVar

_Key = TypeVar("_Key")
_Value = TypeVar("_Value")


class Once(Generic[_Value]):
    """A value that is made on first use."""

    __slots__ = ("_made",)

    def __init__(self) -> None:
        self._made: list[_Value] = []

    def of(self, make: Callable[[], _Value]) -> _Value:
        """Return the value; `make` is called if there is none yet."""
        if not self._made:
            # Appends of threads are atomic, and the first entry stays first.
            self._made.append(make())
            del self._made[1:]
        return self._made[0]


class Last(Generic[_Key, _Value]):
    """The value that was made last, and its key."""

    __slots__ = ("_kept",)

    def __init__(self) -> None:
        self._kept: dict[_Key, _Value] = {}

    def get(self, key: _Key) -> _Value | None:
        """Return the value for this key if it was made last, else None."""
        return self._kept.get(key)

    def keep(self, key: _Key, value: _Value) -> _Value:
        """Return the value kept for this key: this one, unless another thread was faster."""
        kept = self._kept.setdefault(key, value)
        for other in list(self._kept):
            if other != key:
                self._kept.pop(other, None)
        return kept
