"""`Painting`: polygons in pixels in the order in which they are painted, made from a scene."""

from dataclasses import dataclass
from typing import Literal, TypeAlias

import numpy as np

from ..._types import BoolArray, FloatArray, IndexArray
from ..trees.fragments import Fragments
from ..trees.tree import PartitionTree
from .camera import Camera
from .clip import Polygons, clip, next_corners, polygon_of_corner
from .colours import ColourArray, shaded_colours
from .creases import Facets
from .hidden_lines import visible_parts

#: "shaded": lit facets with edges; "hidden": white facets with black edges that hide edges behind
#: them; "edges": edges alone, hidden ones too.
Style: TypeAlias = Literal["shaded", "hidden", "edges"]

#: The edges to draw. "feature": contours, creases and borders; "all": those of all facets.
Edges: TypeAlias = Literal["feature", "all", "none"]

#: The least distance from the eye that is painted, as a fraction of the scene's largest distance.
_MIN_DEPTH = 1e-6

#: A facet is seen edge-on if the cosine between its normal and the view is at most this.
EDGE_ON = 1e-9

#: The width in pixels of the margin outside its frame on which a picture is also painted.
_BLEED = 8.0


@dataclass(frozen=True, eq=False)
class Painting:
    """The polygons and lines of a picture in pixels, the farthest polygon first.

    Parameters
    ----------
    size : (int, int)
        Width and height in pixels; x goes to the right, y downwards.
    polygons : Polygons
        Polygons with (n, 2) corners; their marked edges are drawn right after the polygon.
    lines : (m, 2, 2) float64
        The visible parts of edges that are drawn after all polygons.
    fills : (k, 3) uint8, or None
        The colours of the polygons; None if only edges are drawn.
    source : (k,) int64
        The index of the facet of which each polygon is a part.
    group : (k,) int64
        A number for each polygon, equal for consecutive polygons of one plane and one colour.
    """

    size: tuple[int, int]
    polygons: Polygons
    lines: FloatArray
    fills: ColourArray | None
    source: IndexArray
    group: IndexArray


@dataclass(frozen=True, eq=False)
class Scene:
    """The facets of a picture, with their colours and the edges to draw.

    Parameters
    ----------
    facets : Facets
    colours : (k, 3) uint8
    drawn : (n,) bool
        True for the edges of facets that are drawn.
    """

    facets: Facets
    colours: ColourArray
    drawn: BoolArray

    def take(self, indices: IndexArray) -> "Scene":
        """Return the part of the scene with these facets, in this order."""
        marks = Polygons(self.facets.corners, self.facets.offsets, self.drawn).take(indices)
        facets = Facets(marks.corners, marks.offsets)
        return Scene(facets, self.colours[indices], marks.marked)


def facing(facets: Facets, camera: Camera) -> BoolArray:
    """Return which facets turn their plus side to the viewer, (k,) bool; false if seen edge-on."""
    return camera.facing(facets.firsts, facets.normals) > EDGE_ON


def painting_of(
    tree: PartitionTree,
    scene: Scene,
    camera: Camera,
    size: tuple[int, int],
    style: Style,
    hidden: BoolArray | None = None,
) -> Painting:
    """Return the painting of a scene, with its facets in the back-to-front order of a tree.

    Parameters
    ----------
    hidden : (k,) bool, optional
        True for facets that are left out.
    """
    viewpoint = {"eye": camera.eye} if camera.is_perspective else {"direction": camera.direction}
    fragments = tree.back_to_front(**viewpoint)
    if hidden is not None and hidden.any():
        fragments = fragments.take(np.flatnonzero(~hidden[fragments.source]))
    polygons, kept = _in_pixels(fragments, scene, camera, size)
    source, node = fragments.source[kept], fragments.node[kept]
    fills = None if style == "edges" else _fills(scene, camera, style)[source]
    polygons, lines = _lined(polygons, style)
    return Painting(size, polygons, lines, fills, source, _run_numbers(node, fills))


def _lined(polygons: Polygons, style: Style) -> tuple[Polygons, FloatArray]:
    """Return polygons without marks and the visible edges to draw as lines.

    If there are too many edges, return the marked polygons and no lines.
    """
    marked = np.flatnonzero(polygons.marked)
    ends = polygons.corners[np.stack([marked, next_corners(polygons.offsets)[marked]], axis=1)]
    lines = (
        ends
        if style == "edges"
        else visible_parts(polygons, ends, polygon_of_corner(polygons.offsets)[marked])
    )
    if lines is None:
        return polygons, ends[:0]
    plain = Polygons(polygons.corners, polygons.offsets, np.zeros_like(polygons.marked))
    return plain, lines


def _in_pixels(
    fragments: Fragments, scene: Scene, camera: Camera, size: tuple[int, int]
) -> tuple[Polygons, IndexArray]:
    marked = scene.facets.drawn_edges(fragments, scene.drawn)
    placed = camera.place(fragments.vertices)
    polygons = Polygons(placed, fragments.offsets, marked)
    polygons, kept = _clipped_to_frame(polygons, camera, size)
    width, height = size
    image = camera.flatten(polygons.corners) * (height / 2)
    pixels = np.column_stack([width / 2 + image[:, 0], height / 2 - image[:, 1]])
    return Polygons(pixels, polygons.offsets, polygons.marked), kept


def _clipped_to_frame(
    polygons: Polygons, camera: Camera, size: tuple[int, int]
) -> tuple[Polygons, IndexArray]:
    """Return the parts of polygons in front of the eye and in the picture, and their indices."""
    kept = np.arange(len(polygons.offsets) - 1)
    for normal, least in _frame(polygons.corners, camera, size):
        polygons, left = clip(polygons, normal, least)
        kept = kept[left]
    return polygons, kept


def _frame(
    placed: FloatArray, camera: Camera, size: tuple[int, int]
) -> list[tuple[FloatArray, float]]:
    """Return the half-spaces (normal, least) of the visible region in camera coordinates."""
    width, height = size
    reaches = (np.array([width, height]) + 2 * _BLEED) / height * camera.half_height
    sides = [(axis, sign, reaches[axis]) for axis in (0, 1) for sign in (1.0, -1.0)]
    if not camera.is_perspective:
        return [(sign * np.eye(3)[axis], -reach) for axis, sign, reach in sides]
    farthest = float(np.abs(placed).max()) if len(placed) else 1.0
    near = (np.eye(3)[2], _MIN_DEPTH * farthest)
    return [near] + [(sign * np.eye(3)[a] + reach * np.eye(3)[2], 0.0) for a, sign, reach in sides]


def _fills(scene: Scene, camera: Camera, style: Style) -> ColourArray:
    if style == "hidden":
        return np.full((len(scene.facets), 3), 255, dtype=np.uint8)
    normals = scene.facets.normals
    turned = np.where(facing(scene.facets, camera)[:, None], normals, -normals)
    return shaded_colours(scene.colours, turned, camera.axes)


def _run_numbers(node: IndexArray, fills: ColourArray | None) -> IndexArray:
    """Return an integer for each polygon that increases when the node or the colour changes."""
    keys = node[:, None] if fills is None else np.column_stack([node, fills])
    changes = (keys[1:] != keys[:-1]).any(axis=1)
    return np.concatenate([[0], np.cumsum(changes)])[: len(node)]
