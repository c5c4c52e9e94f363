"""Counts the instructions of some fixed cases and compares them with the recorded counts.

On a machine that is shared, times say little about a small change; counts repeat to within 0.1 %.
Needs valgrind. With --record the new counts are kept, with the machine and the compiler.

With --check the program that `cargo test` has built anyway is counted, and a count that is more
than 3 % from the recorded one fails, in either direction: what costs less has to be recorded, or
later losses hide in the gain. The exit code is 77 if the recorded counts are from elsewhere.
"""

import argparse
import json
import os
import platform
import re
import shutil
import subprocess
import sys
import tempfile
from collections.abc import Iterable
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path
from typing import Any

from recording import RECORDS, REPOSITORY, keep

#: The cases of core/examples/fixed_cases.rs, with what each is.
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

#: Cargo's options and folder of the build that is measured, and of the one that tests leave.
BUILDS = {"release": (["--release"], "release"), "dev": ([], "debug")}

#: Settings of scripts/check, so that its build serves.
_AS_CHECKED = {"CARGO_PROFILE_DEV_DEBUG": "line-tables-only", "CARGO_INCREMENTAL": "0"}

#: By how much two counts of the same program may differ; more is a change.
_NOISE = 0.001

#: The change that fails a check.
_BOUND = 0.03

#: What says that nothing could be compared, as automake's tests do.
SKIPPED = 77


def built(build: str) -> Path:
    """Build the program with the cases and return where it is."""
    options, folder = BUILDS[build]
    command = ["cargo", "build", *options, "--quiet", "--example", "fixed_cases"]
    subprocess.run(
        [*command, "--message-format=short"],
        cwd=REPOSITORY / "core",
        env=_AS_CHECKED | os.environ,
        check=True,
    )
    target = Path(os.environ.get("CARGO_TARGET_DIR", REPOSITORY / "core" / "target"))
    return target / folder / "examples" / "fixed_cases"


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


def all_counted(program: Path, cases: Iterable[str], before: dict[str, int]) -> dict[str, int]:
    """Count cases side by side and say each as soon as it and those before it are known."""
    names = list(cases)
    counts = {}
    with ThreadPoolExecutor(len(os.sched_getaffinity(0))) as pool:
        for case, count in zip(names, pool.map(lambda c: counted(program, c), names), strict=True):
            counts[case] = count
            print(line(case, count, before.get(case)), flush=True)
    return counts


def place() -> dict[str, str]:
    """Return what counts depend on beside the core."""
    done = subprocess.run(["rustc", "--version"], capture_output=True, text=True, check=True)
    return {"compiler": done.stdout.strip(), "instruction set": platform.machine()}


def recorded(build: str) -> dict[str, Any]:
    """Return what is kept of a build: its place and its counts, both empty if there are none."""
    path = RECORDS / f"{_NAME}.json"
    kept = json.loads(path.read_text("utf-8")).get("builds", {}) if path.exists() else {}
    found: dict[str, Any] = kept.get(build, {"place": {}, "counts": {}})
    return found


def line(case: str, count: int, before: int | None) -> str:
    """Say how a count compares with the recorded one."""
    text = f"{case:11} {count:>16,}"
    if not before:
        return f"{text}   (none recorded)"
    ratio = count / before
    word = "same" if abs(ratio - 1) <= _NOISE else "less" if ratio < 1 else "MORE"
    return f"{text}   {ratio:.4f} of {before:,}: {word}"


def changed(counts: dict[str, int], before: dict[str, int]) -> list[str]:
    """Return the cases whose counts are too far from the recorded ones, or not recorded."""
    return [
        case
        for case, count in counts.items()
        if not before.get(case) or abs(count / before[case] - 1) > _BOUND
    ]


def obstacle(kept: dict[str, Any]) -> str:
    """Return why counts cannot be compared with recorded ones, or nothing."""
    if shutil.which("valgrind") is None:
        return "valgrind is needed: apt-get install valgrind"
    here = place()
    others = [name for name in here if kept["place"].get(name) != here[name]]
    return "; ".join(
        f"recorded with the {name} {kept['place'].get(name)}, this is {here[name]}"
        for name in others
    )


def checked(cases: Iterable[str], program: Path | None) -> int:
    """Compare the counts of the program that tests leave, and return the exit code."""
    kept = recorded("dev")
    reason = obstacle(kept)
    if reason:
        print(f"instructions are not compared: {reason}")
        return SKIPPED
    found = changed(all_counted(program or built("dev"), cases, kept["counts"]), kept["counts"])
    if found:
        print(f"instructions: more than {_BOUND:.0%} from the recorded counts: {', '.join(found)}.")
        print("If that is meant, keep the new counts: scripts/instructions --record")
    return 1 if found else 0


def record(cases: Iterable[str]) -> None:
    """Count with both builds and keep the counts; those of other cases stay if all else is so."""
    here = place()
    builds = {}
    for build in BUILDS:
        kept = recorded(build)
        print(f"{build}:")
        counts = all_counted(built(build), cases, kept["counts"])
        before = kept["counts"] if kept["place"] == here else {}
        builds[build] = {"place": here, "counts": {**before, **counts}}
    print(keep(_NAME, {"cases": CASES, "builds": builds}))


def main(arguments: list[str] | None = None) -> int:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("cases", nargs="*", metavar="case", help=f"one of {', '.join(CASES)}")
    parser.add_argument("--program", type=Path, help="a built fixed_cases, instead of building it")
    parser.add_argument("--check", action="store_true", help="fail if a count has changed")
    parser.add_argument("--record", action="store_true", help="keep the counts of both builds")
    options = parser.parse_args(arguments)
    unknown = [case for case in options.cases if case not in CASES]
    if unknown:
        parser.error(f"no such case: {', '.join(unknown)}; there are {', '.join(CASES)}")
    cases = options.cases or list(CASES)
    if options.check:
        return checked(cases, options.program)
    if shutil.which("valgrind") is None:
        raise SystemExit("instructions: valgrind is needed: apt-get install valgrind")
    if options.record:
        record(cases)
    else:
        all_counted(options.program or built("release"), cases, recorded("release")["counts"])
    return 0


if __name__ == "__main__":
    sys.exit(main())
