"""The process that asks pymeshlab: ``child.py FOLDER`` repairs ``mesh.npz`` in there.

It runs apart because pymeshlab is under another licence, and can crash or hang. It imports nothing
of this package, writes ``repaired.npz`` and ``said.json``, and exits with 6 without pymeshlab.
"""

import json
import sys
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np

#: The number of plug-ins that a complete installation loads.
PLUGINS = 58

MISSING = 6


def _weld(meshes: Any, settings: dict[str, Any]) -> None:
    import pymeshlab

    meshes.meshing_remove_duplicate_vertices()
    if settings["weld"]:
        distance = pymeshlab.PureValue(settings["weld"])
        meshes.meshing_merge_close_vertices(threshold=distance)


def _dedup(meshes: Any, settings: dict[str, Any]) -> None:
    meshes.meshing_remove_duplicate_faces()
    meshes.meshing_remove_null_faces()
    meshes.meshing_remove_unreferenced_vertices()


def _split(meshes: Any, settings: dict[str, Any]) -> None:
    meshes.compute_selection_by_non_manifold_edges_per_face()
    # Asked to split where there is nothing to split, the filter tears sound meshes apart.
    if meshes.current_mesh().selected_face_number():
        meshes.meshing_repair_non_manifold_edges(method="Split Vertices")
    meshes.meshing_repair_non_manifold_vertices(vertdispratio=0)


def _orient(meshes: Any, settings: dict[str, Any]) -> None:
    meshes.meshing_re_orient_faces_coherently()


def _fill(meshes: Any, settings: dict[str, Any]) -> None:
    meshes.meshing_close_holes(maxholesize=settings["max_hole"], selfintersection=False)


STEPS: dict[str, Callable[[Any, dict[str, Any]], None]] = {
    "weld": _weld,
    "dedup": _dedup,
    "split": _split,
    "orient": _orient,
    "fill": _fill,
}


def main(folder: Path) -> int:
    """Repair the mesh in a folder."""
    try:
        import pymeshlab

        plugins = pymeshlab.plugin_number()
    except ImportError as error:
        (folder / "said.json").write_text(json.dumps({"missing": str(error)}))
        return MISSING
    if plugins < PLUGINS:
        said = f"only {plugins} of its {PLUGINS} plug-ins could be loaded"
        (folder / "said.json").write_text(json.dumps({"missing": said}))
        return MISSING
    with np.load(folder / "mesh.npz", allow_pickle=False) as arrays:
        mesh = pymeshlab.Mesh(arrays["vertices"], arrays["faces"])
        settings = json.loads(str(arrays["settings"]))
    meshes = pymeshlab.MeshSet()
    meshes.add_mesh(mesh)
    failed = {}
    for name in settings["steps"]:
        try:
            STEPS[name](meshes, settings)
        except pymeshlab.PyMeshLabException as error:
            failed[name] = str(error).strip().splitlines()[-1]
    found = meshes.current_mesh()
    np.savez(folder / "repaired.npz", vertices=found.vertex_matrix(), faces=found.face_matrix())
    (folder / "said.json").write_text(json.dumps({"failed": failed}))
    return 0


if __name__ == "__main__":
    sys.exit(main(Path(sys.argv[1])))
