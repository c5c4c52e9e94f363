"""Fuzz targets guided by coverage: libFuzzer for the core, atheris for the readers."""

import os
import re
import subprocess
import sys
import time
from pathlib import Path

from .outcome import CpuClock, Found, Outcome

REPOSITORY = Path(__file__).resolve().parents[2]

#: The targets in `fuzz/fuzz_targets`.
CORE = ("snapshot", "import", "program", "section", "evaluate", "extract")

#: The flags that make the compiler count edges and comparisons, on stable Rust: those of
#: `cargo fuzz --sanitizer none`.
FLAGS = [
    "-Cpasses=sancov-module",
    "-Cllvm-args=-sanitizer-coverage-level=4",
    "-Cllvm-args=-sanitizer-coverage-inline-8bit-counters",
    "-Cllvm-args=-sanitizer-coverage-pc-table",
    "-Cllvm-args=-sanitizer-coverage-trace-compares",
    "-Ccodegen-units=1",
    "--cfg=fuzzing",
]

#: One input may take this long, and this much memory.
SECONDS, MEGABYTES = 10, 2048

#: An input is stopped after this multiple of its time: it may have waited for the processor.
TIMEOUT_FACTOR = 10

#: The largest number of bytes of an input: longer inputs give no other scenes.
MAX_INPUT_BYTES = 2000

#: A run of a target ends after this many findings.
MAX_FINDINGS = 5

_COVERAGE = re.compile(r"cov: (\d+) ft:")
_COUNT = re.compile(r"stat::number_of_executed_units: (\d+)")
_WRITTEN = re.compile(r"Test unit written to (\S+)")
_PANIC = re.compile(r"panicked at (\S+?):\d+:\d+:\n(.*)")
_RAISED = re.compile(r"=== Uncaught Python exception: ===\n(.*)")


class Guided:
    """A program that takes the options of libFuzzer."""

    def __init__(self, name: str, command: list[str], folder: Path) -> None:
        self._command, self._folder = command, folder / name
        self._corpus, self._found = self._folder / "corpus", self._folder / "found"
        self._corpus.mkdir(parents=True, exist_ok=True)
        self._found.mkdir(exist_ok=True)

    def run(self, seed: int, until: float) -> Outcome:
        """Run until a time of the monotonic clock, restarting after each finding."""
        total, clock = Outcome(), CpuClock()
        ended = 0
        while ended < MAX_FINDINGS and until - time.monotonic() > 1:
            one = self._once(seed + 100 * ended, until)
            ended += 1
            total.executions += one.executions
            total.found += [each for each in one.found if not self._has_waited(each)]
            if one.coverage:
                first = total.coverage[0] if total.coverage else one.coverage[0]
                total.coverage = (first, one.coverage[1])
            if not one.found:
                break
        total.cpu_seconds = clock.seconds()
        return total

    def _has_waited(self, found: Found) -> bool:
        """Return true if an input was slow only because other programs used the processor."""
        if found.kind != "hang" or not found.place:
            return False
        clock = CpuClock()
        words = [*self._command, f"-timeout={100 * SECONDS}", found.place]
        subprocess.run(words, capture_output=True, check=False)
        return clock.seconds() < SECONDS

    def _slow(self) -> set[Path]:
        """Return the paths of inputs that were slow but finished."""
        return set(self._found.glob("slow-unit-*"))

    def _once(self, seed: int, until: float) -> Outcome:
        most, slow = max(1, round(until - time.monotonic())), self._slow()
        options = {
            "seed": seed % 2**31,
            "max_total_time": most,
            "max_len": MAX_INPUT_BYTES,
            "len_control": 0,
            "timeout": TIMEOUT_FACTOR * SECONDS,
            "report_slow_units": SECONDS,
            "rss_limit_mb": MEGABYTES,
            "print_final_stats": 1,
            "artifact_prefix": f"{self._found}/",
        }
        words = [f"-{name}={value}" for name, value in options.items()]
        try:
            done = subprocess.run(
                [*self._command, *words, str(self._corpus)],
                stdout=subprocess.DEVNULL,
                stderr=subprocess.PIPE,
                env={**os.environ, "RUST_BACKTRACE": "0"},
                timeout=most + 2 * TIMEOUT_FACTOR * SECONDS,
                check=False,
            )
        except subprocess.TimeoutExpired as late:
            # What interrupts an input may itself wait for ever, for memory that the input held.
            outcome = outcome_of(_text(late.stderr), 0)
            outcome.found.append(Found("hang", "stopped from outside; its input is lost", ""))
        else:
            outcome = outcome_of(_text(done.stderr), done.returncode)
        late_ones = sorted(self._slow() - slow)
        outcome.found += [Found("hang", f"more than {SECONDS} s", str(one)) for one in late_ones]
        return outcome


class Core(Guided):
    """A fuzz target of the core, built on first use."""

    def __init__(self, name: str, folder: Path) -> None:
        super().__init__(name, [str(built(folder) / name)], folder)
        if not any(self._corpus.iterdir()):
            asked = {**os.environ, "BSPCSG_FUZZ_SEEDS": str(self._corpus)}
            subprocess.run(self._command, env=asked, check=True, capture_output=True)


class Readers(Guided):
    """The fuzz target of all readers of files in Python; needs atheris."""

    def __init__(self, folder: Path) -> None:
        super().__init__("readers", [sys.executable, "-m", "fuzzing.readers"], folder)
        if not any(self._corpus.iterdir()):
            words = [*self._command, "--seeds", str(self._corpus)]
            subprocess.run(words, check=True, capture_output=True)


def built(folder: Path) -> Path:
    """Build the fuzz targets of the core, and return their folder."""
    version = subprocess.run(["rustc", "-vV"], capture_output=True, text=True, check=True).stdout
    host = next(line[6:] for line in version.splitlines() if line.startswith("host: "))
    target = folder / "target"
    # With `--target` what runs while building is not instrumented.
    words = ["--quiet", "--profile", "fuzz", "--target", host, "--target-dir", str(target)]
    subprocess.run(
        ["cargo", "build", "-p", "bspcsg-fuzz", "--features", "run", "--bins", *words],
        cwd=REPOSITORY,
        env={**os.environ, "RUSTFLAGS": " ".join(FLAGS)},
        check=True,
    )
    return target / host / "fuzz"


def _text(said: bytes | None) -> str:
    return (said or b"").decode(errors="replace")


def outcome_of(said: str, code: int) -> Outcome:
    """Return the outcome of a run of libFuzzer, from its output and exit code."""
    reached = [int(number) for number in _COVERAGE.findall(said)]
    count = _COUNT.search(said)
    outcome = Outcome(int(count[1]) if count else 0)
    outcome.coverage = (reached[0], reached[-1]) if reached else None
    if code != 0:
        written = _WRITTEN.search(said)
        kind, what = _finding(said)
        outcome.found.append(Found(kind, what, written[1] if written else ""))
    return outcome


def _finding(said: str) -> tuple[str, str]:
    """Return the kind of the finding that ended a run, and its message."""
    if "libFuzzer: timeout" in said:
        return "hang", f"more than {SECONDS} s"
    if "out-of-memory" in said:
        return "memory", f"more than {MEGABYTES} MB"
    panic, raised = _PANIC.search(said), _RAISED.search(said)
    if panic:
        # Paths of the targets are relative to their crate: what they assert is about answers.
        return "wrong" if panic[1].startswith("src/") else "crash", panic[2]
    if raised:
        return "wrong" if "AssertionError" in raised[1] else "crash", raised[1]
    return "crash", said[-300:]
