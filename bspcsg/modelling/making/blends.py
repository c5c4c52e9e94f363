"""Chamfers and fillets of edges between planes.

A cutter is the part of the solid between an edge and the new surface, bounded by the edge's two
planes and the planes at its ends. Concave edges are convex edges of the complement; their cutters
are added instead of removed. A round corner of three edges has a separate cutter, between the three
planes and a ball.
"""

import math
from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from ..._types import FloatArray, IndexArray, Scalar
from ...errors import LimitError, invalid_parameter
from ...geometry.polygon import triangulate_face
from ...geometry.transform import LATTICE_REACH, cos_sin
from ...operations.setops import intersection, union
from ...parameters import positive, refuse_many_corners, sides_around
from ...shapes.primitives import half_space
from ...solid.leaf import TreeLeaf
from ...solid.solid import Solid, from_leaf
from .blend_chains import ChainTools, closed_chains
from .blend_fit import has_room, no_room, refuse_no_room
from .blend_order import corner_error, corresponding_edges, next_edges
from .caps import face_blend_tool, is_cap
from .edges import EdgeSelection, selection
from .patches import arc_directions, patch_directions, patch_faces
from .plane_faces import FaceGraph, face_graph_of, flatness
from .planes import Planes
from .rings import walls

#: The largest number of edges in one call. Each adds a mesh and four half-spaces to one expression.
_MAX_EDGES = 10_000

#: The smallest distance between the two end sections of a cutter, relative to the blend's size.
#: Nearer sections do not determine the direction of the edge.
_MIN_STATION_GAP = 1e-6

#: The least sine of the angle between an edge and a plane at its end. At this sine the cutter must
#: extend past the end by a hundred times its width.
_FLATTEST = 0.01

#: The least value of one minus the cosine of the angle between two faces. At this value a fillet is
#: ten thousand times as wide as its radius, and has no room.
_MIN_FOLD = 2e-8

#: Two of the three edges at a corner count as mirror images if the cosines of their angles to the
#: third edge differ by less. The new surfaces then meet at the mirror plane up to a millionth of
#: their size.
_SYMMETRICAL = 1e-6

#: How far two mirrored cutters overlap across their mirror plane, relative to the blend's size, so
#: that no gap is left.
_OVERLAP = 0.01


@dataclass(frozen=True, eq=False)
class _Profile:
    """The cross-section of a chamfer or fillet.

    Parameters
    ----------
    size : float
        The width of a chamfer or the radius of a fillet, in model units.
    steps : int
        The number of chords of the arc; 1 for a chamfer.
    is_round : bool
        True for a fillet.
    """

    size: float
    steps: int
    is_round: bool


class _Blend:
    """The solids to remove or add at selected edges, so that they become chamfers or fillets."""

    def __init__(self, graph: FaceGraph, chosen: IndexArray, profile: _Profile, pitch: int) -> None:
        self.graph = graph
        self.chosen = frozenset(chosen.tolist())
        self.profile = profile
        self.pitch = pitch
        self.planes = Planes(graph, pitch)
        self._prisms: dict[int, Solid] = {}
        self._sections: dict[int, FloatArray] = {}

    @cached_property
    def widths(self) -> FloatArray:
        """The width of each edge's chamfer or fillet on its faces, (e,); 0 for unselected edges."""
        own = sorted(self.chosen)
        widths = np.zeros(len(self.graph.ends))
        widths[own] = self.profile.size
        if self.profile.is_round:
            inward = self.graph.inward[own]
            cosine = np.einsum("ij,ij->i", inward[:, 0], inward[:, 1])
            widths[own] *= np.sqrt((1 + cosine) / np.maximum(1 - cosine, _MIN_FOLD))
        return widths

    @cached_property
    def caps(self) -> list[int]:
        """The faces with all edges selected that are too narrow to blend the edges one by one."""
        faces = np.unique(self.graph.sides[sorted(self.chosen)]).tolist()
        return [
            face
            for face in faces
            if is_cap(self.graph, face, self.chosen) and not has_room(self.graph, face, self.widths)
        ]

    def face_blend_tool(self, face: int, sign: int) -> Solid:
        """Return the tool that blends all edges of a face: to remove, or to add if sign is -1."""
        angles = np.arange(self.profile.steps + 1) / self.profile.steps
        cosines, sines = np.array([cos_sin(90 * angle) for angle in angles]).T
        profile = self.profile.size * np.column_stack([1 - cosines, sines])
        return face_blend_tool(self.graph, face, sign, profile, self.pitch)

    def sign(self, edge: int) -> int:
        """Return 1 for a convex edge and -1 for a concave edge."""
        return 1 if self.graph.is_convex[edge] else -1

    def cutter(self, edge: int) -> Solid:
        """Return the solid to remove at a convex edge, or to add at a concave edge."""
        sign = self.sign(edge)
        parts = [self.prism(edge)]
        parts += [self.planes.inside(face, sign) for face in self.graph.sides[edge].tolist()]
        for place in (0, 1):
            parts += [*self._ends(edge, place), *self._mitres(edge, place)]
        return _evaluated(intersection(parts))

    def _ends(self, edge: int, place: int) -> list[Solid]:
        """Return the solids, mostly half-spaces, that limit an edge's cutter at end 0 or 1."""
        vertex, sign = int(self.graph.ends[edge, place]), self.sign(edge)
        others = sorted(self.graph.faces_at(vertex) - set(self.graph.sides[edge].tolist()))
        along = self.graph.directions[edge] * (1 - 2 * place)
        leans = [sign * float(self.graph.normals[face] @ along) for face in others]
        if all(lean < 0 for lean in leans):
            return [self.planes.inside(face, sign) for face in others]
        # The edge ends outside a plane: its cutter stops there, or meets a neighbouring cutter.
        (face,) = others
        outside = ~self.planes.inside(face, sign, beyond=False)
        partners = [
            other
            for other in self.graph.edges_at(vertex)
            if other != edge and other in self.chosen and self.sign(other) == sign
        ]
        return [outside | self.prism(partners[0]) if partners else outside]

    def _mitres(self, edge: int, place: int) -> list[Solid]:
        """Return half-spaces that limit an edge's cutter where exactly three edges meet.

        The plane that bisects the angle between this edge and another selected edge separates their
        cutters, so that none extends past a short neighbour. This applies if both are symmetrical
        to the third edge, or if the third edge is concave and they are convex, or vice versa.
        """
        vertex = int(self.graph.ends[edge, place])
        around = self.graph.edges_at(vertex)
        if len(around) != 3:
            return []
        away = {other: self._away(other, vertex) for other in around}
        found = []
        for other in around:
            if other == edge or other not in self.chosen or self.sign(other) != self.sign(edge):
                continue
            (third,) = set(around) - {edge, other}
            leans = abs(float((away[other] - away[edge]) @ away[third]))
            if leans < _SYMMETRICAL or self.sign(third) != self.sign(edge):
                normal = _perpendicular(away[other], away[third]) - _perpendicular(
                    away[edge], away[third]
                )
                offset = float(normal @ self.graph.vertices[vertex])
                beyond = _OVERLAP * self.profile.size * float(np.linalg.norm(normal))
                found.append(half_space(normal, offset + beyond))
        return found

    def _away(self, edge: int, vertex: int) -> FloatArray:
        """Return the unit vector along an edge, away from the given end vertex."""
        along: FloatArray = self.graph.directions[edge]
        return along if self.graph.ends[edge, 0] == vertex else -along

    def refuse_corners(self) -> None:
        """Raise an error if selected edges meet at a corner that no cutter can blend."""
        vertices = np.unique(self.graph.ends[sorted(self.chosen)])
        for vertex in vertices.tolist():
            edges = self.graph.edges_at(vertex)
            chosen = [edge for edge in edges if edge in self.chosen]
            signs = {self.sign(edge) for edge in edges}
            faces = self.graph.faces_at(vertex)
            if len(faces) != len(edges) or len(faces) < 3:
                raise corner_error(
                    self.graph,
                    vertex,
                    "the corner cannot be blended, because the faces around it do not form one"
                    " closed ring",
                )
            if len(edges) > 3 and (len(signs) > 1 or not self._is_cone(vertex)):
                raise corner_error(
                    self.graph,
                    vertex,
                    "the corner cannot be blended, because more than three faces meet there"
                    " and it is not convex; choose other edges",
                )
            if len(edges) > 3 and len(chosen) > 2 and self.profile.is_round:
                raise corner_error(
                    self.graph,
                    vertex,
                    "the corner cannot be rounded, because more than three faces and more than"
                    " two chosen edges meet there; choose at most two of them, or use chamfer",
                )

    def _is_cone(self, vertex: int) -> bool:
        """Return True if the faces at a vertex form a convex cone, or its complement does."""
        normals = self.graph.normals[sorted(self.graph.faces_at(vertex))]
        edges = self.graph.edges_at(vertex)
        away = np.where(self.graph.ends[edges, 0] == vertex, 1, -1)[:, None]
        signs = np.array([self.sign(edge) for edge in edges])[:, None]
        leans = (self.graph.directions[edges] * away) @ normals.T * signs
        return bool((leans < _FLATTEST).all())

    def is_round_corner(self, vertex: int) -> bool:
        """Return True if exactly three edges meet at a vertex, and all of them get fillets."""
        edges = self.graph.edges_at(vertex)
        is_full = len(edges) == 3 and all(edge in self.chosen for edge in edges)
        return self.profile.is_round and is_full

    def corners(self) -> list[int]:
        """Return the numbers of the vertices that are replaced by a part of a ball."""
        vertices = np.unique(self.graph.ends[sorted(self.chosen)]).tolist()
        return [vertex for vertex in vertices if self.is_round_corner(vertex)]

    def corner_cutter(self, vertex: int) -> Solid:
        """Return the solid between a vertex of three faces and the ball that touches the faces."""
        faces = self.corner_faces(vertex)
        sign = self.sign(self.graph.edges_at(vertex)[0])
        middle = self._ball(vertex)
        directions = patch_directions(sign * self.graph.normals[faces], self.profile.steps)
        inner = self._snapped(middle + self.profile.size * directions)
        reach = math.dist(middle, self.graph.vertices[vertex]) / self.profile.size
        # Multiples of lattice vectors keep the sides planar.
        outer = inner + math.ceil(3 * reach) * (inner - self._snapped(middle))
        patch, rim = patch_faces(self.profile.steps), _rim(self.profile.steps)
        after = np.roll(rim, -1)
        count = len(inner)
        sides = [
            np.column_stack([rim, after, after + count]),
            np.column_stack([rim, after + count, rim + count]),
        ]
        triangles = np.concatenate([patch[:, ::-1], patch + count, *sides])
        shell = self._body(np.concatenate([inner, outer]), triangles)
        planes = [self.planes.inside(face, sign) for face in faces]
        return _evaluated(intersection(shell, planes))

    def corner_faces(self, vertex: int) -> list[int]:
        """Return the three faces at a vertex, counter-clockwise seen from outside the solid."""
        faces = sorted(self.graph.faces_at(vertex))
        sign = self.sign(self.graph.edges_at(vertex)[0])
        turned = np.linalg.det(sign * self.graph.normals[faces]) < 0
        return faces[::-1] if turned else faces

    def _ball(self, vertex: int) -> FloatArray:
        """Return the centre of the ball that touches the three faces at a vertex, (3,)."""
        sign = self.sign(self.graph.edges_at(vertex)[0])
        normals = sign * self.graph.normals[sorted(self.graph.faces_at(vertex))]
        away = np.linalg.solve(normals, np.full(3, -self.profile.size))
        return np.asarray(self.graph.vertices[vertex] + away)

    def _snapped(self, points: FloatArray) -> FloatArray:
        return np.round(points, -self.pitch) if self.pitch < 0 else points

    def prism(self, edge: int) -> Solid:
        """Return the prism between an edge and its chamfer or fillet, extended past both ends."""
        if edge not in self._prisms:
            self._prisms[edge] = self._prism(edge)
        return self._prisms[edge]

    def _prism(self, edge: int) -> Solid:
        arcs = [self._snapped(self._station(edge, place)) for place in (0, 1)]
        rings = np.array([self._ring(edge, arc) for arc in arcs])
        if np.linalg.norm(rings[1] - rings[0], axis=1).min() < _MIN_STATION_GAP * self.profile.size:
            # The balls at the two ends of the edge nearly coincide.
            rings[1] = rings[0] + self.profile.size * self.graph.directions[edge]
        step = rings[1] - rings[0]
        times = max(self._reach(edge, rings, place) for place in (0, 1))
        rings = np.array([rings[0] - times * step, *rings, rings[1] + times * step])
        count = rings.shape[1]
        around = np.column_stack([np.arange(count), np.roll(np.arange(count), -1)])
        cap = triangulate_face(rings[0])
        triangles = np.concatenate([cap[:, ::-1], walls(rings, around), cap + 3 * count])
        points = rings.reshape(-1, 3)
        a, b, c = (points[triangles[:, k]] - points[0] for k in range(3))
        if np.einsum("ij,ij->", np.cross(a, b), c) < 0:
            triangles = triangles[:, ::-1]
        return self._body(points, triangles)

    def _body(self, points: FloatArray, triangles: IndexArray) -> Solid:
        """Return the solid of a mesh, on a coarser lattice if it is too large for `self.pitch`."""
        try:
            return Solid(points, triangles, pitch=self.pitch)
        except LimitError:
            return Solid(points, triangles)

    def _station(self, edge: int, place: int) -> FloatArray:
        """Return the points of an edge's chamfer or fillet at end 0 or 1, from left to right."""
        vertex = int(self.graph.ends[edge, place])
        if self.is_round_corner(vertex):
            return self._ball(vertex) + self._arc(edge)
        return np.asarray(self.graph.vertices[vertex] + self.section(edge))

    def section(self, edge: int) -> FloatArray:
        """Return the points across an edge's chamfer or fillet, from the left to the right face.

        The (k, 3) coordinates are relative to a point of the edge.
        """
        if edge not in self._sections:
            self._sections[edge] = self._section(edge)
        return self._sections[edge]

    def _section(self, edge: int) -> FloatArray:
        inward = self.graph.inward[edge]
        if not self.profile.is_round:
            return np.asarray(self.profile.size * inward)
        normal = self.sign(edge) * self.graph.normals[self.graph.sides[edge, 0]]
        middle = self.widths[edge] * inward[0] - self.profile.size * normal
        return np.asarray(middle + self._arc(edge))

    def _arc(self, edge: int) -> FloatArray:
        """Return points of the fillet's arc across an edge, (k, 3), relative to its centre."""
        normals = self.sign(edge) * self.graph.normals[self.graph.sides[edge]]
        return self.profile.size * arc_directions(normals[0], normals[1], self.profile.steps)

    def _ring(self, edge: int, arc: FloatArray) -> FloatArray:
        """Return the prism's closed section from the arc of the blend.

        The first and last chord are extended past the faces, and a tip past the edge is added.
        """
        first, last = 2 * arc[0] - arc[1], 2 * arc[-1] - arc[-2]
        foot = (arc[0] + arc[-1]) / 2
        along = self.graph.directions[edge]
        start = self.graph.vertices[self.graph.ends[edge, 0]]
        on_edge = start + along * float((foot - start) @ along)
        tip = 2 * on_edge - (first + last) / 2
        return np.array([first, *arc[1:-1], last, self._snapped(tip)])

    def _reach(self, edge: int, rings: FloatArray, place: int) -> int:
        """Return by how many of its lengths a prism along an edge must extend past end 0 or 1."""
        vertex, along = int(self.graph.ends[edge, place]), self.graph.directions[edge]
        others = self.graph.faces_at(vertex) - set(self.graph.sides[edge].tolist())
        sines = np.abs(self.graph.normals[sorted(others)] @ along)
        if len(sines) and sines.min() < _FLATTEST:
            raise no_room(self.graph, self.graph.vertices[vertex], others)
        wide = float(np.linalg.norm(rings - self.graph.vertices[vertex], axis=2).min(axis=0).max())
        length = float(np.linalg.norm(rings[1] - rings[0], axis=1).min())
        return math.ceil(2 * wide / (sines.min() if len(sines) else 1) / length) + 1


def _evaluated(cutter: Solid) -> Solid:
    """Return a cutter with its set operations carried out.

    So the expression of the result does not contain the cutter's long prisms and half-spaces.
    """
    return from_leaf(TreeLeaf(cutter.tree))


def _perpendicular(direction: FloatArray, axis: FloatArray) -> FloatArray:
    """Return the component of a vector perpendicular to a unit axis, normalized."""
    across = direction - (direction @ axis) * axis
    return np.asarray(across / np.linalg.norm(across))


def _rim(steps: int) -> IndexArray:
    """Return the numbers of the border points of a triangular patch, in circular order."""
    rows = np.arange(steps + 1)
    first = rows * (rows + 1) // 2
    return np.concatenate([first[:-1], (first[-1] + rows)[:-1], (first + rows)[:0:-1]])


def chamfer(solid: Solid, edges: EdgeSelection, size: Scalar) -> Solid:
    """Return the solid with the selected edges chamfered; see `Solid.chamfer`."""
    return _blended(solid, edges, _Profile(positive(size, "size"), 1, False))


def fillet(solid: Solid, edges: EdgeSelection, radius: Scalar, segments: int) -> Solid:
    """Return the solid with the selected edges rounded; see `Solid.fillet`."""
    around = sides_around(4, segments, "segments")
    size = positive(radius, "radius")
    graph, chosen = _selected(edges)
    widest = float(np.abs(180 - graph.angles[chosen]).max(initial=0))
    steps = max(math.ceil(around * widest / 360 - 1e-9), 1)
    refuse_many_corners(len(chosen) * steps * (steps + 8), "This fillet")
    return _blended(solid, edges, _Profile(size, steps, True))


def _selected(edges: EdgeSelection) -> tuple[FaceGraph, IndexArray]:
    if not isinstance(edges, EdgeSelection):
        raise invalid_parameter("edges must be a selection of edges, such as solid.edges().")
    graph, chosen = selection(edges)
    if len(chosen) > _MAX_EDGES:
        message = f"{len(chosen)} edges are selected, and at most {_MAX_EDGES} are allowed."
        raise LimitError(f"{message} Select fewer with where().", "too_many")
    return graph, chosen


def _blended(solid: Solid, edges: EdgeSelection, profile: _Profile) -> Solid:
    graph, chosen = _selected(edges)
    mesh = solid.normalized().to_mesh()
    if graph.vertices is not mesh.vertices and not np.array_equal(graph.vertices, mesh.vertices):
        raise invalid_parameter(
            "The selected edges belong to another solid; select from edges() of this solid."
        )
    while len(chosen):
        pitch = _pitch_for(graph, solid.pitch)
        blend = _Blend(graph, next_edges(graph, chosen), profile, pitch)
        solid = _blended_at_once(solid, blend)
        rest = chosen[~np.isin(chosen, list(blend.chosen))]
        if not len(rest):
            break
        tidy = _without_tiny_steps(solid, blend)
        after = face_graph_of(tidy.normalized().to_mesh())
        # Simplification drops attributes.
        solid = solid if mesh.carried is not None else tidy
        reach = float(blend.widths.max())
        chosen = corresponding_edges(graph, rest, after, _new_ends(blend, rest), reach)
        graph = after
    return solid


def _pitch_for(graph: FaceGraph, pitch: int) -> int:
    """Return the pitch of the cutters: the solid's, or one more if coordinates are very large."""
    steps = float(np.abs(graph.vertices).max()) / 10.0**pitch
    return pitch + int(steps > LATTICE_REACH / 10)


def _blended_at_once(solid: Solid, blend: _Blend) -> Solid:
    """Return a solid with all edges of a blend chamfered or rounded in one set operation."""
    blend.refuse_corners()
    refuse_no_room(blend.graph, blend.widths, blend.caps)
    cutters, fillers = _parts(blend)
    return (solid | union(fillers)) - union(cutters) if fillers else solid - union(cutters)


def _without_tiny_steps(solid: Solid, blend: _Blend) -> Solid:
    """Return a solid simplified, to remove the tiny steps where faces are off the lattice.

    If all planes at the blended edges are exact, the solid is returned unchanged.
    """
    ends = np.unique(blend.graph.ends[sorted(blend.chosen)])
    around = {face for vertex in ends.tolist() for face in blend.graph.faces_at(vertex)}
    if all(blend.planes.is_exact(face) for face in around):
        return solid
    return solid.simplify(flatness(blend.graph.vertices))


def _new_ends(blend: _Blend, rest: IndexArray) -> dict[int, FloatArray]:
    """Return the corners of cutters that end between two edges still to be blended.

    The key is the face between the two edges; the value has shape (n, 3).
    """
    graph, waiting = blend.graph, set(rest.tolist())
    found: dict[int, FloatArray] = {}
    for edge in sorted(blend.chosen):
        for vertex in graph.ends[edge].tolist():
            others = [other for other in graph.edges_at(vertex) if other != edge]
            if len(others) == 2 and waiting.issuperset(others):
                (face,) = graph.faces_at(vertex) - set(graph.sides[edge].tolist())
                corners = blend.cutter(edge).vertices
                found[face] = np.concatenate([found.get(face, corners[:0]), corners])
    return found


def _parts(blend: _Blend) -> tuple[Sequence[Solid], Sequence[Solid]]:
    """Return the solids to remove at convex edges, and the solids to add at concave ones."""
    cutters: tuple[list[Solid], list[Solid]] = ([], [])
    near = _SYMMETRICAL * blend.profile.size
    tools = ChainTools(blend.graph, blend.section, near, blend.pitch)
    done: set[int] = set()
    for face in blend.caps:
        own = np.flatnonzero((blend.graph.sides == face).any(axis=1)).tolist()
        sign = blend.sign(own[0])
        cutters[sign < 0].append(blend.face_blend_tool(face, sign))
        done.update(own)
    for chain in closed_chains(blend.graph, blend.chosen - done):
        tool = tools.tool(chain)
        if tool is not None:
            cutters[blend.sign(chain[0][0]) < 0].append(tool)
            done.update(edge for edge, _ in chain)
    for edge in sorted(blend.chosen - done):
        cutters[blend.sign(edge) < 0].append(blend.cutter(edge))
    for vertex in blend.corners():
        sign = blend.sign(blend.graph.edges_at(vertex)[0])
        cutters[sign < 0].append(blend.corner_cutter(vertex))
    return cutters
