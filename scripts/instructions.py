"""Counts the instructions of some fixed cases and compares them with the recorded counts.

On a machine that is shared, times say little about a small change; counts repeat to within 0.1 %.
Needs valgrind. With --record the new counts are kept, with the machine and the compiler.
"""

import argparse
import json
import os
import re
import shutil
import subprocess
import sys
import tempfile
from pathlib import Path

from recording import RECORDS, REPOSITORY, keep

#: The cases of core/examples/fixed_cases.rs, with what each is.
CASES = {
    "pair": "difference of two spheres of 81 920 triangles, arrays to arrays",
    "small": "the same of two spheres of 320 triangles, warm",
    "cubes": "union of two cubes of 12 triangles, arrays to arrays, warm",
    "chain": "cube minus 200 spheres of 80 triangles, the volume read after each step",
    "expression": "union of 64 boxes in one expression",
    "rays": "first hits of 65 536 rays at a sphere of 81 920 triangles, its boxes made on the way",
    "visits": "4 096 rays in a tree over 1 280 triangles that grows on the way",
}

_NAME = "instructions"

#: By how much two counts of the same program may differ; more is a change.
_NOISE = 0.001


def built() -> Path:
    """Build the program with the cases and return where it is."""
    command = ["cargo", "build", "--release", "--quiet", "--example", "fixed_cases"]
    subprocess.run([*command, "--message-format=short"], cwd=REPOSITORY / "core", check=True)
    target = Path(os.environ.get("CARGO_TARGET_DIR", REPOSITORY / "core" / "target"))
    return target / "release" / "examples" / "fixed_cases"


def counted(program: Path, case: str) -> int:
    """Return how many instructions the case takes, without the making of its meshes."""
    with tempfile.TemporaryDirectory() as folder:
        output = Path(folder) / "callgrind.out"
        options = ["--tool=callgrind", "--collect-atstart=no", "--toggle-collect=*measured*"]
        command = ["valgrind", *options, f"--callgrind-out-file={output}", str(program), case]
        done = subprocess.run(command, capture_output=True, text=True, check=False)
        if done.returncode != 0:
            raise SystemExit(f"{case}: {done.stderr.strip() or f'code {done.returncode}'}")
        return int(
            re.findall(r"^(?:summary|totals): (\d+)", output.read_text("utf-8"), re.MULTILINE)[-1]
        )


def compiler() -> str:
    done = subprocess.run(["rustc", "--version"], capture_output=True, text=True, check=True)
    return done.stdout.strip()


def recorded() -> dict[str, int]:
    """Return the counts that are kept, none if there are none."""
    path = RECORDS / f"{_NAME}.json"
    counts: dict[str, int] = json.loads(path.read_text("utf-8"))["counts"] if path.exists() else {}
    return counts


def line(case: str, count: int, before: int | None) -> str:
    """Say how a count compares with the recorded one."""
    text = f"{case:11} {count:>16,}"
    if not before:
        return f"{text}   (none recorded)"
    ratio = count / before
    word = "same" if abs(ratio - 1) <= _NOISE else "less" if ratio < 1 else "MORE"
    return f"{text}   {ratio:.4f} of {before:,}: {word}"


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("cases", nargs="*", metavar="case", help=f"one of {', '.join(CASES)}")
    parser.add_argument("--program", type=Path, help="a built fixed_cases, instead of building it")
    parser.add_argument("--record", action="store_true", help="keep the counts")
    options = parser.parse_args()
    unknown = [case for case in options.cases if case not in CASES]
    if unknown:
        parser.error(f"no such case: {', '.join(unknown)}; there are {', '.join(CASES)}")
    if shutil.which("valgrind") is None:
        raise SystemExit("instructions: valgrind is needed: apt-get install valgrind")
    program = options.program or built()
    before = recorded()
    counts = {}
    for case in options.cases or CASES:
        counts[case] = counted(program, case)
        print(line(case, counts[case], before.get(case)), flush=True)
    if options.record:
        print(keep(_NAME, {"compiler": compiler(), "cases": CASES, "counts": {**before, **counts}}))
    return 0


if __name__ == "__main__":
    sys.exit(main())
