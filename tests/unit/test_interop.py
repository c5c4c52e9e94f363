"""Meshes of other libraries, some replaced by stand-ins with the same attributes."""

import io
import sys
from collections.abc import Callable
from pathlib import Path
from types import ModuleType, SimpleNamespace
from typing import Any

import manifold3d
import numpy as np
import pytest
import trimesh

import bspcsg as b
from bspcsg.mesh import interop
from bspcsg.mesh.certificate import certify
from bspcsg.mesh.mesh import surfaces_of

V = np.array([(x, y, z) for x in (0.0, 1.0) for y in (0.0, 2.0) for z in (0.0, 3.0)])
QUADS = [[0, 1, 3, 2], [4, 6, 7, 5], [0, 4, 5, 1], [2, 3, 7, 6], [0, 2, 6, 4], [1, 5, 7, 3]]
F = np.array([[a, *pair] for a, p, q, r in QUADS for pair in ((p, q), (q, r))])


def manifold() -> manifold3d.Manifold:
    return manifold3d.Manifold.cube((1, 2, 3))


def pymeshlab_set() -> Any:
    pymeshlab = pytest.importorskip("pymeshlab")
    meshes = pymeshlab.MeshSet()
    meshes.add_mesh(pymeshlab.Mesh(V, F))
    return meshes


def pymeshlab_mesh() -> Any:
    pymeshlab = pytest.importorskip("pymeshlab")
    return pymeshlab.Mesh(V, F)


def split_manifold_mesh() -> Any:
    """Return a manifold3d mesh with duplicated vertices that its merge tables join."""
    mesh = manifold().to_mesh64()
    vertices, faces = np.array(mesh.vert_properties), np.array(mesh.tri_verts)
    doubled = faces.copy()
    doubled[0, 0] = len(vertices)
    return manifold3d.Mesh64(
        np.concatenate([vertices, vertices[faces[0, :1]]]),
        doubled,
        merge_from_vert=np.array([len(vertices)], dtype=np.uint64),
        merge_to_vert=faces[0, :1].copy(),
    )


def padded(faces: Any) -> Any:
    return np.concatenate([[len(face), *face] for face in faces])


class VtkLike:
    """Polygons that return each cell in the same object, as those of VTK do."""

    GetPolys = None

    def __init__(self) -> None:
        self._cells: list[list[int]] = [[0, 1], *QUADS]
        self._shown = 0

    def GetNumberOfPoints(self) -> int:  # noqa: N802
        return len(V)

    def GetPoint(self, index: int) -> Any:  # noqa: N802
        return tuple(V[index])

    def GetNumberOfCells(self) -> int:  # noqa: N802
        return len(self._cells)

    def GetCell(self, index: int) -> Any:  # noqa: N802
        self._shown = index
        return SimpleNamespace(
            GetNumberOfPoints=lambda: len(self._cells[self._shown]),
            GetPointId=lambda k: self._cells[self._shown][k],
        )


def block(kind: str, data: Any) -> Any:
    return SimpleNamespace(type=kind, data=np.asarray(data))


def open3d_like() -> Any:
    return SimpleNamespace(vertices=V, triangles=F.astype(np.int32))


def shape(corners: list[Any]) -> Any:
    return SimpleNamespace(
        tessellate=lambda tolerance: (corners, [tuple(face) for face in F]),
        wrapped=None,
        vertices=lambda: None,
        faces=lambda: None,
    )


def cadquery_like(*origins: float) -> Any:
    """Return an object like a workplane of CadQuery, with a shape at each x coordinate."""
    shapes = [
        shape([SimpleNamespace(toTuple=lambda v=v, x=x: (v[0] + x, v[1], v[2])) for v in V])
        for x in origins or (0.0,)
    ]
    return SimpleNamespace(val=lambda: shapes[0], vals=lambda: shapes, plane=None)


def shape_of_loose_faces() -> Any:
    """Return a shape whose faces share no vertices, as CAD kernels tessellate them."""
    corners = [tuple(V[index]) for face in F for index in face]
    faces = [tuple(range(k, k + 3)) for k in range(0, len(corners), 3)]
    return SimpleNamespace(tessellate=lambda tolerance: (corners, faces), wrapped=None)


def builder_like() -> Any:
    made = shape([tuple(v) for v in V])
    return SimpleNamespace(part=made, pending_faces=[], vertices=made.vertices, faces=made.faces)


def meshio_mesh(kind: str, faces: Any) -> Any:
    meshio = pytest.importorskip("meshio")
    return meshio.Mesh(V, [(kind, np.array(faces))])


SOURCES: dict[str, Callable[[], Any]] = {
    "pair": lambda: (V, F),
    "lists": lambda: [V.tolist(), F.tolist()],
    "quads": lambda: (V, QUADS),
    "quads as array": lambda: (V, np.array(QUADS, dtype=np.uint8)),
    "mixed polygons": lambda: (V, [*QUADS[:5], [1, 5, 7], [1, 7, 3]]),
    "whole floats as indices": lambda: (V, F.astype(float)),
    "unsigned indices": lambda: (V, F.astype(np.uint32)),
    "Fortran order, float32": lambda: (
        np.asfortranarray(V, dtype=np.float32),
        np.asfortranarray(F),
    ),
    "Mesh": lambda: b.box((1, 2, 3)).to_mesh(),
    "Solid": lambda: b.box((1, 2, 3)),
    "trimesh": lambda: trimesh.Trimesh(V, F),
    "trimesh scene": lambda: trimesh.Scene([trimesh.Trimesh(V, F)]),
    "manifold": manifold,
    "manifold Mesh64": lambda: manifold().to_mesh64(),
    "manifold Mesh": lambda: manifold().to_mesh(),
    "manifold Mesh64 with seams": split_manifold_mesh,
    "pymeshlab MeshSet": pymeshlab_set,
    "pymeshlab Mesh": pymeshlab_mesh,
    "open3d": open3d_like,
    "open3d tensor": lambda: SimpleNamespace(to_legacy=open3d_like),
    "polydata": lambda: SimpleNamespace(points=V.astype(np.float32), faces=padded(F)),
    "polydata of quads": lambda: SimpleNamespace(points=V, faces=padded(QUADS)),
    "polydata, mixed": lambda: SimpleNamespace(
        points=V, faces=padded([*QUADS[:5], [1, 5, 7], [1, 7, 3]])
    ),
    "meshio": lambda: SimpleNamespace(points=V, cell_sets={}, cells=[block("triangle", F)]),
    "meshio, mixed": lambda: SimpleNamespace(
        points=V,
        cell_sets={},
        cells=[
            block("line", [[0, 1]]),
            block("quad", QUADS[:5]),
            block("triangle", [[1, 5, 7], [1, 7, 3]]),
        ],
    ),
    "meshio's own": lambda: meshio_mesh("triangle", F),
    "meshio's own, quads": lambda: meshio_mesh("quad", QUADS),
    "vtk": VtkLike,
    "build123d": lambda: shape([tuple(v) for v in V]),
    "cadquery": cadquery_like,
    "shape of loose faces": shape_of_loose_faces,
    "build123d builder": builder_like,
    "cadquery assembly": lambda: SimpleNamespace(
        toCompound=shape_of_loose_faces, children=[], vertices=None
    ),
}


@pytest.mark.parametrize("name", SOURCES)
def test_meshes_are_read(name: str) -> None:
    solid = b.Solid.from_mesh(SOURCES[name]())
    assert solid.volume == 6
    assert solid.to_trimesh().is_volume


@pytest.mark.parametrize(
    "source",
    [
        None,
        7,
        object(),
        (V, F, F),
        {"vertices": V},
        SimpleNamespace(vertices=V),
        SimpleNamespace(points=V, cells=[]),
    ],
)
def test_what_holds_no_mesh_is_refused(source: Any) -> None:
    with pytest.raises(b.InvalidMeshError) as caught:
        b.Solid.from_mesh(source)
    assert caught.value.code == "invalid_parameter"


WRONG: dict[str, tuple[Any, Any, str]] = {
    "points in the plane": (V[:, :2], F, "shape"),
    "flat points": (V.ravel(), F, "shape"),
    "words": ("vertices", F, "shape"),
    "ragged points": ([[0, 0, 0], [1]], F, "shape"),
    "edges": (V, F[:, :2], "shape"),
    "flat faces": (V, F.ravel(), "shape"),
    "fractional indices": (V, F + 0.5, "shape"),
    "NaN as index": (V, np.full((1, 3), np.nan), "shape"),
    "huge unsigned index": (V, np.full((1, 3), 2**63, dtype=np.uint64), "shape"),
    "flags": (V, np.ones((1, 3), dtype=bool), "shape"),
    "short face among long": (V, [[0, 1, 2, 3], [0, 1]], "shape"),
    "quad out of range": (V, [[0, 1, 3, 8]], "index_out_of_range"),
    "negative quad": (V, [[0, 1, 3, -1]], "index_out_of_range"),
}


@pytest.mark.parametrize("name", WRONG)
def test_wrong_arrays_are_refused(name: str) -> None:
    vertices, faces, code = WRONG[name]
    with pytest.raises(b.InvalidMeshError) as caught:
        b.Solid(vertices, faces)
    assert caught.value.code == code


def test_volume_cells_are_refused() -> None:
    mesh = SimpleNamespace(points=V, cell_sets={}, cells=[block("tetra", [[0, 1, 2, 3]])])
    with pytest.raises(b.InvalidMeshError, match="tetra"):
        b.Solid.from_mesh(mesh)


def test_arrays_are_copied_only_if_somebody_else_holds_them() -> None:
    points = interop.points_array(V)
    assert points is V
    own, _ = interop.own_arrays(V, F)
    assert not np.shares_memory(own, V)
    assert interop.own_arrays(V.tolist(), F.tolist())[1].dtype == np.int64


def test_options_reach_the_solid() -> None:
    assert b.Solid.from_mesh((V, F), pitch=-6).pitch == -6


# Found: options given with a solid, as `Solid.from_mesh(solid, pitch=…)`, did nothing.
@pytest.mark.parametrize("solid", [b.cube(1), b.Assembly("", b.cube(1))])
def test_options_are_refused_where_they_would_do_nothing(solid: Any) -> None:
    with pytest.raises(
        b.InvalidParameterError, match=f"^pitch .* of type {type(solid).__name__}\\."
    ):
        b.Solid.from_mesh(solid, pitch=-6)
    assert b.Solid.from_mesh(solid).volume == 1


def test_exported_arrays_are_the_callers_own() -> None:
    solid = b.box((1, 2, 3))
    exported = solid.to_trimesh()
    exported.vertices *= 2
    assert solid.volume == 6
    assert solid.to_manifold().volume() == pytest.approx(6)


def test_solids_serve_as_meshes_of_other_libraries() -> None:
    union = trimesh.boolean.union([b.cube(1), b.cube(1).translate(0.5, 0, 0)], check_volume=False)
    assert union.volume == pytest.approx(1.5)


def test_paths_are_read_as_files(tmp_path: Path) -> None:
    path = tmp_path / "box.off"
    b.box((1, 2, 3)).save(path)
    assert b.Solid.from_mesh(path).volume == b.Solid.from_mesh(str(path)).volume == 6


@pytest.mark.parametrize("suffix", [".stl", "ply", "3MF", "glb"])
def test_bytes_and_open_files(tmp_path: Path, suffix: str) -> None:
    path = tmp_path / f"box.{suffix.lower().removeprefix('.')}"
    b.box((1, 2, 3)).save(path)
    data = path.read_bytes()
    for source in (data, bytearray(data), memoryview(data), io.BytesIO(data)):
        solid = b.Solid.from_mesh(source, format=suffix, pitch=-6)
        assert solid.volume == 6 and solid.pitch == -6
    with path.open("rb") as stream:
        assert b.Solid.from_mesh(stream, format=suffix).volume == 6


@pytest.mark.parametrize(
    ("source", "suffix", "code", "said"),
    [
        (b"OFF", None, "unknown_format", "one of .*, not None"),
        (b"OFF", "step", "unknown_format", "not 'step'"),
        (io.StringIO("OFF"), "off", "unreadable", r"open\(path, 'rb'\)"),
        (b"", "off", "empty_file", "<bytes>: the file is empty"),
        (b"OFF", "off", "syntax", "<bytes>"),
    ],
)
def test_bytes_that_are_no_mesh(source: Any, suffix: str | None, code: str, said: str) -> None:
    with pytest.raises(b.FormatError, match=said) as caught:
        b.Solid.from_mesh(source, format=suffix)
    assert caught.value.code == code


def test_all_shapes_of_a_workplane_count() -> None:
    assert b.Solid.from_mesh(cadquery_like(0.0, 5.0)).volume == 12
    assert b.Solid.from_mesh(cadquery_like(0.0, 0.5)).volume == 9


def test_shapes_are_tessellated_as_finely_as_asked_for() -> None:
    asked: list[float] = []

    def tessellate(tolerance: float) -> Any:
        asked.append(tolerance)
        return V.tolist(), F.tolist()

    made = SimpleNamespace(tessellate=tessellate, wrapped=None)
    b.Solid.from_mesh(made)
    b.Solid.from_mesh(SimpleNamespace(vals=lambda: [made], val=None, plane=None), tolerance=1.5)
    assert asked == [interop.TESSELLATION_TOLERANCE, 1.5]


def test_a_grid_is_told_how_to_become_a_surface() -> None:
    grid = SimpleNamespace(points=V, cells=[], extract_surface=None)
    with pytest.raises(b.InvalidMeshError, match=r"pass mesh\.extract_surface\(\)"):
        b.Solid.from_mesh(grid)


@pytest.mark.parametrize("through", ["to_trimesh", "to_manifold"])
def test_what_goes_out_comes_back_the_same(through: str) -> None:
    solid = b.cube(4, center=True) - b.prism(6, h=9, r=1, center=True)
    once = b.Solid.from_mesh(getattr(solid, through)())
    assert once.genus == solid.genus == 1
    assert once.volume == pytest.approx(solid.volume, rel=1e-12)
    lattice = b.cube(4) - b.cube(2).translate(1, 1, 3)
    assert b.Solid.from_mesh(getattr(lattice, through)()).equals(lattice)


def test_solids_are_no_arrays() -> None:
    # Vertices or triangles: there is no telling which one somebody would mean.
    assert not hasattr(b.Solid, "__array__") and np.asarray(b.cube(1)).shape == ()


def test_arrays_by_columns_are_certified_as_what_they_are() -> None:
    mesh = b.cube(2).to_mesh()
    by_columns = np.asfortranarray(mesh.vertices), np.asfortranarray(mesh.faces)
    proof = certify(*by_columns)
    assert proof.ok and proof.triangles == 12
    assert surfaces_of(by_columns[1], 8).tolist() == [0] * 12


# Found: arrays were refused while another thread imported `numpy.ma`.
def test_arrays_are_taken_while_a_module_is_half_imported(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(sys.modules, "numpy.ma", ModuleType("numpy.ma"))
    mesh = b.cube(2).to_mesh()
    assert b.Solid(mesh.vertices, mesh.faces).volume == 8
