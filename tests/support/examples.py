"""What each example writes."""

_PAINTED = ("cycle.svg", "lines.svg", "part.svg", "plane.svg", "scan.png")
_OPERATIONS = ("union", "intersection", "difference", "xor")
_SECTIONS = ("low", "high", "side", "slanted")

#: By the example's stem, the names of its files.
WRITES = {
    "01_drilled_plate": {"plate.stl"},
    "04_two_meshes": {"goat_and_ball.png"},
    "05_checked": {"rest.stl"},
    "06_autopartition": {"autopartition.svg"},
    "07_cost": {"least_cost.svg"},
    "08_painter": {f"painter_{name}" for name in _PAINTED},
    "09_rays": {"rays.png"},
    "10_self_organising": {"self_organising.png"},
    "11_objects": {f"merge_{name}.svg" for name in _OPERATIONS},
    "13_growth": {"growth.png"},
    "12_region": {"profile.svg", *(f"section_{name}.svg" for name in _SECTIONS)},
}
