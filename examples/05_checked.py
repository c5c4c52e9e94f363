"""Read two files, subtract, compare with manifold3d, and save only what agrees."""

import sys
from pathlib import Path

import bspcsg as b

out = Path(sys.argv[1] if len(sys.argv) > 1 else "out")
out.mkdir(exist_ok=True)
meshes = Path(__file__).parent / "meshes"

plate, half = b.load(meshes / "plate_holes.stl"), b.load(meshes / "half_plate.off")
rest = plate - half
report = rest.validate()
print(report)
rest.save(out / "rest.stl")

try:
    b.load(meshes / "teapot_open.stl")
except b.BspcsgError as error:
    print(f"refused: {error.code}, first faces {error.where[:3]}")
