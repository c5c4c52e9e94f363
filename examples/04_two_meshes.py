"""A scan and a ball: four operations as a picture, coloured by where each triangle came from."""

import sys
from pathlib import Path

import picture

import bspcsg as csg

out = Path(sys.argv[1] if len(sys.argv) > 1 else "out")
size = int(sys.argv[2]) if len(sys.argv) > 2 else 420

goat = csg.load(Path(__file__).parent / "meshes" / "goathead.obj")
ball = csg.sphere(4.2, segments=48).translate(2.4, 4, 2.6)

tiles = []
for name, solid in {
    "union": goat | ball,
    "intersection": goat & ball,
    "goat without ball": goat - ball,
    "ball without goat": ~goat & ball,
}.items():
    mesh = solid.to_mesh()
    print(f"{name:20} {len(mesh.faces):6d} triangles, volume {solid.volume:.6f}")
    tiles.append((mesh.vertices, mesh.faces, mesh.source[:, 0]))

picture.save_png(
    picture.row(tiles, picture.view(turn=25, tilt=15), size), out / "goat_and_ball.png"
)
