"""A small table as an assembly: its bill of masses, and that no part clashes with another."""

from model import finish

import bspcsg as csg

OAK, STEEL = 7.2e-7, 7.85e-6  # kg/mm³

board = csg.box(600, 400, 24, center=True).translate(0, 0, 412)
board = board.fillet(board.edges().parallel("z"), 40)
rim = board.edges().where(lambda e: e.ends[:, :, 2].min(axis=1) == 424)
board = board.chamfer(rim, 3)

bolt = csg.cylinder(30, d=5).translate(0, 0, -30) | csg.cylinder(3, r1=0, d2=12).translate(0, 0, -3)
bolt = bolt.translate(0, 0, 424)
foot = csg.cylinder(400, d1=26, d2=40, segments=48) - bolt

screw = csg.Assembly("screw", bolt, color=(0.72, 0.74, 0.77), density=STEEL)
leg = csg.Assembly("leg", foot, color=(0.55, 0.42, 0.27), density=OAK)
stand = csg.Assembly("leg and screw", [leg, screw])

# Four placed stands share one leg and one screw.
stands = [stand.translate(x, y, 0) for x in (-240, 240) for y in (-140, 140)]
bores = csg.union(bolt.translate(x, y, 0) for x in (-240, 240) for y in (-140, 140))
top = csg.Assembly("top", board - bores, color=(0.79, 0.64, 0.42), density=OAK)
table = csg.Assembly("table", [top, *stands])

print(table.bill())
print(f"mass: {table.bill().mass:.3f} kg in {len(table)} parts")
print("clashes:", len(table.clashes()))

hexed = ["#" + "".join(f"{round(255 * c):02x}" for c in part.color[:3]) for part in table]
finish("assembly", *(part.solid for part in table), colours=hexed)
