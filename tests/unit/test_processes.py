"""Processes that fork after they have used the library; `support.processes` has the programs."""

import os
import subprocess
import sys
from pathlib import Path

import pytest

REPOSITORY = Path(__file__).resolve().parents[2]

unix = pytest.mark.skipif(not hasattr(os, "fork"), reason="there is no fork here")
linux = pytest.mark.skipif(not Path("/proc/self/task").is_dir(), reason="there is no /proc here")


def ran(name: str, folder: Path, patience: float = 100, **environment: str) -> tuple[str, str]:
    """Run a program in a folder, assert that it ends with 0, and return both streams."""
    path = os.pathsep.join([str(REPOSITORY), str(REPOSITORY / "tests")])
    ended = subprocess.run(
        [sys.executable, "-m", "support.processes", *name.split()],
        cwd=folder,
        env={**os.environ, "PYTHONPATH": path, **environment},
        capture_output=True,
        text=True,
        timeout=patience,
        check=False,
    )
    assert ended.returncode == 0, ended.stderr
    return ended.stdout, ended.stderr


# Found: a process that was forked after it had used the package waited for ever.
@unix
@pytest.mark.sampled(2)
@pytest.mark.parametrize("name", ["fork", "preload", "with-fork", "with-forkserver"])
def test_a_process_forks_after_use(name: str, tmp_path: Path) -> None:
    ran(name, tmp_path)


# Found: a program that ended while a daemon thread was in the core was aborted.
@pytest.mark.parametrize("after", [50, 200, 400])
def test_a_program_ends_while_threads_are_in_the_core(after: int, tmp_path: Path) -> None:
    ran(f"ending {after}", tmp_path)


@unix
def test_one_thread_is_a_pool_too(tmp_path: Path) -> None:
    ran("fork", tmp_path, RAYON_NUM_THREADS="1")


@linux
def test_threads_are_started_where_many_faces_meet(tmp_path: Path) -> None:
    ran("crowd", tmp_path, RAYON_NUM_THREADS="2")


@pytest.mark.sampled(2)
@pytest.mark.parametrize("name", ["with-spawn", "joblib"])
def test_solids_go_to_new_processes_and_come_back(name: str, tmp_path: Path) -> None:
    ran(name, tmp_path)


@unix
def test_another_thread_works_while_the_process_forks(tmp_path: Path) -> None:
    ran("busy", tmp_path)


@unix
def test_what_a_lost_thread_was_changing_is_refused(tmp_path: Path) -> None:
    ran("casting", tmp_path)


@unix
@pytest.mark.timeout(300)
def test_a_signal_handler_forks_in_the_middle_of_an_operation(tmp_path: Path) -> None:
    _, said = ran("handler", tmp_path, 280)
    assert "a child must end inside the handler" in said


@linux
@pytest.mark.sampled(2)
@pytest.mark.parametrize("count", ["1", "3"])
def test_the_number_of_threads_means_the_same_in_a_child(count: str, tmp_path: Path) -> None:
    ran("threads", tmp_path, RAYON_NUM_THREADS=count)


@unix
@pytest.mark.deep
@pytest.mark.timeout(900)
def test_many_jobs_through_a_forked_pool(tmp_path: Path) -> None:
    ran("many", tmp_path, 850)


@linux
@pytest.mark.deep
@pytest.mark.timeout(900)
def test_small_operations_leave_no_memory_behind(tmp_path: Path) -> None:
    grown, _ = ran("memory", tmp_path, 850)
    assert float(grown) < 20


# Found: a symmetric difference of many operands in the same place used one nested call for each,
# until the stack overflowed.
@pytest.mark.parametrize("count", [75, pytest.param(300, marks=pytest.mark.deep)])
def test_many_symmetric_differences_need_no_deep_stack(count: int, tmp_path: Path) -> None:
    ran(f"stack {count}", tmp_path)
