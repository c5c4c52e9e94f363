"""The plane faces of a mesh and the edges between them."""

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from ..._types import BoolArray, FloatArray, IndexArray
from ...mesh.mesh import Mesh, surfaces_of

#: Triangles count as coplanar if no corner is farther from the plane than this share of the mesh's
#: longest extent. For a solid of extent 1, it is ten lattice steps.
_FLAT = 1e-8

#: The sine of the least angle between planes that a triangle distinguishes, unless it is thin.
_BENT = 0.01


@dataclass(frozen=True, eq=False)
class FaceGraph:
    """The plane faces of a mesh, each a group of coplanar triangles, and the edges between faces.

    Parameters
    ----------
    vertices : (n, 3) float64
    triangles : (m, 3) int64
    face : (m,) int64
        The number of the face that contains each triangle.
    normals : (f, 3) float64
        The outward unit normal of each face.
    ends : (e, 2) int64
        The start and end vertex of each edge.
    sides : (e, 2) int64
        The faces on the left and the right of each edge, seen from outside.
    """

    vertices: FloatArray
    triangles: IndexArray
    face: IndexArray
    normals: FloatArray
    ends: IndexArray
    sides: IndexArray

    @cached_property
    def vectors(self) -> FloatArray:
        """The vector from the start to the end of each edge, (e, 3)."""
        vectors: FloatArray = self.vertices[self.ends[:, 1]] - self.vertices[self.ends[:, 0]]
        return vectors

    @cached_property
    def directions(self) -> FloatArray:
        """The unit vector along each edge, (e, 3)."""
        directions: FloatArray = self.vectors / np.linalg.norm(self.vectors, axis=1)[:, None]
        return directions

    @cached_property
    def areas(self) -> FloatArray:
        """The vector area of each triangle, (m, 3): its normal, with the area as length."""
        return _vector_areas(self.vertices, self.triangles) / 2

    @cached_property
    def inward(self) -> FloatArray:
        """The unit vectors perpendicular to each edge in its left and right face, (e, 2, 3).

        They point from the edge into the face.
        """
        left, right = (self.normals[self.sides[:, k]] for k in (0, 1))
        across = [np.cross(left, self.directions), np.cross(self.directions, right)]
        stacked = np.stack(across, axis=1)
        inward: FloatArray = stacked / np.linalg.norm(stacked, axis=2)[:, :, None]
        return inward

    @cached_property
    def is_convex(self) -> BoolArray:
        """True for each edge whose angle inside the solid is below 180 degrees, (e,)."""
        bend = np.einsum("ij,ij->i", self.inward[:, 0], self.normals[self.sides[:, 1]])
        return np.asarray(bend < 0)

    @cached_property
    def angles(self) -> FloatArray:
        """The angle between the two faces of each edge, inside the solid, in degrees, (e,)."""
        one, other = self.inward[:, 0], self.inward[:, 1]
        across = np.linalg.norm(np.cross(one, other), axis=1)
        between = np.degrees(np.arctan2(across, np.einsum("ij,ij->i", one, other)))
        return np.asarray(np.where(self.is_convex, between, 360 - between))

    @cached_property
    def _at(self) -> tuple[dict[int, list[int]], dict[int, set[int]]]:
        edges: dict[int, list[int]] = {}
        for edge, pair in enumerate(self.ends.tolist()):
            for vertex in pair:
                edges.setdefault(vertex, []).append(edge)
        faces: dict[int, set[int]] = {vertex: set() for vertex in edges}
        for corners, face in zip(self.triangles.tolist(), self.face.tolist(), strict=True):
            for vertex in corners:
                if vertex in faces:
                    faces[vertex].add(face)
        return edges, faces

    def edges_at(self, vertex: int) -> list[int]:
        """Return the numbers of the edges that start or end at a vertex."""
        return self._at[0][vertex]

    def faces_at(self, vertex: int) -> set[int]:
        """Return the numbers of the faces at a vertex, which must be an end of an edge."""
        return self._at[1][vertex]


def face_graph_of(mesh: Mesh) -> FaceGraph:
    """Return the plane faces of a closed mesh, and the edges between them."""
    vertices, triangles = mesh.vertices, mesh.faces
    if not len(triangles):
        none = np.zeros((0, 2), np.int64)
        return FaceGraph(vertices, triangles, none[:, 0], np.zeros((0, 3)), none, none)
    segments, owners = _segments(triangles, len(vertices))
    areas = _vector_areas(vertices, triangles)
    away = _away(vertices, triangles, areas, segments, owners)
    is_flat = away <= flatness(vertices)
    is_thin = _are_thin(vertices, triangles, areas)
    pairs = _with_one_plane(owners[is_flat], away[is_flat], is_thin)
    face = groups(pairs, len(triangles))
    face = _mended(vertices, triangles, areas, face, owners[is_flat], is_thin)
    normals, _ = _facing(areas, face)
    sides = face[owners]
    sharp = sides[:, 0] != sides[:, 1]
    ends, sides = _runs(vertices, *_ascending(segments[sharp], sides[sharp]))
    return FaceGraph(vertices, triangles, face, normals, ends, sides)


def flatness(vertices: FloatArray) -> float:
    """Return the largest distance at which a corner counts as lying in a face's plane."""
    return _FLAT * extent(vertices)


def extent(vertices: FloatArray) -> float:
    """Return the longest side of the bounding box of points, or 0 without points."""
    return float(np.ptp(vertices, axis=0).max()) if len(vertices) else 0.0


def _segments(triangles: IndexArray, count: int) -> tuple[IndexArray, IndexArray]:
    """Return the distinct edges of triangles, (s, 2), and the triangles left and right of each."""
    starts, ends = triangles.ravel(), np.roll(triangles, -1, axis=1).ravel()
    owner = np.repeat(np.arange(len(triangles)), 3)
    forth = starts < ends
    there = np.argsort(starts[forth] * np.int64(count) + ends[forth], kind="stable")
    back = np.argsort(ends[~forth] * np.int64(count) + starts[~forth], kind="stable")
    segments = np.column_stack([starts[forth], ends[forth]])[there]
    return segments, np.column_stack([owner[forth][there], owner[~forth][back]])


def _vector_areas(vertices: FloatArray, triangles: IndexArray) -> FloatArray:
    a, b, c = (vertices[triangles[:, k]] for k in range(3))
    return np.asarray(np.cross(b - a, c - a))


def _away(
    vertices: FloatArray,
    triangles: IndexArray,
    areas: FloatArray,
    segments: IndexArray,
    owners: IndexArray,
) -> FloatArray:
    """Return, for each segment, how far its smaller triangle is from its larger one's plane.

    It is the distance of the corner opposite the segment; infinite if the normals of the two
    triangles point in opposite directions.
    """
    size = np.linalg.norm(areas, axis=1)
    first_is_large = size[owners[:, 0]] >= size[owners[:, 1]]
    large = np.where(first_is_large, owners[:, 0], owners[:, 1])
    small = np.where(first_is_large, owners[:, 1], owners[:, 0])
    tip = triangles[small].sum(axis=1) - segments.sum(axis=1)
    unit = areas[large] / np.where(size > 0, size, 1)[large][:, None]
    away = np.einsum("ij,ij->i", vertices[tip] - vertices[segments[:, 0]], unit)
    ahead = np.einsum("ij,ij->i", areas[large], areas[small]) >= 0
    return np.where(ahead, np.abs(away), np.inf)


def _are_thin(vertices: FloatArray, triangles: IndexArray, areas: FloatArray) -> BoolArray:
    """Return a mask of the triangles that are so thin that rounding may rotate their plane."""
    around = vertices[triangles] - vertices[np.roll(triangles, 1, axis=1)]
    longest = np.linalg.norm(around, axis=2).max(axis=1)
    thin = np.linalg.norm(areas, axis=1) <= flatness(vertices) / _BENT * longest
    return np.asarray(thin)


def _with_one_plane(flat: IndexArray, away: FloatArray, is_thin: BoolArray) -> IndexArray:
    """Return pairs of coplanar triangles; a thin triangle is paired with its best neighbour only.

    A thin triangle along an edge may seem coplanar with both faces there, and must not join them.
    """
    kept = [flat[~is_thin[flat].any(axis=1)]]
    is_placed = ~is_thin
    best_first = np.argsort(np.tile(away, 2), kind="stable")
    both = np.concatenate([flat, flat[:, ::-1]])[best_first]
    while True:
        ready = both[is_placed[both[:, 0]] & ~is_placed[both[:, 1]]]
        if not len(ready):
            break
        _, first = np.unique(ready[:, 1], return_index=True)
        kept.append(ready[first])
        is_placed[ready[:, 1]] = True
    # Pairs within faces that consist only of thin triangles.
    kept.append(flat[~is_placed[flat].any(axis=1)])
    return np.concatenate(kept)


def _facing(areas: FloatArray, face: IndexArray) -> tuple[FloatArray, FloatArray]:
    """Return the unit normals of faces, (f, 3), and twice their areas."""
    normals = np.zeros((face.max() + 1, 3))
    np.add.at(normals, face, areas)
    lengths = np.linalg.norm(normals, axis=1)
    return normals / np.where(lengths > 0, lengths, 1)[:, None], lengths


def _mended(
    vertices: FloatArray,
    triangles: IndexArray,
    areas: FloatArray,
    face: IndexArray,
    flat: IndexArray,
    is_thin: BoolArray,
) -> IndexArray:
    """Return the face of each triangle, (m,), after adjacent coplanar faces are joined.

    Such faces arise where a thin triangle, which belongs to one of them, lies between both.
    """
    is_wide = np.bincount(face, ~is_thin) > 0
    pairs = np.unique(face[flat], axis=0)
    pairs = pairs[(pairs[:, 0] != pairs[:, 1]) & is_wide[pairs].all(axis=1)]
    normals, sizes = _facing(areas, face)
    is_first = sizes[pairs[:, 0]] >= sizes[pairs[:, 1]]
    large, small = (np.where(one, *pairs.T) for one in (is_first, ~is_first))
    corners = vertices[triangles] - vertices.mean(axis=0)
    middles = np.einsum("ij,ij->i", corners.mean(axis=1), normals[face])
    weights = np.linalg.norm(areas, axis=1)
    totals = np.bincount(face, weights)
    offsets = np.bincount(face, weights * middles) / np.where(totals > 0, totals, 1)
    own, pair = members(face, small)
    heights = np.einsum("ijk,ik->ij", corners[own], normals[large[pair]])
    away = np.zeros(len(pairs))
    np.maximum.at(away, pair, np.abs(heights - offsets[large[pair], None]).max(axis=1))
    ahead = np.einsum("ij,ij->i", normals[small], normals[large]) > 0
    return groups(pairs[ahead & (away <= flatness(vertices))], len(is_wide))[face]


def members(face: IndexArray, chosen: IndexArray) -> tuple[IndexArray, IndexArray]:
    """Return the triangles of the faces `chosen`, and the index in `chosen` for each triangle."""
    counts = np.bincount(face)
    starts, sizes = np.cumsum(counts) - counts, counts[chosen]
    place = np.repeat(np.arange(len(chosen)), sizes)
    rank = np.arange(len(place)) - np.repeat(np.cumsum(sizes) - sizes, sizes)
    return np.argsort(face, kind="stable")[starts[chosen][place] + rank], place


def groups(pairs: IndexArray, count: int) -> IndexArray:
    """Return a group number for each of `count` items, equal for items that pairs connect."""
    loops = np.repeat(np.arange(count), 2).reshape(-1, 2)
    links = np.concatenate([loops, pairs])
    return surfaces_of(links[:, [0, 1, 1]], count)[:count]


def _ascending(segments: IndexArray, sides: IndexArray) -> tuple[IndexArray, IndexArray]:
    """Return segments and sides, reversed so that the smaller face number is on the left."""
    turned = sides[:, 0] > sides[:, 1]
    segments = np.where(turned[:, None], segments[:, ::-1], segments)
    return segments, np.sort(sides, axis=1)


def _runs(
    vertices: FloatArray, segments: IndexArray, sides: IndexArray
) -> tuple[IndexArray, IndexArray]:
    """Join consecutive segments between the same two faces to edges.

    Return the start and end vertex of each edge, (e, 2), and its two faces, (e, 2).
    """
    if not len(segments):
        return segments, sides
    degree = np.bincount(segments.ravel(), minlength=len(vertices))
    leaving, arriving = np.full(len(vertices), -1), np.full(len(vertices), -1)
    leaving[segments[:, 0]] = np.arange(len(segments))
    arriving[segments[:, 1]] = np.arange(len(segments))
    middle = np.flatnonzero((degree == 2) & (leaving >= 0) & (arriving >= 0))
    before, after = arriving[middle], leaving[middle]
    steps = vertices[segments[:, 1]] - vertices[segments[:, 0]]
    ahead = np.einsum("ij,ij->i", steps[before], steps[after]) > 0
    joined = (sides[before] == sides[after]).all(axis=1) & ahead
    pairs = _without_loops(np.column_stack([before, after])[joined], len(segments))
    run = groups(pairs, len(segments))
    first = ~np.isin(np.arange(len(segments)), pairs[:, 1])
    last = ~np.isin(np.arange(len(segments)), pairs[:, 0])
    ends = np.empty((run.max() + 1, 2), dtype=np.int64)
    ends[run[first], 0], ends[run[last], 1] = segments[first, 0], segments[last, 1]
    of_run = np.empty((len(ends), 2), dtype=np.int64)
    of_run[run] = sides
    return ends, of_run


def _without_loops(pairs: IndexArray, count: int) -> IndexArray:
    """Return pairs of consecutive segments, without the pairs that form closed loops.

    Exact planes meet in lines, but faces that are planar only within a tolerance can meet in a
    loop.
    """
    run = groups(pairs, count)
    has_start = np.zeros(count, dtype=np.bool_)
    has_start[run[~np.isin(np.arange(count), pairs[:, 1])]] = True
    return pairs[has_start[run[pairs[:, 0]]]]
