"""Fuzz all readers of files with atheris, which follows the branches of the package's Python.

An input is a byte that chooses the format, then the file; most changes respect the structure of the
format. `--seeds FOLDER` writes valid files as first inputs.
"""

import sys
import tempfile
from pathlib import Path

import atheris  # type: ignore[import-untyped]
import numpy as np

with atheris.instrument_imports(include=["bspcsg"]):
    from fuzzing import files
    from fuzzing.files import FORMATS, File

#: Good files of each format to start from.
SEEDS = 5


def one(data: bytes, folder: Path) -> None:
    """Read one input, and assert that the outcome is correct."""
    if data:
        wrong = files.judge_file(File(FORMATS[data[0] % len(FORMATS)], data[1:]), folder)
        assert not wrong, wrong


def changed(data: bytes, max_size: int, seed: int) -> bytes:
    """Return a changed input: by a change for its format, or by libFuzzer's."""
    rng = np.random.default_rng(seed)
    if not data or rng.random() < 0.4:
        found: bytes = atheris.Mutate(data, max_size)
        return found
    kind = FORMATS[data[0] % len(FORMATS)]
    return data[:1] + files.damaged(rng, kind, data[1:])[: max_size - 1]


def main() -> None:
    if sys.argv[1:2] == ["--seeds"]:
        for number, kind in enumerate(FORMATS):
            for k in range(SEEDS):
                good = files.good_file(np.random.default_rng([k, number]), kind)
                path = Path(sys.argv[2]) / f"seed-{number:02}-{k}"
                path.write_bytes(bytes([number]) + good.data)
        return
    with tempfile.TemporaryDirectory() as folder:
        words = atheris.Setup(
            sys.argv, lambda data: one(data, Path(folder)), custom_mutator=changed
        )
        assert words
        atheris.Fuzz()


if __name__ == "__main__":
    main()
