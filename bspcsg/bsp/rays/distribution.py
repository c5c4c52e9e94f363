"""Trees for a given distribution of rays, with the facets that are most likely hit at the top.

The score of a facet p for rays l with the density ω is ``score(p) = ∫ ω(l) · |n · l_d| · area(p) /
area(S) dl``, with the unit normal n of the facet, the unit direction l_d of the ray, and the set S
of all facets. The integral is computed as a sum over a sample of rays (lecture notes, "Distribution
optimized BSP").
"""

from collections.abc import Callable
from typing import Any

import numpy as np

from ..._types import FloatArray
from ...errors import InvalidMeshError, invalid_parameter
from ...geometry.arrays import doubles
from ...parameters import function_of
from .adaptive import StaticTree
from .targets import RayTargets, facets_from, ray_arrays

#: The number of rays whose scores are computed in one array operation.
_RAYS_PER_BATCH = 256

#: A density of rays: a function ω(origins, directions) of (n, d) arrays that returns n weights.
Density = Callable[[FloatArray, FloatArray], Any]


def scores(
    facets: Any,
    origins: Any,
    directions: Any,
    *,
    weights: Any = None,
    density: Density | None = None,
) -> FloatArray:
    """Return the score of each facet for a sample of rays, (n,) float64.

    The score of a facet estimates how likely a ray of the distribution hits it.

    Parameters
    ----------
    facets : array_like, Solid, or mesh
        As for `RayCaster`.
    origins, directions : (k, d) or (d,) array_like of float
        The sample of rays; directions need no unit length.
    weights : (k,) array_like of float, optional
        ω of each ray, at least 0; by default every ray counts 1/k.
    density : callable, optional
        Used instead of weights: ``density(origins, directions)`` returns ω of each ray of the
        sample. The sample must then be drawn uniformly; each ray counts ω/k.

    Returns
    -------
    (n,) float64
        Sums over the rays of ω · abs(n · l_d) · area(p) / area(S), with unit normal n, unit
        direction l_d, and S all facets. In 2D areas are lengths, in 1D 1.

    Raises
    ------
    InvalidMeshError
        For a direction of length zero, weights that are negative or not finite, other shapes.
    """
    return _scores(facets_from(facets), origins, directions, weights, density)


def optimised_tree(
    facets: Any,
    origins: Any,
    directions: Any,
    *,
    weights: Any = None,
    density: Density | None = None,
    pitch: int | None = None,
    max_nodes: int = 4_000_000,
) -> StaticTree:
    """Return the autopartition that uses facets of high score (see `scores`) as cuts first.

    Parameters are those of `scores` and `StaticTree`; facets of equal score keep their order.
    """
    found = facets_from(facets)
    score = _scores(found, origins, directions, weights, density)
    order = np.argsort(-score, kind="stable")
    return StaticTree(facets, order=order, pitch=pitch, max_nodes=max_nodes)


def _scores(
    facets: RayTargets, origins: Any, directions: Any, weights: Any, density: Density | None
) -> FloatArray:
    starts, heads = ray_arrays(origins, directions, facets.dimension)
    omega = _weights(starts, heads, weights, density)
    heads = _unit(heads)
    normals, total = facets.normals(), np.zeros(len(facets.corners))
    for first in range(0, len(heads), _RAYS_PER_BATCH):
        rows = slice(first, first + _RAYS_PER_BATCH)
        total += np.abs(normals @ heads[rows].T) @ omega[rows]
    sizes = facets.sizes()
    whole = sizes.sum()
    return np.asarray(total * sizes / (whole if whole > 0 else 1))


def _unit(directions: FloatArray) -> FloatArray:
    # Scaling first avoids overflow and underflow of very long and short directions.
    largest = np.abs(directions).max(axis=1, keepdims=True, initial=0)
    bad = np.flatnonzero(~(np.isfinite(largest) & (largest > 0))[:, 0])
    if len(bad):
        message = f"Ray {bad[0]} has a direction that is zero or not finite."
        raise InvalidMeshError(message, "bad_normal", bad[:10].tolist())
    scaled = directions / largest
    return np.asarray(scaled / np.linalg.norm(scaled, axis=1, keepdims=True))


def _weights(
    origins: FloatArray, directions: FloatArray, weights: Any, density: Density | None
) -> FloatArray:
    count = len(origins)
    if weights is not None and density is not None:
        raise invalid_parameter("Give weights or density, not both.")
    if density is not None:
        refusal = invalid_parameter(
            "The function density must return an array of numbers, one for each ray."
        )
        given = function_of(density, "density")(origins, directions)
        weights = doubles(given, refusal) / max(count, 1)
    refusal = invalid_parameter("weights must be an array of numbers, one for each ray.")
    omega = np.full(count, 1 / max(count, 1)) if weights is None else doubles(weights, refusal)
    if omega.shape != (count,) or not (np.isfinite(omega) & (omega >= 0)).all():
        raise invalid_parameter(
            f"There must be {count} weights, one for each ray, all of them finite and at least 0."
        )
    return omega
