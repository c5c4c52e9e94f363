"""The connected parts of a solid, compatible with their former type, a number."""

from typing import TYPE_CHECKING

from ..errors import deprecated

if TYPE_CHECKING:
    from .solid import Solid


class Components(tuple["Solid", ...]):
    """The connected parts; a comparison with an integer warns and uses the number of surfaces.

    Otherwise programs that compare with a number would silently get wrong answers.
    """

    _whole: "Solid"

    @classmethod
    def of(cls, whole: "Solid") -> "Components":
        """Return the parts of a solid."""
        parts = cls(whole.decompose())
        parts._whole = whole
        return parts

    def __eq__(self, other: object) -> bool:
        """Say whether both are the same parts."""
        if isinstance(other, int):
            deprecated("Solid.components as a number", "Solid.surface_count, or len() for parts")
            return self._whole.surface_count == other
        return super().__eq__(other)

    def __ne__(self, other: object) -> bool:
        """Say whether they are not the same parts."""
        return not self == other

    def __hash__(self) -> int:
        """Return the hash of a tuple."""
        return super().__hash__()

    def __reduce__(self) -> "tuple[type[tuple[Solid, ...]], tuple[list[Solid]]]":
        """Pickle the parts alone."""
        return tuple, (list(self),)
