"""`Layer`: one mesh of a 3D view, with its appearance."""

from collections.abc import Sequence
from dataclasses import dataclass, field, replace

import numpy as np

from ..._types import FloatArray, IndexArray
from ...mesh.weld import welded
from .paint import Paint

#: Colours of operands in order; after the last colour, the first one is used again.
COLOURS = ("#6f9bd1", "#e0a458", "#7fb285", "#a98bc9", "#c98b8b", "#79b7bd")

#: The colour of a result, and of the difference between two results.
RESULT, DIFFERENCE = "#b4c2d1", "#f0283a"


@dataclass(frozen=True, eq=False)
class Layer:
    """One mesh of a 3D view, with its appearance.

    Parameters
    ----------
    name : str
    vertices : (n, 3) float64
        In model units.
    faces : (m, 3) int64
    colour : str
        As ``"#rrggbb"``.
    opacity : float
        From 0 to 1.
    shown : bool
        True if the layer is visible when the page is opened.
    paints : tuple of Paint
        Ways to colour the faces that the page offers.
    lines : (k, 2) int64
        Pairs of vertices, drawn as thick lines in front of all faces.
    """

    name: str
    vertices: FloatArray
    faces: IndexArray
    colour: str = RESULT
    opacity: float = 1.0
    shown: bool = True
    paints: tuple[Paint, ...] = ()
    lines: IndexArray = field(default_factory=lambda: np.zeros((0, 2), dtype=np.int64))

    @property
    def is_closed(self) -> bool:
        """True if every edge has as many faces in one direction as in the other.

        Then sections of the mesh can be filled.
        """
        start, end = self.faces.ravel(), np.roll(self.faces, -1, axis=1).ravel()
        size = max(len(self.vertices), 1)
        low, high = np.minimum(start, end), np.maximum(start, end)
        _, edge = np.unique(low * size + high, return_inverse=True)
        return not np.bincount(edge.ravel(), np.sign(end - start)).any()

    def simplified(self, cells: int) -> "Layer":
        """Return the layer with the vertices in each cell of a cubic grid merged.

        `cells` is the number of cells along the longest side.
        """
        if len(self.faces) == 0:
            return self
        low, high = bounds_of([self])
        step = max(float((high - low).max()), np.finfo(np.float64).tiny) / cells
        # Keep the order of the vertices, so that neighbours stay close and compress well.
        _, same = welded(np.rint((self.vertices - low) / step))
        counts = np.bincount(same)[:, None]
        sums = [np.bincount(same, axis) for axis in (self.vertices - low).T]
        faces = same[self.faces]
        kept = np.flatnonzero((faces != np.roll(faces, 1, axis=1)).all(axis=1))
        return replace(
            self,
            vertices=low + np.column_stack(sums) / counts,
            faces=faces[kept],
            paints=tuple(paint.for_faces(kept) for paint in self.paints),
            lines=same[self.lines],
        )


def drawn_points(layers: Sequence[Layer]) -> FloatArray:
    """Return the vertices that faces or lines use, (n, 3) float64; the origin if there are none."""
    drawn = [np.union1d(layer.faces, layer.lines) for layer in layers]
    used = [layer.vertices[some] for layer, some in zip(layers, drawn, strict=True) if len(some)]
    return np.concatenate(used) if used else np.zeros((1, 3))


def bounds_of(layers: Sequence[Layer]) -> tuple[FloatArray, FloatArray]:
    """Return smallest and largest x, y and z, (3,) each, of all vertices that are drawn."""
    points = drawn_points(layers)
    return points.min(axis=0), points.max(axis=0)
