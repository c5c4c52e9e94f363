"""Moved trees, trees with labels, sets of directions, and visibility."""

import itertools
import math
import pickle
from typing import Any

import numpy as np
import pytest

from bspcsg import bsp
from bspcsg.errors import BspcsgError, InvalidMeshError, InvalidParameterError, LimitError


def segments(seed: int, count: int = 12) -> Any:
    ends = np.random.default_rng(seed).integers(-9, 10, (4 * count, 2, 2))
    return ends[(ends[:, 0] != ends[:, 1]).any(axis=1)][:count].astype(float)


def triangles(seed: int, count: int = 6) -> Any:
    corners = np.random.default_rng(seed).integers(-5, 6, (4 * count, 3, 3)).astype(float)
    normals = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    return corners[normals.any(axis=1)][:count]


class TestMotions:
    @pytest.mark.parametrize(
        ("facets", "axes"),
        [
            (np.arange(12.0), None),
            (segments(1), (2, -1)),
            (segments(2), (-1, -2)),
            (triangles(1), (2, 3, 1)),
            (triangles(2), (-2, 1, 3)),
        ],
    )
    def test_every_node_is_moved(self, facets: Any, axes: Any) -> None:
        dimension = facets.shape[-1] if facets.ndim > 1 else 1
        normal = [1, 2, 3][:dimension]
        tree = bsp.PartitionTree(facets, top=3, cuts=[(normal, 0.5)])
        shift = np.array([3.5, -2, 1][:dimension])
        moved = tree.moved(axes, shift, 2)
        axes = axes or range(1, dimension + 1)
        turn = np.zeros((dimension, dimension))
        for row, axis in enumerate(axes):
            turn[row, abs(axis) - 1] = math.copysign(1, axis)
        assert len(moved) == len(tree)
        for name in ("minus", "plus", "parent", "start", "end"):
            assert moved.arrays[name].tolist() == tree.arrays[name].tolist()
        assert moved.arrays["normal"] == pytest.approx(tree.arrays["normal"] @ turn.T)
        places = 2 * tree.fragments.vertices @ turn.T + shift
        assert moved.fragments.vertices == pytest.approx(places)
        assert moved.fragments.source.tolist() == tree.fragments.source.tolist()
        assert pickle.loads(pickle.dumps(moved)) == moved

    def test_there_and_back_is_the_same_set_of_fragments(self) -> None:
        tree = bsp.PartitionTree(segments(3))
        back = tree.moved((2, -1), (1, 2)).moved(None, (-1, -2)).moved((-2, 1))
        assert back.fragments.vertices.tolist() == tree.fragments.vertices.tolist()
        assert back == tree

    @pytest.mark.parametrize("axes", [(1, 1), (1,), (2, 1), (0, 1), (1, 2, 3)])
    def test_what_is_no_rotation_is_refused(self, axes: Any) -> None:
        with pytest.raises(InvalidParameterError):
            bsp.PartitionTree(segments(1)).moved(axes)

    def test_images_beyond_the_lattice_are_refused(self) -> None:
        tree = bsp.PartitionTree(segments(1))
        for motion in ({"scale": 10**7}, {"offset": (1e300, 0)}, {"scale": 10**30}):
            with pytest.raises(LimitError):
                tree.moved(**motion)


def quarters() -> bsp.AttributeTree[str]:
    whole: bsp.AttributeTree[str] = bsp.AttributeTree(2, "all")
    return whole.insert_hyperplane((1, 0), 0, ("west", "east")).insert([[5, 1], [1, 1]], "inherit")

    # Found: callers could give neither hyperplanes nor a policy of their own.


class TestLabels:
    def test_a_facet_divides_only_what_it_reaches(self) -> None:
        tree = quarters()
        assert [region.label for region in tree] == ["west", "east", "east"]
        assert tree.labels_at([0, 0]) == ("west", "east")
        assert [len(region.sides) for region in tree] == [1, 2, 2]

    # Found: regions of the sphere, trees with labels and paths of boundaries were missing.
    def test_cut_rules_label_the_sides(self) -> None:
        tree = quarters().insert([[-1, 3], [9, 3]], ("above", "below"))
        # The line of the segment through each region, even where the segment ends.
        assert tree.label_at([-5, 9]) == tree.label_at([50, 9]) == "above"
        assert tree.label_at([-5, 2]) == tree.label_at([2, 2]) == "below"
        assert tree.label_at([2, 0.5]) == "east"

    def test_regions_fill_a_box(self) -> None:
        for dimension, facets in ((1, [3.0, -2.0]), (2, segments(4)), (3, triangles(4, 4))):
            tree: bsp.AttributeTree[int] = bsp.AttributeTree(dimension, 0)
            for number, facet in enumerate(facets):
                tree = tree.insert(facet, (2 * number, 2 * number + 1))
            low, high = [-10] * dimension, [10] * dimension
            sizes = [region.measure_within(low, high) for region in tree]
            assert sum(sizes) == pytest.approx(20.0**dimension)
            assert len(sizes) == len(tree) > len(facets)

    @pytest.mark.parametrize("seed", range(4))
    def test_labels_are_those_of_the_last_cut_above(self, seed: int) -> None:
        """Compare each point's label with the sides of the hyperplanes on its way."""
        tree: bsp.AttributeTree[tuple[int, int]] = bsp.AttributeTree(2, (-1, 0))
        scene = segments(seed)
        for number, facet in enumerate(scene):
            tree = tree.insert(facet, ((number, -1), (number, 1)))
        for point in np.random.default_rng(seed).uniform(-9, 9, (50, 2)).round(3):
            number, side = tree.label_at(point)
            a, b = scene[number]
            turn = (b[0] - a[0]) * (point[1] - a[1]) - (b[1] - a[1]) * (point[0] - a[0])
            assert np.sign(-turn) in (side, 0)

    def test_it_is_a_value(self) -> None:
        tree = quarters()
        grown = tree.insert([[9, 9], [9, 8]])
        assert len(tree) == 3 < len(grown)
        assert pickle.loads(pickle.dumps(grown)) == grown != tree
        assert tree.mapped(str.upper).label_at([-1, 0]) == "WEST"
        assert tree.mapped(len).mapped(str) == tree.mapped(lambda label: str(len(label)))

    @pytest.mark.parametrize(
        "facet",
        [
            [[0, 0], [0, 0]],
            [[0, 0, 0], [1, 0, 0], [0, 1, 0]],
            [[0, 0], [float("nan"), 1]],
        ],
    )
    def test_what_is_no_facet_is_refused(self, facet: Any) -> None:
        with pytest.raises((BspcsgError, ValueError)):
            quarters().insert(facet)

    def test_bent_polygons_are_refused(self) -> None:
        space: bsp.AttributeTree[str] = bsp.AttributeTree(3, "all")
        with pytest.raises(InvalidMeshError, match="plane"):
            space.insert([[0, 0, 0], [1, 0, 0], [1, 1, 1], [0, 1, 0]])


OCTANT = bsp.SphericalRegion.polygon([[1, 0, 0], [0, 1, 0], [0, 0, 1]])


class TestSpheres:
    def test_an_octant_is_an_eighth(self) -> None:
        assert OCTANT.share == pytest.approx(1 / 8, abs=1e-14)
        assert (~OCTANT).share == pytest.approx(7 / 8, abs=1e-14)
        assert OCTANT.classify([[1, 1, 1], [1, 1, 0], [1, 1, -1], [0, 0, 1]]).tolist() == [
            1,
            0,
            -1,
            0,
        ]

    def test_set_operations_are_those_of_their_members(self) -> None:
        random = np.random.default_rng(3)
        for dimension in (2, 3):
            vectors = random.integers(-5, 6, (300, dimension))
            vectors = vectors[vectors.any(axis=1)]
            axes = random.integers(-3, 4, (5, dimension))
            axes = axes[axes.any(axis=1)]
            halves = [bsp.SphericalRegion.hemisphere(axis) for axis in axes.tolist()]
            for (n, a), (m, b) in itertools.combinations(zip(axes, halves, strict=True), 2):
                p, q = vectors @ n, vectors @ m
                sure = (p != 0) & (q != 0)
                for region, member in (
                    (a | b, (p > 0) | (q > 0)),
                    (a & b, (p > 0) & (q > 0)),
                    (a - b, (p > 0) & (q < 0)),
                    (a ^ b, (p > 0) != (q > 0)),
                ):
                    found = region.classify(vectors[sure].tolist())
                    assert ((found == 1) == member[sure]).all()
                    assert (found != 0).all()

    def test_two_half_spheres_make_a_lune_of_their_angle(self) -> None:
        for x, y in ((1, 0), (1, 1), (0, 1), (-1, 1), (-3, 1)):
            lune = bsp.SphericalRegion.hemisphere([0, 1, 0]) & bsp.SphericalRegion.hemisphere(
                [y, -x, 0]
            )
            assert lune.measure == pytest.approx(2 * math.atan2(y, x), abs=1e-13)

    def test_arcs_run_counterclockwise(self) -> None:
        ends = [(1, 0), (2, 1), (0, 1), (-1, 0), (-1, -2), (3, -1)]
        for a, b in itertools.product(ends, repeat=2):
            arc = bsp.SphericalRegion.arc(a, b)
            expected = (math.atan2(b[1], b[0]) - math.atan2(a[1], a[0])) / (2 * math.pi) % 1
            assert arc.share == pytest.approx(expected, abs=1e-14)

    def test_pieces_are_counterclockwise_seen_from_outside(self) -> None:
        for piece in OCTANT.pieces():
            assert np.linalg.norm(piece, axis=1) == pytest.approx(1)
            assert np.dot(np.cross(piece[0], piece[1]), piece[2]) > 0

    def test_all_and_nothing(self) -> None:
        full, empty = bsp.SphericalRegion.full(), bsp.SphericalRegion.empty()
        assert full.share == pytest.approx(1)
        assert empty.share == 0
        assert full == (OCTANT | ~OCTANT)
        assert empty == (OCTANT & ~OCTANT)
        assert bsp.SphericalRegion.full(2).measure == pytest.approx(2 * math.pi)
        assert pickle.loads(pickle.dumps(OCTANT)) == OCTANT != full

    @pytest.mark.parametrize(
        "corners",
        [
            [[1, 0, 0], [0, 0, 1], [0, 1, 0]],
            [[1, 0, 0], [0, 1, 0]],
            [[1, 0, 0], [0, 0, 0], [0, 1, 0]],
            [[1, 0], [0, 1], [1, 1]],
        ],
    )
    def test_what_is_no_convex_polygon_is_refused(self, corners: Any) -> None:
        with pytest.raises(InvalidParameterError):
            bsp.SphericalRegion.polygon(corners)

    def test_cones_go_through_the_origin(self) -> None:
        with pytest.raises(InvalidParameterError, match="origin"):
            bsp.SphericalRegion(bsp.ObjectTree.half_space((1, 0, 0), 5, pitch=0))


class TestSky:
    def test_a_cube_around_the_eye_hides_all_and_without_a_face_a_sixth_is_seen(self) -> None:
        corners = np.array(list(itertools.product((-1.0, 1.0), repeat=3)))
        quads = [(0, 1, 3, 2), (4, 6, 7, 5), (0, 4, 5, 1), (2, 3, 7, 6), (0, 2, 6, 4), (1, 5, 7, 3)]
        faces = np.array([t for a, b, c, d in quads for t in ((a, b, c), (a, c, d))])
        assert bsp.visible_sky(corners[faces], [0, 0, 0]).is_empty
        assert bsp.visible_sky(corners[faces][2:], [0, 0, 0]).share == pytest.approx(1 / 6)
        assert bsp.visible_sky(corners[faces], [0.5, -0.25, 0.125]).is_empty

    @pytest.mark.parametrize("seed", range(3))
    def test_rays_agree(self, seed: int) -> None:
        for scene in (segments(seed, 8), triangles(seed, 6)):
            dimension = scene.shape[2]
            eye = np.full(dimension, 0.37)
            sky = bsp.visible_sky(scene, eye)
            heads = np.random.default_rng(seed).integers(-99, 100, (200, dimension)).astype(float)
            seen = ~bsp.RayCaster(scene).first_hit(eye, heads).hit
            found = sky.classify(heads.tolist())
            assert (found[found != 0] == np.where(seen, 1, -1)[found != 0]).all()
            assert (found != 0).mean() > 0.95

    def test_facets_seen_edge_on_hide_nothing(self) -> None:
        assert bsp.visible_sky([[[1, 0], [2, 0]]], [0, 0]).is_full
        assert bsp.visible_sky([[[1, 0, 0], [2, 0, 0], [1, 1, 0]]], [0, 0, 0]).is_full

    def test_other_shapes_are_refused(self) -> None:
        for facets, eye in (([1.0], [0]), ([[[0, 0], [1, 1]]], [0, 0, 0])):
            with pytest.raises(InvalidParameterError):
                bsp.visible_sky(facets, eye)


class TestVisibility:
    @pytest.mark.parametrize("seed", range(4))
    def test_the_polygon_holds_what_no_segment_hides(self, seed: int) -> None:
        scene, eye = segments(seed), np.array([0.125, 0.375])
        region = bsp.visibility_polygon(scene, eye, (-12, -12), (12, 12))
        points = np.random.default_rng(seed).uniform(-11, 11, (300, 2)).round(3)
        hidden = bsp.RayCaster(scene).occluded(eye, points)
        found = region.classify(points)
        assert (found[found != 0] == np.where(hidden, -1, 1)[found != 0]).all()

    @pytest.mark.parametrize("seed", range(2))
    def test_the_volume_holds_what_no_triangle_hides(self, seed: int) -> None:
        scene, eye = triangles(seed, 5), np.array([0.125, 0.375, 0.625])
        volume = bsp.visibility_volume(scene, eye, (-7, -7, -7), (7, 7, 7))
        points = np.random.default_rng(seed).uniform(-6, 6, (300, 3)).round(3)
        hidden = bsp.RayCaster(scene).occluded(eye, points)
        found = np.asarray(volume.classify(points))
        assert (found[found != 0] == np.where(hidden, -1, 1)[found != 0]).all()

    def test_both_have_exact_measures(self) -> None:
        # A wall of half the view: the box of 16 without the trapezoid of 3 behind it.
        wall = [[[1, -1], [1, 1]]]
        assert bsp.visibility_polygon(wall, (0, 0), (-2, -2), (2, 2)).area == 13

    def test_large_scenes_choose_a_coarser_lattice(self) -> None:
        scene, eye = bsp.analysis.disjoint_segments(8), np.array([8000000.5, 8000000.5])
        region = bsp.visibility_polygon(scene, eye, (0, 0), (2**24, 2**24))
        points = np.random.default_rng(1).uniform(0, 2**24, (100, 2)).round(1)
        hidden = bsp.RayCaster(scene).occluded(eye, points)
        assert (region.classify(points) == np.where(hidden, -1, 1)).all()

    def test_an_eye_on_a_segment_is_refused(self) -> None:
        with pytest.raises(InvalidParameterError, match="lies on"):
            bsp.visibility_polygon([[[-1, 0], [1, 0]]], (0, 0), (-2, -2), (2, 2))


BAD_BOXES = [
    ((math.nan, 0), (1, 1)),
    ((1, 1), (0, 0)),
    ((0, 1), (1, 0)),
    ((0, 0), (1,)),
    (3, (1, 1)),
]


# Found: boxes with exchanged corners gave measures of 1 and empty views without an error, and boxes
# with NaN a raw `ValueError`.
@pytest.mark.parametrize(("low", "high"), BAD_BOXES)
def test_boxes_that_are_none_are_refused(low: Any, high: Any) -> None:
    whole = bsp.AttributeTree(2, "all")
    for tree in (whole, whole.insert([[0, 0], [1, 0]])):
        for region in tree:
            with pytest.raises(InvalidParameterError, match=r"^(low|high) must"):
                region.measure_within(low, high)
            with pytest.raises(InvalidParameterError, match=r"^(low|high) must"):
                region.within(low, high)
    with pytest.raises(InvalidParameterError, match=r"^(low|high) must"):
        bsp.visibility_polygon([[[1, -1], [1, 1]]], (0.5, 0.5), low, high)


def test_a_volume_is_seen_in_no_box_that_is_turned_over() -> None:
    with pytest.raises(InvalidParameterError, match="low must not be above high"):
        bsp.visibility_volume(np.ones((0, 3, 3)), (0, 0, 0), (-2, 2, -2), (2, -2, 2))


# Found: a spherical polygon with equal corners ended in a raw `TypeError`.
def test_spherical_polygons_need_corners_that_differ() -> None:
    with pytest.raises(InvalidParameterError, match="must not all have the same direction"):
        bsp.SphericalRegion.polygon([[1, 0, 0], [2, 0, 0], [3, 0, 0]])


# Found: corners of 16 digits did not lie on the spherical polygons that they made, whose sides
# were rounded.
def test_corners_of_sixteen_digits_lie_on_their_polygon() -> None:
    rng = np.random.default_rng(1)
    for _ in range(20):
        corners = rng.normal(size=(4, 3))
        corners /= np.linalg.norm(corners, axis=1)[:, None]
        a, b, c = corners[:3] if np.linalg.det(corners[:3]) > 0 else corners[2::-1]
        side = bsp.SphericalRegion.polygon([a, b, c])
        assert side.classify([a, b, c]).tolist() == [0, 0, 0]
        around = (a + b + c).tolist()
        fan = [bsp.SphericalRegion.polygon([p, q, around]) for p, q in ((a, b), (b, c), (c, a))]
        assert fan[0] | fan[1] | fan[2] == side
        assert not (fan[0] & fan[1] or fan[1] & fan[2] or fan[2] & fan[0])
