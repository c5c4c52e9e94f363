"""Read two files, subtract, compare with manifold3d, and save only what agrees."""

import sys
from pathlib import Path

import bspcsg as csg

out = Path(sys.argv[1] if len(sys.argv) > 1 else "out")
out.mkdir(exist_ok=True)
meshes = Path(__file__).parent / "meshes"

plate, half = csg.load(meshes / "plate_holes.stl"), csg.load(meshes / "half_plate.off")
rest = plate - half
report = rest.validate()
print(report)
rest.save(out / "rest.stl")

try:
    csg.load(meshes / "teapot_open.stl")
except csg.BspcsgError as error:
    print(f"refused: {error.code}, first faces {error.where[:3]}")
