"""Reading of the meshes that a campaign has stored for a case, as layers of a 3D view."""

import os
import zipfile
from dataclasses import replace
from pathlib import Path
from typing import NamedTuple

import numpy as np

from ..campaign.cases.meshes import unpacked
from ..errors import FormatError
from ..mesh.mesh import Mesh
from .viewer.layer import COLOURS, DIFFERENCE, RESULT, Layer

#: The opacity of operands, which are transparent when they are shown with the result.
_OPERAND_OPACITY = 0.4


class StoredMeshes(NamedTuple):
    """The stored meshes of one case: the operands in order, the result and the difference.

    `difference` is the symmetric difference of our result and manifold3d's; empty if both are
    equal.
    """

    operands: list[Layer]
    result: Layer
    difference: Layer

    @property
    def layers(self) -> list[Layer]:
        """All layers that have faces; operands are hidden, unless the result is empty."""
        hidden = len(self.result.faces) > 0
        operands = [
            replace(layer, shown=not hidden, opacity=_OPERAND_OPACITY) for layer in self.operands
        ]
        layers = [*operands, self.result, self.difference]
        return [layer for layer in layers if len(layer.faces)]


def stored_meshes(folder: Path, name: str) -> StoredMeshes:
    """Read the stored meshes of a case.

    Parameters
    ----------
    folder : Path
        The folder of the results file.
    name : str
        The path of the file with the meshes, relative to `folder`.

    Raises
    ------
    FormatError
        If the file cannot be read, is not in `folder`, or has other content.
    """
    path = folder / name
    # Links are followed, but the path in the results must not lead out of the folder.
    if os.path.isabs(name) or os.path.normpath(name).startswith(".."):
        raise FormatError(
            f"{name}: the stored meshes are not read, because this path leads out of the folder of"
            " the results file.",
            "unreadable",
        )
    try:
        meshes = unpacked(path)
        operands = [
            _layer(mesh, letter.upper(), COLOURS[number % len(COLOURS)])
            for number, (letter, mesh) in enumerate(sorted(meshes.operands.items()))
        ]
        result = _layer(meshes.result, "result", RESULT)
        return StoredMeshes(operands, result, _layer(meshes.difference, "difference", DIFFERENCE))
    except (OSError, ValueError, KeyError, EOFError, zipfile.BadZipFile) as error:
        raise FormatError(f"{name}: cannot read these meshes: {error}.", "unreadable") from error


def _layer(mesh: Mesh, name: str, colour: str) -> Layer:
    for array in (mesh.vertices, mesh.faces):
        if array.ndim != 2 or array.shape[1] != 3:
            raise ValueError(
                f"an array of the mesh {name} has shape {array.shape} instead of (n, 3)"
            )
    if not np.isfinite(mesh.vertices).all():
        raise ValueError(f"the mesh {name} has a coordinate that is not a finite number")
    if len(mesh.faces) and not (mesh.faces.min() >= 0 and mesh.faces.max() < len(mesh.vertices)):
        raise ValueError(f"the mesh {name} has a face with a vertex index out of range")
    return Layer(name, mesh.vertices, mesh.faces, colour)
