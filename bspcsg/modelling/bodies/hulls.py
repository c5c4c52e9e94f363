"""Convex hulls of solids, regions and points."""

from collections.abc import Iterable, Iterator
from typing import Any, overload

import numpy as np

from ..._core import hull_mesh, suited_pitch
from ..._types import FloatArray
from ...bsp import Region
from ...errors import InvalidMeshError, core_errors, invalid_parameter
from ...geometry.arrays import axes_of
from ...mesh import interop
from ...parameters import shown
from ...solid.leaf import MeshLeaf
from ...solid.ledger import counted
from ...solid.solid import Solid, from_leaf, given_pitch, keeping_pitch
from ..planar.hulls import hull_of_figures

#: The bound of lattice coordinates, in lattice steps.
_REACH = 2**53


@overload
def hull(*solids_or_points: Solid) -> Solid: ...
@overload
def hull(*solids_or_points: Region) -> Region: ...
@overload
def hull(*solids_or_points: Any) -> Any: ...
def hull(*solids_or_points: Any) -> Solid | Region:
    """Return the convex hull: the smallest convex set that contains all arguments.

    Each corner of the result is a corner of a solid or one of the points, with unchanged
    coordinates; but if a face is so thin that rounding would turn it inwards, its corners are on
    the lattice. No point lies outside a face, except by rounding.

    Parameters
    ----------
    *solids_or_points : Solid, (n, 3) or (3,) array_like of float, or iterable of such
        In model units. Points, and corners that cuts made off the lattice, are snapped to the
        finest lattice of the solids. In the plane: regions and (n, 2) points.

    Returns
    -------
    Solid or Region
        Empty if all arguments lie in one plane up to rounding; for regions and plane points, if
        they lie on one line.

    Raises
    ------
    InvalidMeshError
        If points have another shape or are not finite (`where` lists them).
    UnboundedError
        If a solid reaches to infinity.
    LimitError
        If the points do not fit on one lattice.

    Notes
    -----
    The hull of the snapped points is exact. If no point was moved by snapping, every point outside
    the hull of the other points is a corner, however close it lies. Otherwise snapping moves each
    point by less than a lattice step or a few spacings of doubles at its coordinates. A point whose
    distance from the hull of the other points is less than twice the largest such motion is not a
    corner; so rotated bodies keep their plane faces. An omitted point lies outside the result by no
    more than that distance.

    Examples
    --------
    >>> import bspcsg as csg
    >>> csg.hull(csg.cube(1), csg.cube(1).translate(0, 0, 4)).volume
    5.0
    >>> csg.hull([(0, 0, 0), (1, 0, 0), (0, 1, 0), (0, 0, 6)]).volume
    1.0
    """
    return _hull(list(_entries(solids_or_points)))


@counted
def _hull(given: list[Any]) -> Solid | Region:
    if any(_is_flat(one) for one in given):
        return hull_of_figures(given)
    clouds = [_points_of(one) for one in given]
    solids = [one for one in given if isinstance(one, Solid) and not one.is_empty]
    finest = min((solid.pitch for solid in solids), default=None)
    kept = {given_pitch(solid) for solid in solids if solid.pitch == finest}
    points = np.concatenate(clouds) if clouds else np.zeros((0, 3))
    return keeping_pitch(hull_of(points, finest), finest if kept == {finest} else None)


def hull_of(points: FloatArray, pitch: int | None = None) -> Solid:
    """Return the convex hull of points; it is empty if they lie in a plane up to rounding.

    Parameters
    ----------
    points : (n, 3) float64
        Finite, in model units.
    pitch : int or None
        The preferred exponent of the lattice step. With None, or if the points reach too far for
        that lattice, a suitable exponent is chosen.
    """
    if len(points) < 4:
        return Solid.empty()
    chosen = lattice_for(points, pitch)
    with core_errors():
        vertices, faces, is_convex_there = hull_mesh(np.ascontiguousarray(points), chosen)
    if len(faces) == 0:
        return Solid.empty()
    leaf = MeshLeaf(vertices, faces, pitch=chosen, trusted=is_convex_there)
    return keeping_pitch(from_leaf(leaf), None)


def lattice_for(points: FloatArray, pitch: int | None) -> int:
    """Return the given pitch if its lattice reaches all points, else a pitch suited to them."""
    largest = float(np.abs(points).max())
    if pitch is not None and largest < (_REACH - 1) * 10.0**pitch:
        return pitch
    with core_errors():
        return suited_pitch(largest, float(np.ptp(points, axis=0).max()))


def _is_flat(given: Any) -> bool:
    return isinstance(given, Region) or (axes_of(given) == 2 and np.shape(given)[1] == 2)


def _entries(given: Iterable[Any]) -> Iterator[Any]:
    """Yield each solid, region and array of points, also those in lists that contain solids.

    Raise `InvalidParameterError` for an argument that is none of these.
    """
    for one in given:
        if isinstance(one, (Solid, Region)):
            yield one
            continue
        if not isinstance(one, Iterable) or isinstance(one, (str, bytes)):
            raise invalid_parameter(
                f"The arguments of hull must be solids or arrays of points, not {shown(one)}."
            )
        held: Any = one if isinstance(one, np.ndarray) else list(one)
        mixed = any(isinstance(entry, (Solid, Region)) for entry in held)
        yield from held if mixed else [held]


def _points_of(given: Any) -> FloatArray:
    if isinstance(given, Solid):
        return given.normalized().to_mesh().vertices
    is_one = len(given) == 3 and all(np.ndim(number) == 0 for number in given)
    points = interop.points_array([given] if is_one else given)
    bad = np.flatnonzero(~np.isfinite(points).all(axis=1))
    if len(bad):
        message = (
            f"{len(bad)} of the points have coordinates that are not finite numbers; the first is"
            f" point {bad[0]} (counted from 0)."
        )
        raise InvalidMeshError(message, "non_finite", bad[:20].tolist())
    return points
