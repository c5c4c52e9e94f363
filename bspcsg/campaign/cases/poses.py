"""Poses: affine maps that place the second of two meshes at random or on the first mesh.

A pose is given by the three rows of its matrix and applied to the vertices as they were read, in
double precision.
"""

from collections.abc import Callable
from typing import TypeAlias

import numpy as np

from ..._types import FloatArray, MeshArrays

PoseFunction: TypeAlias = Callable[[FloatArray, FloatArray, np.random.Generator], FloatArray]

_QUARTER_TURN = np.array([(0.0, -1, 0), (1, 0, 0), (0, 0, 1)])


def pose_matrix(
    name: str, first: FloatArray, second: FloatArray, seed: int, number: int
) -> FloatArray:
    """Return the rows of the affine map of a pose, (3, 4) float64.

    Parameters
    ----------
    name : str
        One of `POSES`.
    first, second : (n, 3) float64
        The vertices of both meshes. For a pose in `OF_THE_FIRST` the second mesh is a copy of the
        first.
    seed, number : int
        The seed of the campaign and the number of the case, which determine random choices.
    """
    return POSES[name](first, second, np.random.default_rng([seed, number]))


def placed(mesh: MeshArrays, rows: FloatArray) -> MeshArrays:
    """Return the image of a mesh under an affine map; a mirroring map also reverses the faces."""
    vertices = mesh[0] @ rows[:, :3].T + rows[:, 3]
    mirrors = np.linalg.det(rows[:, :3]) < 0
    return vertices, mesh[1][:, ::-1].copy() if mirrors else mesh[1]


def shuffled(mesh: MeshArrays, seed: int, number: int) -> MeshArrays:
    """Return the mesh with its faces in a random order."""
    rng = np.random.default_rng([seed, number])
    return mesh[0], mesh[1][rng.permutation(len(mesh[1]))]


def _rows(linear: FloatArray, shift: FloatArray) -> FloatArray:
    return np.concatenate([linear, shift[:, None]], axis=1)


def _box_centre(points: FloatArray) -> FloatArray:
    middle: FloatArray = (points.min(axis=0) + points.max(axis=0)) / 2
    return middle


def _size(points: FloatArray) -> float:
    return float(np.linalg.norm(np.ptp(points, axis=0)))


def _random(first: FloatArray, second: FloatArray, rng: np.random.Generator) -> FloatArray:
    """Rotate, scale and shift the second mesh so that both overlap in general position."""
    scale = _size(first) / _size(second) * rng.uniform(0.5, 1.5)
    linear = _rotation(rng) * scale
    shift = rng.uniform(-0.4, 0.4, 3) * np.ptp(first, axis=0)
    return _rows(linear, _box_centre(first) + shift - linear @ _box_centre(second))


def _rotation(rng: np.random.Generator) -> FloatArray:
    """Return a uniformly distributed rotation matrix, from a random quaternion."""
    w, x, y, z = (q := rng.normal(size=4)) / np.linalg.norm(q)
    return np.array(
        [
            [1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)],
            [2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)],
            [2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)],
        ]
    )


def _alike_in_size(first: FloatArray, second: FloatArray) -> float:
    # With a power of ten, decimals stay short and coplanar faces coplanar.
    return float(10.0 ** round(float(np.log10(_size(first) / _size(second)))))


def _corner(first: FloatArray, second: FloatArray, rng: np.random.Generator) -> FloatArray:
    """Align the minimum corners of both bounding boxes, so that outer faces become coplanar."""
    scale = _alike_in_size(first, second)
    return _rows(np.eye(3) * scale, first.min(axis=0) - (second * scale).min(axis=0))


def _beside(first: FloatArray, second: FloatArray, rng: np.random.Generator) -> FloatArray:
    """Put the second mesh beside the first along an axis, so that outer faces touch."""
    rows = _corner(first, second, rng)
    axis = int(rng.integers(3))
    rows[axis, 3] += np.ptp(first, axis=0)[axis]
    return rows


def _copy(first: FloatArray, second: FloatArray, rng: np.random.Generator) -> FloatArray:
    """Shift a copy of the first mesh along an axis, so that its faces slide in their planes."""
    shift, axis = np.zeros(3), int(rng.integers(3))
    shift[axis] = rng.choice([0.25, 0.5, 1.0]) * np.ptp(first, axis=0)[axis]
    return _rows(np.eye(3), shift)


def _mirror(first: FloatArray, second: FloatArray, rng: np.random.Generator) -> FloatArray:
    """Reflect a copy of the first mesh in a plane through the centre of its bounding box."""
    linear, shift, axis = np.eye(3), np.zeros(3), int(rng.integers(3))
    linear[axis, axis] = -1
    shift[axis] = first[:, axis].max() + first[:, axis].min()
    return _rows(linear, shift)


def _turned(first: FloatArray, second: FloatArray, rng: np.random.Generator) -> FloatArray:
    """Rotate a copy of the first mesh by 90 degrees about the centre of its bounding box."""
    return _rows(_QUARTER_TURN, _box_centre(first) - _QUARTER_TURN @ _box_centre(first))


def _same(first: FloatArray, second: FloatArray, rng: np.random.Generator) -> FloatArray:
    """Return the identity map for the copy; `shuffled` gives the copy's faces another order."""
    return _rows(np.eye(3), np.zeros(3))


POSES: dict[str, PoseFunction] = {
    "random": _random,
    "corner": _corner,
    "beside": _beside,
    "copy": _copy,
    "mirror": _mirror,
    "turned": _turned,
    "same": _same,
}

#: Poses in which parts of the two meshes coincide.
COINCIDENT = tuple(name for name in POSES if name != "random")

#: Poses of a copy of the first mesh.
OF_THE_FIRST = frozenset({"copy", "mirror", "turned", "same"})
