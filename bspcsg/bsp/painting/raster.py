"""Pictures of more than 100 000 triangles by a z-buffer: the nearest triangle of each sample.

A tree that cuts a million triangles takes most of a minute; a z-buffer needs no order of triangles.
Triangles are half-open, and both triangles of an edge use the same arithmetic for it, so that each
sample near the edge belongs to exactly one of them.

References
----------
Catmull 1974, "A subdivision algorithm for computer display of curved surfaces".
"""

from collections.abc import Iterator
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from ..._types import BoolArray, FloatArray, IndexArray
from .camera import Camera
from .colours import ColourArray, shaded_colours
from .painting import EDGE_ON, Edges, Style

#: The largest number of samples, or of rows of triangles, in one array, which then takes about ten
#: megabytes.
_MAX_SAMPLES_PER_BATCH = 1 << 20


@dataclass(frozen=True, eq=False)
class Triangles:
    """Triangles with common vertices and one colour each.

    Parameters
    ----------
    vertices : (n, 3) float64
    faces : (m, 3) int64
    colours : (m, 3) uint8
    """

    vertices: FloatArray
    faces: IndexArray
    colours: ColourArray

    @cached_property
    def areas(self) -> FloatArray:
        """The normal of each triangle with length twice its area, (m, 3) float64."""
        a, b, c = (self.vertices[self.faces[:, k]] for k in range(3))
        (px, py, pz), (qx, qy, qz) = (b - a).T, (c - a).T
        return np.stack([py * qz - pz * qy, pz * qx - px * qz, px * qy - py * qx], axis=1)

    @cached_property
    def normals(self) -> FloatArray:
        """The unit normal of each triangle, (m, 3) float64; zero for triangles without area."""
        lengths = np.sqrt(np.einsum("ij,ij->i", self.areas, self.areas))
        normals: FloatArray = self.areas / np.where(lengths > 0, lengths, 1)[:, None]
        return normals

    def facing(self, camera: Camera) -> BoolArray:
        """Return which triangles turn their plus side to the viewer, (m,) bool."""
        front: BoolArray = camera.facing(self.vertices[self.faces[:, 0]], self.normals) > EDGE_ON
        return front

    @cached_property
    def _joints(self) -> tuple[IndexArray, BoolArray]:
        """The half-edges, sorted so that the half-edges of one edge are consecutive.

        The second array is true for a half-edge that is the first of exactly two, opposite ones of
        an edge.
        """
        start, end = self.faces.ravel(), self.faces[:, [1, 2, 0]].ravel()
        keys = np.minimum(start, end) * len(self.vertices) + np.maximum(start, end)
        order = np.argsort(keys, kind="stable")
        keys, forth = keys[order], (start < end)[order]
        same = np.concatenate([[False], keys[1:] == keys[:-1], [False]])
        is_pair = same[1:-1] & ~same[:-2] & ~same[2:] & (forth[1:] != forth[:-1])
        return order, np.concatenate([is_pair, [False]])

    @property
    def is_closed(self) -> bool:
        """True if each edge belongs to exactly two triangles, and the volume is positive."""
        _, is_first = self._joints
        if 2 * np.count_nonzero(is_first) != self.faces.size:
            return False
        firsts = self.vertices[self.faces[:, 0]] - self.vertices[self.faces[0, 0]]
        return float(np.einsum("ij,ij->", firsts, self.areas)) > 0

    def edges(self, front: BoolArray, edges: Edges, crease: float) -> IndexArray:
        """Return the edges to draw as pairs of vertices, (k, 2) int64, by the rules of `picture`.

        Parameters
        ----------
        front : (m,) bool
            The triangles that face the viewer.
        edges, crease
            As for `picture`.
        """
        order, is_first = self._joints
        second = np.concatenate([[False], is_first[:-1]])
        drawn = ~(is_first | second)
        if edges == "all":
            drawn |= is_first
        elif edges == "feature":
            places = np.flatnonzero(is_first)
            one, other = order[places] // 3, order[places + 1] // 3
            cosines = np.einsum("ij,ij->i", self.normals[one], self.normals[other])
            wide = np.asarray((self.areas != 0).any(axis=1))
            bent = (cosines < np.cos(np.radians(crease))) | (front[one] != front[other])
            drawn[places] = bent & wide[one] & wide[other]
        else:
            drawn[:] = False
        chosen = order[drawn]
        return np.stack([self.faces.ravel()[chosen], self.faces[:, [1, 2, 0]].ravel()[chosen]], 1)


class ZBuffer:
    """A z-buffer: the depth and the index of the nearest triangle in each sample.

    Parameters
    ----------
    camera : Camera
    size : (int, int)
        The numbers of samples across and down.
    """

    def __init__(self, camera: Camera, size: tuple[int, int]) -> None:
        self._camera = camera
        self.width, self.height = size
        self._depths = np.full(self.width * self.height, np.inf)
        #: The index of the nearest triangle in each sample, -1 for none.
        self.nearest = np.full(self.width * self.height, -1, dtype=np.int64)

    def placed(self, vertices: FloatArray) -> FloatArray:
        """Return the column, row and depth of each point, (n, 3); integers are centres of samples.

        Depths grow away from the viewer, and depend linearly on column and row within a plane.
        """
        placed = self._camera.place(vertices)
        image = self._camera.flatten(placed) * (self.height / 2)
        depth = -1 / placed[:, 2] if self._camera.is_perspective else placed[:, 2]
        across = self.width / 2 + image[:, 0] - 0.5
        return np.column_stack([across, self.height / 2 - image[:, 1] - 0.5, depth])

    def fill(self, placed: FloatArray, faces: IndexArray, chosen: IndexArray) -> None:
        """Draw the chosen triangles in the samples in which no nearer triangle is drawn."""
        for some in _row_slices(self._rows(placed, faces[chosen]), _MAX_SAMPLES_PER_BATCH):
            self._fill(placed, faces, chosen[some])

    def _rows(self, placed: FloatArray, faces: IndexArray) -> IndexArray:
        """Return the number of rows of samples that each triangle covers."""
        down = placed[:, 1][faces]
        first, last = self._span(down.min(axis=1), down.max(axis=1), self.height)
        return last - first

    @staticmethod
    def _span(low: FloatArray, high: FloatArray, end: int) -> tuple[IndexArray, IndexArray]:
        """Return the first integer and the end of half-open intervals, clipped to 0 … `end`."""
        first, last = (np.ceil(np.clip(x, 0, end)).astype(np.int64) for x in (low, high))
        return first, np.maximum(first, last)

    def _fill(self, placed: FloatArray, faces: IndexArray, chosen: IndexArray) -> None:
        corners = placed[faces[chosen]]
        # Sort corners by row, so that both triangles of an edge compute it from the same end.
        order = np.argsort(corners[:, :, 1], axis=1, kind="stable")
        (x0, y0, z0), (x1, y1, z1), (x2, y2, z2) = (
            np.take_along_axis(corners, order[:, k, None, None], axis=1)[:, 0].T for k in range(3)
        )
        first, last = self._span(y0, y2, self.height)
        owner, row = _expanded(last - first)
        row += first[owner]
        long = _slopes(x2 - x0, y2 - y0)
        lower, upper = _slopes(x1 - x0, y1 - y0), _slopes(x2 - x1, y2 - y1)
        area = (x1 - x0) * (y2 - y0) - (x2 - x0) * (y1 - y0)
        across = _slopes((z1 - z0) * (y2 - y0) - (z2 - z0) * (y1 - y0), area)
        down = _slopes((x1 - x0) * (z2 - z0) - (x2 - x0) * (z1 - z0), area)
        one = x0[owner] + (row - y0[owner]) * long[owner]
        is_low = row < y1[owner]
        start = np.where(is_low, x0[owner], x1[owner])
        since = row - np.where(is_low, y0[owner], y1[owner])
        other = start + since * np.where(is_low, lower[owner], upper[owner])
        left, right = self._span(np.minimum(one, other), np.maximum(one, other), self.width)
        seen = np.flatnonzero(right > left)
        low, high = np.minimum(np.minimum(z0, z1), z2), np.maximum(np.maximum(z0, z1), z2)
        owner, row, left, right = owner[seen], row[seen], left[seen], right[seen]
        at_left = z0[owner] + down[owner] * (row - y0[owner]) - across[owner] * x0[owner]
        for some in _row_slices(right - left, _MAX_SAMPLES_PER_BATCH):
            span, column = _expanded((right - left)[some])
            span += some.start
            mine = owner[span]
            column += left[span]
            depth = at_left[span] + across[mine] * column
            self._put(
                row[span] * self.width + column, np.clip(depth, low[mine], high[mine]), chosen[mine]
            )

    def _put(self, samples: IndexArray, depths: FloatArray, triangles: IndexArray) -> None:
        np.minimum.at(self._depths, samples, depths)
        is_nearest = depths == self._depths[samples]
        self.nearest[samples[is_nearest]] = triangles[is_nearest]

    def lines(self, ends: FloatArray) -> BoolArray:
        """Return the samples in which lines are visible, (height, width) bool.

        Parameters
        ----------
        ends : (k, 2, 3) float64
            The ends of the lines as column, row and depth, as from `placed`.
        """
        marked = np.zeros(self.width * self.height, dtype=bool)
        behind = self._farthest_around()
        ends = self._framed(ends)
        counts = np.ceil(np.abs(ends[:, 1, :2] - ends[:, 0, :2]).max(axis=1, initial=0)) + 1
        counts = counts.astype(np.int64)
        for some in _row_slices(counts, _MAX_SAMPLES_PER_BATCH):
            owner, step = _expanded(counts[some])
            owner += some.start
            share = (step / np.maximum(counts[owner] - 1, 1))[:, None]
            x, y, z = (ends[owner, 0] * (1 - share) + ends[owner, 1] * share).T
            column, row = np.rint(x).astype(np.int64), np.rint(y).astype(np.int64)
            inside = (column >= 0) & (column < self.width) & (row >= 0) & (row < self.height)
            samples = (row * self.width + column)[inside]
            marked[samples[z[inside] <= behind[samples]]] = True
        return marked.reshape(self.height, self.width)

    def _framed(self, ends: FloatArray) -> FloatArray:
        """Return the parts of lines that are in the picture, (k, 2, 3)."""
        start, along = ends[:, 0], ends[:, 1] - ends[:, 0]
        first, last = np.zeros(len(ends)), np.ones(len(ends))
        for axis, extent in ((0, self.width), (1, self.height)):
            with np.errstate(all="ignore"):
                meets = np.stack([(s - start[:, axis]) / along[:, axis] for s in (-1, extent)])
            is_level = along[:, axis] == 0
            first = np.where(is_level, first, np.maximum(first, np.fmin(*meets)))
            last = np.where(is_level, last, np.minimum(last, np.fmax(*meets)))
        kept = last >= first
        limits = np.stack([first, last], axis=1)[kept]
        framed: FloatArray = start[kept, None] + limits[:, :, None] * along[kept, None]
        return framed

    def _farthest_around(self) -> FloatArray:
        """Return for each sample the greatest depth among it and its eight neighbours."""
        depths = self._depths.reshape(self.height, self.width)
        padded = np.pad(depths, 1, mode="edge")
        wide = np.maximum(np.maximum(padded[:, :-2], padded[:, 1:-1]), padded[:, 2:])
        farthest: FloatArray = np.maximum(np.maximum(wide[:-2], wide[1:-1]), wide[2:]).ravel()
        return farthest


def raster(
    scene: Triangles,
    camera: Camera,
    size: tuple[int, int],
    *,
    style: Style,
    edges: Edges,
    crease: float,
    cull: bool | None,
    line: int,
) -> tuple[IndexArray, ColourArray, BoolArray]:
    """Return the visible triangle and the edges at each sample of a picture.

    Parameters
    ----------
    scene : Triangles
    camera : Camera
    size : (int, int)
        The numbers of samples across and down.
    style, edges, crease, cull
        As for `picture`.
    line : int
        The width of edges, in samples.

    Returns
    -------
    nearest : (height, width) int64
        The index of the visible triangle, -1 for none.
    fills : (m, 3) uint8
        The shaded colour of each triangle.
    ink : (height, width) bool
        True for samples on drawn edges.
    """
    buffer = ZBuffer(camera, size)
    placed = buffer.placed(scene.vertices)
    front = scene.facing(camera)
    is_culled = _hides_its_back(scene, camera) if cull is None else cull
    chosen = np.flatnonzero(front) if is_culled else np.arange(len(scene.faces))
    buffer.fill(placed, scene.faces, chosen)
    ink = buffer.lines(placed[scene.edges(front, edges, crease)])
    shape = size[1], size[0]
    if style == "hidden":
        fills = np.full((len(scene.faces), 3), 255, dtype=np.uint8)
    else:
        normals = np.where(front[:, None], scene.normals, -scene.normals)
        fills = shaded_colours(scene.colours, normals, camera.axes)
    return buffer.nearest.reshape(shape), fills, _thickened(ink, line)


def in_front(points: FloatArray, camera: Camera) -> bool:
    """Return true if all points are in front of the eye, or the projection is parallel."""
    return not camera.is_perspective or bool((camera.place(points)[:, 2] > 0).all())


def _hides_its_back(scene: Triangles, camera: Camera) -> bool:
    eye = camera.eye
    if eye is not None:
        low, high = scene.vertices.min(axis=0), scene.vertices.max(axis=0)
        if ((eye >= low) & (eye <= high)).all():
            return False
    return scene.is_closed


def _thickened(marked: BoolArray, width: int) -> BoolArray:
    """Return the marked samples, each thickened to a disc `width` samples wide."""
    reach = (width - 1) / 2
    thick = marked.copy()
    far = int(np.ceil(reach))
    for down in range(-far, far + 1):
        for across in range(-far, far + 1):
            if down**2 + across**2 <= (reach + 0.25) ** 2:
                to, of = _shifted(down, across)
                thick[to] |= marked[of]
    return thick


def _shifted(down: int, across: int) -> tuple[tuple[slice, ...], tuple[slice, ...]]:
    """Return the target and the source slices that shift an array by rows and columns."""
    steps = down, across
    to = tuple(slice(max(step, 0), min(step, 0) or None) for step in steps)
    of = tuple(slice(max(-step, 0), min(-step, 0) or None) for step in steps)
    return to, of


def _slopes(rise: FloatArray, run: FloatArray) -> FloatArray:
    """Return rise / run, or 0 where the quotient is not finite; such values are never used."""
    with np.errstate(all="ignore"):
        slopes = rise / run
    return np.where(np.isfinite(slopes), slopes, 0.0)


def _expanded(counts: IndexArray) -> tuple[IndexArray, IndexArray]:
    """Return for each item the index of its row and its number in the row, given row lengths."""
    owner = np.repeat(np.arange(len(counts)), counts)
    starts = np.cumsum(counts) - counts
    return owner, np.arange(len(owner)) - starts[owner]


def _row_slices(counts: IndexArray, most: int) -> Iterator[slice]:
    """Yield consecutive slices of rows whose counts add up to at most `most`, or single rows."""
    ends = np.cumsum(counts)
    start = 0
    while start < len(counts):
        before = ends[start - 1] if start else 0
        end = max(int(np.searchsorted(ends, before + most, side="right")), start + 1)
        yield slice(start, end)
        start = end
