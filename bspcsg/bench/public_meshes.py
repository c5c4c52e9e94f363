"""Meshes from public projects and a chain of swept tools, in a folder beside the checkout."""

import csv
from functools import cache
from pathlib import Path

import numpy as np

from .._types import MeshArrays
from .shapes import generator, moved, random_rotation, scaled, turned, unit_vector

#: The least and the greatest number of triangles of a mesh in large pairs, and in small pairs.
LARGE, SMALL = (10_000, 500_000), (10, 30_000)

#: The distance between the box centres of two meshes, in multiples of their half diagonal.
_CENTRE_DISTANCE = 0.3


def swept_capsules(shared: Path) -> tuple[MeshArrays, list[MeshArrays]]:
    """Return a workpiece and the swept capsules that a benchmark combines with it in order."""
    with np.load(shared / "chains" / "swept-capsules-100.npz") as data:
        vertices = np.split(data["v"].astype(np.float64), np.cumsum(data["nv"])[:-1])
        faces = np.split(data["f"].astype(np.int64), np.cumsum(data["nf"])[:-1])
    base, *tools = zip(vertices, faces, strict=True)
    # The tools are stored with reversed faces.
    return base, [(points, triangles[:, ::-1].copy()) for points, triangles in tools]


def posed_pair(
    shared: Path, number: int, sizes: tuple[int, int] = LARGE
) -> tuple[MeshArrays, MeshArrays]:
    """Return two public meshes, scaled to half diagonal 1, rotated and shifted at random."""
    random = generator(number)
    names = solid_names(shared, sizes)
    first, second = random.choice(len(names), size=2, replace=False)
    return _posed(shared, (names[first], names[second]), random)


def overlapping_pair(shared: Path, number: int) -> tuple[MeshArrays, MeshArrays]:
    """Return two small public meshes in a random pose, the first of which overlaps itself."""
    random = generator(number)
    overlapping = solid_names(shared, SMALL, overlapping=True)
    first = overlapping[random.integers(len(overlapping))]
    others = [name for name in (*overlapping, *solid_names(shared, SMALL)) if name != first]
    return _posed(shared, (first, others[random.integers(len(others))]), random)


def _posed(
    shared: Path, names: tuple[str, str], random: np.random.Generator
) -> tuple[MeshArrays, MeshArrays]:
    posed = [turned(_unit(shared / "meshes" / name), random_rotation(random)) for name in names]
    return posed[0], moved(posed[1], _CENTRE_DISTANCE * unit_vector(random))


@cache
def solid_names(
    shared: Path, sizes: tuple[int, int] = LARGE, *, overlapping: bool = False
) -> list[str]:
    """Return the names of closed public meshes that every engine accepts.

    Parameters
    ----------
    shared : Path
    sizes : (int, int)
        The least and the greatest number of triangles.
    overlapping : bool
        True for meshes that overlap themselves, False for meshes that do not.
    """
    with (shared / "meshes" / "MANIFEST.tsv").open(newline="") as lines:
        rows = list(csv.DictReader(lines, delimiter="\t"))
    return sorted(
        row["file"]
        for row in rows
        if row["is_volume"] == "yes"
        and row["self_intersecting"].isdigit()
        and (int(row["self_intersecting"]) > 0) == overlapping
        and row["manifold_status"] == "NoError"
        and sizes[0] <= int(row["n_triangles"]) <= sizes[1]
    )


def _unit(path: Path) -> MeshArrays:
    from ..io import load

    vertices, faces = (array.copy() for array in load(path).to_mesh())
    low, high = vertices.min(axis=0), vertices.max(axis=0)
    return scaled(
        moved((vertices, faces), -(low + high) / 2), 2 / float(np.linalg.norm(high - low))
    )
