"""`picture`: a scene painted from back to front, or with a z-buffer if it is very large."""

import os
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import Any, get_args

import numpy as np

from ..._types import BoolArray, FloatArray, MeshArrays
from ...errors import FormatError, InvalidMeshError, LimitError, invalid_parameter
from ...formats.atomic import write_file
from ...formats.raw import compacted
from ...mesh.weld import welded
from ...parameters import at_least, file_path, number, one_of, positive, shown, truth_value
from ..trees.facets import mesh_of
from ..trees.tree import PartitionTree
from .camera import Camera, View
from .colours import DEFAULT, ColourArray, colour, colours
from .creases import Facets
from .painting import Edges, Painting, Scene, Style, facing, painting_of
from .png import canvas_size, line_samples, png, png_of_samples
from .raster import Triangles, in_front, raster
from .svg import svg

#: A picture of at most this many facets uses the policy "least-splits", which is slow for more.
_MAX_FACETS_LEAST_SPLITS = 3000

#: Notebooks show pictures of at most this many polygons as SVG, others as PNG.
_MAX_SVG_POLYGONS = 5000

#: The largest number of triangles that a tree orders for a PNG; for more a z-buffer finds the
#: visible triangles. The tree takes 2.3 s of processor time for this many and the z-buffer 0.6 s;
#: thirteen times as many take 47 s and 3.5 s.
_MAX_TRIANGLES_ORDERED = 100_000

#: The largest coordinate of a scene. The coarsest lattice of a tree has a smaller range.
_MAX_COORDINATE = 1e60

#: The largest number of pixels along a side of a picture.
_MAX_SIDE_PIXELS = 16384


@dataclass(frozen=True, eq=False)
class Picture:
    """A picture as SVG and as PNG; notebooks show the one that is smaller.

    Parameters
    ----------
    painting : Painting
        Polygons in pixels, the farthest first.
    background : (3,) uint8 or None
        The colour of the background; None for transparent.
    line_width : float
        The width of drawn edges, in pixels.
    samples : int
        Each pixel of a PNG is the mean of `samples` × `samples` samples.
    """

    painting: Painting
    background: ColourArray | None
    line_width: float
    samples: int

    @cached_property
    def svg(self) -> str:
        """The picture as the text of an SVG file."""
        return svg(self.painting, self.background, self.line_width)

    @cached_property
    def png(self) -> bytes:
        """The picture as the bytes of a PNG file; needs Pillow."""
        return png(self.painting, self.background, self.line_width, self.samples)

    def save(self, path: str | os.PathLike[str]) -> None:
        """Write the picture in the format of the path's suffix, ``.svg`` or ``.png``.

        Raises
        ------
        FormatError
            If the suffix is another, or the file cannot be written.
        BspcsgError
            If the format is PNG and Pillow is not installed.
        """
        ending = Path(file_path(path)).suffix.lower()
        if ending not in (".svg", ".png"):
            message = (
                "The file name of a picture must end in .svg or .png, not"
                f" {ending or 'without an ending'!r}."
            )
            raise FormatError(message, "unknown_format")
        write_file(path, [self.svg.encode() if ending == ".svg" else self.png])

    # Notebooks ask for all formats at once; only one returns something.

    def _repr_svg_(self) -> str | None:
        return None if self._is_large else self.svg

    def _repr_png_(self) -> bytes | None:
        return self.png if self._is_large else None

    @property
    def polygons(self) -> int:
        """The number of polygons in the picture."""
        return len(self.painting.source)

    @property
    def size(self) -> tuple[int, int]:
        """The picture's width and height in pixels."""
        return self.painting.size

    @property
    def _is_large(self) -> bool:
        return self.polygons > _MAX_SVG_POLYGONS

    def __repr__(self) -> str:
        """Return a text with the width and height in pixels and the number of polygons."""
        width, height = self.size
        return f"Picture({width} x {height}, {self.polygons} polygons)"


class _LargePicture(Picture):
    """A picture of more than 100 000 triangles: a z-buffer makes the PNG, a tree only the SVG.

    Parameters
    ----------
    scene : Triangles
    settings : Looks
    """

    _scene: Triangles
    _settings: "_PictureSettings"

    def __init__(self, scene: Triangles, settings: "_PictureSettings") -> None:
        names = ("background", "line_width", "samples")
        self.__dict__.update({name: getattr(settings, name) for name in names})
        self.__dict__.update(_scene=scene, _settings=settings)

    @cached_property
    def painting(self) -> Painting:
        """The polygons in pixels, the farthest first, ordered by a tree."""
        scene = self._scene
        return _ordered(_facets((scene.vertices, scene.faces)), None, scene.colours, self._settings)

    @cached_property
    def png(self) -> bytes:
        """The picture as the bytes of a PNG file, by a z-buffer; needs Pillow."""
        settings = self._settings
        size = canvas_size(settings.frame, self.samples)
        line = line_samples(self.line_width, self.samples)
        seen = raster(self._scene, settings.camera, size, line=line, **settings.raster_arguments)
        return png_of_samples(*seen, self.background, self.samples)

    @property
    def polygons(self) -> int:
        """The number of triangles of the scene."""
        return len(self._scene.faces)

    @property
    def size(self) -> tuple[int, int]:
        """The picture's width and height in pixels."""
        return self._settings.frame


@dataclass(frozen=True)
class _PictureSettings:
    """The checked parameters of `picture`."""

    camera: Camera
    frame: tuple[int, int]
    style: Style
    edges: Edges
    crease: float
    cull: bool | None
    background: ColourArray | None
    line_width: float
    samples: int

    @property
    def raster_arguments(self) -> dict[str, Any]:
        """The parameters that select visible triangles and edges, as arguments for `raster`."""
        return {name: getattr(self, name) for name in ("style", "edges", "crease", "cull")}


def picture(
    scene: Any,
    view: View = "iso",
    *,
    camera: Camera | None = None,
    size: tuple[int, int] = (800, 600),
    style: Style = "shaded",
    edges: Edges = "feature",
    crease: float = 25.0,
    colors: Any = None,
    background: Any = "white",
    cull: bool | None = None,
    line_width: float = 1.2,
    samples: int = 3,
) -> Picture:
    """Return a picture of facets in space by the painter's algorithm.

    A polygon that is painted over another one is never behind it, even with cyclic overlaps and
    crossing facets, since the tree cuts them. For a PNG of a mesh of more than 100 000 triangles, a
    z-buffer finds the nearest triangle in each sample instead.

    Parameters
    ----------
    scene : PartitionTree or mesh
        A tree of polygons; or a `Solid`, a pair (vertices, faces), or anything else that
        `PartitionTree.from_mesh` takes, for which a tree is made.
    view : str
        One of `View`; a parallel projection, scaled so that the whole scene is in the picture.
    camera : Camera, optional
        The camera to use instead of a named view.
    size : (int, int)
        Width and height in pixels.
    style : {"shaded", "hidden", "edges"}
        "shaded": lit, coloured facets with dark edges. "hidden": white facets that hide the black
        edges behind them. "edges": edges alone, hidden ones too.
    edges : {"feature", "all", "none"}
        The edges of facets to draw. "feature": edges of a single facet, edges bent by more than
        `crease`, and contours. Lines along which the tree cuts are never drawn.
    crease : float
        The angle between the normals of two facets, in degrees, above which their edge is a
        feature.
    colors : optional
        One colour, or one for each facet (for a mesh: face): "orange", "#ff8800", or red, green and
        blue as floats from 0 to 1 or whole numbers from 0 to 255, then of shape (3,) or (n, 3).
        Only for the style "shaded".
    background : optional
        A colour, or None for transparent.
    cull : bool, optional
        True to leave out facets that turn their minus side to the viewer. By default only for
        closed surfaces seen from outside their box, where these facets are hidden anyway.
    line_width : float
        The width of drawn edges, in pixels.
    samples : int
        Each pixel of a PNG is the mean of `samples` × `samples` samples.

    Returns
    -------
    Picture
        Only the background for a scene without facets. Facets seen edge-on, with the eye in their
        plane, have no area in the picture and are not visible. A perspective shows only the space
        in front of the eye.

    Raises
    ------
    InvalidMeshError
        If the scene is not in space, a coordinate is not finite (`where` lists faces), or a
        parameter is not one of those above.
    LimitError
        If coordinates do not fit the lattice of a tree.

    Notes
    -----
    Fuchs, Kedem, Naylor 1980, "On visible surface generation by a priori tree structures".
    """
    frame = checked_size(size)
    one_of(get_args(Style), style, "style")
    one_of(get_args(Edges), edges, "edges")
    facets, mesh = _shapes_of(scene)
    points, count = (facets.corners, len(facets)) if mesh is None else (mesh[0], len(mesh[1]))
    base = colours(DEFAULT if colors is None else colors, count, "colors")
    settings = _PictureSettings(
        _camera(camera, view, points, frame),
        frame,
        style,
        edges,
        number(crease, "crease"),
        None if cull is None else truth_value(cull, "cull"),
        None if background is None else colour(background, "background"),
        positive(line_width, "line_width"),
        at_least(1, samples, "samples"),
    )
    if mesh is not None and style != "edges" and in_front(points, settings.camera):
        return _LargePicture(Triangles(*mesh, base), settings)
    tree = scene if isinstance(scene, PartitionTree) else None
    painting = _ordered(facets, tree, base, settings)
    return Picture(painting, settings.background, settings.line_width, settings.samples)


def _ordered(
    facets: Facets, tree: PartitionTree | None, base: ColourArray, settings: _PictureSettings
) -> Painting:
    """Return the painting of facets, ordered from back to front by `tree` or by a new tree."""
    camera, style = settings.camera, settings.style
    front = facing(facets, camera)
    scene = Scene(facets, base, _drawn(facets, front, style, settings.edges, settings.crease))
    culled = _is_culled(facets, camera, style) if settings.cull is None else settings.cull
    hidden = ~front if culled else None
    if tree is None and hidden is not None:
        scene, hidden = scene.take(np.flatnonzero(front)), None
    if tree is None:
        tree = _tree(scene.facets)
    return painting_of(tree, scene, camera, settings.frame, style, hidden)


def _camera(
    camera: Camera | None, view: View, points: FloatArray, frame: tuple[int, int]
) -> Camera:
    if camera is None:
        return Camera.named(view, points, frame[0] / frame[1])
    if not isinstance(camera, Camera):
        raise invalid_parameter(f"The camera must be a bsp.Camera, not {shown(camera)}.")
    return camera


def _shapes_of(scene: Any) -> tuple[Facets, MeshArrays | None]:
    """Return the facets of a scene, and its mesh (vertices, faces) if it is very large, or None.

    That mesh has no duplicate or unused vertices.
    """
    if isinstance(scene, PartitionTree):
        if scene.dimension != 3:
            message = (
                "picture takes triangles or polygons in 3 dimensions, but this scene has"
                f" {scene.dimension}; use panorama for segments in the plane."
            )
            raise invalid_parameter(message)
        corners, offsets = scene.core.lattice()
        units: FloatArray = np.asarray(corners * 10.0**scene.pitch, dtype=np.float64)
        return Facets(units, offsets), None
    vertices, faces = mesh_of(scene)
    facets = _facets((vertices, faces))
    _check_coordinates(facets.corners.reshape(-1, 3, 3))
    if len(facets) <= _MAX_TRIANGLES_ORDERED:
        return facets, None
    points, same = welded(vertices)
    used, renumbered = compacted(same[faces])
    return facets, (points[used], renumbered)


def _facets(mesh: MeshArrays) -> Facets:
    """Return the triangles of a mesh (vertices, faces) as `Facets`."""
    return Facets(mesh[0][mesh[1]].reshape(-1, 3), 3 * np.arange(len(mesh[1]) + 1))


def _check_coordinates(triangles: FloatArray) -> None:
    """Raise an error if a coordinate is not finite, or so large that products overflow doubles."""
    finite = np.isfinite(triangles).all(axis=(1, 2))
    if not finite.all():
        where = np.flatnonzero(~finite)[:10].tolist()
        message = f"Face {where[0]} has a coordinate that is not a finite number."
        raise InvalidMeshError(message, "non_finite", where)
    if len(triangles) and np.abs(triangles).max() > _MAX_COORDINATE:
        message = (
            f"The scene has a coordinate beyond {_MAX_COORDINATE:g}, the largest that is allowed;"
            " scale the scene down."
        )
        raise LimitError(message, "too_large")


def _tree(facets: Facets) -> PartitionTree:
    triangles = facets.corners.reshape(-1, 3, 3)
    if len(facets) <= _MAX_FACETS_LEAST_SPLITS:
        return PartitionTree(triangles, "least-splits", degenerate="drop")
    return PartitionTree(triangles, "random", top=16, degenerate="drop")


def _drawn(
    facets: Facets, front: BoolArray, style: Style, edges: Edges, crease: float
) -> BoolArray:
    if edges == "none":
        return np.zeros(len(facets.corners), dtype=bool)
    if edges == "all" or not len(facets):
        return np.ones(len(facets.corners), dtype=bool)
    return facets.features(front, crease)


def _is_culled(facets: Facets, camera: Camera, style: Style) -> bool:
    if style == "edges" or not len(facets) or not facets.is_closed:
        return False
    eye = camera.eye
    if eye is None:
        return True
    low, high = facets.corners.min(axis=0), facets.corners.max(axis=0)
    return bool(((eye < low) | (eye > high)).any())


def checked_size(size: Any) -> tuple[int, int]:
    """Return a picture's width and height in pixels, or raise an error if they are out of range."""
    try:
        width, height = size
    except (TypeError, ValueError) as error:
        raise invalid_parameter(
            f"size must be a pair (width, height) in pixels, not {shown(size)}."
        ) from error
    frame = at_least(1, width, "width"), at_least(1, height, "height")
    if max(frame) > _MAX_SIDE_PIXELS:
        raise invalid_parameter(
            f"The width and height of a picture must be at most {_MAX_SIDE_PIXELS} pixels, not"
            f" {max(frame)}."
        )
    return frame
