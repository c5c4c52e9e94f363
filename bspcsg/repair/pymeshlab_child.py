"""Run pymeshlab in its own process: ``pymeshlab_child.py FOLDER`` repairs ``mesh.npz`` there.

It is a process of its own because pymeshlab has another licence, and can crash or hang. It imports
nothing of this package, and writes ``repaired.npz`` and ``said.json``. If pymeshlab is missing, its
exit code is 6.
"""

import json
import sys
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np

#: The number of plug-ins that a complete installation of pymeshlab loads.
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


def _drop(meshes: Any, settings: dict[str, Any]) -> None:
    import pymeshlab

    mesh = meshes.current_mesh()
    vertices, faces = mesh.vertex_matrix(), mesh.face_matrix()
    stray = stray_faces(faces)
    settings["dropped"] = int(stray.sum())
    if settings["dropped"]:
        meshes.add_mesh(pymeshlab.Mesh(vertices, faces[~stray]))
        meshes.meshing_remove_unreferenced_vertices()


def stray_faces(faces: Any) -> Any:
    """Say for each face whether it belongs to a stray fragment; no face does if all are fragments.

    A stray fragment is a piece of surface with one boundary loop that contains all vertices, so
    that it encloses nothing: a loose triangle, a fin, a strip. A tube without caps has two boundary
    loops, and a pyramid without its base has a tip that is not on the loop, so neither is one.
    """
    faces = faces.astype(np.int64)
    start, end = faces.ravel(), np.roll(faces, -1, axis=1).ravel()
    keys = _keys(np.minimum(start, end), np.maximum(start, end))
    _, edge, counts = np.unique(keys, return_inverse=True, return_counts=True)
    uses = counts[edge]
    order = np.argsort(edge, kind="stable")
    owner = _joined(order[uses[order] == 2].reshape(-1, 2) // 3, len(faces))
    _, bits = np.unique(owner, return_inverse=True)
    at, rim = np.repeat(bits, 3), uses != 2
    corners, edges = _counts(at, start), _counts(at, edge)
    rims = _counts(np.tile(at[rim], 2), np.concatenate([start[rim], end[rim]]), len(corners))
    is_open = np.bincount(at, uses == 1) > 0
    # A disc has Euler number 1: vertices minus edges plus faces.
    is_stray = is_open & (corners - edges + np.bincount(bits) == 1) & (rims == corners)
    return is_stray[bits] & (not is_stray.all())


def _keys(first: Any, second: Any) -> Any:
    """Return an integer for each pair of integers, distinct for distinct pairs."""
    return first * (second.max(initial=0) + 1) + second


def _counts(bits: Any, things: Any, size: int = 0) -> Any:
    """Return for each piece its number of distinct things: piece ``bits[k]`` has ``things[k]``.

    Pieces and things are given by index; the result has at least `size` entries.
    """
    pairs = np.unique(_keys(bits, things))
    return np.bincount(pairs // (things.max(initial=0) + 1), minlength=size)


def _joined(links: Any, count: int) -> Any:
    """Return for each of `count` nodes the smallest node that pairs of nodes connect it to."""
    least = np.arange(count)
    while len(links):
        before = least.copy()
        lower = least[links].min(axis=1)
        for side in links.T:
            np.minimum.at(least, least[side], lower)
        least = least[least]
        if np.array_equal(before, least):
            break
    return least


def _split(meshes: Any, settings: dict[str, Any]) -> None:
    meshes.compute_selection_by_non_manifold_edges_per_face()
    # If no edge is non-manifold, this filter would split correct meshes.
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
    "drop": _drop,
    "split": _split,
    "orient": _orient,
    "fill": _fill,
}


def main(folder: Path) -> int:
    """Repair the mesh in a folder, and return the exit code of the process."""
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
    (folder / "said.json").write_text(
        json.dumps({"failed": failed, "dropped": settings.get("dropped", 0)})
    )
    return 0


if __name__ == "__main__":
    sys.exit(main(Path(sys.argv[1])))
