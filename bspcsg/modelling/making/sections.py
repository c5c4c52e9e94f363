"""Profiles of a loft as closed loops in space, and the matching of their corners."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from ..._types import FloatArray, IndexArray
from ...errors import invalid_parameter
from ...geometry.arrays import axes_of, doubles
from ...geometry.polygon import contours_of, runs_clockwise, triangulate, triangulate_face
from ...geometry.transform import apply, matrix_factor, translation
from ...parameters import number, refuse_many_corners

#: The relative difference of fit below which two cyclic shifts of an outline count as equally good.
_EQUAL = 1e-9


@dataclass(frozen=True, eq=False)
class Section:
    """One profile of a loft, at its position in space.

    Parameters
    ----------
    loops : list of (n, 3) float64
    flat : list of (n, 2) float64, or None
        The same loops in the profile's plane; None for loops given in space.
    is_region : bool
        True if the profile is a region, whose outlines start at arbitrary corners.
    """

    loops: list[FloatArray]
    flat: list[FloatArray] | None
    is_region: bool

    @property
    def is_tip(self) -> bool:
        """True if the section is a single point."""
        return len(self.loops[0]) == 1

    def cap(self) -> IndexArray:
        """Return triangles that fill the loops, (m, 3) corner numbers, oriented like the loops."""
        if self.is_tip:
            return np.zeros((0, 3), np.int64)
        return triangulate_face(self.loops[0]) if self.flat is None else triangulate(self.flat)


def section_of(given: Any, place: int) -> Section:
    """Return a section from a pair (profile, height or matrix), or from points in space.

    Raises
    ------
    InvalidParameterError
        If `given` is neither, or the profile is empty; `where` is the profile's number, `place`.
    """
    if not isinstance(given, (tuple, list)) or len(given) != 2:
        return Section([_loop(given, place)], None, False)
    profile, where = given
    flat = contours_of(profile)
    if not flat:
        raise invalid_parameter(
            f"Profile {place} of the loft is empty; it must have at least one outline.", [place]
        )
    matrix = _matrix(where)
    loops = [apply(matrix, np.pad(contour, ((0, 0), (0, 1)))) for contour in flat]
    return Section(loops, flat, hasattr(profile, "outlines"))


def _matrix(where: Any) -> FloatArray:
    if axes_of(where) == 0:
        return translation((0.0, 0.0, number(where, "z"))).matrix
    return matrix_factor(where).matrix


def _loop(given: Any, place: int) -> FloatArray:
    message = (
        f"Profile {place} of the loft must be a pair (profile, z), a pair (profile, 4x4 matrix), or"
        " (n, 3) points."
    )
    loop = doubles(given, invalid_parameter(message, [place]))
    if loop.ndim != 2 or loop.shape[1] != 3 or len(loop) in (0, 2):
        raise invalid_parameter(message, [place])
    if not np.isfinite(loop).all():
        raise invalid_parameter(
            f"Profile {place} of the loft has a coordinate that is not a finite number.", [place]
        )
    return loop


def aligned_section(low: Section, high: Section, place: int) -> Section:
    """Return the upper section with its outlines in the order of the lower section's outlines.

    Outlines of regions have arbitrary first corners, so they are also shifted cyclically to fit.

    Raises
    ------
    InvalidParameterError
        If the sections differ in the number of outlines or holes; `where` is `place`, the number of
        the upper section.
    """
    if low.flat is None or high.flat is None:
        if len(low.loops) != 1 or len(high.loops) != 1:
            raise _other_outlines(place)
        return high
    order = _order(low.flat, high.flat, place)
    flat = [high.flat[k] for k in order]
    loops = [high.loops[k] for k in order]
    if low.is_region and high.is_region:
        rolls = [_best_roll(a, c) for a, c in zip(low.flat, flat, strict=True)]
        flat = [np.roll(c, -k, axis=0) for c, k in zip(flat, rolls, strict=True)]
        loops = [np.roll(c, -k, axis=0) for c, k in zip(loops, rolls, strict=True)]
    return Section(loops, flat, high.is_region)


def _order(low: Sequence[FloatArray], high: Sequence[FloatArray], place: int) -> list[int]:
    """Return, for each outline or hole in `low`, the number of its partner in `high`.

    Outlines are paired with outlines and holes with holes; the pairs with the nearest middles are
    formed first.
    """
    holes = [[runs_clockwise(c) for c in contours] for contours in (low, high)]
    if sorted(holes[0]) != sorted(holes[1]):
        raise _other_outlines(place)
    middles = [np.array([c.mean(axis=0) for c in contours]) for contours in (low, high)]
    refuse_many_corners(len(low) * len(high), "This loft")
    gaps = np.linalg.norm(middles[0][:, None] - middles[1][None], axis=2)
    gaps[np.not_equal.outer(*holes)] = np.inf
    order, taken = [-1] * len(low), [False] * len(low)
    nearest = np.argsort(gaps, axis=None, kind="stable")
    for one, other in zip(*(k.tolist() for k in np.divmod(nearest, len(low))), strict=True):
        if order[one] < 0 and not taken[other]:
            order[one], taken[other] = other, True
    return order


def _other_outlines(place: int) -> Exception:
    message = (
        f"Profile {place} of the loft must have as many outlines and holes as the profile"
        " before it."
    )
    return invalid_parameter(message, [place])


def _best_roll(low: FloatArray, high: FloatArray) -> int:
    """Return the number of the corner of `high` that fits the first corner of `low` best."""
    low, high = low - low.mean(axis=0), high - high.mean(axis=0)
    if len(low) == len(high):
        # The correlation of both outlines for each cyclic shift: the greatest belongs to the least
        # sum of squared distances.
        products = np.conj(np.fft.rfft(low, axis=0)) * np.fft.rfft(high, axis=0)
        likeness = np.fft.irfft(products.sum(axis=1), len(low))
    else:
        first, sizes = low[0], np.linalg.norm(high, axis=1)
        likeness = high @ first / np.where(sizes > 0, sizes, 1)
    return int(np.flatnonzero(likeness >= likeness.max() - _EQUAL * np.abs(likeness).max())[0])


def shortest_band(low: FloatArray, high: FloatArray) -> IndexArray:
    """Return the band of triangles between two loops with the least total length of cross edges.

    The first corners of the loops are joined. Fuchs, Kedem, Uselton 1977, "Optimal surface
    reconstruction from planar contours".

    Returns
    -------
    (m, 3) int64
        Corner numbers; the corners of `high` are counted after the corners of `low`.
    """
    n, m = (len(loop) if len(loop) > 1 else 0 for loop in (low, high))
    refuse_many_corners((n + 1) * (m + 1), "This loft")
    a, b = np.arange(n + 1) % len(low), np.arange(m + 1) % len(high)
    cost = np.linalg.norm(low[a][:, None] - high[b][None], axis=2)
    _add_up(cost)
    faces, i, j = [], n, m
    while i or j:
        if j == 0 or (i and cost[i - 1, j] <= cost[i, j - 1]):
            i -= 1
            faces.append((a[i], a[i + 1], len(low) + b[j]))
        else:
            j -= 1
            faces.append((a[i], len(low) + b[j + 1], len(low) + b[j]))
    return np.array(faces, dtype=np.int64).reshape(-1, 3)


def _add_up(cost: FloatArray) -> None:
    """Replace each entry of `cost`, in place, by the least sum along a path from entry (0, 0).

    A path increases one index by one in each step.
    """
    n, m = cost.shape
    cost[0], cost[:, 0] = np.cumsum(cost[0]), np.cumsum(cost[:, 0])
    for total in range(2, n + m - 1):
        i = np.arange(max(1, total - m + 1), min(n, total))
        j = total - i
        cost[i, j] += np.minimum(cost[i - 1, j], cost[i, j - 1])
