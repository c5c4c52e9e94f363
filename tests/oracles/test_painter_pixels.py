"""Pixels of painted pictures against rays cast through them in rational arithmetic."""

import io
import re
from fractions import Fraction
from functools import cache
from itertools import product
from typing import Any, TypeAlias

import numpy as np
import numpy.typing as npt
import pytest
from PIL import Image

import bspcsg as b
from bspcsg import bsp
from support import DEEP, draw

Floats: TypeAlias = npt.NDArray[np.float64]
Exact: TypeAlias = list[Fraction]

SIZE = (240, 180)

#: The number of pixels of each picture that are judged.
PIXELS = 400 if DEEP else 130

#: Pixels from an edge or from a line where facets cross within which a pixel is not judged: Pillow
#: rounds corners to pixels, and paints every pixel that a border touches.
CLEAR = 1.7
AROUND = [np.array(shift) for shift in product((-CLEAR, 0.0, CLEAR), repeat=2)]


def soup(seed: int, count: int) -> Floats:
    """Return random triangles with integer coordinates that cross each other."""
    random = np.random.default_rng(seed)
    facets = random.integers(-9, 10, (count, 3, 3)).astype(float)
    areas = np.cross(facets[:, 1] - facets[:, 0], facets[:, 2] - facets[:, 0])
    wide: Floats = facets[np.abs(areas).sum(axis=1) > 60]
    return wide


def bars(long: float, wide: float, tilt: float) -> Floats:
    """Return the triangles of three bars that overlap cyclically."""
    corner = [(-long, 1), (long, 1), (long, 1 + wide), (-long, 1 + wide)]
    bar = np.array([(x, y, tilt * (x > 0)) for x, y in corner])
    turns = [
        np.array([(c, -s, 0), (s, c, 0), (0, 0, 1)]) for c, s in ((1, 0), (-0.5, 1), (-0.5, -1))
    ]
    quads = [np.round(bar @ turn.T, 3) for turn in turns]
    return np.array([quad[list(t)] for quad in quads for t in ((0, 1, 2), (0, 2, 3))])


def part() -> Floats:
    """Return the triangles of a block with two intersecting holes."""
    hole = b.cylinder(h=9, r=1.2, segments=8)
    block = (
        b.box((6, 5, 4)) - hole.translate(3, 2.5, -2) - hole.rotate((0, 90, 0)).translate(-1, 2, 2)
    )
    mesh = block.to_mesh()
    triangles: Floats = mesh.vertices[mesh.faces]
    return triangles


def eye(place: Any, target: Any, angle: float) -> bsp.Camera:
    return bsp.Camera.perspective(place, target, field_of_view=angle)


SCENES: dict[str, tuple[Floats, bsp.Camera]] = {
    "cycle": (bars(5, 1.5, 2), bsp.Camera.orthographic((0, 0, -1), scale=13)),
    "cycle from below": (bars(5, 1.5, 2), eye((1, 2, -14), (0, 0, 1), 50)),
    "crossing": (soup(1, 26), eye((20, -17, 11), (0, 0, 0), 45)),
    "crossing, parallel": (soup(2, 26), bsp.Camera.orthographic((-1, 2, -1), scale=24)),
    "eye among them": (soup(3, 30), eye((1, 2, 1), (-3, 4, -2), 100)),
    "part": (part(), eye((14, -9, 9), (3, 2.5, 2), 32)),
}


def ray(camera: bsp.Camera, pixel: Floats) -> tuple[Floats, Floats]:
    """Return origin and direction of the ray through a position in the picture."""
    width, height = SIZE
    across, up = (pixel - np.array([width, height]) / 2) * (2 / height) * camera.half_height
    right, upwards, away = camera.axes
    aside = across * right - up * upwards
    if camera.is_perspective:
        return camera.origin, away + aside
    return camera.origin + aside - 1000 * away, away


def nearest(facets: Floats, start: Floats, along: Floats) -> int:
    """Return the index of the facet that a ray meets first, in doubles; -1 for none."""
    a, u, v = facets[:, 0], facets[:, 1] - facets[:, 0], facets[:, 2] - facets[:, 0]
    with np.errstate(divide="ignore", invalid="ignore"):
        p, arm = np.cross(along, v), start - a
        slope = (u * p).sum(axis=1)
        s = (arm * p).sum(axis=1) / slope
        q = np.cross(arm, u)
        t, w = (v * q).sum(axis=1) / slope, q @ along / slope
        hit = (s >= 0) & (w >= 0) & (s + w <= 1) & (t > 0)
    return int(np.argmin(np.where(hit, t, np.inf))) if hit.any() else -1


def exactly_nearest(facets: list[list[Exact]], start: Exact, along: Exact) -> int:
    """Return the index of the facet that a ray meets first, exactly; -1 for none."""
    best, found = None, -1
    for number, (a, c, e) in enumerate(facets):
        u, v, arm = minus(c, a), minus(e, a), minus(start, a)
        p, q = cross(along, v), cross(arm, u)
        slope = dot(u, p)
        if slope == 0:
            continue
        s, w, t = dot(arm, p) / slope, dot(along, q) / slope, dot(v, q) / slope
        if s >= 0 and w >= 0 and s + w <= 1 and t > 0 and (best is None or t < best):
            best, found = t, number
    return found


def minus(a: Exact, b: Exact) -> Exact:
    return [x - y for x, y in zip(a, b, strict=True)]


def cross(a: Exact, b: Exact) -> Exact:
    return [a[i - 2] * b[i - 1] - a[i - 1] * b[i - 2] for i in range(3)]


def dot(a: Exact, b: Exact) -> Fraction:
    return sum((x * y for x, y in zip(a, b, strict=True)), Fraction(0))


def rational(values: Any) -> Any:
    return [rational(v) for v in values] if np.ndim(values) else Fraction(float(values))


def borders(facets: Floats, camera: bsp.Camera) -> Floats:
    """Return the edges of facets in front of the eye, (n, 2, 2) in pixels."""
    ends = np.stack([facets, np.roll(facets, -1, axis=1)], axis=2).reshape(-1, 2, 3)
    placed = (ends - camera.origin) @ camera.axes.T
    if camera.is_perspective:
        placed = placed[(placed[:, :, 2] > 0.01).any(axis=1)]
        first, last = placed[:, 0], placed[:, 1]
        for start, end in ((first, last), (last, first)):
            share = np.clip((0.01 - start[:, 2]) / (end[:, 2] - start[:, 2] + 1e-300), 0, 1)
            behind = start[:, 2] < 0.01
            start[behind] += (share[:, None] * (end - start))[behind]
        placed = placed / placed[:, :, 2:]
    scale = SIZE[1] / 2 / camera.half_height
    pixels: Floats = placed[:, :, :2] * np.array([scale, -scale]) + np.array(SIZE) / 2
    return pixels


def distance(spot: Floats, ends: Floats) -> float:
    """Return the distance of a point from the nearest of segments."""
    along, arm = ends[:, 1] - ends[:, 0], spot - ends[:, 0]
    share = (arm * along).sum(axis=1) / np.maximum((along**2).sum(axis=1), 1e-300)
    gap = arm - np.clip(share, 0, 1)[:, None] * along
    return float(np.hypot(*gap.T).min())


@cache
def judged(name: str) -> list[tuple[tuple[int, int], int]]:
    """Return random pixels away from all edges, with the facet visible at each."""
    facets, camera = SCENES[name]
    random = np.random.default_rng(draw(name, 2**32))
    exact, edges = rational(facets), borders(facets, camera)
    chosen: list[tuple[tuple[int, int], int]] = []
    while len(chosen) < PIXELS:
        spot = random.integers(0, SIZE)
        middle: Floats = spot.astype(np.float64) + 0.5
        if distance(middle, edges) < CLEAR:
            continue
        around = {nearest(facets, *ray(camera, middle + shift)) for shift in AROUND}
        if len(around) == 1 and (around != {-1} or random.random() < 0.1):
            answer = exactly_nearest(exact, *map(rational, ray(camera, middle)))
            assert {answer} == around
            chosen.append(((int(spot[0]), int(spot[1])), answer))
    return chosen


def picture_of(facets: Floats, camera: bsp.Camera, policy: bsp.Policy) -> bsp.Picture:
    """Return a picture in which each facet has a different colour."""
    colors = 0.3 + 0.7 * np.random.default_rng(4).random((len(facets), 3))
    tree = bsp.PartitionTree(facets, policy)
    return bsp.picture(
        tree, camera=camera, size=SIZE, colors=colors, edges="none", samples=1, cull=False
    )


def sources(picture: bsp.Picture) -> dict[tuple[int, ...], int]:
    """Return the facet of each colour in a picture."""
    painting = picture.painting
    assert painting.fills is not None
    fills = map(tuple, painting.fills.tolist())
    found = dict(zip(fills, painting.source.tolist(), strict=True))
    assert len(found) == len(set(painting.source.tolist())), "two facets have one colour"
    return found | {(255, 255, 255): -1}


def windings(path: str, x: float, y: float) -> int:
    """Return the winding number of the outlines of an SVG path about a point."""
    total = 0
    for loop in re.findall(r"M([^Mz]*)z", path):
        steps = np.array([[int(n) for n in pair.split(",")] for pair in re.split("[l ]", loop)])
        a = np.cumsum(steps, axis=0)
        e = np.roll(a, -1, axis=0)
        above = (a[:, 1] > y) != (e[:, 1] > y)
        side = (e[:, 0] - a[:, 0]) * (y - a[:, 1]) - (e[:, 1] - a[:, 1]) * (x - a[:, 0])
        up = e[:, 1] > a[:, 1]
        total += int((above & up & (side > 0)).sum() - (above & ~up & (side < 0)).sum())
    return total


@pytest.mark.sampled(3)
@pytest.mark.parametrize("policy", ["first", "random", "least-splits"])
@pytest.mark.parametrize("name", SCENES)
def test_nothing_is_painted_over_what_is_nearer(name: str, policy: bsp.Policy) -> None:
    facets, camera = SCENES[name]
    picture = picture_of(facets, camera, policy)
    colour_sources = sources(picture)
    pixels = np.asarray(Image.open(io.BytesIO(picture.png)).convert("RGB"))
    wrong = [
        ((x, y), answer)
        for (x, y), answer in judged(name)
        if colour_sources[tuple(pixels[y, x].tolist())] != answer
    ]
    assert not wrong


@pytest.mark.parametrize("name", SCENES)
def test_the_last_path_at_a_pixel_is_the_nearest_facet(name: str) -> None:
    facets, camera = SCENES[name]
    picture = picture_of(facets, camera, "random")
    colour_sources = sources(picture)
    _, _, grid_width, _ = re.findall(r'viewBox="(\S+) (\S+) (\S+) (\S+)"', picture.svg)[0]
    grid = int(grid_width) / SIZE[0]
    paths = re.findall(r'<path fill="#(\w+)" [^>]*d="([^"]*)"', picture.svg)
    for (x, y), answer in judged(name)[: PIXELS // 5]:
        spot = ((x + 0.5) * grid, (y + 0.5) * grid)
        fills = [fill for fill, path in paths if windings(path, *spot)]
        last = tuple(bytes.fromhex(fills[-1])) if fills else (255, 255, 255)
        assert colour_sources[last] == answer


def test_leaving_out_back_faces_of_a_closed_surface_changes_nothing() -> None:
    facets, camera = SCENES["part"]
    looks: dict[str, Any] = {"camera": camera, "size": SIZE, "edges": "none", "samples": 1}
    mesh = facets.reshape(-1, 3), np.arange(3 * len(facets)).reshape(-1, 3)
    culled, whole = (bsp.picture(mesh, cull=cull, **looks) for cull in (None, False))
    assert len(culled.painting.source) < 0.7 * len(whole.painting.source)
    first, second = (np.asarray(Image.open(io.BytesIO(p.png))) for p in (culled, whole))
    pixels = judged("part")
    assert all((first[y, x] == second[y, x]).all() for (x, y), _ in pixels)


def test_the_scenes_have_no_order_of_whole_facets() -> None:
    facets, camera = SCENES["cycle"]
    above = set()
    for spot in np.random.default_rng(1).integers(0, SIZE, (4000, 2)):
        start, along = ray(camera, spot + 0.5)
        here = nearest(facets, start, along)
        if here >= 0:
            others = facets[[k for k in range(6) if k // 2 != here // 2]]
            names = [k for k in range(6) if k // 2 != here // 2]
            below = nearest(others, start, along)
            if below >= 0:
                above.add((here // 2, names[below] // 2))
    assert above in ({(0, 1), (1, 2), (2, 0)}, {(1, 0), (2, 1), (0, 2)})
