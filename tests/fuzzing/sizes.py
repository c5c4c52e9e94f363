"""Random scenes of the sizes at which the core changes its methods.

For example 16 faces are searched one by one and 17 are sorted; 2000 elements are the work of one
thread and 2001 of several. Such thresholds are read from the core's sources, so that new ones are
included.
"""

import re
from collections.abc import Callable, Iterator, Sequence
from dataclasses import replace
from pathlib import Path
from typing import TypeAlias

import numpy as np

import bspcsg as b

from .judge import Kernel, evaluated, judge
from .places import Balls, Point, Surface, Triangle, cross, dot, less, minus, normal, reduced
from .scenes import (
    UNIT,
    Body,
    Expression,
    Part,
    Rng,
    Scene,
    cuboid_part,
    point_of,
    random_expression,
    random_motion,
    random_plane,
    tetrahedron_part,
)

_CORE = Path(__file__).parents[2] / "core" / "src"
_ROOMS = ("mesh", "tree", "merge", "extract", "query", "python/calls/run.rs")
_SIZE = re.compile(r"const [A-Z_]+: usize = (\d+)(?:_(\d+))?(?: << (\d+))?;")

#: The smallest and the largest size near which scenes are made: every scene has smaller ones, and
#: larger ones would take minutes.
MIN_SIZE, MAX_SIZE = 8, 1 << 14

#: The largest number of faces around a corner, and of corners of a polygon: the time for their
#: needles grows with its square.
MAX_FAN_SIZE = 129

#: The largest distance of points that are far from everything, in lattice steps.
MAX_FAR_STEPS = 100 * UNIT

#: The largest number of operands of a scene: their names are letters.
MAX_OPERANDS = 24

#: Numbers of threads that must give the same bytes.
THREADS = (1, 2, 4)

Faces: TypeAlias = list[tuple[int, int, int]]


def thresholds() -> list[int]:
    """Return the sizes that the core's sources define as constants."""
    paths = [path for room in _ROOMS for path in _sources(_CORE / room)]
    found = {
        int(low + (more or "")) << int(shift or 0)
        for path in paths
        for low, more, shift in _SIZE.findall(path.read_text(encoding="utf-8"))
    }
    return sorted(size for size in found if MIN_SIZE <= size <= MAX_SIZE)


def _sources(path: Path) -> list[Path]:
    return [path] if path.is_file() else sorted(path.rglob("*.rs"))


_THRESHOLDS = thresholds()


def a_size(rng: Rng, most: int = MAX_SIZE) -> int:
    """Return a random threshold of at most `most`, plus -1, 0 or 1."""
    fitting = [size for size in _THRESHOLDS if size <= most]
    return fitting[int(rng.integers(len(fitting)))] + int(rng.integers(-1, 2))


def sized_scene(rng: Rng) -> Scene:
    """Return a random scene with an operand whose size is near a threshold."""
    makers = [_with_tools, _with_tools, _with_tools, _plate, _crowd]
    bodies = makers[int(rng.integers(len(makers)))](rng)
    order = rng.permutation(len(bodies)).tolist()
    bodies = tuple(bodies[k] for k in order)
    if rng.random() < 0.2:
        motion = random_motion(rng, UNIT)
        bodies = tuple(replace(body, motions=(motion,)) for body in bodies)
    scene = Scene(bodies, _expression(rng, len(bodies)), ())
    return replace(scene, points=_points(rng, scene))


def judge_sized(scene: Scene, kernel: Kernel | None = None) -> list[str]:
    """Return what is wrong with a scene, also with several threads and far from other operands."""
    return judge(scene, kernel) or list(far_and_wide(scene, kernel or Kernel()))


def far_and_wide(scene: Scene, kernel: Kernel) -> Iterator[str]:
    """Yield what is wrong with the mesh with several threads, and far from where operands meet."""
    if not scene.is_bounded:
        return
    found = set()
    try:
        for number in THREADS:
            b.set_threads(number)
            mesh = kernel.mesh(evaluated(scene, kernel)[1])
            found.add((mesh.vertices.tobytes(), mesh.faces.tobytes()))
    finally:
        b.set_threads(0)
    if len(found) > 1:
        yield f"threads: {len(found)} unchanged input meshes"
    yield from _untouched(scene, mesh)


# Faces far from other operands


def _untouched(scene: Scene, mesh: "b.Mesh") -> Iterator[str]:
    """Yield complaints about faces far from other operands that are changed, lost or left over."""
    there = set(map(_turned, _steps(mesh)))
    operands = [known.triangles for known in scene.known() if isinstance(known, Surface)]
    for k, body in enumerate(scene.bodies):
        if body.volume is None:
            continue
        others = [faces for j, faces in enumerate(operands) if j != k]
        alone = [j == k for j in range(len(operands))]
        inside, outside = scene.value(alone), scene.value([False] * len(operands))
        for face in _far(operands[k], others):
            p, q, r = face
            kept, opposite = _turned(face) in there, _turned((p, r, q)) in there
            if (kept, opposite) != (inside and not outside, outside and not inside):
                yield f"untouched: the face {face} of operand {k}"
                break


def _steps(mesh: "b.Mesh") -> list[Triangle]:
    corners = [tuple(row) for row in np.rint(mesh.vertices * UNIT).astype(np.int64).tolist()]
    return [(corners[p], corners[q], corners[r]) for p, q, r in mesh.faces.tolist()]


def _turned(face: Triangle) -> Triangle:
    """Return the corners of a face in cyclic order, the least first."""
    p, q, r = face
    return min((p, q, r), (q, r, p), (r, p, q))


def _far(faces: Sequence[Triangle], others: Sequence[Sequence[Triangle]]) -> list[Triangle]:
    """Return the faces that no other operand can change.

    They lie outside the boxes of the other operands, in no plane of a face that may be cut, and
    beside no face of their plane: if such a face is cut, corners on edges may vanish.
    """
    corners = np.array(faces, dtype=np.float64).reshape(-1, 3, 3)
    near = np.zeros(len(faces), dtype=bool)
    for other in others:
        box = np.array(other, dtype=np.float64).reshape(-1, 3)
        low, high = box.min(axis=0), box.max(axis=0)
        near |= ((corners.max(axis=1) >= low) & (corners.min(axis=1) <= high)).all(axis=1)
    planes = [_plane(face) for face in faces]
    cut = {planes[k] for k in np.flatnonzero(near).tolist()}
    cut |= {_plane(face) for other in others for face in other}
    beside = {
        edge: plane for face, plane in zip(faces, planes, strict=True) for edge in _edges(face)
    }
    return [
        faces[k]
        for k in np.flatnonzero(~near).tolist()
        if planes[k] not in cut
        and all(beside.get((q, p)) != planes[k] for p, q in _edges(faces[k]))
    ]


def _edges(face: Triangle) -> list[tuple[Point, Point]]:
    p, q, r = face
    return [(p, q), (q, r), (r, p)]


def _plane(face: Triangle) -> tuple[Point, int]:
    """Return a key that is equal for faces of one plane, in either orientation."""
    n = reduced(normal(face))
    n = max(n, minus(n))
    return n, dot(n, face[0])


def _expression(rng: Rng, operands: int) -> Expression:
    """Return a random expression; sometimes the union of all operands."""
    if operands < 3 or rng.random() < 0.5:
        return random_expression(rng, operands)
    found: Expression = 0
    for k in range(1, operands):
        found = ("|", found, k)
    return found


# Operands


def _with_tools(rng: Rng) -> tuple[Body, ...]:
    """Return a large operand, and one or two others near a point of its surface."""
    makers: list[Callable[[Rng], Part]] = [ball, terrain, scatter, fan, stairs]
    large = makers[int(rng.integers(len(makers)))](rng)
    tools = [_tool(rng, large) for _ in range(int(rng.choice([1, 1, 2])))]
    return (Body((large,)), *tools)


def _tool(rng: Rng, large: Part) -> Body:
    kind = int(rng.integers(6))
    if kind == 0:
        beside = bool(rng.random() < 0.5)
        plane = _plane_beside(rng, large) if beside else random_plane(rng, UNIT // 10, 4)
        if plane is not None:
            return Body(plane=plane)
    if kind == 1:
        return Body((_knife(rng, large),))
    if kind == 2 and (glued := _glued(rng, large)) is not None:
        return Body((glued,))
    return Body((_tiny(rng, large),))


def _plane_beside(rng: Rng, large: Part) -> Triangle:
    """Return three points of a plane across an axis, in front of, behind or through a surface."""
    axis, outwards = int(rng.integers(3)), bool(rng.random() < 0.5)
    along = [corner[axis] for corner in large.vertices]
    at = int(rng.choice([min(along) - UNIT, along[0], max(along) + UNIT]))
    places = [(0, 0), (1, 0), (0, 1)] if outwards else [(0, 0), (0, 1), (1, 0)]
    p, q, r = (_with_axis(axis, at, (j * UNIT, k * UNIT)) for j, k in places)
    return p, q, r


def _with_axis(axis: int, at: int, others: tuple[int, int]) -> Point:
    j, k = others
    return ((at, j, k), (k, at, j), (j, k, at))[axis]


def _tiny(rng: Rng, large: Part) -> Part:
    """Return a box or tetrahedron at a point of a surface, of any size down to one step."""
    x, y, z = point_of(rng, _any_face(rng, large))
    size = max(1, round(UNIT * 10 ** -float(rng.uniform(0, 9))))
    if rng.random() < 0.4:
        arms = rng.integers(-size, size + 1, (4, 3)).tolist()
        part = tetrahedron_part([(x + i, y + j, z + k) for i, j, k in arms])
        if part is not None:
            return part
    # A box with a side through the point is coplanar with what is there, now and then.
    low = [at - int(rng.choice([0, size, int(rng.integers(0, size + 1))])) for at in (x, y, z)]
    high = [start + int(rng.choice([size, 2 * size])) for start in low]
    return cuboid_part((low[0], low[1], low[2]), (high[0], high[1], high[2]))


def _glued(rng: Rng, large: Part) -> Part | None:
    """Return a tetrahedron on a face of a surface, outside or inside; None for a flat face."""
    p, q, r = _any_face(rng, large)
    n = cross(less(q, p), less(r, p))
    long = dot(n, n) ** 0.5
    if long == 0:
        return None
    height = UNIT * float(rng.choice([-1, 1])) * 10 ** -float(rng.uniform(0.5, 6))
    x, y, z = (round((p[i] + q[i] + r[i]) / 3 + n[i] / long * height) for i in range(3))
    return tetrahedron_part([p, q, r, (x, y, z)])


def _knife(rng: Rng, large: Part) -> Part:
    """Return a plate that cuts through a whole surface."""
    corners = np.array(large.vertices)
    low, high = corners.min(axis=0) - UNIT, corners.max(axis=0) + UNIT
    axis, thickness = int(rng.integers(3)), max(1, round(UNIT * 10 ** -float(rng.uniform(0, 9))))
    low[axis] = large.vertices[int(rng.integers(len(large.vertices)))][axis]
    high[axis] = low[axis] + thickness
    (a, c, e), (d, f, g) = low.tolist(), high.tolist()
    return cuboid_part((a, c, e), (d, f, g))


def _plate(rng: Rng) -> tuple[Body, ...]:
    """Return a plate of twelve faces, and many parts on it, in it or through it."""
    parts = scatter(rng)
    corners = np.array(parts.vertices)
    low, high = corners.min(axis=0) - UNIT, corners.max(axis=0) + UNIT
    low[2] = -UNIT * int(rng.integers(0, 3)) - UNIT
    high[2] = UNIT * int(rng.integers(0, 3))
    (a, c, e), (d, f, g) = low.tolist(), high.tolist()
    return Body((cuboid_part((a, c, e), (d, f, g)),)), Body((parts,))


def _crowd(rng: Rng) -> tuple[Body, ...]:
    """Return many small operands close to one point."""
    count = min(a_size(rng, MAX_OPERANDS), MAX_OPERANDS)
    grid = int(rng.choice([UNIT, 1]))
    bodies = []
    for _ in range(count):
        corners = rng.integers(0, 4 * UNIT // grid, (4, 3)) * grid
        p, q, r, s = ((int(x), int(y), int(z)) for x, y, z in corners.tolist())
        part = tetrahedron_part([p, q, r, s]) if rng.random() < 0.5 else None
        high = (max(p[0], q[0]) + UNIT, max(p[1], q[1]) + UNIT, max(p[2], q[2]) + UNIT)
        bodies.append(Body((part or cuboid_part(p if p < high else q, high),)))
    return tuple(bodies)


# Surfaces of given sizes


def ball(rng: Rng) -> Part:
    """Return a ball of about two units with a number of faces near a threshold."""
    count = max(a_size(rng), 8) & ~1
    rings = max(1, round((count / 4) ** 0.5))
    while (columns := count // (2 * rings)) < 3:
        rings -= 1
    radius = 2 * UNIT
    vertices: list[Point] = [(0, 0, -radius)]
    for ring in range(1, rings + 1):
        tilt = np.pi * (ring / (rings + 1) - 0.5)
        for turn in 2 * np.pi * np.arange(columns) / columns:
            flat = radius * np.cos(tilt)
            x, y, z = flat * np.cos(turn), flat * np.sin(turn), radius * np.sin(tilt)
            vertices.append((round(x), round(y), round(z)))
    vertices.append((0, 0, radius))
    faces: Faces = []
    for k in range(columns):
        first, second = 1 + k, 1 + (k + 1) % columns
        faces.append((0, second, first))
        for ring in range(rings - 1):
            p, q = first + ring * columns, second + ring * columns
            faces += [(p, q, q + columns), (p, q + columns, p + columns)]
        last = (rings - 1) * columns
        faces.append((first + last, second + last, len(vertices) - 1))
    return _refined(rng, vertices, faces, count)


def terrain(rng: Rng) -> Part:
    """Return a slab with a flat or rough top, whose faces lie in a grid of cells."""
    count = max(a_size(rng), 12) & ~1
    side = max(1, int(((64 + 16 * count) ** 0.5 - 8) / 8))
    cell, rough = UNIT // 10 * int(rng.integers(1, 6)), bool(rng.random() < 0.5)
    heights = rng.integers(0, UNIT if rough else 1, (side + 1, side + 1))
    across = range(side + 1)
    top = [(i * cell, j * cell, UNIT + int(heights[i, j])) for i in across for j in across]
    vertices: list[Point] = [*top, *((x, y, 0) for x, y, _ in top)]
    faces: Faces = []
    below, row = len(top), side + 1
    for i in range(side):
        for j in range(side):
            p, q, r, s = (row * i + j, row * (i + 1) + j, row * (i + 1) + j + 1, row * i + j + 1)
            faces += [(p, q, r), (p, r, s)]
            faces += [(p + below, r + below, q + below), (p + below, s + below, r + below)]
    rim = [row * i for i in range(side)] + [row * side + j for j in range(side)]
    rim += [row * i + side for i in range(side, 0, -1)] + list(range(side, 0, -1))
    for p, q in zip(rim, rim[1:] + rim[:1], strict=True):
        faces += [(p + below, q + below, q), (p + below, q, p)]
    return _refined(rng, vertices, faces, count)


def scatter(rng: Rng) -> Part:
    """Return disjoint boxes or tetrahedra; their or their faces' number is near a threshold."""
    boxes = bool(rng.random() < 0.5)
    count = a_size(rng, 4096)
    if rng.random() < 0.5 or count > 1024:
        count = max(1, count // (12 if boxes else 4))
    side = int(np.ceil(count**0.5))
    parts = []
    for k in range(count):
        x, y = k // side * 2 * UNIT, k % side * 2 * UNIT
        far = (x + UNIT, y + UNIT, UNIT)
        sharp = tetrahedron_part([(x, y, 0), (x + UNIT, y, 0), (x, y + UNIT, 0), far])
        parts.append(cuboid_part((x, y, 0), far) if boxes or sharp is None else sharp)
    return _joined(parts)


def fan(rng: Rng) -> Part:
    """Return a pyramid with a number of sides near a threshold."""
    count = max(a_size(rng, MAX_FAN_SIZE), 3)
    turns = 2 * np.pi * np.arange(count) / count
    rim = [(round(2 * UNIT * np.cos(t)), round(2 * UNIT * np.sin(t)), 0) for t in turns]
    vertices: list[Point] = [*rim, (0, 0, 2 * UNIT)]
    faces: Faces = [(k, (k + 1) % count, count) for k in range(count)]
    faces += [(0, k + 1, k) for k in range(1, count - 1)]
    return Part(tuple(vertices), tuple(faces), True)


def stairs(rng: Rng) -> Part:
    """Return stairs whose two side walls have a number of corners near a threshold."""
    steps, step = a_size(rng, MAX_FAN_SIZE), UNIT // 10
    corners = [(0, 0)]
    for k in range(steps):
        corners += [(steps - k, k), (steps - k, k + 1)]
    corners.append((0, steps))
    count = len(corners)
    low: list[Point] = [(x * step, y * step, 0) for x, y in corners]
    vertices = [*low, *((x, y, UNIT) for x, y, _ in low)]
    faces: Faces = []
    for k in range(1, count - 1):
        faces += [(0, k + 1, k), (count, count + k, count + k + 1)]
    for p in range(count):
        q = (p + 1) % count
        faces += [(p, q, q + count), (p, q + count, p + count)]
    return Part(tuple(vertices), tuple(faces), True)


def _refined(rng: Rng, vertices: list[Point], faces: Faces, count: int) -> Part:
    """Return a surface with `count` faces, by dividing faces at their centres."""
    missing = (count - len(faces)) // 2
    for k in rng.permutation(len(faces))[: max(missing, 0)].tolist():
        p, q, r = faces[k]
        corners = (vertices[p], vertices[q], vertices[r])
        x, y, z = (sum(axis) // 3 for axis in zip(*corners, strict=True))
        middle = len(vertices)
        vertices.append((x, y, z))
        faces[k] = (p, q, middle)
        faces += [(q, r, middle), (r, p, middle)]
    return Part(tuple(vertices), tuple(faces), True)


def _joined(parts: Sequence[Part]) -> Part:
    starts = np.cumsum([0] + [len(part.vertices) for part in parts]).tolist()
    faces = tuple(
        (p + start, q + start, r + start)
        for part, start in zip(parts, starts, strict=False)
        for p, q, r in part.faces
    )
    return Part(tuple(p for part in parts for p in part.vertices), faces, True)


# Points


def _any_face(rng: Rng, part: Part) -> Triangle:
    p, q, r = part.faces[int(rng.integers(len(part.faces)))]
    return part.vertices[p], part.vertices[q], part.vertices[r]


def _points(rng: Rng, scene: Scene) -> tuple[Point, ...]:
    """Return points of the smallest operand, of other operands near these, and points far away."""
    balls = [known.balls for known in scene.known() if isinstance(known, Surface)]
    small = min(balls, key=lambda each: len(each.triangles))
    points: list[Point] = []
    for _ in range(5):
        points.append(point_of(rng, _one_of(rng, small.triangles)))
        points += [
            point_of(rng, _one_of(rng, near)) for each in balls if (near := _near(each, points[-1]))
        ][:3]
    for k in rng.integers(0, len(points), 4).tolist():
        x, y, z = points[k]
        dx, dy, dz = rng.integers(-2, 3, 3).tolist()
        points.append((x + dx, y + dy, z + dz))
    points += [
        (x, y, z) for x, y, z in rng.integers(-MAX_FAR_STEPS, MAX_FAR_STEPS, (3, 3)).tolist()
    ]
    return tuple(points)


def _near(balls: Balls, point: Point) -> list[Triangle]:
    return balls.around(point)


def _one_of(rng: Rng, triangles: Sequence[Triangle]) -> Triangle:
    return triangles[int(rng.integers(len(triangles)))]
