"""Sub-hyperplanes, and the connected paths of boundaries."""

import math
import operator
from itertools import pairwise
from typing import Any

import numpy as np
import pytest

import bspcsg as b
from bspcsg import InvalidMeshError, InvalidParameterError, Region, UnboundedError
from bspcsg.bsp import Intervals, ObjectTree, SubHyperplane, boundary_paths

UP = Region.half_plane((0, -1))
QUADRANT = UP & Region.half_plane((1, 0))
RING = Region.rectangle(4, 3) - Region.rectangle(1, 1).translate(1, 1)
NOTCHED = ObjectTree.from_mesh(b.box(2, 3, 4) - b.box(1, 1, 1))


def told(region: Region) -> Any:
    return [
        (p.points.tolist(), p.start if p.start is None else p.start.tolist(), p.is_closed)
        for p in boundary_paths(region)
    ]


class TestPaths:
    """Boundary paths, with the cases getBoundaryPaths of Commons Geometry's RegionBSPTree2DTest."""

    def test_nothing_and_everything_have_none(self) -> None:
        assert boundary_paths(Region.empty()) == boundary_paths(Region.full()) == ()

    def test_a_half_plane_has_a_line(self) -> None:
        (path,) = boundary_paths(Region.half_plane((1, 2), 3))
        assert path.points.tolist() == [[0.6, 1.2]]
        direction = np.array([-2, 1]) / math.sqrt(5)
        assert path.start is not None
        assert path.end is not None
        assert np.allclose([path.start, path.end], direction, rtol=1e-15, atol=0)
        assert path.length == math.inf

    def test_a_quadrant_has_two_rays_that_meet(self) -> None:
        assert told(QUADRANT) == [([[0, 0]], [1, 0], False)]
        assert told(~QUADRANT) == [([[0, 0]], [0, -1], False)]

    def test_closed_paths_are_the_outlines(self) -> None:
        paths = boundary_paths(RING)
        assert [p.points.tolist() for p in paths] == [o.points.tolist() for o in RING.outlines]
        assert [p.length for p in paths] == [14, 4]

    def test_a_hole_in_an_unbounded_set_is_closed(self) -> None:
        hole = Region.rectangle(1, 1).translate(0, 1)
        loop = [[0, 1], [0, 2], [1, 2], [1, 1]]
        assert told(UP - hole) == [([[0, 0]], [1, 0], False), (loop, None, True)]
        assert told(~hole) == [(loop, None, True)]

    def test_opposite_corners_make_two_paths_that_touch(self) -> None:
        cross = QUADRANT ^ ~(UP | Region.half_plane((1, 0)))
        assert [(path, closed) for path, _, closed in told(cross)] == [([[0, 0]], False)] * 2

    @pytest.mark.parametrize("seed", range(8))
    def test_the_region_lies_on_the_left_of_every_edge(self, seed: int) -> None:
        random = np.random.default_rng(seed)
        region = Region.empty()
        for nx, ny, d, op in random.integers(-5, 6, (6, 4)).tolist():
            half = Region.half_plane((nx, ny or 1), d)
            region = region ^ half if op > 0 else region | half
        for path in boundary_paths(region):
            corners = [*path.points]
            if path.start is not None and path.end is not None:
                corners = [corners[0] - path.start, *corners, corners[-1] + path.end]
            else:
                corners.append(corners[0])
            for p, q in pairwise(corners):
                left = 1e-6 * np.array([p[1] - q[1], q[0] - p[0]])
                middle = (p + q) / 2
                assert region.classify([middle + left, middle - left]).tolist() == [1, -1]


class TestBoundaries:
    def test_a_ring_has_eight_sides(self) -> None:
        sides = SubHyperplane.of_boundary(RING)
        assert sum(side.size for side in sides) == 18
        for side in sides:
            assert RING.classify([side.centroid - 1e-3 * side.normal]) == [1]
            assert RING.classify([side.centroid + 1e-3 * side.normal]) == [-1]

    def test_a_side_in_two_pieces_is_one(self) -> None:
        comb = Region.rectangle(5, 2) - Region.rectangle(1, 1).translate(2, 1)
        tops = [s for s in SubHyperplane.of_boundary(comb) if s.normal.tolist() == [0, 1]]
        assert [(s.offset, s.size, len(s.pieces())) for s in tops] == [(2, 4, 2), (1, 1, 1)]

    def test_a_notched_box(self) -> None:
        sides = SubHyperplane.of_boundary(NOTCHED)
        sizes = {(*s.normal.tolist(), s.offset): s.size for s in sides}
        assert len(sides) == len(sizes) == 9
        assert sizes[0, 0, -1, 0] == 5
        assert sizes[0, 0, -1, -1] == 1
        # Gauss: a third of the sum of areas times distances is the volume.
        assert sum(s.size * s.offset for s in sides) / 3 == pytest.approx(23, rel=1e-15)

    def test_sides_of_unbounded_sets(self) -> None:
        for side in SubHyperplane.of_boundary(QUADRANT):
            assert not side.is_bounded
            with pytest.raises(UnboundedError):
                side.pieces()
        with pytest.raises(UnboundedError):
            SubHyperplane.of_boundary(ObjectTree.half_space((0, 0, 1)))
        with pytest.raises(InvalidParameterError):
            SubHyperplane.of_boundary(Intervals([(0, 1)]))


class TestInside:
    def test_a_line_through_a_ring(self) -> None:
        found = SubHyperplane.inside(RING, (0, 1), 1.5)
        assert found.part == Intervals([(-4, -2), (-1, 0)])
        assert found.centroid.tolist() == [13 / 6, 1.5]

    def test_what_lies_on_the_boundary_is_left_out(self) -> None:
        for sign in (1, -1):
            found = SubHyperplane.inside(RING, (0, sign), sign)
            ends = sorted(abs(x) for piece in found.pieces() for x in piece[:, 0])
            assert ends == [0, 1, 2, 4]
        assert SubHyperplane.inside(RING, (0, 1), 3).is_empty

    def test_rays_and_lines(self) -> None:
        found = SubHyperplane.inside(QUADRANT, (1, 1))
        assert found.part == Intervals([(0, math.inf)])
        assert SubHyperplane.inside(Region.full(), (1, 1)).part.is_full

    def test_a_plane_through_a_notched_box(self) -> None:
        found = SubHyperplane.inside(NOTCHED, (1, 1, 1), 3)
        whole = SubHyperplane.inside(ObjectTree.from_mesh(b.box(2, 3, 4)), (1, 1, 1), 3)
        # The triangle of side 3 less that of side 1; the notch ends in a point of the plane.
        assert whole.size == pytest.approx(math.sqrt(3) / 2 * (9 - 1), rel=1e-8)
        assert (found - whole).size < 1e-8
        assert found.size == pytest.approx(whole.size, rel=1e-8)


class TestValues:
    PART = SubHyperplane((3, 0, 4), 5, Region.rectangle(2, 1))
    TURN = np.array([[0, 2, 0, 1], [1, 0, 0, 0], [0, 0, 1, -3]])

    def test_normals_have_length_one(self) -> None:
        assert (self.PART.normal.tolist(), self.PART.offset) == ([0.6, 0, 0.8], 1)
        assert self.PART.size == 2

    def test_pieces_lie_in_the_plane_and_face_the_plus_side(self) -> None:
        (piece,) = self.PART.pieces()
        assert np.allclose(piece @ self.PART.normal, 1, rtol=1e-15, atol=0)
        normal = np.cross(piece[1] - piece[0], piece[2] - piece[1])
        assert normal @ self.PART.normal == pytest.approx(2)

    def test_operations(self) -> None:
        other = SubHyperplane((3, 0, 4), 5, Region.rectangle(1, 3))
        sizes = [p.size for p in (self.PART | other, self.PART & other, self.PART - other)]
        assert [*sizes, (self.PART ^ other).size] == [4, 1, 1, 3]
        assert not (~self.PART).is_bounded
        assert (self.PART & other.reversed()).size == 1
        assert (self.PART & other) == (other & self.PART) != self.PART
        assert self.PART.reversed() != self.PART != 1
        assert len({self.PART, self.PART | self.PART}) == 1
        for apart in (SubHyperplane((1, 0, 0)), SubHyperplane((3, 0, 4), 6), SubHyperplane((1, 0))):
            with pytest.raises(InvalidParameterError):
                self.PART | apart

    def test_splits(self) -> None:
        minus, plus = self.PART.split((0, 1, 0), 0.25)
        low, high = minus.centroid[1], plus.centroid[1]
        assert low < 0.25 < high
        assert minus.size + plus.size == pytest.approx(2, rel=1e-12)
        assert [p.is_empty for p in self.PART.split((3, 0, 4), 6)] == [False, True]
        assert [p.is_empty for p in self.PART.split((-3, 0, -4), -6)] == [True, False]
        assert [p.is_empty for p in self.PART.split((3, 0, 4), 5)] == [True, True]
        halves = SubHyperplane((0, 1), 2, Intervals([(-4, 0)])).split((1, 0), 1)
        assert [half.centroid.tolist() for half in halves] == [[0.5, 2], [2.5, 2]]

    @pytest.mark.parametrize("mirrored", [False, True])
    def test_transforms(self, mirrored: bool) -> None:
        matrix = self.TURN * ([[-1], [1], [1]] if mirrored else 1)
        image = self.PART.transform(matrix)
        expected = matrix[:, :3] @ self.PART.centroid + matrix[:, 3]
        assert np.allclose(image.centroid, expected, atol=1e-8)
        (piece,) = self.PART.pieces()
        sides = matrix[:, :3] @ (piece[1] - piece[0]), matrix[:, :3] @ (piece[2] - piece[1])
        assert image.size == pytest.approx(np.linalg.norm(np.cross(*sides)), rel=1e-8)
        below = matrix[:, :3] @ (self.PART.centroid - self.PART.normal) + matrix[:, 3]
        assert below @ image.normal < image.offset
        line = SubHyperplane((0, 1), 2, Intervals([(-4, 0)]))
        moved = line.transform([[1 - 2 * mirrored, 0, 1], [0, 3, 0]])
        assert (moved.size, moved.centroid[0]) == (4, -1 if mirrored else 3)
        assert moved.centroid[1] == pytest.approx(6, rel=1e-15)
        with pytest.raises(InvalidParameterError):
            line.transform(np.zeros((2, 3)))

    def test_reversed_are_the_same_points(self) -> None:
        turned = self.PART.reversed()
        assert turned.normal.tolist() == [-0.6, 0, -0.8]
        assert turned.size == 2
        assert np.allclose(turned.centroid, self.PART.centroid, atol=1e-9)

    def test_nearest_points(self) -> None:
        line = SubHyperplane((0, 1), 2, Intervals([(-4, -3), (-1, 0)]))
        nearest, distance = line.nearest([(0.5, 5), (1.5, 2), (9, 2)])
        assert nearest.tolist() == [[0.5, 2], [1, 2], [4, 2]]
        assert distance.tolist() == [3, 0.5, 5]
        with pytest.raises(InvalidParameterError):
            (line - line).nearest([(0, 0)])

    @pytest.mark.parametrize(
        ("normal", "part"),
        [((0, 0), None), (1, None), ((1, 0), Region.rectangle(1)), ((1, 0, 0), Intervals.full())],
    )
    def test_what_is_no_sub_hyperplane_is_refused(self, normal: Any, part: Any) -> None:
        with pytest.raises((InvalidParameterError, InvalidMeshError)):
            SubHyperplane(normal, 0, part)

    def test_it_says_what_it_is(self) -> None:
        shown = repr(SubHyperplane((0, 2), 4, Intervals([(-4, 0)])))
        assert shown == "SubHyperplane((0, 1), 2, Intervals((-4, 0)))"


# Found: the union of a sub-hyperplane with itself lay in another hyperplane, because of rounding.
@pytest.mark.parametrize("normal", [(1, 4), (1, 2, 3), (0, 3, 1), (0.3, 0.7)])
def test_set_operations_keep_the_hyperplane(normal: tuple[float, ...]) -> None:
    part = SubHyperplane(normal, 3)
    assert (part | part) == part == ~~part
    assert part.reversed().reversed() == part
    assert hash(part & part) == hash(part)


# Found: a far hyperplane that coincides with a sub-hyperplane left it on one side.
@pytest.mark.parametrize("normal", [(3, 1, 2), (0, 3, 1), (1, 1, 1), (2, 3, 6)])
def test_a_far_hyperplane_that_coincides_divides_nothing(normal: tuple[int, ...]) -> None:
    far, triple = 1e6 + 0.1, [3 * x for x in normal]
    square = SubHyperplane(normal, far, Region.rectangle(1))
    assert [side.is_empty for side in square.split(triple, 3 * far)] == [True, True]
    assert [side.is_empty for side in square.split(triple, 3 * far + 1)] == [False, True]


PARTS = [
    (SubHyperplane((1, 4), 3), SubHyperplane((1, 4), 3, Intervals.empty())),
    (b.bsp.SphericalRegion.hemisphere([0, 0, 1]), b.bsp.SphericalRegion.empty()),
]


# Found: empty regions of the sphere and empty parts of hyperplanes were true as bool, and their
# operators raised an `AttributeError`.
@pytest.mark.parametrize(("full", "empty"), PARTS)
def test_parts_of_nothing_are_false(full: Any, empty: Any) -> None:
    assert bool(full) and not bool(empty)


@pytest.mark.parametrize("part", [pair[0] for pair in PARTS])
@pytest.mark.parametrize("operation", [operator.or_, operator.and_, operator.sub, operator.xor])
@pytest.mark.parametrize("other", [3, None, UP])
def test_parts_combine_with_their_like_only(part: Any, operation: Any, other: Any) -> None:
    with pytest.raises(TypeError, match="unsupported operand"):
        operation(part, other)
