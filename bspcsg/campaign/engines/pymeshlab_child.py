"""Run pymeshlab in a process of its own: ``pymeshlab_child.py FOLDER`` combines meshes there.

It is separate because pymeshlab is under another licence, and can crash or hang. It imports nothing
of this package, reads ``operands.npz``, writes ``result.npz`` and ``said.json``, and exits with 6
if pymeshlab cannot be imported.
"""

import json
import sys
from importlib.metadata import version
from pathlib import Path

import numpy as np

MISSING = 6

#: The text in pymeshlab's error message for an empty result.
_EMPTY = "Vertex matrix is empty"

#: pymeshlab's filters for set operations, which are exact: libigl's mesh arrangements with CGAL's
#: kernel.
FILTERS = {
    "union": "generate_boolean_union",
    "difference": "generate_boolean_difference",
    "intersection": "generate_boolean_intersection",
    "xor": "generate_boolean_xor",
}


def main(folder: Path) -> int:
    """Combine the operands in a folder from left to right, and return the exit code."""
    try:
        import pymeshlab

        meshes = pymeshlab.MeshSet()
    except ImportError as error:
        (folder / "said.json").write_text(json.dumps({"missing": str(error)}))
        return MISSING
    report = {"version": version("pymeshlab")}
    with np.load(folder / "operands.npz", allow_pickle=False) as arrays:
        for number in range(int(arrays["count"])):
            corners = arrays[f"vertices{number}"], arrays[f"faces{number}"]
            meshes.add_mesh(pymeshlab.Mesh(*corners))
        combine = getattr(meshes, FILTERS[str(arrays["operation"])])
        count = int(arrays["count"])
    try:
        current = 0
        for number in range(1, count):
            combine(first_mesh=current, second_mesh=number)
            current = meshes.current_mesh_id()
        found = meshes.current_mesh()
        np.savez(folder / "result.npz", vertices=found.vertex_matrix(), faces=found.face_matrix())
    except pymeshlab.PyMeshLabException as error:
        _note_failure(folder, str(error), report)
    (folder / "said.json").write_text(json.dumps(report))
    return 0


def _note_failure(folder: Path, message: str, report: dict[str, str]) -> None:
    """Record pymeshlab's error message, or an empty mesh if the message means an empty result."""
    if _EMPTY in message:
        np.savez(folder / "result.npz", vertices=np.zeros((0, 3)), faces=np.zeros((0, 3), int))
    else:
        report["failed"] = message.strip().splitlines()[-1]


if __name__ == "__main__":
    sys.exit(main(Path(sys.argv[1])))
