"""Evaluate the reference scripts and compare their volumes with OpenSCAD's.

    scripts/csg_reference [FOLDER]

FOLDER (../shared/csg by default) has `.csg` files and MANIFEST.tsv with OpenSCAD 2021.01's results
for them. Prints a table: the relative difference of the volumes, the same after our coordinates are
rounded as OpenSCAD writes them, and the largest difference that rounding explains. Ends with 1 if a
script fails or a volume differs by more than that.
"""

import csv
import sys
import time
import warnings
from collections.abc import Iterator
from pathlib import Path

import numpy as np

import bspcsg as b
from bspcsg import csg

#: The step of OpenSCAD's grid for plane figures, in model units.
_PLANE_GRID = 2.0**-16

#: The nodes whose results OpenSCAD rounds to its grid for plane figures.
_PLANE = {"circle", "square", "polygon", "offset", "projection", "import", "linear_extrude",
          "rotate_extrude"}  # fmt: skip


#: The scripts whose first node OpenSCAD leaves out, with the reason why it is a solid.
LEFT_OUT = {
    "openscad-bugs_issue802.csg": (
        "OpenSCAD leaves out the first polyhedron, in which four edges have one face each; they lie"
        " on one line and bound nothing"
    ),
}


def manifest(folder: Path) -> Iterator[dict[str, str]]:
    """Yield the rows of MANIFEST.tsv for the scripts in a folder."""
    with (folder / "MANIFEST.tsv").open(encoding="utf-8") as lines:
        rows = csv.DictReader(lines, delimiter="\t")
        yield from (row for row in rows if row["file"].endswith(".csg"))


def tolerance(solid: b.Solid, uses_plane: bool) -> float:
    """Return the largest error of OpenSCAD's volume by rounding, for our solid of the script.

    OpenSCAD writes coordinates with six significant digits: each corner moves by up to half a unit
    of the sixth digit of the largest coordinate, along each axis, and a boundary of area A that
    moves by d changes the volume by at most A d. Plane figures are rounded to 2**-16 before that.
    """
    largest = float(abs(solid.bounds).max()) if solid.bounds is not None else 0.0
    digits = 0.5 * 10.0 ** (len(str(int(largest))) - 6)
    return solid.area * 3**0.5 * (digits + (_PLANE_GRID if uses_plane else 0.0))


def compare(folder: Path, row: dict[str, str]) -> tuple[str, str]:
    """Return a status ("same", "explained", "DIFFERS", "unsupported", "FAILS") and details."""
    start = time.perf_counter()
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", csg.CsgWarning)
            solid = csg.load(folder / row["file"], on_invalid="warn")
        volume = solid.volume
    except b.BspcsgError as error:
        status = "unsupported" if error.code == "unsupported" else "FAILS"
        return status, str(error).removeprefix(f"{folder}/").partition(". ")[0]
    seconds = time.perf_counter() - start
    reference = float(row["ref_volume"])
    names = {entry.partition(":")[0] for entry in row["nodes"].split()}
    allowed = tolerance(solid, bool(names & _PLANE)) / volume
    reason = LEFT_OUT.get(row["file"])
    if reason is not None:
        reference += first_node(folder / row["file"]).volume
    relative, rounded = (abs(v / reference - 1) for v in (volume, six_digits(solid)))
    status = "DIFFERS" if relative > allowed else "same" if reason is None else "explained"
    figures = f"{relative:8.2e} {rounded:8.2e} {allowed:8.2e} {volume:15.5f} {seconds:6.2f} s"
    return status, figures if reason is None else f"{figures}  {reason}"


def first_node(path: Path) -> b.Solid:
    """Return the solid of the first node of a script."""
    tree = csg.read_tree(path)
    solid = csg.evaluate(csg.CsgTree(tree.nodes[:1], tree.name, tree.folder))
    assert isinstance(solid, b.Solid)
    return solid


def six_digits(solid: b.Solid) -> float:
    """Return a solid's volume with its coordinates rounded as OpenSCAD writes them."""
    mesh = solid.normalized().to_mesh()
    single = mesh.vertices.astype(np.float32)
    rounded = np.array([[float(f"{c:.6g}") for c in point] for point in single.tolist()])
    return b.Mesh(rounded, mesh.faces, mesh.source).volume


def main() -> int:
    """Print the table, and return the exit code."""
    folder = Path(sys.argv[1] if len(sys.argv) > 1 else "../shared/csg")
    counts: dict[str, int] = {}
    print(f"{'file':46} {'status':12} {'rel.diff':>8} {'6 digits':>8} {'allowed':>8} volume, time")
    for row in manifest(folder):
        status, details = compare(folder, row)
        counts[status] = counts.get(status, 0) + 1
        print(f"{row['file']:46} {status:12} {details}", flush=True)
    print(", ".join(f"{count} {status}" for status, count in sorted(counts.items())))
    return 1 if counts.keys() & {"DIFFERS", "FAILS"} else 0


if __name__ == "__main__":
    sys.exit(main())
