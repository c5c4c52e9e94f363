"""The shared part of these models: the proof that they can be printed, and a picture."""

import sys
import tempfile
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np

import bspcsg as csg
from bspcsg import bsp

OUT = Path(sys.argv[1] if len(sys.argv) > 1 else "out")


def finish(
    name: str,
    *parts: csg.Solid,
    colours: Sequence[str] = ("#9db8d2",),
    view: Any = "iso",
    crease: float = 25,
) -> None:
    """Say that parts are closed and certified in single precision, and draw them."""
    with tempfile.TemporaryDirectory() as folder:
        # Binary STL is what most slicers read; it holds single precision.
        proofs = [_certificate(part, Path(folder) / "part.stl") for part in parts]
    triangles, volume = sum(p.triangles for p in proofs), sum(part.volume for part in parts)
    print(f"{name}: {triangles} triangles, volume {volume:.1f} mm³")
    print("closed:", not any(proof.open_edges for proof in proofs))
    sound = all(proof.ok and proof.precision == "single" for proof in proofs)
    print("certified in single precision:", sound)
    meshes = [part.to_mesh() for part in parts]
    starts = np.cumsum([0] + [len(mesh.vertices) for mesh in meshes])
    vertices = np.concatenate([mesh.vertices for mesh in meshes])
    faces = np.concatenate([m.faces + s for m, s in zip(meshes, starts[:-1], strict=True)])
    painted = [colours[k % len(colours)] for k, mesh in enumerate(meshes) for _ in mesh.faces]
    picture = bsp.picture(
        (vertices, faces), view, size=(480, 360), colors=painted, crease=crease, cull=True
    )
    OUT.mkdir(parents=True, exist_ok=True)
    picture.save(OUT / f"{name}.png")


def _certificate(part: csg.Solid, path: Path) -> Any:
    part.save(path)
    return csg.load(path).to_mesh().certificate
