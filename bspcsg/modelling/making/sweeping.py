"""Sweeps of plane profiles along paths."""

import math
from typing import Any

import numpy as np

from ..._types import FloatArray, IndexArray, Scalar
from ...errors import invalid_parameter
from ...geometry.arrays import doubles
from ...geometry.polygon import contours_of, directed_edges, triangulate
from ...geometry.transform import cos_sin
from ...parameters import (
    MAX_CORNERS,
    SEGMENTS,
    not_negative,
    number,
    positive,
    radius_or_half_diameter,
    refuse_many_corners,
    sides_around,
)
from ...shapes.sweep import unit_circle
from ...solid.ledger import counted
from ...solid.solid import Solid
from .rings import solid_of, walls
from .spine import Along, Frame, Spine, divided_path, frame_rotation, path_points, spine_of

#: Corners of a rotated profile equal corners of the original profile if they differ by at most this
#: share of its extent.
_SAME = 1e-9

#: The largest number of corners of which all pairs are compared. A pair takes three doubles, so all
#: pairs take 100 MB.
_MAX_CORNERS_COMPARED = 2000


@counted
def sweep(
    profile: Any,
    path: Any,
    *,
    twist: Along = 0.0,
    scale: Along = 1.0,
    frame: Frame = "parallel",
    segments: int = SEGMENTS,
) -> Solid:
    """Return the solid that a profile sweeps along a path, perpendicular to it.

    Parameters
    ----------
    profile : object
        A `Region`, or what `extrude` takes. Its origin moves along the path.
    path : (n, 3) or (n, 2) array_like of float
        Corners of a polyline. It is closed if its last corner equals its first; it may cross
        itself.
    twist : float or function
        Rotation of the profile at the end in degrees, clockwise seen from there, as in `extrude`;
        or a function that takes shares of the length, (k,) from 0 to 1, and returns degrees.
    scale : float or function
        Scale factor at the end, 0 or more, where the start has 1; or a function that takes shares
        of the length, as for `twist`, and returns factors, (k,).
    frame : {"parallel", "fixed"}
        "parallel": the profile does not rotate about the path. "fixed": its x axis stays horizontal
        and its y axis as upright as possible. Both start with x horizontal; on a path that starts
        along z, x is along the x axis.
    segments : int
        Number of slices for a full turn of `twist`, or for the whole length if a function is given;
        at least 3.

    Raises
    ------
    InvalidParameterError
        If the path has fewer than two different points, turns by more than 175 degrees at a point,
        or is parallel to z in a fixed frame (`where` lists the points); or if on a closed path the
        profile at the end differs from the profile at the start in scale or rotation.
    LimitError
        If the solid would have too many corners.

    Notes
    -----
    Corners of the path are mitred, so that straight parts have the profile as cross-section. Points
    at which the swept surface has a positive winding number are inside, so overlaps are united. In
    a bend tighter than the profile's width, inverted parts lower the winding number.

    Examples
    --------
    >>> import bspcsg as csg
    >>> square = [(-1, -1), (1, -1), (1, 1), (-1, 1)]
    >>> csg.sweep(square, [(0, 0, 0), (10, 0, 0), (10, 10, 0)]).volume
    80.0
    """
    contours = contours_of(profile)
    corners = np.concatenate(contours) if contours else np.zeros((0, 2))
    around = sides_around(3, segments, "segments")
    points, closed = path_points(path)
    slices = _slices(twist, scale, around)
    # Check before the path is divided, since dividing takes a second for very many points.
    refuse_many_corners(max(len(points), slices) * max(len(corners), 1), "This sweep")
    points = divided_path(points, closed, slices)
    refuse_many_corners(len(points) * len(corners), "This sweep")
    spine = spine_of(points, closed, frame)
    if not contours:
        return Solid.empty()
    turns, sizes = -_along(twist, 0.0, spine, "twist"), _along(scale, 1.0, spine, "scale")
    if sizes.min() < 0:
        raise invalid_parameter(f"scale must be at least 0, not {sizes.min():g}.")
    slip = math.degrees(frame_rotation(spine))
    rings = [
        spine.ring(k, _placed(corners, turns[k] - slip * share, sizes[k]))
        for k, share in enumerate(spine.shares)
    ]
    edges = directed_edges(contours)
    if closed:
        rings.append(spine.ring(0, _placed(corners, turns[-1], sizes[-1])))
        same = _same_corners(rings[-1], rings[0], edges)
        names = np.concatenate([np.arange((len(rings) - 1) * len(corners)), same])
        return solid_of(np.concatenate(rings[:-1]), names[walls(np.array(rings), edges)])
    cap = triangulate(contours)
    last = (len(rings) - 1) * len(corners)
    faces = [cap[:, ::-1], walls(np.array(rings), edges), cap + last]
    return solid_of(np.concatenate(rings), np.concatenate(faces))


@counted
def pipe(
    path: Any,
    r: Scalar | None = None,
    *,
    d: Scalar | None = None,
    inner: Scalar | None = None,
    inner_d: Scalar | None = None,
    segments: int = SEGMENTS,
) -> Solid:
    """Return a round bar or a pipe along a path.

    Parameters
    ----------
    path : (n, 3) or (n, 2) array_like of float
        As for `sweep`; corners are mitred.
    r, d : float
        Radius or diameter of the outside, in model units; give one of them.
    inner, inner_d : float, optional
        Radius or diameter of the bore, less than the outside; by default 0, which makes a bar.
    segments : int
        Number of sides of the cross-section, at least 3.

    Raises
    ------
    InvalidParameterError
        As for `sweep`, or if the bore is not narrower than the outside.

    Examples
    --------
    >>> import bspcsg as csg
    >>> csg.pipe([(0, 0, 0), (0, 0, 5)], 2, inner=1, segments=4).volume
    30.0
    """
    outer = positive(radius_or_half_diameter(r, d, "A pipe"), "r")
    bore = not_negative(radius_or_half_diameter(inner, inner_d, "A bore", default=0.0), "inner")
    if bore >= outer:
        raise invalid_parameter(
            f"the inner radius of a pipe must be smaller than its outer radius {outer:g}, but is"
            f" {bore:g}."
        )
    circle = unit_circle(sides_around(3, segments, "segments"))
    contours = [circle * outer, circle[::-1] * bore] if bore else [circle * outer]
    return sweep(contours, path)


def _slices(twist: Along, scale: Along, around: int) -> int:
    """Return the least number of parts into which a sweep divides its path, for its twist."""
    if callable(twist) or callable(scale):
        return around
    return math.ceil(min(abs(number(twist, "twist")) / 360 * around, MAX_CORNERS)) or 1


def _along(given: Along, start: float, spine: Spine, name: str) -> FloatArray:
    """Return the value of `twist` or `scale` at each point of a path, (n,).

    A number is reached linearly from `start`. On a closed path, the value at the end is added.
    """
    shares = np.append(spine.shares, 1.0) if spine.closed else spine.shares
    if not callable(given):
        return start + (number(given, name) - start) * shares
    message = (
        f"The function {name} must return an array with one number for each number that it is"
        " given."
    )
    refusal = invalid_parameter(message)
    try:
        values = np.broadcast_to(doubles(given(shares.copy()), refusal), shares.shape)
    except ValueError as error:  # another shape
        raise refusal from error
    if not np.isfinite(values).all():
        raise invalid_parameter(f"The function {name} must return finite numbers.")
    return np.array(values)


def _placed(corners: FloatArray, turn: float, size: float) -> FloatArray:
    cosine, sine = cos_sin(float(turn))
    x, y = corners.T
    return np.column_stack([x * cosine - y * sine, x * sine + y * cosine]) * size


def _same_corners(last: FloatArray, first: FloatArray, edges: IndexArray) -> IndexArray:
    """Return, for each corner of a closed sweep's last section, the equal corner of the first.

    Raise `InvalidParameterError` if the two sections differ.
    """
    tolerance = _SAME * float(np.abs(first - first.mean(axis=0)).max())
    same = np.arange(len(first))
    if np.abs(last - first).max() <= tolerance:
        return same
    if len(first) <= _MAX_CORNERS_COMPARED:
        gaps = np.abs(last[:, None] - first[None]).max(axis=2)
        same = np.asarray(gaps.argmin(axis=1), dtype=np.int64)
        fits = gaps.min(axis=1).max() <= tolerance and len(np.unique(same)) == len(same)
        if fits and set(map(tuple, same[edges].tolist())) == set(map(tuple, edges.tolist())):
            return same
    raise invalid_parameter(
        "On a closed path, the profile must return to its initial orientation and size at the"
        " end; choose a twist that maps it onto itself, such as 360, and a scale of 1."
    )
