"""A hinge printed in one piece that turns through 90 degrees without a clash."""

from model import finish

import bspcsg as csg

length, leaf, thick, r, gap, knuckles = 50.0, 24.0, 4.0, 5.0, 0.4, 5
step = length / knuckles


def along(h: float, radius: float, start: float) -> csg.Solid:
    """Return a cylinder along the y axis."""
    return csg.cylinder(h, radius, segments=64).rotate(-90, "x").translate(0, start, 0)


def knuckle(k: int) -> csg.Solid:
    """Return one barrel, with the arm to a leaf at x > 0."""
    start = k * step + gap / 2
    arm = csg.box(r + 2 * gap, step - gap, thick).translate(0, start, -r)
    return along(step - gap, r, start) | arm


def side(first: int) -> csg.Solid:
    """Return a leaf at x > 0 with every other knuckle, its underside at z = -r."""
    plate = csg.box(leaf, length, thick).translate(r + gap, 0, -r)
    screws = csg.grid(csg.cylinder(20, d=4, center=True), (1, 2), (1, 26), center=True)
    own = csg.union(knuckle(k) for k in range(first, knuckles, 2))
    return (plate | own) - screws.translate(r + leaf / 2, length / 2, 0)


fixed = side(0) | along(length, 2.0, 0)
turning = side(1).mirror((1, 0, 0)) - along(length + 2, 2.0 + gap, -1)
poses = [turning.rotate(angle, "y") for angle in range(0, 91, 15)]

print("volumes shared on the way:", [(pose & fixed).volume for pose in poses])
print("smallest gap on the way:", round(min(pose.min_gap(fixed) for pose in poses), 3), "mm")
finish("hinge", fixed, poses[3], colours=["#b9a5c9", "#c9b27c"])
