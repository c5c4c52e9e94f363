"""The meshes that a campaign has kept of a case, as layers of a view."""

import zipfile
from collections.abc import Mapping
from dataclasses import replace
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np

from ..errors import FormatError
from .layer import COLOURS, DIFFERENCE, RESULT, Layer

#: Operands are seen through when they are shown with the result.
_OPERAND_OPACITY = 0.4

_VERTICES, _FACES = "_vertices", "_faces"


class Stored(NamedTuple):
    """What was kept of one case: operands in their order, the result, and what is too much in it.

    `difference` is where the result and the oracle's are not the same; empty if they are.
    """

    operands: list[Layer]
    result: Layer | None
    difference: Layer | None

    @property
    def layers(self) -> list[Layer]:
        """All layers that have faces; if there is a result, only it and the difference are shown."""
        hidden = self.result is not None
        operands = [
            replace(layer, shown=not hidden, opacity=_OPERAND_OPACITY) for layer in self.operands
        ]
        others = [layer for layer in (self.result, self.difference) if layer is not None]
        return [layer for layer in operands + others if len(layer.faces)]


def stored_meshes(folder: Path, name: str) -> Stored:
    """Read the meshes of a case.

    Parameters
    ----------
    folder : Path
        Where the results file is.
    name : str
        Path of the meshes in that folder.

    Raises
    ------
    FormatError
        If the file cannot be read, is not in that folder, or holds something else.
    """
    path = folder / name
    if not path.resolve().is_relative_to(folder.resolve()):
        raise FormatError(f"{name}: meshes lie in the folder of the results only.", "unreadable")
    try:
        with np.load(path, allow_pickle=False) as arrays:
            return _stored(arrays)
    except (OSError, ValueError, KeyError, EOFError, zipfile.BadZipFile) as error:
        raise FormatError(f"{name}: cannot read these meshes: {error}.", "unreadable") from error


def _stored(arrays: Mapping[str, Any]) -> Stored:
    names = [key.removesuffix(_VERTICES) for key in arrays if key.endswith(_VERTICES)]
    letters = sorted(set(names) - {"result", "difference"})
    operands = [
        _layer(arrays, letter, letter.upper(), COLOURS[k % len(COLOURS)])
        for k, letter in enumerate(letters)
    ]
    result = _layer(arrays, "result", "result", RESULT) if "result" in names else None
    found = _layer(arrays, "difference", "difference", DIFFERENCE) if "difference" in names else None
    return Stored(operands, result, found)


def _layer(arrays: Mapping[str, Any], key: str, name: str, colour: str) -> Layer:
    vertices = np.asarray(arrays[key + _VERTICES], dtype=np.float64).reshape(-1, 3)
    faces = np.asarray(arrays[key + _FACES], dtype=np.int64).reshape(-1, 3)
    if not np.isfinite(vertices).all():
        raise ValueError(f"{key} has a coordinate that is not a finite number")
    if len(faces) and not (faces.min() >= 0 and faces.max() < len(vertices)):
        raise ValueError(f"{key} has a face that names a vertex which does not exist")
    return Layer(name, vertices, faces, colour)
