"""Runs the random probes of tests/support/probes.py at full counts and prints what failed.

Ends with status 1 if anything did. `--rounds 0.01` runs a hundredth of each.
"""

import argparse
import sys
import time
from collections.abc import Callable
from typing import NamedTuple

from recording import keep
from support import probes
from support.probes import Failure


class Probe(NamedTuple):
    """A probe with its full count."""

    what: str
    rounds: int
    run: Callable[[int], list[Failure]]


PROBES = [
    Probe("tetrahedra glued on a triangle", 20_000, lambda n: probes.glued_tetrahedra(n, 1)),
    Probe("(A & B) | (A - B) is A", 1000, lambda n: probes.parts_reunited(n, 2)),
    Probe("halves of a random cut re-united", 1000, lambda n: probes.halves_reunited(n, 3)),
    Probe("boxes turned together, union", 3000, lambda n: probes.boxes_turned_together(n, 4)),
    Probe("box minus its half, turned together", 3000, lambda n: probes.half_of_turned_box(n, 5)),
    Probe("nearly identical cubes", 2000, lambda n: probes.nearly_identical_cubes(n, 6)),
    Probe("chains of 8 turned cubes", 300, lambda n: probes.chains_of_cubes(n, 8, 7)),
    Probe("cubes at 1e12", 1, lambda _: probes.cubes_at(1e12)),
    Probe("decimals meet", 1, lambda _: probes.decimals_meet()),
]


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--rounds", type=float, default=1.0, help="share of the full counts")
    parser.add_argument("--record", action="store_true", help="keep the result in scripts/records")
    options = parser.parse_args()
    rows = []
    for probe in PROBES:
        rounds = max(1, round(probe.rounds * options.rounds))
        began = time.perf_counter()
        failed = probe.run(rounds)
        seconds = time.perf_counter() - began
        print(
            f"{probe.what:38} {rounds:6d} rounds {len(failed):5d} failed {seconds:8.1f} s",
            flush=True,
        )
        for failure in failed[:3]:
            print(f"    round {failure.round}: {failure.what}")
        rows.append(
            {
                "probe": probe.what,
                "rounds": rounds,
                "failed": len(failed),
                "seconds": round(seconds, 1),
            }
        )
    if options.record:
        print(keep("probes", {"probes": rows}))
    return int(any(row["failed"] for row in rows))


if __name__ == "__main__":
    sys.exit(main())
