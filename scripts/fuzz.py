"""Run random tests for a given time; print each target's run time, executions and findings.

    scripts/fuzz [--minutes N] [--seed S] [TARGET ...]

Targets of the core (`fuzz/`) and of the readers are guided by coverage, with their corpora in
`.fuzz`; the targets scenes, sizes and files make random inputs in rounds. All continue where they
stopped. A scene with a wrong result is made small and put into `tests/corpus/cases`. The code is in
`tests/fuzzing`.
"""

import argparse
import importlib.util
import json
import os
import sys
import time
from pathlib import Path

from fuzzing.guided import CORE, Core, Readers
from fuzzing.outcome import Outcome
from fuzzing.rounds import Rounds

#: The folder of corpora, of findings, and of the numbers of the next rounds.
FOLDER = Path(__file__).resolve().parent.parent / ".fuzz"

TARGETS = [*CORE, "readers", "scenes", "sizes", "files"]


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("targets", nargs="*", metavar="TARGET", help=f"of {', '.join(TARGETS)}")
    parser.add_argument("--minutes", type=float, default=1.0, help="for each target")
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--folder", type=Path, default=FOLDER, help="for corpora and findings")
    options = parser.parse_args()
    targets = options.targets or TARGETS
    unknown = set(targets) - set(TARGETS)
    if unknown:
        parser.error(f"no such target: {', '.join(sorted(unknown))}")
    if "readers" in targets and importlib.util.find_spec("atheris") is None:
        parser.error("the target readers needs atheris: pip install atheris")
    os.nice(10)
    found = 0
    for name in targets:
        outcome = run(name, options)
        print(f"{name:9} {outcome.line()}", flush=True)
        for each in outcome.found[:5]:
            print(f"    {each.kind}: {each.what[:300]}\n        {each.place}")
        found += len(outcome.found)
    return int(found > 0)


def run(name: str, options: argparse.Namespace) -> Outcome:
    """Run one target, continuing where it stopped last, and return the outcome."""
    folder: Path = options.folder / name
    folder.mkdir(parents=True, exist_ok=True)
    state = folder / "state.json"
    before = json.loads(state.read_text("utf-8")) if state.is_file() else {}
    times = before.get(str(options.seed), 0)
    seconds = 60 * options.minutes
    if name in CORE or name == "readers":
        made = Core(name, options.folder) if name in CORE else Readers(options.folder)
        # A seed stands for a sequence of runs, each with its own seed. Building takes no test time.
        outcome = made.run(options.seed * 1000 + times, time.monotonic() + seconds)
        after = times + 1
    else:
        outcome, after = Rounds(name, options.seed).run(times, time.monotonic() + seconds)
    state.write_text(json.dumps({**before, str(options.seed): after}) + "\n")
    return outcome


if __name__ == "__main__":
    sys.exit(main())
