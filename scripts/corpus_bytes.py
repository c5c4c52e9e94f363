"""Print a hash for each result of the corpus, or compare the hashes with the recorded ones.

The same input must give the same bytes: a change that should not affect results leaves all hashes
equal. With folders of meshes, these are combined instead, and the hashes are printed for `diff`.
"""

import argparse
from pathlib import Path

from support.result_bytes import (
    RECORD,
    differences,
    recorded,
    words_of_cases,
    words_of_files,
    write,
)


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("folders", nargs="*", type=Path, help="of meshes to combine instead")
    parser.add_argument("--record", action="store_true", help=f"write {RECORD.name} anew")
    options = parser.parse_args()
    if options.folders:
        for folder in options.folders:
            for name, word in words_of_files(folder):
                print(f"{name}\t{word}", flush=True)
        return 0
    words = dict([*words_of_cases(), *words_of_files()])
    if options.record:
        write(words)
        return 0
    changed = differences(recorded(), words)
    print("\n".join(changed) or f"All {len(words)} results have the recorded bytes.")
    return 1 if changed else 0


if __name__ == "__main__":
    raise SystemExit(main())
