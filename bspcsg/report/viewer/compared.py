"""The page of two superimposed solids and their differences."""

from collections.abc import Sequence

import numpy as np

from ..._types import FloatArray
from ...mesh.mesh import Mesh
from ...solid.solid import Solid
from ...verify.comparison import SetComparison, distances
from .landmark import Landmark
from .layer import COLOURS, Layer
from .paint import DISTANCE, Scale
from .view import view_page

#: Colours of what only the first and only the second has.
_ONLY = ("#d7301f", "#2b62b3")

#: Opacity of the two solids, where they differ.
_BEHIND = 0.35

#: The distances of vertices from the other surface are measured if there are no more than this.
_MAX_VERTICES_MEASURED = 20_000

#: The paint that shows how far the other surface is.
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
        The result of their comparison.
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
    """Return the distance of each vertex of a mesh from another mesh, unless there are too many."""
    used = np.unique(mesh.faces)
    if len(used) > _MAX_VERTICES_MEASURED or not len(other.faces):
        return ()
    values: FloatArray = np.zeros(len(mesh.vertices))
    values[used] = distances(other, mesh.vertices[used])
    return (Scale(DIFFERENCE, values[mesh.faces], DISTANCE),)
