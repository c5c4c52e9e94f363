"""`Components`: a solid's connected parts as a tuple that can be compared with a number."""

from typing import TYPE_CHECKING

from ..errors import deprecated

if TYPE_CHECKING:
    from .solid import Solid


class Components(tuple["Solid", ...]):
    """A tuple of the connected parts of a solid.

    Formerly `Solid.components` was the number of connected surfaces. So a comparison with an
    integer still compares that number, with a `DeprecationWarning`.
    """

    _whole: "Solid"

    @classmethod
    def of(cls, whole: "Solid") -> "Components":
        """Return the connected parts of a solid, the largest volume first."""
        parts = cls(whole.decompose())
        parts._whole = whole
        return parts

    def __eq__(self, other: object) -> bool:
        """Return true for a tuple of equal parts, or for an integer equal to the surface count."""
        if isinstance(other, int):
            deprecated("Solid.components as a number", "Solid.surface_count, or len() for parts")
            return self._whole.surface_count == other
        return super().__eq__(other)

    def __ne__(self, other: object) -> bool:
        """Return the negation of ``==``."""
        return not self == other

    def __hash__(self) -> int:
        """Return the hash of the tuple of parts."""
        return super().__hash__()

    def __reduce__(self) -> "tuple[type[tuple[Solid, ...]], tuple[list[Solid]]]":
        """Pickle the parts as an ordinary tuple."""
        return tuple, (list(self),)
