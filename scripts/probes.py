"""Runs the random probes and the measures of tests/support at full counts and prints what failed.

    scripts/probes [--rounds SHARE] [WORD ...]

Ends with status 1 if anything did. `--rounds 0.01` runs a hundredth of each; words choose those
whose names have one of them. `--record` keeps what earlier runs said of others.
"""

import argparse
import sys
import time
from collections.abc import Callable
from typing import Any, NamedTuple

from fuzz_record import cpu_hours
from recording import keep_rows
from support import measures, probes
from support.measures import Measured
from support.probes import Failure


class Probe(NamedTuple):
    """A probe or a measure with its full count."""

    what: str
    rounds: int
    run: Callable[[int], Measured]


def _of(probe: Callable[..., list[Failure]], *settings: int) -> Callable[[int], Measured]:
    """Return a measure without figures, of the number of rounds."""
    return lambda rounds: (probe(rounds, *settings), {})


def _on_the_wall(triangles: int) -> Measured:
    """Return the shares of proofs in the time that a writer waits for its file."""
    return measures.shares_of_proofs(triangles, turns=7, clock=time.perf_counter)


PROBES = [
    Probe("tetrahedra glued on a triangle", 20_000, _of(probes.glued_tetrahedra, 1)),
    Probe("(A & B) | (A - B) is A", 1000, _of(probes.parts_reunited, 2)),
    Probe("halves of a random cut re-united", 1000, _of(probes.halves_reunited, 3)),
    Probe("boxes turned together, union", 3000, _of(probes.boxes_turned_together, 4)),
    Probe("box minus its half, turned together", 3000, _of(probes.half_of_turned_box, 5)),
    Probe("nearly identical cubes", 2000, _of(probes.nearly_identical_cubes, 6)),
    Probe("chains of 8 turned cubes", 300, _of(probes.chains_of_cubes, 8, 7)),
    Probe("cubes at 1e12", 1, lambda _: (probes.cubes_at(1e12), {})),
    Probe("decimals meet", 1, lambda _: (probes.decimals_meet(), {})),
    Probe("points on half-spaces", 10_000, _of(probes.points_on_half_spaces, 8)),
    Probe("box & half-space is a tetrahedron", 1, lambda _: (probes.corner_of_a_box(), {})),
    Probe("crossings of nearly coincident parts", 10_000, measures.crossings),
    Probe("share of the proof in writing", 327_000, measures.shares_of_proofs),
    Probe("share of the proof in large files", 1_310_000, measures.shares_of_proofs),
    Probe("share of the proof on the wall clock", 327_000, _on_the_wall),
    Probe("share of the checks in reading", 327_000, measures.shares_of_checks),
    Probe("jobs through a forked pool", 1000, measures.jobs_through_forks),
    Probe("memory after small operations", 100_000, measures.growth),
    Probe("CPU hours of fuzzing on record", 1, lambda _: ([], cpu_hours())),
]


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("words", nargs="*", metavar="WORD", help="by default all")
    parser.add_argument("--rounds", type=float, default=1.0, help="share of the full counts")
    parser.add_argument("--record", action="store_true", help="keep the result in scripts/records")
    options = parser.parse_args()
    chosen = [
        probe
        for probe in PROBES
        if not options.words or any(word in probe.what for word in options.words)
    ]
    rows = [row_of(probe, max(1, round(probe.rounds * options.rounds))) for probe in chosen]
    if options.record:
        print(keep_rows("probes", rows, "probe", [probe.what for probe in PROBES]))
    return int(any(row["failed"] for row in rows))


def row_of(probe: Probe, rounds: int) -> dict[str, Any]:
    """Run a probe, print its line, and return its row of the record."""
    began = time.perf_counter()
    failed, figures = probe.run(rounds)
    seconds = time.perf_counter() - began
    print(
        f"{probe.what:38} {rounds:7d} rounds {len(failed):5d} failed {seconds:8.1f} s", flush=True
    )
    for name, figure in figures.items():
        print(f"    {name}: {figure}")
    for failure in failed[:3]:
        print(f"    round {failure.round}: {failure.what}")
    row = {
        "probe": probe.what,
        "rounds": rounds,
        "failed": len(failed),
        "seconds": round(seconds, 1),
    }
    return row | ({"figures": figures} if figures else {})


if __name__ == "__main__":
    sys.exit(main())
