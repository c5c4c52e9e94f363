"""Meshes from public projects and a chain of swept tools, in a folder beside the checkout."""

import csv
from functools import cache
from math import inf
from pathlib import Path
from typing import NamedTuple

import numpy as np

from .._types import FloatArray, MeshArrays
from .shapes import moved, rotation_of, scaled, turned

#: The number of random pairs, and the seed that draws them.
PAIRS, _SEED = 60, 11

#: The largest number of triangles of a mesh.
_MOST_TRIANGLES = 60_000

#: The largest distance between the centres of two meshes along each axis.
_SHIFT = 0.25

#: The kinds of pairs, and the numbers of triangles below which a pair is of that kind. Pairs of
#: which a mesh overlaps itself are of a kind of their own.
KINDS = {"tiny": 1000, "medium": 5000, "large": inf, "overlap": 0}


def swept_capsules(shared: Path) -> tuple[MeshArrays, list[MeshArrays]]:
    """Return a workpiece and the swept capsules that a benchmark combines with it in order."""
    with np.load(shared / "chains" / "swept-capsules-100.npz") as data:
        vertices = np.split(data["v"].astype(np.float64), np.cumsum(data["nv"])[:-1])
        faces = np.split(data["f"].astype(np.int64), np.cumsum(data["nf"])[:-1])
    base, *tools = zip(vertices, faces, strict=True)
    # The tools are stored with reversed faces.
    return base, [(points, triangles[:, ::-1].copy()) for points, triangles in tools]


class RealPair(NamedTuple):
    """Two public meshes and the random pose of the second.

    Parameters
    ----------
    names : (str, str)
        The files of the meshes.
    turn : (3, 3) array
    shift : (3,) array
        In multiples of the longest side of a mesh's bounding box.
    """

    names: tuple[str, str]
    turn: FloatArray
    shift: FloatArray

    def meshes(self, shared: Path) -> tuple[MeshArrays, MeshArrays]:
        """Return both meshes, scaled to bounding boxes with longest side 1."""
        first, second = (_unit(shared / "meshes" / name) for name in self.names)
        return first, moved(turned(second, self.turn), self.shift)


@cache
def real_pairs(shared: Path) -> list[RealPair]:
    """Return random pairs of all public meshes that are solids and not too large."""
    random, names = np.random.default_rng(_SEED), solid_names(shared)
    return [_random_pair(names, random) for _ in range(PAIRS)]


def _random_pair(names: list[str], random: np.random.Generator) -> RealPair:
    first, second = random.choice(names, 2).tolist()
    turn = rotation_of(random.normal(size=4))
    return RealPair((first, second), turn, random.uniform(-_SHIFT, _SHIFT, 3))


@cache
def kinds(shared: Path) -> list[str]:
    """Return the kind of each pair of `real_pairs`, a key of `KINDS`."""
    return [kind_of(pair.meshes(shared)) for pair in real_pairs(shared)]


def kind_of(meshes: tuple[MeshArrays, MeshArrays]) -> str:
    """Return the kind of a pair of meshes, a key of `KINDS`."""
    if any(map(_overlaps_itself, meshes)):
        return "overlap"
    triangles = sum(len(faces) for _, faces in meshes)
    return next(kind for kind, below in KINDS.items() if triangles < below)


def _overlaps_itself(mesh: MeshArrays) -> bool:
    from ..solid.solid import Solid

    return "self_overlap" in {finding.code for finding in Solid(*mesh).findings}


def solid_names(shared: Path) -> list[str]:
    """Return the files of closed public meshes that manifold3d accepts, but for the largest."""
    with (shared / "meshes" / "MANIFEST.tsv").open(newline="") as lines:
        rows = list(csv.DictReader(lines, delimiter="\t", quoting=csv.QUOTE_NONE))
    return [
        row["file"]
        for row in rows
        if row["is_volume"] == "yes"
        and row["manifold_status"] == "NoError"
        and int(row["n_triangles"]) <= _MOST_TRIANGLES
    ]


def _unit(path: Path) -> MeshArrays:
    from ..io import load

    vertices, faces = (array.copy() for array in load(path).to_mesh())
    centred = moved((vertices, faces), -vertices.mean(axis=0))
    return scaled(centred, 1 / float(np.ptp(vertices, axis=0).max()))
