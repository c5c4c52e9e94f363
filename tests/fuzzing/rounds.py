"""Fuzz targets in rounds, in a process of their own: round k is seeded with (seed, k).

As a program it runs rounds, and prints a line of JSON when a round begins and when it found
something wrong.
"""

import argparse
import json
import resource
import signal
import subprocess
import sys
import tempfile
import time
from pathlib import Path
from typing import Any

import numpy as np

from .outcome import CpuClock, Found, Outcome

#: A round may take this long, and the process this much memory.
SECONDS, MEGABYTES = 10, 4096

#: A round of large operands: some twenty calls, each of which may take as long as another round.
LARGE_SECONDS = 60

#: The folder of cases that must be answered.
CASES = Path(__file__).resolve().parents[1] / "corpus" / "cases"

#: A run of a target ends after this many findings.
MAX_FINDINGS = 20


class Rounds:
    """A fuzz target in rounds, run by child processes."""

    def __init__(self, name: str, seed: int) -> None:
        self._name, self._seed = name, seed

    def run(self, first: int, until: float) -> tuple[Outcome, int]:
        """Run rounds until a time of the monotonic clock; return the outcome and the next round."""
        outcome, clock, at = Outcome(), CpuClock(), first
        while len(outcome.found) < MAX_FINDINGS and until - time.monotonic() > 1:
            at, ended = self._rounds(at, until, outcome)
            if not ended:
                break
        outcome.executions, outcome.cpu_seconds = at - first, clock.seconds()
        return outcome, at

    def _rounds(self, first: int, until: float, outcome: Outcome) -> tuple[int, bool]:
        """Run one child process; return the next round, and true if a round ended the process."""
        seconds = str(until - time.monotonic())
        words = [self._name, "--seed", str(self._seed), "--first", str(first), "--seconds", seconds]
        command = [sys.executable, "-m", "fuzzing.rounds", *words]
        at = first
        with (
            tempfile.TemporaryFile("w+") as told,
            subprocess.Popen(command, stdout=subprocess.PIPE, stderr=told, text=True) as child,
        ):
            assert child.stdout is not None
            for line in child.stdout:
                said = json.loads(line)
                at = said["round"]
                outcome.found += [Found("wrong", what, said["place"]) for what in said["wrong"]]
            code = child.wait()
            if code == 0:
                return at, False
            told.seek(0)
            place = f"round {at} of seed {self._seed}"
            hang = -code == signal.SIGPROF
            what = (
                f"more than {_limit(self._name)} s"
                if hang
                else told.read()[-300:] or f"ended by {-code}"
            )
            outcome.found.append(Found("hang" if hang else "crash", what, place))
            return at + 1, True


def _limit(name: str) -> int:
    return LARGE_SECONDS if name == "sizes" else SECONDS


def rounds(name: str, seed: int, first: int, until: float) -> None:
    """Run rounds in this process, and print a line for each."""
    resource.setrlimit(resource.RLIMIT_AS, (MEGABYTES << 20, MEGABYTES << 20))
    judge = {"scenes": one_scene, "sizes": one_size, "files": one_file}[name]
    at = first
    while time.monotonic() < until:
        tell(at, [], "")
        # From now on: a limit of the whole process counts ticks, which drift from the time used.
        signal.setitimer(signal.ITIMER_PROF, _limit(name))
        wrong, place = judge(seed, at)
        if wrong:
            tell(at, wrong, place)
        at += 1
    tell(at, [], "")


def tell(at: int, wrong: list[str], place: str) -> None:
    """Print a line of JSON: the round, what was wrong, and the path of the input."""
    print(json.dumps({"round": at, "wrong": wrong[:1], "place": place}), flush=True)  # noqa: T201 (the parent reads it)


def one_scene(seed: int, at: int) -> tuple[list[str], str]:
    """Judge a random scene; make a wrong one small and store it as a case."""
    from .judge import judge
    from .scenes import random_scene
    from .shrink import keep_case, shrunk

    scene = random_scene(np.random.default_rng([seed, at]))
    wrong = judge(scene)
    if not wrong:
        return [], ""
    # Making it small takes as long as it takes.
    signal.setitimer(signal.ITIMER_PROF, 0)
    why = f"Round {at} of scripts/fuzz scenes, seed {seed}: {wrong[0].split(':')[0]}."
    return wrong, str(keep_case(CASES, f"scene_{seed}_{at}", shrunk(scene, judge), why))


def one_size(seed: int, at: int) -> tuple[list[str], str]:
    """Judge a random scene with large operands; it is named by its round, too large to store."""
    from .sizes import judge_sized, sized_scene

    wrong = judge_sized(sized_scene(np.random.default_rng([seed, at])))
    return wrong, f"round {at} of seed {seed}"


def one_file(seed: int, at: int) -> tuple[list[str], str]:
    """Judge a random file; the format depends on the number of the round."""
    from .files import FORMATS, judge_file, random_file

    rng: Any = np.random.default_rng([seed, at])
    with tempfile.TemporaryDirectory() as folder:
        file = random_file(rng, FORMATS[at % len(FORMATS)])
        return judge_file(file, Path(folder)), f"round {at} of seed {seed}: {file.format}"


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("name", choices=["scenes", "sizes", "files"])
    parser.add_argument("--seed", type=int, required=True)
    parser.add_argument("--first", type=int, required=True)
    parser.add_argument("--seconds", type=float, required=True)
    options = parser.parse_args()
    rounds(options.name, options.seed, options.first, time.monotonic() + options.seconds)


if __name__ == "__main__":
    main()
