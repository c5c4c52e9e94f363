"""An M10 bolt and a nut that fit: the same thread, and a clearance that is measured."""

from model import finish

import bspcsg as csg

pitch, major, clearance, sides = 1.5, 10.0, 0.1, 48
core = major / 2 - 0.61343 * pitch

# The thread's profile: x from the core inwards, y along the axis; flanks at 60 degrees.
depth, crest = major / 2 - core, pitch / 8
root = crest + 2 * depth * 0.57735
side = [(-depth, crest / 2), (0, root / 2), (0.3, root / 2)]
ridge = csg.Region(side[::-1] + [(x, -y) for x, y in side])


def thread(length: float, extra: float = 0.0) -> csg.Solid:
    """Return a threaded rod, larger by `extra` all over, from z = 0 on."""
    turns = length / pitch + 2
    path = csg.helix(core, pitch, turns, segments=sides) - (0, 0, pitch)
    coil = csg.sweep(ridge.offset(extra, "miter"), path, frame="fixed")
    rod = csg.cylinder(length, r=core + extra, segments=sides)
    return rod | (coil & csg.cylinder(length, r=major, segments=sides))


head = csg.prism(6, 6.4, 16 / 2 / 0.8660254)
head = head & csg.cylinder(6.4, r1=10.3, r2=8.2, segments=96)
point = csg.cylinder(31, r1=major / 2 + 30, r2=core - 0.2, segments=96)
bolt = head.mirror((0, 0, 1)) | (thread(30) & point)

hexagon = csg.prism(6, 8, 16 / 2 / 0.8660254)
mouth = csg.cone(5.6, r=5.6, segments=96)
holes = mouth | mouth.mirror((0, 0, 1)).translate(0, 0, 8)
# The hole's thread has the phase of the bolt's where the nut stands.
nut = hexagon.translate(0, 0, 15) - thread(30, clearance) - holes.translate(0, 0, 15)

print("bolt and nut share", (bolt & nut).volume, "mm³")
print("clearance between them:", round(bolt.min_gap(nut), 3), "mm")
aside = nut.translate(24, 0, -15)
finish("bolt_and_nut", bolt.rotate(180, "x"), aside, colours=["#b8bcc4", "#c9b27c"])
