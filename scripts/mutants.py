"""Change one line of the core at a time, and check that the tests named beside it fail.

    scripts/mutants [NUMBER ...]

The core is copied to `.fuzz/mutants` and built there. `--record` updates the recorded verdicts.
Ends with status 1 if the tests of a mutant pass, or if a line to change is no longer in the source.
"""

import argparse
import shutil
import subprocess
import sys
import time
from pathlib import Path
from typing import NamedTuple

from recording import REPOSITORY, write_rows

FOLDER = REPOSITORY / ".fuzz" / "mutants"

#: The exit code of cargo if a test fails, which differs from that of a failed build.
FAILED = 101


#: The time limit of a mutant's tests, in seconds; longer tests count as failed.
SECONDS = 600


class Mutant(NamedTuple):
    """A change of one line of the core, and the tests that must fail with it."""

    what: str
    file: str
    old: str
    new: str
    tests: tuple[str, ...]


MUTANTS = [
    Mutant(
        "lines that are equal decide a union, and lines that are opposite do not",
        "merge/residual.rs",
        "is_decided |= named[usize::from(!negate)];",
        "is_decided |= named[usize::from(negate)];",
        ("expressions",),
    ),
    Mutant(
        "all that change at a place own it",
        "merge/expression.rs",
        "        open &= !changes[line];\n",
        "        open &= u64::MAX;\n",
        ("expressions",),
    ),
    Mutant(
        "a triangle that a path crosses counts with the other sign",
        "geometry/winding/crossing.rs",
        "        return i32::from(-sign);\n",
        "        return i32::from(sign);\n",
        ("laws_solids",),
    ),
    Mutant(
        "points of regions that nothing winds around are inside",
        "query/classify.rs",
        "w if w > 0 => Location::Inside",
        "w if w >= 0 => Location::Inside",
        ("voxels",),
    ),
    Mutant(
        "even-odd is nonzero",
        "merge/rule.rs",
        "Self::EvenOdd => w % 2 != 0",
        "Self::EvenOdd => w != 0",
        ("voxels",),
    ),
    Mutant(
        "what absorbs an expression is turned around",
        "merge/residual.rs",
        "FoldedLine::Value(v) => is_decided |= v == absorbing,",
        "FoldedLine::Value(v) => is_decided |= v != absorbing,",
        ("expressions",),
    ),
    Mutant(
        "leaves are joined whatever the numbers at their corners",
        "merge/descent/join.rs",
        "if plus_corner != corner + change_along_edge(&faces, cell, cut) {",
        "if plus_corner == i32::MIN {",
        ("laws_solids", "leaves_of_different_winding_numbers_stay_apart"),
    ),
    Mutant(
        "faces in general position are never turned around",
        "merge/kernels/general/keep.rs",
        "let turned = outside != (self.weight < 0);",
        "let turned = self.weight < 0;",
        ("leaf_against_merge",),
    ),
    Mutant(
        "coplanar faces that face each other add up",
        "merge/kernels/trees/coverage.rs",
        "                -fragment.weight\n",
        "                fragment.weight\n",
        ("voxels",),
    ),
    Mutant(
        "mirrored snapshots keep their faces as they were",
        "store/snapshot.rs",
        "                face.swap(1, 2);\n",
        "                face.rotate_left(1);\n",
        ("laws_motions", "motions_of_the_lattice_carry_solids_exactly"),
    ),
    Mutant(
        "what is left over by a division does not decide ties",
        "arith/round.rs",
        "let sticky = !exact || any_bit_below(num, num_start);",
        "let sticky = !exact && any_bit_below(num, num_start);",
        ("arith",),
    ),
    Mutant(
        "corners of several fans count as one",
        "extract/contacts/mod.rs",
        "            _ => return false,\n",
        "            _ => return true,\n",
        ("voxels",),
    ),
]


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("numbers", nargs="*", type=int, help="from 1; by default all")
    parser.add_argument("--folder", type=Path, default=FOLDER, help="to build in")
    parser.add_argument("--record", action="store_true", help="keep the result in out/records")
    options = parser.parse_args()
    core = options.folder / "core"
    rows = []
    for number, mutant in enumerate(MUTANTS, 1):
        if options.numbers and number not in options.numbers:
            continue
        began = time.perf_counter()
        verdict = verdict_on(mutant, core)
        seconds = time.perf_counter() - began
        print(f"{number:3} {mutant.what:60} {verdict:10} {seconds:6.0f} s", flush=True)
        rows.append({"mutant": mutant.what, "tests": " ".join(mutant.tests), "verdict": verdict})
    if options.record:
        print(write_rows("mutants", rows, "mutant", [mutant.what for mutant in MUTANTS]))
    return int(any(row["verdict"] != "noticed" for row in rows))


def verdict_on(mutant: Mutant, core: Path) -> str:
    """Return "noticed" if a mutant's tests fail, "SURVIVED" if they pass.

    Return "not there" if the line to change is missing, "not built" if the build fails.
    """
    copy_core(core)
    path = core / "src" / mutant.file
    text = path.read_text("utf-8")
    if text.count(mutant.old) != 1:
        return "not there"
    path.write_text(text.replace(mutant.old, mutant.new))
    code = tested(mutant, core)
    return "noticed" if code == FAILED else "SURVIVED" if code == 0 else "not built"


def copy_core(core: Path) -> None:
    """Copy the workspace; unchanged files keep their time, so that cargo does not rebuild them."""
    members = [REPOSITORY / name for name in ("core", "fuzz", "lecture")]
    sources = [path for member in members for path in member.rglob("*") if _is_source(path)]
    for source in [REPOSITORY / "Cargo.toml", REPOSITORY / "Cargo.lock", *sources]:
        _copied(source, core.parent / source.relative_to(REPOSITORY))


def _is_source(path: Path) -> bool:
    return path.suffix in (".rs", ".toml") or ("kept" in path.parts and path.is_file())


def _copied(source: Path, target: Path) -> None:
    if not target.is_file() or target.read_bytes() != source.read_bytes():
        target.parent.mkdir(parents=True, exist_ok=True)
        shutil.copyfile(source, target)


def tested(mutant: Mutant, core: Path) -> int:
    """Return cargo's exit code of a mutant's tests; -1 if the build fails."""
    file, *names = mutant.tests
    cargo = ["cargo", "test", "--quiet", "--manifest-path", str(core / "Cargo.toml"), "--lib"]
    built = subprocess.run([*cargo, "--no-run"], capture_output=True, check=False)
    if built.returncode != 0:
        return -1
    try:
        path = "::".join(["tests", file, *names])
        done = subprocess.run([*cargo, path], capture_output=True, check=False, timeout=SECONDS)
    except subprocess.TimeoutExpired:
        return FAILED
    return done.returncode


if __name__ == "__main__":
    sys.exit(main())
