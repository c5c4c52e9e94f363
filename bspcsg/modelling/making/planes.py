"""Half-spaces that plane faces bound, exact if the faces' corners are on the lattice."""

import math
from fractions import Fraction

import numpy as np

from ..._types import FloatArray
from ...geometry.hyperplane import Hyperplane, exact_number
from ...geometry.transform import whole_steps
from ...solid.leaf import PlaneLeaf
from ...solid.solid import Solid, from_leaf
from .plane_faces import FaceGraph

#: Lattice steps by which a half-space extends past a face whose plane is not exact. Rounding moves
#: the face's corners by less than one step.
_EXTENSION_STEPS = 20


class Planes:
    """The half-spaces that a solid's plane faces bound, computed on demand.

    Parameters
    ----------
    graph : FaceGraph
    pitch : int
        The pitch of the solid.
    """

    def __init__(self, graph: FaceGraph, pitch: int) -> None:
        self._graph = graph
        self._pitch = pitch
        self._made: dict[tuple[int, int, bool], Solid] = {}
        self._exact: dict[int, Hyperplane | None] = {}

    def inside(self, face: int, sign: int, *, beyond: bool = True) -> Solid:
        """Return the half-space behind a face, or in front of it if the sign is -1.

        Parameters
        ----------
        face, sign : int
        beyond : bool
            True to extend the half-space slightly past a face whose plane is not exact on the
            lattice.
        """
        key = face, sign, beyond
        if key not in self._made:
            self._made[key] = from_leaf(PlaneLeaf(self._plane(*key)))
        return self._made[key]

    def is_exact(self, face: int) -> bool:
        """Return True if all lattice corners of a face lie exactly in one plane."""
        return self._known(face) is not None

    def _known(self, face: int) -> Hyperplane | None:
        if face not in self._exact:
            self._exact[face] = self._lattice_plane(face)
        return self._exact[face]

    def _plane(self, face: int, sign: int, beyond: bool) -> Hyperplane:
        exact = self._known(face)
        if exact is not None:
            normal = [Fraction(sign * entry) for entry in exact.normal]
            return Hyperplane.of(normal, sign * exact.offset)
        unit = sign * self._graph.normals[face]
        products = self._corners(face) @ unit
        offset = (
            products.max() + _EXTENSION_STEPS * 10.0**self._pitch if beyond else products.mean()
        )
        return Hyperplane.from_numbers(unit.tolist(), float(offset))

    def _corners(self, face: int) -> FloatArray:
        own = np.unique(self._graph.triangles[self._graph.face == face])
        corners: FloatArray = self._graph.vertices[own]
        return corners

    def _lattice_plane(self, face: int) -> Hyperplane | None:
        """Return the exact plane of a face's lattice corners; None if they are not in one plane."""
        corners = self._corners(face)
        for axis in range(3):
            if np.ptp(corners[:, axis]) == 0:
                side = int(np.sign(self._graph.normals[face, axis]))
                unit = [Fraction(side * (k == axis)) for k in range(3)]
                return Hyperplane.of(unit, side * exact_number(corners[0, axis]))
        steps = [self._steps(corner) for corner in corners]
        known = [corner for corner in steps if corner is not None]
        normal = self._lattice_normal(face)
        if normal is None:
            return None
        offsets = {sum(n * x for n, x in zip(normal, corner, strict=True)) for corner in known}
        if len(offsets) != 1:
            return None
        step = Fraction(10) ** self._pitch
        return Hyperplane.of([Fraction(entry) for entry in normal], offsets.pop() * step)

    def _lattice_normal(self, face: int) -> tuple[int, int, int] | None:
        """Return the integer normal of a face's largest triangle with all corners on the lattice.

        None means that there is no such triangle, or that its area is zero.
        """
        triangles = self._graph.triangles[self._graph.face == face]
        a, b, c = (self._graph.vertices[triangles[:, k]] for k in range(3))
        order = np.argsort(-np.linalg.norm(np.cross(b - a, c - a), axis=1), kind="stable")
        for triangle in triangles[order].tolist():
            corners = [self._steps(self._graph.vertices[vertex]) for vertex in triangle]
            if corners[0] is None or corners[1] is None or corners[2] is None:
                continue
            one, other = (
                [x - y for x, y in zip(corner, corners[0], strict=True)]
                for corner in (corners[1], corners[2])
            )
            x = one[1] * other[2] - one[2] * other[1]
            y = one[2] * other[0] - one[0] * other[2]
            z = one[0] * other[1] - one[1] * other[0]
            divisor = math.gcd(x, y, z)
            return None if divisor == 0 else (x // divisor, y // divisor, z // divisor)
        return None

    def _steps(self, corner: FloatArray) -> tuple[int, int, int] | None:
        x, y, z = (whole_steps(float(entry), self._pitch) for entry in corner)
        return None if x is None or y is None or z is None else (x, y, z)
