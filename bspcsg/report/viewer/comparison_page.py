"""The page that shows two solids at once, and the parts that only one of them has."""

from collections.abc import Sequence

import numpy as np

from ..._types import FloatArray
from ...mesh.mesh import Mesh
from ...solid.solid import Solid
from ...verify.comparison import SetComparison, distances
from .landmark import Landmark
from .layer import COLOURS, Layer
from .paint import DISTANCE, Scale
from .view_page import view_page

#: Colours of the parts that only the first solid has, and that only the second has.
_ONLY = ("#d7301f", "#2b62b3")

#: The opacity of both solids if they differ.
_BEHIND = 0.35

#: The largest number of vertices whose distances from the other solid's surface are measured.
_MAX_VERTICES_MEASURED = 20_000

#: The name of the paint that shows the distance from the other solid's surface.
DIFFERENCE = "difference"


def compared_page(
    solids: tuple[Solid, Solid],
    names: tuple[str, str],
    found: SetComparison,
    notes: Sequence[str] = (),
    unit: str = "",
) -> str:
    """Return a page that shows two solids, and the parts that only one of them has.

    Parameters
    ----------
    solids : (Solid, Solid)
    names : (str, str)
    found : SetComparison
        The result of comparing the solids.
    notes : sequence of str
        Sentences below the title.
    unit : str

    Raises
    ------
    MissingPartError
        If Jinja2 is not installed.
    """
    meshes = [solid.normalized().to_mesh() for solid in solids]
    opacity = 1.0 if found.equal else _BEHIND
    layers = []
    for which, name in enumerate(names):
        mesh, other = meshes[which], meshes[1 - which]
        paints = _distances(mesh, other) if found.hausdorff is not None and not found.equal else ()
        colour = COLOURS[which]
        layers.append(Layer(name, mesh.vertices, mesh.faces, colour, opacity, paints=paints))
    for which, name in enumerate(names):
        only = solids[which] - solids[1 - which]
        part = only.normalized().to_mesh()
        if len(part.faces):
            layers.append(Layer(f"only in {name}", part.vertices, part.faces, _ONLY[which]))
    title = f"{names[0]} and {names[1]}"
    return view_page(layers, title, unit=unit, landmarks=_landmarks(found), notes=notes)


def _landmarks(found: SetComparison) -> list[Landmark]:
    part = found.difference
    if part.place is None:
        return []
    name = f"thickest difference: {part.thickness:.3g}"
    return [Landmark(name, np.array(part.place), 10 * part.thickness)]


def _distances(mesh: Mesh, other: Mesh) -> tuple[Scale, ...]:
    """Return a paint by the distance of each vertex from `other`; none for too many vertices."""
    used = np.unique(mesh.faces)
    if len(used) > _MAX_VERTICES_MEASURED or not len(other.faces):
        return ()
    values: FloatArray = np.zeros(len(mesh.vertices))
    values[used] = distances(other, mesh.vertices[used])
    return (Scale(DIFFERENCE, values[mesh.faces], DISTANCE),)
