"""The worker process that evaluates cases: it reads requests and writes answers as JSON lines.

The module `start_worker` starts it. When its input ends, because the runner has finished or was
killed, it kills its whole process group.
"""

import json
import os
import queue
import signal
import sys
import threading
from typing import Any

from ...errors import BspcsgError
from ...machine import limit_memory
from ...parameters import set_threads
from ...solid.solid import Solid
from ..cases.case import Case
from ..judging.evaluation import EvaluationSettings, blank_record, evaluate


def main() -> None:
    """Answer requests from standard input, one for each line, until the process is killed."""
    lines: queue.SimpleQueue[str] = queue.SimpleQueue()
    answers = os.fdopen(os.dup(1), "w", encoding="utf-8")
    # Send the output of libraries to stderr, so that stdout has only answers.
    os.dup2(2, 1)
    started = json.loads(sys.stdin.readline())
    os.chdir(started["folder"])
    limit_memory(started["memory"])
    set_threads(started["threads"])
    settings = EvaluationSettings(
        **{**started["settings"], "against": tuple(started["settings"]["against"])}
    )
    answers.write("ready\n")
    answers.flush()
    threading.Thread(target=_listen, args=(lines,), daemon=True).start()
    while True:
        answer = _answered(json.loads(lines.get()), settings)
        answers.write(json.dumps(answer) + "\n")
        answers.flush()


def _listen(lines: "queue.SimpleQueue[str]") -> None:
    for line in sys.stdin:
        lines.put(line)
    if os.name == "posix" and os.getpgrp() == os.getpid():
        os.killpg(0, signal.SIGKILL)
    os._exit(0)


def _answered(request: dict[str, Any], settings: EvaluationSettings) -> Any:
    if "survey" in request:
        return _surveyed(request["survey"])
    case = Case.from_dict(request["case"])
    try:
        record = evaluate(case, settings, request["keep"])
        json.dumps(record, allow_nan=False)
        return record
    except MemoryError:
        return blank_record(case, "crash", "out of memory")
    except Exception as error:
        return blank_record(case, "crash", f"{type(error).__name__}: {error}")


def _surveyed(file: str) -> dict[str, Any]:
    """Return a file's number of triangles, and the reason if it is no solid."""
    try:
        solid = Solid.load(file)
        return {"file": file, "triangles": len(solid.to_mesh().faces), "refused": None}
    except BspcsgError as error:
        return {"file": file, "triangles": 0, "refused": error.message}
