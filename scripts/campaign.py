"""Runs set operations over a folder of real meshes and prints counts by verdict.

First every file is loaded; then pairs of those that loaded are combined in random and in coincident
poses by four operations. Each result must be closed, accepted by manifold3d and trimesh, add up in
exact volume, and agree with manifold3d as a set. Each case runs in a child process that is killed
at the time limit. Answers go to a file of JSON lines; a case that is answered there is not run
again, so an interrupted campaign goes on where it stopped.
"""

import argparse
import json
import os
import queue
import select
import subprocess
import sys
import threading
from collections import Counter
from pathlib import Path
from typing import Any

import numpy as np

from recording import REPOSITORY, keep

FORMATS = {".stl", ".obj", ".ply", ".off", ".3mf"}
COINCIDENT = ("corner", "beside", "copy", "mirror", "turned", "same")
BAD = ("crash", "timeout", "defect")

Case = dict[str, Any]


class Worker:
    """A child process that answers cases one by one, restarted when it dies."""

    def __init__(self) -> None:
        self._child: subprocess.Popen[str] | None = None

    def answer(self, case: Case, seconds: float) -> Case:
        """Return the case with its answer, or with what became of the process."""
        child = self._running()
        assert child.stdin and child.stdout
        child.stdin.write(json.dumps(case) + "\n")
        child.stdin.flush()
        ready, _, _ = select.select([child.stdout], [], [], seconds)
        if not ready:
            self.stop()
            return {**case, "verdict": "timeout", "seconds": seconds}
        line = child.stdout.readline()
        if not line:
            code = child.wait()
            self.stop()
            return {**case, "verdict": "crash", "says": f"process ended with {code}"}
        answer: Case = json.loads(line)
        return answer

    def _running(self) -> "subprocess.Popen[str]":
        if self._child is None:
            program = str(Path(__file__).with_name("campaign_case.py"))
            self._child = subprocess.Popen(
                [sys.executable, program],
                stdin=subprocess.PIPE,
                stdout=subprocess.PIPE,
                stderr=subprocess.DEVNULL,
                text=True,
            )
        return self._child

    def stop(self) -> None:
        """End the child process."""
        if self._child is not None:
            self._child.kill()
            self._child.communicate()
            self._child = None


class Campaign:
    """The journal of answers and the pool that extends it."""

    def __init__(self, journal: Path, jobs: int, limit: float, again: bool) -> None:
        self.journal, self.jobs, self.limit = journal, jobs, limit
        journal.parent.mkdir(parents=True, exist_ok=True)
        lines = journal.read_text().splitlines() if journal.exists() else []
        answers = {case["key"]: case for case in map(json.loads, lines)}
        kept = {key: case for key, case in answers.items() if not (again and faults_of(case))}
        self.answers: dict[str, Case] = kept
        self._lock = threading.Lock()

    def run(self, cases: list[Case]) -> list[Case]:
        """Answer what is not answered yet, and return all answers in the order of the cases."""
        waiting: queue.SimpleQueue[Case] = queue.SimpleQueue()
        for case in cases:
            if case["key"] not in self.answers:
                waiting.put(case)
        total = waiting.qsize()
        threads = [
            threading.Thread(target=self._work, args=(waiting, total)) for _ in range(self.jobs)
        ]
        for thread in threads:
            thread.start()
        for thread in threads:
            thread.join()
        return [self.answers[case["key"]] for case in cases]

    def _work(self, waiting: "queue.SimpleQueue[Case]", total: int) -> None:
        worker = Worker()
        try:
            while True:
                answer = worker.answer(waiting.get_nowait(), self.limit)
                self._note(answer, total - waiting.qsize(), total)
        except queue.Empty:
            return
        finally:
            worker.stop()

    def _note(self, answer: Case, done: int, total: int) -> None:
        with self._lock:
            self.answers[answer["key"]] = answer
            with self.journal.open("a") as journal:
                journal.write(json.dumps(answer) + "\n")
            if problems := faults_of(answer):
                print(f"[{done}/{total}] {answer['key']}: {'; '.join(problems)}", flush=True)


def faults_of(answer: Case) -> list[str]:
    """Return everything about an answer that must not be."""
    if answer["verdict"] in BAD:
        return [f"{answer['verdict']} {answer.get('says', '')}".strip()]
    if answer["verdict"] == "refused":
        if answer["kind"] == "pair":
            return [f"refused: {answer['says']}"]
        silent = answer["code"] == "not_closed" and not answer["where"]
        return ["refused without saying where"] if silent else []
    faults = list(answer["faults"])
    for name, operation in answer.get("operations", {}).items():
        faults += [f"{name}: {fault}" for fault in operation["faults"]]
        if is_disagreement(operation["verdict"]):
            faults.append(f"{name}: {operation['verdict']}: {operation['reason']}")
    return faults


def is_disagreement(verdict: str) -> bool:
    """Whether a verdict speaks against the result."""
    return verdict in ("DISAGREE", "subject failed")


def file_cases(folder: Path) -> list[Case]:
    """Return one case for each mesh file."""
    files = sorted(path for path in folder.rglob("*") if path.suffix.lower() in FORMATS)
    names = [str(path.relative_to(folder)) for path in files]
    return [
        {"key": f"file {name}", "kind": "file", "folder": str(folder), "file": name}
        for name in names
    ]


def pair_cases(folder: Path, names: list[str], count: int, seed: int, check: bool) -> list[Case]:
    """Draw pairs and poses, half of them random and half coincident."""
    cases = []
    for number in range(count):
        rng = np.random.default_rng([seed, number, 1])
        first, second = (names[int(k)] for k in rng.integers(len(names), size=2))
        pose = "random" if number % 2 == 0 else COINCIDENT[int(rng.integers(len(COINCIDENT)))]
        key = f"pair {seed}/{number} {pose} {first} {second}"
        names_of = {"first": first, "second": second, "pose": pose}
        place = {"kind": "pair", "folder": str(folder), "seed": seed, "number": number}
        cases.append({"key": key, "check": check, **place, **names_of})
    return cases


def summary(files: list[Case], pairs: list[Case]) -> dict[str, Any]:
    """Count everything by verdict."""
    operations = [
        (name, operation)
        for case in pairs
        for name, operation in case.get("operations", {}).items()
    ]
    faulty = [case for case in [*files, *pairs] if faults_of(case)]
    return {
        "files": dict(Counter(case["verdict"] for case in files)),
        "refused_as": dict(Counter(case["code"] for case in files if case["verdict"] == "refused")),
        "pairs": dict(Counter(case["verdict"] for case in pairs)),
        "poses": dict(Counter(case["pose"] for case in pairs)),
        "operations": {
            kind: dict(
                Counter(operation["verdict"] for name, operation in operations if name == kind)
            )
            for kind in ("union", "intersection", "difference", "xor")
        },
        "results": len(operations),
        "not_sound": sum(bool(operation["faults"]) for _, operation in operations),
        "volumes_do_not_add_up": sum(bool(case.get("faults")) for case in pairs),
        "faulty_cases": {case["key"]: faults_of(case) for case in faulty},
    }


def show(counts: dict[str, Any]) -> None:
    """Print the counts for a person."""
    print("files     ", ", ".join(f"{n} {name}" for name, n in counts["files"].items()))
    print("  refused:", ", ".join(f"{n} {name}" for name, n in counts["refused_as"].items()))
    print("pairs     ", ", ".join(f"{n} {name}" for name, n in counts["pairs"].items()))
    for kind, verdicts in counts["operations"].items():
        print(f"  {kind:13}", ", ".join(f"{n} {name}" for name, n in sorted(verdicts.items())))
    print(f"results not sound: {counts['not_sound']} of {counts['results']}")
    print(f"pairs whose exact volumes do not add up: {counts['volumes_do_not_add_up']}")
    print(f"cases with a fault: {len(counts['faulty_cases'])}")
    for key, faults in list(counts["faulty_cases"].items())[:40]:
        print(f"  {key}: {'; '.join(faults)}")


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--meshes", type=Path, default=REPOSITORY.parent / "shared" / "meshes")
    parser.add_argument("--pairs", type=int, default=500)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("-j", "--jobs", type=int, default=os.cpu_count() or 1)
    parser.add_argument("--timeout", type=float, default=300, help="seconds for one case")
    parser.add_argument("--max-faces", type=int, default=100_000, help="of a mesh in a pair")
    parser.add_argument("--results", type=Path, default=REPOSITORY / "out" / "campaign.jsonl")
    parser.add_argument("--again", action="store_true", help="run cases with faults again")
    parser.add_argument(
        "--check",
        action=argparse.BooleanOptionalAction,
        default=True,
        help="compare with manifold3d, which takes most of the time",
    )
    parser.add_argument("--record", action="store_true", help="keep the counts in scripts/records")
    options = parser.parse_args()
    folder = options.meshes.resolve()
    campaign = Campaign(options.results, options.jobs, options.timeout, options.again)
    files = campaign.run(file_cases(folder))
    usable = [
        case["file"]
        for case in files
        if case["verdict"] == "loaded" and 0 < case["triangles"] <= options.max_faces
    ]
    drawn = pair_cases(folder, usable, options.pairs, options.seed, options.check) if usable else []
    pairs = campaign.run(drawn)
    counts = summary(files, pairs)
    show(counts)
    if options.record:
        print(keep("campaign", {"seed": options.seed, "timeout": options.timeout, **counts}))
    return int(bool(counts["faulty_cases"]))


if __name__ == "__main__":
    sys.exit(main())
