"""`Camera`: the view of a scene, and the projection of points to the picture."""

from dataclasses import dataclass, replace
from itertools import product
from typing import Any, Literal, TypeAlias

import numpy as np

from ..._types import FloatArray
from ...errors import invalid_parameter
from ...geometry.arrays import doubles
from ...parameters import number, one_of, positive, shown
from ..trees.facets import vector_rows

#: Views by name; z is up. "front" looks along +y, with x to the right; "iso" looks from the right
#: front top.
View: TypeAlias = Literal["iso", "front", "back", "left", "right", "top", "bottom"]

_DIRECTIONS: dict[str, tuple[int, int, int]] = {
    "iso": (-1, 1, -1),
    "front": (0, 1, 0),
    "back": (0, -1, 0),
    "left": (1, 0, 0),
    "right": (-1, 0, 0),
    "top": (0, 0, -1),
    "bottom": (0, 0, 1),
}

#: The fraction of the picture's height and width that stays empty on each side of a fitted scene.
MARGIN = 0.04

#: The least distance from the eye of a fitted perspective to the scene, as a fraction of the
#: scene's depth.
_CLEARANCE = 0.01

#: Two directions count as parallel if the sine of the angle between them is below this.
_PARALLEL = 1e-9


@dataclass(frozen=True, eq=False)
class Camera:
    """A perspective or parallel projection of space to a picture; use a class method to make one.

    Parameters
    ----------
    axes : (3, 3) float64
        The unit vectors to the right, up, and away from the viewer, as rows.
    origin : (3,) float64
        The eye of a perspective projection, or the centre of a parallel picture.
    half_height : float
        Half of the picture's height: for a perspective at distance 1, so the tangent of half the
        field of view; for a parallel projection in model units.
    is_perspective : bool
    """

    axes: FloatArray
    origin: FloatArray
    half_height: float
    is_perspective: bool

    def __post_init__(self) -> None:
        """Replace the arrays by read-only copies."""
        for name in ("axes", "origin"):
            own = np.array(getattr(self, name), dtype=np.float64)
            own.flags.writeable = False
            object.__setattr__(self, name, own)

    @classmethod
    def perspective(
        cls, eye: Any, target: Any, up: Any = None, field_of_view: float = 35.0
    ) -> "Camera":
        """Return a perspective camera at an eye point.

        Parameters
        ----------
        eye, target : (3,) array_like
            The position of the viewer, and the point in the middle of the picture, in model units.
        up : (3,) array_like, optional
            The direction that is upwards in the picture; by default z, or y for looking along z.
        field_of_view : float
            Angle between the top and the bottom of the picture in degrees, between 0 and 180.

        Raises
        ------
        InvalidParameterError
            If a vector is not three finite numbers, target and eye are the same point, `up` is zero
            or along the direction of view, or the angle is out of its range.
        """
        place = vector(eye, "eye")
        direction = vector(target, "target") - place
        if not direction.any():
            raise invalid_parameter(
                f"The eye and the target of the camera are the same point {shown(eye)}; choose two"
                " different points."
            )
        return cls(_axes(direction, up), place, _tangent(field_of_view), True)

    @classmethod
    def orthographic(
        cls, direction: Any, up: Any = None, scale: float = 1.0, target: Any = (0, 0, 0)
    ) -> "Camera":
        """Return a camera with a parallel projection along a direction.

        Parameters
        ----------
        direction : (3,) array_like
            The direction of view, away from the viewer.
        up : (3,) array_like, optional
            As for `perspective`.
        scale : float
            The height of the picture in model units.
        target : (3,) array_like
            The point in the middle of the picture.

        Raises
        ------
        InvalidParameterError
            If a vector is not three finite numbers, the direction or `up` is zero, both are
            parallel, or the scale is not above 0.
        """
        axes = _axes(vector(direction, "direction"), up)
        return cls(axes, vector(target, "target"), positive(scale, "scale") / 2, False)

    @classmethod
    def named(
        cls,
        view: View,
        points: Any,
        aspect: float = 4 / 3,
        field_of_view: float | None = None,
        margin: float = MARGIN,
    ) -> "Camera":
        """Return a camera that sees all points from one of the named sides.

        Parameters
        ----------
        view : {"iso", "front", "back", "left", "right", "top", "bottom"}
        points : (n, 3) array_like
            The points that must be in the picture; two points are the minimum and maximum corner of
            a box. Without points the camera sees the unit cube around the origin.
        aspect : float
            Width of the picture divided by its height.
        field_of_view : float, optional
            The angle between the top and the bottom of a perspective picture, in degrees; by
            default the projection is parallel.
        margin : float
            The fraction of the picture that stays empty on each side.
        """
        camera = cls.orthographic(_DIRECTIONS[one_of(_DIRECTIONS, view, "view")])
        if field_of_view is not None:
            camera = replace(camera, is_perspective=True, half_height=_tangent(field_of_view))
        return camera.fitted(points, aspect, margin)

    def fitted(self, points: Any, aspect: float = 4 / 3, margin: float = MARGIN) -> "Camera":
        """Return a camera moved without turning so that all points are in the picture.

        A parallel projection is also scaled. The direction of view and the field of view do not
        change; parameters are those of `named`.
        """
        if not 0 <= number(margin, "margin") < 0.5:
            raise invalid_parameter(f"margin must be at least 0 and below 0.5, not {margin}.")
        wanted = _spread(points)
        middle = (wanted.min(axis=0) + wanted.max(axis=0)) / 2
        x, y, depth = self.axes @ (wanted - middle).T
        inner = 1 - 2 * margin
        limits = np.array([positive(aspect, "aspect") * inner, inner])
        if self.is_perspective:
            return self._receded(middle, np.abs([x, y]).T / limits, depth)
        low, high = np.array([(x.min(), y.min()), (x.max(), y.max())])
        origin = middle + (low + high) / 2 @ self.axes[:2]
        half = float(((high - low) / 2 / limits).max())
        return replace(self, origin=origin, half_height=half if half > 0 else 0.5)

    def _receded(self, middle: FloatArray, reach: FloatArray, depth: FloatArray) -> "Camera":
        """Return this camera moved back from `middle` until all points are within the picture.

        `reach` (n, 2) are the points' offsets from the view axis, relative to the limits of the
        picture; `depth` (n,) their distances behind `middle` along the view.
        """
        distance = float((reach.max(axis=1) / self.half_height - depth).max())
        # Keep points on the view axis, or a single point, away from the eye and its plane.
        nearest = float(depth.min())
        distance = max(distance, _CLEARANCE * float(np.ptp(depth)) - nearest)
        distance = distance if distance > -nearest else 1.0
        return replace(self, origin=middle - distance * self.axes[2])

    @property
    def eye(self) -> FloatArray | None:
        """The eye point (3,) of a perspective, None for a parallel projection."""
        return self.origin if self.is_perspective else None

    @property
    def direction(self) -> FloatArray:
        """The unit direction of view (3,) in the middle of the picture, away from the viewer."""
        direction: FloatArray = self.axes[2]
        return direction

    def place(self, points: FloatArray) -> FloatArray:
        """Return points in camera coordinates, (n, 3): right, up, and away from the viewer."""
        placed: FloatArray = (points - self.origin) @ self.axes.T
        return placed

    def project(self, points: Any) -> tuple[FloatArray, FloatArray]:
        """Return the 2D positions of points in the picture, and their depths.

        Parameters
        ----------
        points : (n, 3) array_like
            In model units.

        Returns
        -------
        image : (n, 2) float64
            Right and up from the picture's centre, in units of half its height. NaN in a
            perspective for points that are not in front of the eye.
        depth : (n,) float64
            Distance along the direction of view, from the eye or from the target of a parallel
            projection, in model units.
        """
        given = vector_rows(points, 3, "Points")
        if not np.isfinite(given).all():
            raise invalid_parameter(
                "The points have coordinates that are not finite numbers; remove these points."
            )
        placed = self.place(given)
        depth = placed[:, 2]
        return self.flatten(placed), depth

    def flatten(self, placed: FloatArray) -> FloatArray:
        """Return the (n, 2) picture positions of points in camera coordinates (see `place`)."""
        if not self.is_perspective:
            return placed[:, :2] / self.half_height
        depth = np.where(placed[:, 2] > 0, placed[:, 2], np.nan)
        image: FloatArray = placed[:, :2] / (depth * self.half_height)[:, None]
        return image

    def facing(self, corners: FloatArray, normals: FloatArray) -> FloatArray:
        """Return the cosines between planes' normals and the directions to the viewer, (n,).

        Parameters
        ----------
        corners, normals : (n, 3) float64
            A point and the unit normal of each plane.
        """
        if not self.is_perspective:
            return -normals @ self.direction
        arms = self.origin - corners
        # The squares of very long vectors would overflow; scaling by powers of two keeps cosines.
        arms = np.ldexp(arms, -np.frexp(np.abs(arms).max(initial=0))[1])
        lengths = np.linalg.norm(arms, axis=1)
        cosines: FloatArray = np.einsum("ij,ij->i", arms, normals) / np.where(
            lengths > 0, lengths, 1
        )
        return cosines

    def __repr__(self) -> str:
        """Return a text with the kind of projection, the origin and the direction of view."""
        kind = "perspective" if self.is_perspective else "orthographic"
        origin, direction = (", ".join(f"{x:.4g}" for x in v) for v in (self.origin, self.axes[2]))
        return f"Camera({kind}, origin=({origin}), direction=({direction}))"


def vector(value: Any, name: str) -> FloatArray:
    """Return three finite numbers, or raise an error that names the parameter."""
    result = doubles(value, invalid_parameter(f"The {name} must be three numbers."))
    if result.shape != (3,) or not np.isfinite(result).all():
        raise invalid_parameter(f"The {name} must be three finite numbers, not {shown(value)}.")
    return result


def _axes(direction: FloatArray, up: Any) -> FloatArray:
    if not direction.any():
        raise invalid_parameter("The direction of view must not be the zero vector.")
    away = _unit(direction)
    if up is None:
        along_z = np.hypot(away[0], away[1]) < _PARALLEL
        up = (0, 1, 0) if along_z else (0, 0, 1)
    upwards = vector(up, "up")
    if not upwards.any():
        raise invalid_parameter("The up vector of the camera must not be (0, 0, 0).")
    right = np.cross(away, _unit(upwards))
    if np.linalg.norm(right) < _PARALLEL:
        message = (
            "The up vector must not be parallel to the direction of view; choose another, or"
            " leave up out."
        )
        raise invalid_parameter(message)
    right = _unit(right)
    # Adding 0 makes negative zeros positive, for printing.
    axes: FloatArray = np.stack([right, np.cross(right, away), away]) + 0.0
    return axes


def _unit(given: FloatArray) -> FloatArray:
    # The squares of very large or small numbers would overflow or underflow.
    scaled = given / np.abs(given).max()
    unit: FloatArray = scaled / np.linalg.norm(scaled)
    return unit


def _tangent(field_of_view: float) -> float:
    angle = number(field_of_view, "field_of_view")
    if not 0 < angle < 180:
        raise invalid_parameter(f"The field of view must be from 0 to 180 degrees, not {angle:g}.")
    return float(np.tan(np.radians(angle / 2)))


def _spread(points: Any) -> FloatArray:
    """Return points to fit: box corners for two points, corners of the unit cube for none."""
    wanted = doubles(points, invalid_parameter("The points to fit must be an (n, 3) array."))
    if not wanted.size:
        wanted = np.array([[-0.5] * 3, [0.5] * 3])
    if wanted.ndim != 2 or wanted.shape[1] != 3 or not np.isfinite(wanted).all():
        raise invalid_parameter("The points to fit must be an (n, 3) array of finite numbers.")
    if len(wanted) == 2:
        wanted = np.array(list(product(*wanted.T)), dtype=np.float64)
    return wanted
