"""Count the instructions of fixed cases and compare them with the recorded counts.

On a shared machine, times are too noisy to show a small change; counts repeat to within 0.1 %.
The program is built as users get the core, in one unit: across the many units of development
builds, functions are not inlined, so that a small change may count as another one there.
Needs valgrind. With --record the new counts are recorded, with the machine and the compiler.
"""

import argparse
import json
import os
import platform
import re
import shutil
import subprocess
import tempfile
import tomllib
from collections.abc import Iterable
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path
from typing import Any

from recording import RECORDS, REPOSITORY, write_record

#: The cases of core/examples/fixed_cases.rs, with a description of each.
CASES = {
    "pair": "difference of two spheres of 81 920 triangles, arrays to arrays",
    "small": "the same of two spheres of 320 triangles, warm",
    "cubes": "union of two cubes of 12 triangles, arrays to arrays, warm",
    "built": "difference of two spheres of 81 920 triangles, operands already built",
    "needles": "difference of two bundles of 40 needles, one a step further along them",
    "overlap": "one mesh of 30 spheres of 80 triangles that overlap, reduced",
    "chain": "cube minus 200 spheres of 80 triangles, the volume read after each step",
    "holes": "plate minus 64 boxes through it, the volume read after each step",
    "expression": "union of 64 boxes in one expression",
    "crowd": "union of 24 icosahedra at nearly one place",
    "rays": "first hits of 65 536 rays at a sphere of 81 920 triangles, its boxes made on the way",
    "visits": "4 096 rays in a tree over 1 280 triangles that grows on the way",
}

_NAME = "instructions"

#: The largest relative difference between two counts of the same program.
_NOISE = 0.001


def users_profile() -> dict[str, Any]:
    """Return the settings of the build that users install."""
    workspace = tomllib.loads((REPOSITORY / "Cargo.toml").read_text("utf-8"))
    return dict(workspace["profile"]["release"])


def built_program() -> Path:
    """Build the program with the cases as users get the core, and return its path.

    Settings in the environment, as for development, would replace those of the profile.
    """
    settings = ("CARGO_PROFILE_", "CARGO_INCREMENTAL", "CARGO_ENCODED_RUSTFLAGS", "RUSTFLAGS")
    left = {name: value for name, value in os.environ.items() if not name.startswith(settings)}
    command = ["cargo", "build", "--release", "--quiet", "-p", "bspcsg", "--example", "fixed_cases"]
    subprocess.run(command, cwd=REPOSITORY, env=left, check=True)
    target = Path(os.environ.get("CARGO_TARGET_DIR", REPOSITORY / "target"))
    return target / "release" / "examples" / "fixed_cases"


def instruction_count(program: Path, case: str) -> int:
    """Return the number of instructions of a case, without making its meshes."""
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


def all_counted(program: Path, cases: Iterable[str], before: dict[str, int]) -> dict[str, int]:
    """Count all cases in parallel, print each in order, and return the counts."""
    names = list(cases)
    counts = {}
    with ThreadPoolExecutor(len(os.sched_getaffinity(0))) as pool:
        for case, count in zip(
            names, pool.map(lambda c: instruction_count(program, c), names), strict=True
        ):
            counts[case] = count
            print(line(case, count, before.get(case)), flush=True)
    return counts


def compiler_and_machine() -> dict[str, Any]:
    """Return the compiler, its settings and the instruction set, on which counts depend."""
    done = subprocess.run(["rustc", "--version"], capture_output=True, text=True, check=True)
    found = {"compiler": done.stdout.strip(), "instruction set": platform.machine()}
    return {**found, "profile": users_profile()}


def recorded_counts() -> dict[str, int]:
    """Return the recorded counts, or none for another compiler, build or instruction set."""
    path = RECORDS / f"{_NAME}.json"
    kept: dict[str, Any] = json.loads(path.read_text("utf-8")) if path.exists() else {}
    return dict(kept["counts"]) if kept.get("place") == compiler_and_machine() else {}


def line(case: str, count: int, before: int | None) -> str:
    """Return a line of text that compares a count with the recorded one."""
    text = f"{case:11} {count:>16,}"
    if not before:
        return f"{text}   (none recorded)"
    ratio = count / before
    word = "same" if abs(ratio - 1) <= _NOISE else "less" if ratio < 1 else "MORE"
    return f"{text}   {ratio:.4f} of {before:,}: {word}"


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("cases", nargs="*", metavar="case", help=f"one of {', '.join(CASES)}")
    parser.add_argument("--program", type=Path, help="a built fixed_cases, instead of building it")
    parser.add_argument("--record", action="store_true", help="keep the counts")
    options = parser.parse_args()
    unknown = [case for case in options.cases if case not in CASES]
    if unknown:
        parser.error(f"no such case: {', '.join(unknown)}; there are {', '.join(CASES)}")
    if options.record and options.program:
        parser.error("--record counts what users install; leave out --program")
    if shutil.which("valgrind") is None:
        raise SystemExit("instructions: valgrind is needed: apt-get install valgrind")
    before = recorded_counts()
    counts = all_counted(options.program or built_program(), options.cases or CASES, before)
    if options.record:
        result = {"place": compiler_and_machine(), "cases": CASES, "counts": {**before, **counts}}
        print(write_record(_NAME, result))


if __name__ == "__main__":
    main()
