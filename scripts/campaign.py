"""Run the recorded campaign over real meshes: ``bspcsg crosscheck`` with settings.

    scripts/campaign [--meshes FOLDER] [--poses N] [--record] [options of bspcsg crosscheck]

Pairs of files are drawn in random and in coincident poses and combined by four operations; the
scripts in FOLDER's neighbour `csg` are compared with openscad. Cases that are in the results file
are not run again, so that an interrupted campaign continues.
"""

import argparse
import sys
from os.path import relpath
from pathlib import Path

from bspcsg.campaign.record import read_results
from bspcsg.campaign.summary import summary_of
from bspcsg.cli.main import run
from recording import REPOSITORY, write_record


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--meshes", type=Path, default=REPOSITORY.parent / "shared" / "meshes")
    parser.add_argument("--poses", type=int, default=520)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--max-triangles", type=int, default=2000)
    parser.add_argument("--results", type=Path, default=REPOSITORY / "out" / "campaign.jsonl")
    parser.add_argument("--record", action="store_true", help="keep the counts in out/records")
    options, more = parser.parse_known_args()
    options.results.parent.mkdir(parents=True, exist_ok=True)
    scripts = options.meshes.parent / "csg"
    settings = {
        "--poses": options.poses,
        "--seed": options.seed,
        "--max-triangles": options.max_triangles,
        "--results": relpath(options.results),
    }
    given = [str(word) for pair in settings.items() for word in pair]
    # Reports contain paths as given, so make them relative.
    folders = [relpath(folder) for folder in (options.meshes, scripts) if folder.is_dir()]
    code = run(["crosscheck", *folders, *given, "--resume", *more])
    if options.record:
        record(options.results, settings)
    return code


def record(results: Path, settings: dict[str, object]) -> None:
    """Record the counts of all cases in a results file."""
    found = read_results([results])
    asked = {name.lstrip("-"): value for name, value in settings.items() if name != "--results"}
    counts = summary_of(list(found.cases.values()))
    versions = found.runs[-1]["versions"]
    print(write_record("campaign", {"settings": asked, "versions": versions, **counts}))


if __name__ == "__main__":
    sys.exit(main())
