"""Evaluate OpenSCAD's own tests and examples, and compare volumes and areas with OpenSCAD's.

    scripts/openscad_suite SOURCE [--record]

SOURCE is the folder of OpenSCAD's published sources, 2021.01 for the recorded results (`apt-get
source openscad`); its scripts are GPL or CC0 and not part of this repository. The program
`openscad` of the same version must be on the PATH: it writes the `.csg` that is read here. Scripts
without an installed font use DejaVu Sans (`fonts-dejavu-core`). OpenSCAD's results are in
tests/corpus/csg/openscad_suite.tsv; --record writes them anew. Prints counts, and the scripts that
OpenSCAD evaluates without a warning and for which our result differs, each with the reason. Ends
with 1 if a difference has no reason.
"""

import argparse
import csv
import os
import re
import subprocess
import sys
import tempfile
import warnings
from collections import Counter
from collections.abc import Iterator
from dataclasses import asdict, dataclass, fields
from pathlib import Path

import numpy as np

import bspcsg as b
from bspcsg import csg
from bspcsg.bsp import Region
from bspcsg.io import read
from csg_reference import _PLANE_GRID
from recording import REPOSITORY

RECORD = REPOSITORY / "tests" / "corpus" / "csg" / "openscad_suite.tsv"

#: The folders of OpenSCAD's sources with scripts that make shapes.
FOLDERS = (
    *["2D/features", "2D/issues", "3D/features", "3D/issues", "3D/misc", "bugs", "issues", "dxf"],
    *["svg", "svg/svg-spec", "svg/extruded", "stl", "misc"],
)
EXAMPLES = ("Old", "Basics", "Advanced", "Functions", "Parametric")

#: The time limit of OpenSCAD for one script, in seconds.
TIMEOUT = 300

_OPEN = "a lone polyhedron that is not closed: OpenSCAD writes its faces as they are"
_GRID = "OpenSCAD moves corners of DXF files to multiples of 1/1024"

#: The reason why our result differs, by script.
REASONS = {
    "testdata/scad/3D/issues/issue1061.scad": "its faces are not plane",
    "testdata/scad/3D/issues/issue964.scad": _OPEN,
    "testdata/scad/3D/issues/issue964b.scad": _OPEN,
    "testdata/scad/3D/issues/polygon-illegal-winding.scad": _OPEN,
    "testdata/scad/bugs/issue1876.scad": _OPEN,
    "testdata/scad/misc/nonmanifold-polyhedron.scad": _OPEN,
    "testdata/scad/dxf/polygon-concave-simple.scad": _GRID,
    "testdata/scad/dxf/polygon-mesh.scad": "its DXF file is a mesh of lines: many outlines fit",
}


@dataclass(frozen=True)
class Reference:
    """OpenSCAD's result for a script.

    Parameters
    ----------
    file : str
    warnings : int
    dimension : int
        The dimension of the result: 3 or 2, or 0 if OpenSCAD writes no result.
    measure, border, largest : float
        The volume and the area in 3D, the area and the perimeter in 2D; the largest coordinate.
    """

    file: str
    warnings: int
    dimension: int = 0
    measure: float = 0.0
    border: float = 0.0
    largest: float = 0.0

    @property
    def tolerance(self) -> float:
        """Return the largest error of `measure` by OpenSCAD's rounding."""
        return tolerance(self.dimension, self.border, self.largest)


def tolerance(dimension: int, border: float, largest: float) -> float:
    """Return the largest error of a volume or area by rounding coordinates to six digits.

    `border` is the area or the perimeter, `largest` the largest coordinate.
    """
    digits = 0.5 * 10.0 ** (len(str(int(largest))) - 6)
    return float(border * dimension**0.5 * (digits + _PLANE_GRID) + 1e-9)


def scripts(source: Path) -> Iterator[str]:
    """Yield the paths of all scripts, relative to the folder of OpenSCAD's sources."""
    folders = [f"testdata/scad/{name}" for name in FOLDERS]
    for folder in (*folders, *(f"examples/{name}" for name in EXAMPLES)):
        for path in sorted((source / folder).glob("*.scad")):
            yield path.relative_to(source).as_posix()


def measured(source: Path, file: str) -> Reference:
    """Return OpenSCAD's result for a script, by running it."""
    with tempfile.TemporaryDirectory() as folder:
        stl, svg = Path(folder, "x.stl"), Path(folder, "x.svg")
        said = openscad_result(source / file, stl)
        count = len(re.findall("WARNING|ERROR", said))
        if stl.exists() and stl.stat().st_size > 100:
            mesh = read(stl)
            made = b.Mesh(mesh.vertices, mesh.faces, np.zeros((len(mesh.faces), 2), np.int64))
            largest = float(np.abs(mesh.vertices).max())
            return Reference(file, count, 3, made.volume, made.area, largest)
        if "not a 3D object" not in said:
            return Reference(file, count)
        openscad_result(source / file, svg)
        if not svg.exists():
            return Reference(file, count)
        region = region_of_svg(svg.read_text(encoding="utf-8"))
        corners = [np.abs(outline.points).max() for outline in region.outlines]
        return Reference(
            file, count, 2, region.area, region.perimeter, float(max(corners, default=0.0))
        )


def openscad_result(script: Path, target: Path) -> str:
    """Return OpenSCAD's messages while it writes a script's shape to a file."""
    command = ["openscad", "-o", str(target), str(script)]
    environment = {**os.environ, "QT_QPA_PLATFORM": "offscreen"}
    try:
        done = subprocess.run(
            command, capture_output=True, errors="replace", timeout=TIMEOUT, env=environment,
            check=False,
        )  # fmt: skip
    except subprocess.TimeoutExpired:
        target.unlink(missing_ok=True)
        return "ERROR: it took too long"
    return str(done.stderr)


def region_of_svg(text: str) -> Region:
    """Return the region of an SVG file by OpenSCAD, which has only straight paths."""
    words = " ".join(re.findall(r'<path d="([^"]*)"', text))
    loops = []
    for loop in words.split("M")[1:]:
        pairs = re.findall(r"(-?[\d.e+-]+),(-?[\d.e+-]+)", loop)
        if len(pairs) > 2:
            loops.append([(float(x), -float(y)) for x, y in pairs])
    return Region(loops, winding="even-odd")


def our_result(source: Path, file: str) -> float:
    """Return the volume or area of our result for a script; refused children are left out."""
    tree = csg.read_tree(source / file)
    try:
        body = csg.evaluate(tree, allow_paths=[source])
    except b.BspcsgError:
        body = csg.evaluate(tree, lenient=True, allow_paths=[source])
    if body is None:
        return 0.0
    return float(body.volume if isinstance(body, b.Solid) else body.area)


def status_and_details(source: Path, row: Reference) -> tuple[str, str]:
    """Return the status of a script ("same", "explained", "DIFFERS", "FAILS") and details."""
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", csg.CsgWarning)
            found = our_result(source, row.file)
    except b.BspcsgError as error:
        return "FAILS", str(error).splitlines()[0]
    if abs(found - row.measure) <= row.tolerance:
        return "same", ""
    reason = REASONS.get(row.file, "")
    status = "explained" if reason else "DIFFERS"
    return status, f"{found:.6g} here, {row.measure:.6g} there  {reason}"


def recorded() -> list[Reference]:
    """Return the recorded results of OpenSCAD 2021.01."""
    with RECORD.open(encoding="utf-8") as lines:
        rows = list(csv.DictReader(lines, delimiter="\t"))
    return [
        Reference(
            row["file"],
            int(row["warnings"]),
            int(row["dimension"]),
            *(float(row[name]) for name in ("measure", "border", "largest")),
        )
        for row in rows
    ]


def record(source: Path) -> None:
    """Run OpenSCAD on all scripts, and write its results to the record."""
    names = [field.name for field in fields(Reference)]
    with RECORD.open("w", encoding="utf-8", newline="") as lines:
        table = csv.DictWriter(lines, names, delimiter="\t", lineterminator="\n")
        table.writeheader()
        for file in scripts(source):
            table.writerow(asdict(measured(source, file)))


def with_fonts(fonts: Path, folder: Path) -> None:
    """Make fontconfig find the fonts in a folder, with its cache in another folder."""
    usual = os.environ.get("FONTCONFIG_FILE", "/etc/fonts/fonts.conf")
    settings = folder / "fonts.conf"
    settings.write_text(
        '<?xml version="1.0"?><!DOCTYPE fontconfig SYSTEM "fonts.dtd"><fontconfig>'
        f'<include ignore_missing="yes">{usual}</include>'
        f"<dir>{fonts.absolute()}</dir>"
        f"<cachedir>{folder / 'cache'}</cachedir></fontconfig>",
        encoding="utf-8",
    )
    os.environ["FONTCONFIG_FILE"] = str(settings)


def main() -> int:
    """Print the scripts whose results differ, and return the exit code."""
    parser = argparse.ArgumentParser(description=__doc__.partition("\n")[0])
    parser.add_argument("source", type=Path, metavar="SOURCE")
    parser.add_argument("--record", action="store_true", help="measure OpenSCAD's results anew")
    options = parser.parse_args()
    if options.record:
        record(options.source)
    with tempfile.TemporaryDirectory() as folder:
        # The fonts that scripts load with `use <….ttf>`.
        with_fonts(options.source / "testdata" / "ttf", Path(folder))
        counts = compared(options.source)
    print(", ".join(f"{count} {status}" for status, count in sorted(counts.items())))
    judged = sum(counts[status] for status in ("same", "explained", "DIFFERS", "FAILS"))
    print(f"the same set: {counts['same'] / judged:.1%} of those without a warning")
    return 1 if counts.keys() & {"DIFFERS", "FAILS"} else 0


def compared(source: Path) -> Counter[str]:
    """Print the scripts whose results differ, and return the number of scripts of each status."""
    counts: Counter[str] = Counter()
    for row in recorded():
        if row.warnings or not row.dimension:
            counts["with a warning" if row.warnings else "without a shape"] += 1
            continue
        status, details = status_and_details(source, row)
        counts[status] += 1
        if status != "same":
            print(f"{row.file:52} {status:9} {details}", flush=True)
    return counts


if __name__ == "__main__":
    sys.exit(main())
