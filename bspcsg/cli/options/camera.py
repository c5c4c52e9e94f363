"""Options for the point of view of a picture, and the camera that they describe."""

import math
from collections.abc import Callable
from typing import TYPE_CHECKING, Any, TypeVar

import click

from ...errors import BspcsgError
from .shared import FiniteRange, finite_numbers, numbers, rare_option

if TYPE_CHECKING:
    from ..._types import FloatArray
    from ...bsp import Camera

_Command = TypeVar("_Command", bound=Callable[..., Any])

_VIEWS = ("iso", "front", "back", "left", "right", "top", "bottom")

#: The direction of the view "iso", in degrees: to the right of the front, and from above.
_AZIMUTH, _ELEVATION = 45.0, math.degrees(math.atan(math.sqrt(0.5)))

#: The default angle between the top and the bottom of a perspective picture, in degrees.
_FIELD_OF_VIEW = 35.0


def _as_point(
    context: click.Context, option: click.Parameter, value: str | None
) -> tuple[float, ...] | None:
    """Convert a text such as “10,-20,15” to three finite numbers."""
    if value is None:
        return None
    found = finite_numbers(value, 3)
    if found is None:
        message = f"{value!r} is not a point; give three numbers x,y,z, as in 10,-20,15."
        raise click.BadParameter(message, context, option)
    return found


_VIEW_OPTIONS = [
    click.option(
        "--view",
        type=click.Choice(_VIEWS),
        default="iso",
        show_default=True,
        help="From where; z is up, front looks along +y.",
    ),
    rare_option(
        "--azimuth",
        metavar="DEGREES",
        type=FiniteRange(-360, 360),
        help="From where around z: 0 from the front, 90 from the right.",
    ),
    rare_option(
        "--elevation",
        metavar="DEGREES",
        type=FiniteRange(-90, 90),
        help="From how high: 0 from the side, 90 from the top.",
    ),
    rare_option("--eye", metavar="X,Y,Z", callback=_as_point, help="Where the viewer is."),
    rare_option(
        "--target",
        "aim",
        metavar="X,Y,Z",
        callback=_as_point,
        help="The point in the middle of the picture; by default the middle of what is seen.",
    ),
    rare_option(
        "--up",
        metavar="X,Y,Z",
        callback=numbers("direction", "x,y,z", "0,0,1"),
        help="Direction that is upwards in the picture; by default z.",
    ),
    rare_option(
        "--perspective",
        "field_of_view",
        metavar="[=DEGREES]",
        is_flag=False,
        flag_value=_FIELD_OF_VIEW,
        type=FiniteRange(0, 180, min_open=True, max_open=True),
        help="Draw in perspective, with a field of view of 35 or this number of degrees; implied by"
        " --eye.",
    ),
]


def view_options(command: _Command) -> _Command:
    """Add the options for the point of view to a command."""
    for option in reversed(_VIEW_OPTIONS):
        command = option(command)
    return command


def refuse_contradictions(settings: dict[str, Any]) -> None:
    """Raise a usage error if options for the point of view contradict each other."""
    angles = [name for name in ("azimuth", "elevation") if settings[name] is not None]
    given = ["eye"] if settings["eye"] is not None else []
    view = settings["view"] != "iso"
    if angles and (given or view):
        raise click.UsageError(
            f"--{angles[0]} cannot be combined with {'--eye' if given else '--view'}; leave one"
            " out."
        )
    if given and view:
        raise click.UsageError("--view cannot be combined with --eye; leave one out.")
    if settings["aim"] is not None and not given:
        raise click.UsageError(
            "--target needs --eye; give the viewer's position with --eye, or leave out --target."
        )


def camera_of(
    settings: dict[str, Any], points: "FloatArray", aspect: float, turn: float = 0.0
) -> "Camera":
    """Return the camera that the options describe; without ``--eye`` all points are in the picture.

    Parameters
    ----------
    settings : dict
        The values of the options of `view_options`.
    points : (n, 3) float64
    aspect : float
        Width of the picture divided by its height.
    turn : float
        Degrees by which the camera is also rotated about z.
    """
    from ...bsp import Camera

    field, up = settings["field_of_view"], settings["up"]
    try:
        if settings["eye"] is not None:
            return _from_eye(settings, points, turn)
        direction = _direction(settings, turn)
        if field is None:
            return Camera.orthographic(direction, up).fitted(points, aspect)
        eye = [-x for x in direction]
        return Camera.perspective(eye, (0, 0, 0), up, field).fitted(points, aspect)
    except BspcsgError as error:
        raise click.UsageError(error.message) from None


def _from_eye(settings: dict[str, Any], points: "FloatArray", turn: float) -> "Camera":
    from ...bsp import Camera

    middle = (points.min(axis=0) + points.max(axis=0)) / 2 if len(points) else (0, 0, 0)
    target = middle if settings["aim"] is None else settings["aim"]
    x, y, z = (e - t for e, t in zip(settings["eye"], target, strict=True))
    cosine, sine = math.cos(math.radians(turn)), math.sin(math.radians(turn))
    arm = (cosine * x - sine * y, sine * x + cosine * y, z) if turn else (x, y, z)
    eye = [t + step for t, step in zip(target, arm, strict=True)]
    field = settings["field_of_view"] or _FIELD_OF_VIEW
    return Camera.perspective(eye, target, settings["up"], field)


def _direction(settings: dict[str, Any], turn: float) -> tuple[float, float, float]:
    """Return the direction of view as a vector from the viewer to the model."""
    angles = settings["azimuth"], settings["elevation"]
    if angles == (None, None):
        azimuth, elevation = _SIDES[settings["view"]]
    else:
        azimuth = _AZIMUTH if angles[0] is None else angles[0]
        elevation = _ELEVATION if angles[1] is None else angles[1]
    around, above = math.radians(azimuth + turn), math.radians(elevation)
    level = math.cos(above) if abs(elevation) < 90 else 0.0
    return (-level * math.sin(around), level * math.cos(around), -math.sin(above))


#: Azimuth and elevation, in degrees, of each value of ``--view``.
_SIDES = {
    "iso": (_AZIMUTH, _ELEVATION),
    "front": (0.0, 0.0),
    "back": (180.0, 0.0),
    "left": (-90.0, 0.0),
    "right": (90.0, 0.0),
    "top": (0.0, 90.0),
    "bottom": (0.0, -90.0),
}
