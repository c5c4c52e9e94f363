"""The names of the files that each example writes."""

_PAINTED = ("cycle.svg", "lines.svg", "part.svg", "plane.svg", "scan.png")
_SECTIONS = ("low", "high", "side", "slanted")

#: The models, whose pictures have their names.
MODELS = (
    "14_enclosure",
    "15_gear",
    "16_bolt_and_nut",
    "17_flange",
    "18_brick",
    "19_honeycomb",
    "20_text_plate",
    "21_vase",
    "22_gyroid",
    "23_duct",
    "24_hinge",
    "25_assembly",
)

#: By the example's stem, the names of its files.
WRITES = {
    "01_drilled_plate": {"plate.stl"},
    "04_two_meshes": {"goat_and_ball.png"},
    "05_checked": {"rest.stl"},
    "08_painter": {f"painter_{name}" for name in _PAINTED},
    "09_rays": {"rays.png"},
    "12_region": {"profile.svg", *(f"section_{name}.svg" for name in _SECTIONS)},
    **{stem: {f"{stem[3:]}.png"} for stem in MODELS},
}
