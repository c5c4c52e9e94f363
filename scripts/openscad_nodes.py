"""Record OpenSCAD 2021.01's results for ten small scripts of each module of its language.

    scripts/openscad_nodes

Writes tests/corpus/csg/openscad_nodes.tsv: for each script OpenSCAD's `.csg`, and the volume, area
and Euler number of its result, or in the plane area, perimeter and number of outlines.
tests/pipeline/test_csg_reference.py compares them. The program `openscad` must be on the PATH. The
last five scripts of each module are degenerate: empty, flat, touching, inside out.
"""

import csv
import sys
from dataclasses import asdict, dataclass, fields
from pathlib import Path
from tempfile import TemporaryDirectory

import numpy as np

import bspcsg as b
from bspcsg.bsp import Region
from bspcsg.io import read
from bspcsg.modelling.planar import lettering
from openscad_suite import openscad_result, region_of_svg, tolerance, with_fonts
from recording import REPOSITORY

RECORD = REPOSITORY / "tests" / "corpus" / "csg" / "openscad_nodes.tsv"

#: The folder of the files that the scripts import.
FOLDER = Path(__file__).parents[1] / "tests" / "corpus" / "csg"

_BLOCK = "cube([3, 2, 1]);"
_BAR = "translate([1, 0.5, -1]) cube([1, 1, 4]);"
_DISC = "circle(2, $fn = 12);"
_TETRA = "[[0,0,0],[2,0,0],[0,2,0],[0,0,2]]"
#: The faces of a tetrahedron, clockwise seen from outside, as in OpenSCAD.
_OUT = "[[0,1,2],[0,3,1],[1,3,2],[0,2,3]]"

#: The bodies for modules that move or combine bodies; the last five are degenerate.
_BODIES = (
    *["cube(2);", "sphere(2, $fn = 8);", "cylinder(h = 3, r1 = 2, r2 = 1, $fn = 7);"],
    *[f"difference() {{ {_BLOCK} {_BAR} }}", "square([3, 2]);"],
    *["cube(0);", "cube(1); translate([1, 0, 0]) cube(1);", "cube([2, 2, 0.001]);"],
    *["difference() { cube(2); cube(2); }", "cube(1); translate([1, 1, 0]) cube(1);"],
)

#: Pairs of bodies; the last five touch, are equal, nested, empty, or differ in dimension.
_PAIRS = (
    *[f"{_BLOCK} {_BAR}", "cube(2); translate([1, 1, 1]) cube(2);"],
    *["sphere(2, $fn = 8); cube(2);", "square(3); translate([1, 1]) circle(1.5, $fn = 9);"],
    "cylinder(h = 4, r = 1, $fn = 6); translate([0, 0, 2]) rotate([90, 0, 0])"
    " cylinder(h = 4, r = 1, $fn = 6);",
    *["cube(2); translate([2, 0, 0]) cube(2);", "cube(2); cube(2);"],
    *["cube(3); translate([1, 1, 1]) cube(1);", "cube(2); cube(0);"],
    "square(2); translate([2, 2]) square(2);",
)


def _on_bodies(head: str, bodies: tuple[str, ...] = _BODIES) -> tuple[str, ...]:
    return tuple(f"{head} {{ {body} }}" for body in bodies)


#: Ten scripts for each module.
SCRIPTS: dict[str, tuple[str, ...]] = {
    "cube": (
        *["cube(2);", "cube([1, 2, 3]);", "cube([1, 2, 3], center = true);", "cube(0.1);"],
        *["cube([1e3, 1, 1]);", "cube(0);", "cube([1, 0, 2]);", "cube(-1);"],
        *["cube([1, 1, 1e-4]);", "cube();"],
    ),
    "sphere": (
        *["sphere(2);", "sphere(r = 3, $fn = 12);", "sphere(d = 5, $fa = 30);"],
        *["sphere(10, $fs = 3);", "sphere(1.5, $fn = 5);", "sphere(0);", "sphere(-2);"],
        *["sphere(2, $fn = 3);", "sphere(1e-3);", "sphere(2, $fn = 1);"],
    ),
    "cylinder": (
        *["cylinder(h = 3, r = 2);", "cylinder(h = 3, d1 = 4, d2 = 2, $fn = 9);"],
        *["cylinder(3, 2, 1, center = true);", "cylinder(h = 1, r1 = 3, r2 = 0, $fn = 5);"],
        *["cylinder(h = 10, d = 1, $fs = 0.1);", "cylinder(h = 0, r = 2);"],
        *["cylinder(h = 3, r = 0);", "cylinder(h = 3, r1 = 0, r2 = 2, $fn = 4);"],
        *["cylinder(h = 3, r = 2, $fn = 3);", "cylinder(h = 1e-3, r = 2);"],
    ),
    "polyhedron": (
        f"polyhedron({_TETRA}, {_OUT});",
        "polyhedron([[0,0,0],[4,0,0],[4,3,0],[0,3,0],[2,1,5]],"
        " [[0,1,2,3],[0,4,1],[1,4,2],[2,4,3],[3,4,0]]);",
        f"scale([1, 2, 3]) polyhedron({_TETRA}, {_OUT});",
        f"union() {{ polyhedron({_TETRA}, {_OUT}); cube(0.5); }}",
        "polyhedron([[0,0,0],[2,0,0],[2,2,0],[0,2,0],[0,0,2],[2,0,2],[2,2,2],[0,2,2]],"
        " [[0,1,2,3],[7,6,5,4],[4,5,1,0],[5,6,2,1],[6,7,3,2],[7,4,0,3]]);",
        f"polyhedron(points = {_TETRA}, triangles = {_OUT});",
        "polyhedron([], []);",
        f"polyhedron(concat({_TETRA}, [[9,9,9]]), {_OUT});",
        f"polyhedron({_TETRA}, concat({_OUT}, [[0,1]]));",
        "polyhedron([[0,0,0],[2,0,0],[0,2,0],[0,0,1e-3]], [[0,1,2],[0,3,1],[1,3,2],[0,2,3]]);",
    ),
    "square": (
        *["square(2);", "square([1, 3]);", "square([1, 3], center = true);", "square(0.1);"],
        *["square([1e3, 1]);", "square(0);", "square([2, 0]);", "square(-1);"],
        *["square([1, 1e-3]);", "square();"],
    ),
    "circle": (
        *["circle(2);", "circle(d = 5);", "circle(3, $fn = 7);", "circle(10, $fa = 40);"],
        *["circle(4, $fs = 1);", "circle(0);", "circle(-2);", "circle(2, $fn = 3);"],
        *["circle(1e-2);", "circle();"],
    ),
    "polygon": (
        *["polygon([[0,0],[4,0],[0,3]]);", "polygon([[0,0],[5,0],[5,5],[2,2],[0,5]]);"],
        "polygon([[0,0],[9,0],[9,9],[0,9],[2,2],[4,2],[4,4],[2,4]], [[0,1,2,3],[4,5,6,7]]);",
        *["polygon([[0,0],[0,3],[4,0]]);", "polygon([[0,0],[1,1],[2,0],[3,1],[4,0],[2,5]]);"],
        *["polygon([[0,0],[2,2],[2,0],[0,2]]);", "polygon([[0,0],[4,0],[4,0],[0,3]]);"],
        *["polygon([[0,0],[4,0],[2,0],[0,3]]);", "polygon([[0,0],[4,0],[8,0]]);"],
        "polygon([[0,0],[4,0],[4,4],[2,4],[2,0],[2,4],[0,4]]);",
    ),
    "text": (
        *['text("a");', 'text("Hello", 8);', 'text("0123", size = 5, $fn = 4);'],
        *['text("AV", halign = "center", valign = "center");', 'text("b q", spacing = 1.5);'],
        *['text("");', 'text(" ");', 'text("i", size = 1e-1);', 'text("x", size = 0);'],
        'text("ab", direction = "rtl");',
    ),
    "import": (
        *['import("drawing.svg");', 'import("curves.svg");', 'import("drawing.svg", dpi = 96);'],
        *['import("drawing.dxf", origin = [1, 2], scale = 2);', 'import("block.stl");'],
        *['import("drawing.svg", center = true);', 'import("block.stl"); cube(0);'],
        *['scale(0.01) import("block.stl");', 'mirror([1, 0, 0]) import("block.stl");'],
        'intersection() { import("block.stl"); translate([9, 9, 9]) cube(1); }',
    ),
    "surface": (
        *['surface("table.dat");', 'surface("table.dat", center = true);'],
        *['surface("table.png");', 'surface("table.png", invert = true);'],
        *['scale([1, 2, 0.1]) surface("table.dat");', 'scale(1e-2) surface("table.png");'],
        *['mirror([0, 0, 1]) surface("table.dat");', 'scale([1, 1, 0]) surface("table.dat");'],
        'difference() { surface("table.dat"); surface("table.dat"); }',
        'projection() surface("table.dat");',
    ),
    "linear_extrude": (
        *[f"linear_extrude(3) {_DISC}", f"linear_extrude(3, twist = 90, slices = 8) {_DISC}"],
        *[f"linear_extrude(3, scale = 0.5) {_DISC}", f"linear_extrude(3, center = true) {_DISC}"],
        "linear_extrude(2) difference() { square(4); translate([1, 1]) square(2); }",
        *[f"linear_extrude(0) {_DISC}", f"linear_extrude(3, scale = 0) {_DISC}"],
        *["linear_extrude(2) square(0);", f"linear_extrude(2, scale = [1, 0]) {_DISC}"],
        "linear_extrude(2) { square(1); translate([1, 1]) square(1); }",
    ),
    "rotate_extrude": (
        *["rotate_extrude($fn = 9) translate([3, 0]) square(1);", "rotate_extrude() square(2);"],
        "rotate_extrude(angle = 90, $fn = 16) translate([3, 0]) circle(1, $fn = 6);",
        "rotate_extrude($fn = 5) polygon([[0,0],[2,0],[0,3]]);",
        "rotate_extrude(angle = -45, $fn = 16) translate([2, 1]) square(1);",
        *["rotate_extrude(angle = 0, $fn = 8) square(1);", "rotate_extrude($fn = 3) square(1);"],
        "rotate_extrude(angle = 400, $fn = 8) square(1);",
        "rotate_extrude($fn = 8) translate([-3, 0]) square(1);",
        "rotate_extrude($fn = 8) square(0);",
    ),
    "translate": _on_bodies("translate([1, 2, 0])"),
    "rotate": _on_bodies("rotate([0, 0, 30])"),
    "scale": _on_bodies("scale([1, 2, 3])"),
    "mirror": _on_bodies("mirror([1, 1, 0])"),
    "multmatrix": _on_bodies("multmatrix([[1, 0.5, 0, 1], [0, 1, 0, 2], [0, 0, 1, 0]])"),
    "resize": (
        *_on_bodies("resize([4, 0, 0])", _BODIES[:5]),
        *["resize([0, 0, 0]) cube(2);", "resize([4, 4, 4]) cube(0);"],
        *["resize([4, 0, 0], auto = true) cube([1, 2, 3]);"],
        *["resize([0, 0, 1e-3]) cube(2);", "resize([4, 0], auto = [true, true]) square([1, 2]);"],
    ),
    "color": _on_bodies('color("red")'),
    "render": _on_bodies("render()"),
    "group": _on_bodies("group()"),
    "offset": (
        *["offset(r = 1, $fn = 16) square(3);", "offset(delta = 1) square(3);"],
        *["offset(delta = 1, chamfer = true) square(3);", "offset(r = -1) square(4);"],
        "offset(delta = -0.5) polygon([[0,0],[5,0],[5,5],[2,2],[0,5]]);",
        *["offset(r = 0) square(3);", "offset(delta = -2) square(3);"],
        *["offset(r = 1, $fn = 8) square(0);", "offset(delta = -1.5) square(3);"],
        "offset(delta = 0.5) { square(1); translate([2, 0]) square(1); }",
    ),
    "hull": _on_bodies("hull()", _PAIRS),
    "union": _on_bodies("union()", _PAIRS),
    "difference": _on_bodies("difference()", _PAIRS),
    "intersection": _on_bodies("intersection()", _PAIRS),
    "minkowski": (
        *["minkowski() { cube(2); sphere(1, $fn = 6); }", "minkowski() { square(2); circle(1); }"],
        *[f"minkowski() {{ {_BLOCK} {_BAR} }}", f"minkowski() {{ {_BODIES[3]} cube(0.5); }}"],
        "minkowski() { cube(1); cube(2); cube(3); }",
        *["minkowski() { cube(2); }", "minkowski() { cube(2); cube([1, 1, 1e-2]); }"],
        "minkowski() { square([3, 1]); square([1, 1e-2]); }",
        *["minkowski() { cube(1); translate([5, 0, 0]) cube(1); }", "minkowski() { }"],
    ),
    "intersection_for": (
        "intersection_for(k = [0 : 2]) translate([k, 0, 0]) cube(4);",
        "intersection_for(a = [0, 45]) rotate(a) cube([3, 3, 1], center = true);",
        "intersection_for(k = [1, 2]) sphere(k, $fn = 8);",
        "intersection_for(k = [0 : 1]) translate([k, k]) square(3);",
        "intersection_for(a = [0 : 30 : 60]) rotate([0, a, 0]) cube(2, center = true);",
        *["intersection_for(k = [0]) cube(2);", "intersection_for(k = []) cube(2);"],
        "intersection_for(k = [0, 1]) translate([k, 0, 0]) cube(1);",
        "intersection_for(k = [0, 5]) translate([k, 0, 0]) cube(1);",
        "intersection_for(k = [0, 0]) cube(1);",
    ),
    "for": (
        "for (k = [0 : 3]) translate([2 * k, 0, 0]) cube(1);",
        "for (k = [0 : 3]) translate([k / 2, 0, 0]) cube(1);",
        "for (x = [0, 1], y = [0, 2]) translate([x, y, 0]) cube(1.5);",
        "for (k = [0 : 30 : 330]) rotate(k) translate([4, 0]) square(1);",
        "for (k = [1 : 4]) translate([0, 0, k]) cylinder(h = 1, r = 5 - k, $fn = 6);",
        *["for (k = []) cube(1);", "for (k = [5 : 1 : 2]) cube(1);"],
        *["for (k = [0 : 1]) translate([k, 0, 0]) cube(1);", "for (k = [0, 0]) cube(1);"],
        "for (k = [0 : 1]) translate([k, k, 0]) cube(1);",
    ),
    "children": tuple(f"module m() {{ children(); }} m() {{ {body} }}" for body in _BODIES),
    "projection": (
        *[f"projection() {body}" for body in _BODIES[:3]],
        f"projection(cut = true) translate([0, 0, -0.5]) {{ {_BODIES[3]} }}",
        "projection() rotate([30, 20, 0]) cube(2);",
        *[
            "projection(cut = true) cube(2);",
            "projection(cut = true) translate([0, 0, 5]) cube(2);",
        ],
        *["projection() cube(0);", "projection(cut = true) translate([0, 0, -2]) cube(2);"],
        "projection() { cube(1); translate([1, 1, 0]) cube(1); }",
    ),
}


@dataclass(frozen=True)
class Sample:
    """A script, and OpenSCAD's result for it.

    Parameters
    ----------
    node, script, csg : str
        The module, the script, and its evaluated tree in one line.
    warnings : int
    dimension : int
        The dimension of the result: 3 or 2, or 0 for no result.
    measure, border : float
        The volume and the area in 3D, the area and the perimeter in 2D.
    shape : int
        The Euler number in 3D, the number of outlines in 2D.
    largest : float
        The largest coordinate.
    """

    node: str
    script: str
    csg: str
    warnings: int
    dimension: int = 0
    measure: float = 0.0
    border: float = 0.0
    shape: int = 0
    largest: float = 0.0

    @property
    def tolerance(self) -> float:
        """Return the largest error of the measure by OpenSCAD's rounding (see openscad_suite)."""
        return tolerance(self.dimension, self.border, self.largest)


def sampled(node: str, script: str, folder: Path) -> Sample:
    """Return the sample of OpenSCAD's result for a script, run in the folder of the corpus."""
    path = FOLDER / "sample.scad"
    path.write_text(script, encoding="utf-8")
    targets = {suffix: folder / f"x.{suffix}" for suffix in ("csg", "stl", "svg")}
    try:
        said = {suffix: openscad_result(path, target) for suffix, target in targets.items()}
    finally:
        path.unlink()
    tree = " ".join(targets["csg"].read_text(encoding="utf-8").split())
    count = said["csg"].count("WARNING") + said["csg"].count("ERROR")
    nothing = Sample(node, script, tree, count)
    stl, svg = targets["stl"], targets["svg"]
    if stl.exists() and stl.stat().st_size > 100:
        mesh = read(stl)
        body = b.Mesh(mesh.vertices, mesh.faces, np.zeros((len(mesh.faces), 2), np.int64))
        if not body.volume:
            return nothing
        figures = body.volume, body.area, body.euler_number, float(np.abs(mesh.vertices).max())
        return Sample(node, script, tree, count, 3, *figures)
    if svg.exists() and "<path" in svg.read_text(encoding="utf-8"):
        region = region_of_svg(svg.read_text(encoding="utf-8"))
        corners = [float(np.abs(outline.points).max()) for outline in region.outlines]
        figures = region.area, region.perimeter, len(region.outlines), max(corners, default=0.0)
        return Sample(node, script, tree, count, 2, *figures)
    return nothing


def recorded() -> list[Sample]:
    """Return the recorded samples of OpenSCAD 2021.01."""
    with RECORD.open(encoding="utf-8") as lines:
        rows = list(csv.DictReader(lines, delimiter="\t"))
    kinds = {field.name: field.type for field in fields(Sample)}
    return [Sample(**{name: kinds[name](row[name]) for name in kinds}) for row in rows]  # type: ignore[operator]


def main() -> int:
    """Run OpenSCAD on all scripts, and write its results to the record."""
    names = [field.name for field in fields(Sample)]
    with RECORD.open("w", encoding="utf-8", newline="") as lines, TemporaryDirectory() as fonts:
        with_fonts(Path(lettering.__file__).parent / "faces", Path(fonts))
        table = csv.DictWriter(lines, names, delimiter="\t", lineterminator="\n")
        table.writeheader()
        for node, scripts in SCRIPTS.items():
            for script in scripts:
                with TemporaryDirectory() as folder:
                    table.writerow(asdict(sampled(node, script, Path(folder))))
    return 0


def ours(sample: Sample, body: b.Solid | Region | None) -> Sample:
    """Return our result for a sample's script, as a sample."""
    told = sample.node, sample.script, sample.csg, sample.warnings
    if body is None or body.is_empty:
        return Sample(*told)
    if isinstance(body, Region):
        return Sample(*told, 2, body.area, body.perimeter, len(body.outlines), sample.largest)
    mesh = body.normalized().to_mesh()
    # Where a surface touches itself, our meshes have separate vertices, OpenSCAD's common ones.
    places, names = np.unique(mesh.vertices, axis=0, return_inverse=True)
    welded = b.Mesh(places, names.reshape(-1)[mesh.faces], mesh.source)
    return Sample(*told, 3, body.volume, body.area, welded.euler_number, sample.largest)


if __name__ == "__main__":
    sys.exit(main())
