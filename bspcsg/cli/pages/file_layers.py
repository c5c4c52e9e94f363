"""Reading of files as layers of a 3D view."""

from collections.abc import Iterable, Sequence
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING

from ..inputs.files import Inputs, display_name

if TYPE_CHECKING:
    from ...report.viewer.layer import Layer


def layers_of(
    inputs: Inputs, files: Iterable[Path], section: Sequence[float] | None = None
) -> "tuple[list[Layer], str]":
    """Return a layer for each object of each file, and the unit if it is the same in all files.

    Findings about the files are printed. Meshes need not be closed, unless a section (nx, ny, nz,
    d) is given: then only the part with nx x + ny y + nz z <= d is shown.
    """
    from ...report.viewer.layer_making import with_distinct_colours

    found: list[tuple[Path, list[Layer]]] = []
    units = set()
    for path in files:
        layers, unit = _layers_of(inputs, path, section)
        if not any(len(layer.faces) for layer in layers):
            inputs.out.warning(f"{display_name(path)}: the file has no triangles to show.")
        found.append((path, layers))
        units.add(unit)
    several = len(found) > 1
    named = [
        replace(layer, name=f"{path.name}: {layer.name}") if several and len(layers) > 1 else layer
        for path, layers in found
        for layer in layers
    ]
    return with_distinct_colours(named), units.pop() if len(units) == 1 else ""


def _layers_of(
    inputs: Inputs, path: Path, section: Sequence[float] | None
) -> "tuple[list[Layer], str]":
    from ...report.viewer.layer_making import layers_of_file, layers_of_solid, with_origin

    name = display_name(path) if display_name(path) == "-" else path.name
    unit = "" if inputs.unit is None else "mm"
    if section is not None:
        *normal, offset = section
        kept, _ = with_origin(inputs.solid(path)).split(normal, offset)
        return layers_of_solid(kept, name), unit
    if inputs.is_script(path):
        return layers_of_solid(inputs.solid(path), name), unit
    raw = inputs.raw(path)
    inputs.print_findings(path, raw.findings)
    return layers_of_file(raw, name), raw.unit
