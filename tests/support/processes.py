"""Programs that use the library before and after their process forks.

Each runs in a process of its own, ``python -m support.processes NAME [COUNT]``, and ends with 0 if
nothing fails.
"""

import importlib
import multiprocessing
import os
import pickle
import signal
import sys
import threading
import time
from collections.abc import Callable
from concurrent.futures import ProcessPoolExecutor
from functools import partial
from multiprocessing.queues import SimpleQueue as Queue
from pathlib import Path
from typing import TypeAlias

import numpy as np

import bspcsg as b
from bspcsg import bsp
from bspcsg.machine import memory_mb

Corner: TypeAlias = tuple[float, ...]

#: Seconds after which a child counts as stuck.
TIMEOUT = 60

#: Requests to a server of three workers: more than there are workers.
REQUESTS = 4


def job(k: int) -> b.Solid:
    """Return solid number k, with enough faces for several threads."""
    ball = b.sphere(10, segments=48)
    return ball - b.sphere(8, segments=48).translate((k % 7 + 1, k % 5, 0.25))


def small_job(k: int) -> b.Solid:
    """Return solid number k, with so few faces that it takes no time."""
    return b.box((4, 4, 4)) - b.box((1, 2, 3)).translate((k % 5 * 0.5, 0.25, k % 3))


def triangles(solid: b.Solid) -> set[tuple[Corner, Corner, Corner]]:
    """Return the triangles of a solid's mesh, each starting with its least corner."""
    mesh = solid.to_mesh()
    found = set()
    for corners in mesh.vertices[mesh.faces].tolist():
        p, q, r = map(tuple, corners)
        found.add(min((p, q, r), (q, r, p), (r, p, q)))
    return found


def same(one: b.Solid, other: b.Solid) -> bool:
    """Return true if two solids are equal sets with bitwise equal triangles."""
    return triangles(one) == triangles(other) and one.equals(other)


def ended(child: int, patience: float = TIMEOUT) -> int:
    """Wait for a child and return its status as `os.waitpid` does; kill it after a time limit."""
    until = time.monotonic() + patience
    while time.monotonic() < until:
        found, status = os.waitpid(child, os.WNOHANG)
        if found:
            return status
        time.sleep(0.01)
    os.kill(child, signal.SIGKILL)
    os.waitpid(child, 0)
    raise TimeoutError("the child is stuck")


def in_child(work: Callable[[], object]) -> int:
    """Fork; return the child's id, and in the child run `work` and exit with 0 unless it raises."""
    child = os.fork()
    if child:
        return child
    try:
        work()
    except BaseException as error:
        sys.stderr.write(f"child: {error!r}\n")
        sys.stderr.flush()
        os._exit(1)
    os._exit(0)


def answer(work: Callable[[], object], file: str) -> None:
    """Run `work` in a forked child, which pickles the result to a file, and wait for it."""
    child = in_child(lambda: Path(file).write_bytes(pickle.dumps(work())))
    if ended(child):
        raise RuntimeError("the child failed")


def fork() -> None:
    """Compute in the parent, in a forked child, and in a child of that child."""
    expected = [job(k) for k in range(3)]
    expected[0].to_mesh()
    answer(lambda: job(0), "child")
    assert same(pickle.loads(Path("child").read_bytes()), expected[0])
    # Operands that the parent has evaluated, and a child that forks again.

    def deeper() -> b.Solid:
        answer(lambda: job(2), "grandchild")
        return expected[0] | expected[1]

    answer(deeper, "child")
    assert same(pickle.loads(Path("child").read_bytes()), expected[0] | expected[1])
    assert same(pickle.loads(Path("grandchild").read_bytes()), expected[2])
    assert same(job(1), expected[1]), "the parent goes on"


def crowd_of_cubes() -> b.Solid:
    """Return a solid of few faces, of which so many meet at a point that threads share the work."""
    cubes = [b.cube(2, center=True).rotate((31 * k, 17 * k, 7 * k)) for k in range(1, 31)]
    return b.union(*cubes)


def crowd() -> None:
    """Check that a small operation starts no threads, that many faces do, and that children can."""

    def threads_of_process() -> int:
        return len(list(Path("/proc/self/task").iterdir()))

    before = threads_of_process()
    small_job(0).to_mesh()
    assert threads_of_process() == before
    expected = crowd_of_cubes()
    expected.to_mesh()
    assert threads_of_process() > before
    answer(crowd_of_cubes, "child")
    assert same(pickle.loads(Path("child").read_bytes()), expected)


def method(name: str) -> Callable[[], None]:
    """Return a program that distributes jobs to processes with one start method."""

    def program() -> None:
        expected = [job(k) for k in range(4)]
        expected[0].to_mesh()
        context = multiprocessing.get_context(name)
        with context.Pool(2) as pool:
            found = pool.map_async(job, range(4)).get(TIMEOUT)
        assert all(map(same, found, expected))
        with ProcessPoolExecutor(2, mp_context=context) as executor:
            futures = [executor.submit(job, k) for k in range(4)]
            assert all(same(f.result(TIMEOUT), e) for f, e in zip(futures, expected, strict=True))

    return program


def joblib() -> None:
    """Run jobs with joblib's loky backend, which pickles operands and results."""
    from joblib import Parallel, delayed

    expected = [job(k) for k in range(4)]
    solids = [solid.translate((0, 0, 1)) for solid in expected]
    found = Parallel(n_jobs=2, backend="loky", timeout=TIMEOUT)(
        delayed(b.union)(solid, other) for solid, other in zip(solids, expected, strict=True)
    )
    assert all(same(f, s | e) for f, s, e in zip(found, solids, expected, strict=True))


def preload() -> None:
    """Use the library in a server, then fork workers that answer requests."""
    loaded = job(0)
    loaded.to_mesh()
    assert bsp.Region.rectangle(2).area == 4
    expected = [loaded & job(k) for k in range(REQUESTS)]
    requests: Queue[int | None] = multiprocessing.SimpleQueue()
    answers: Queue[tuple[int, bytes]] = multiprocessing.SimpleQueue()

    def serve() -> None:
        for k in iter(requests.get, None):
            answers.put((k, pickle.dumps(loaded & job(k))))

    workers = [in_child(serve) for _ in range(3)]
    for k in range(REQUESTS):
        requests.put(k)
    found = dict(answers.get() for _ in range(REQUESTS))
    for _ in workers:
        requests.put(None)
    assert [ended(worker) for worker in workers] == [0, 0, 0]
    assert all(same(pickle.loads(found[k]), expected[k]) for k in range(REQUESTS))


def volume_of_difference(one: b.Solid, other: b.Solid) -> float:
    """Return the volume of a difference, which uses the operands' caches."""
    return (one - other).volume


def busy() -> None:
    """Fork repeatedly while another thread works on the operands that the children use."""
    ball, over = b.sphere(10, segments=96), threading.Event()
    others = [b.sphere(9, segments=96).translate((k + 0.5, 0, 0)) for k in range(6)]

    def work() -> None:
        while not over.is_set():
            for other in others:
                result = ball - other
                assert result.volume > 0
                assert result.to_mesh().faces.size

    thread = threading.Thread(target=work)
    thread.start()
    try:
        for k in range(30):
            time.sleep(0.013 * (k % 5))
            other = others[k % len(others)]
            assert ended(in_child(partial(volume_of_difference, ball, other))) == 0, k
    finally:
        over.set()
        thread.join()


def casting() -> None:
    """Check that a caster in use by another thread at a fork is refused in the child."""
    mesh = b.sphere(10, segments=256).to_mesh()
    caster, idle = bsp.RayCaster(mesh), bsp.RayCaster(mesh)
    origins = np.random.default_rng(1).uniform(-20, 20, (400_000, 3))
    directions = -origins
    begun, over = threading.Event(), threading.Event()

    def work() -> None:
        while not over.is_set():
            begun.set()
            caster.first_hit(origins, directions)

    def child() -> None:
        few = origins[:4000], directions[:4000]
        assert (idle.first_hit(*few).facet >= 0).all()
        assert (bsp.RayCaster(mesh).first_hit(*few).facet >= 0).all()
        for _ in range(2):
            try:
                caster.first_hit(*few)
            except b.BspcsgError as error:
                assert error.code == "forked", error.code
            else:
                raise AssertionError("nobody objected")

    idle.first_hit(origins[:10], directions[:10])
    thread = threading.Thread(target=work)
    thread.start()
    begun.wait()
    time.sleep(0.1)
    try:
        assert ended(in_child(child)) == 0
    finally:
        over.set()
        thread.join()
    # Nobody is inside now, so that a child may go on with it.
    few = origins[:4000], directions[:4000]
    assert ended(in_child(lambda: caster.first_hit(*few))) == 0


def balls_side_by_side(segments: int) -> list[b.Solid]:
    """Return overlapping balls in a row, with their trees built."""
    balls = [b.sphere(10, segments=segments).translate((k * 0.37, k * 0.21, 0)) for k in range(5)]
    assert all(ball.tree for ball in balls)
    return balls


def handler() -> None:
    """Fork in a signal handler in the middle of an operation."""
    parent, missed = os.getpid(), 42
    statuses = []

    def leave(*_: object) -> None:
        statuses.append(ended(in_child(lambda: small_job(1).volume)))

    def come_back(*_: object) -> None:
        child = os.fork()
        if child:
            statuses.append(ended(child))

    for action, expected in ((leave, 0), (come_back, signal.SIGABRT)):
        signal.signal(signal.SIGALRM, action)
        # Work that ends before the core asks for signals grows until it asks, on any machine.
        for segments in (128, 192, 256, 384, 512):
            balls = balls_side_by_side(segments)
            signal.setitimer(signal.ITIMER_REAL, 0.02)
            assert b.union(*balls).to_mesh().faces.size
            if os.getpid() != parent:
                # The signal came between two calls into the core, where nothing is in the way.
                os._exit(missed)
            if statuses and statuses[-1] == expected:
                break
            assert not statuses or statuses[-1] in (0, missed << 8), statuses
        else:
            raise AssertionError(statuses)


def threads() -> None:
    """Check that the settings of the number of threads apply in a child."""
    count = int(os.environ["RAYON_NUM_THREADS"])

    def running() -> int:
        return len(os.listdir("/proc/self/task"))

    def child() -> None:
        before = running()
        job(1).to_mesh()
        assert running() == before + count, (before, running())
        b.set_threads(count + 2)
        job(2).to_mesh()
        assert running() == before + 2 * count + 2, (before, running())

    before = running()
    small_job(1).to_mesh()
    assert running() == before, "small work starts no threads"
    job(0).to_mesh()
    assert running() == before + count
    assert ended(in_child(child)) == 0


def ending(after: int = 100) -> None:
    """End the program while daemon threads are in the core, after `after` milliseconds."""

    def work() -> None:
        while True:
            assert (b.sphere(2, segments=64) - b.sphere(1.9, segments=64).rotate(10)).volume > 0

    for _ in range(2):
        threading.Thread(target=work, daemon=True).start()
    time.sleep(after / 1000)


def many(jobs: int = 1000) -> None:
    """Run many jobs one after the other, and 64 at a time, in forked pools."""
    job(0).to_mesh()
    expected = [small_job(k).volume for k in range(15)]
    context = multiprocessing.get_context("fork")
    with context.Pool(1) as pool:
        for k in range(jobs):
            assert pool.apply(small_job, (k,)).volume == expected[k % 15], k
    kinds = [job(k) for k in range(35)]
    with context.Pool(64) as pool:
        found = pool.map_async(job, range(64), chunksize=1).get(10 * TIMEOUT)
    assert all(f.equals(kinds[k % 35]) for k, f in enumerate(found))


def memory(count: int = 100_000) -> None:
    """Print the growth of the process in 10^6 bytes during `count` small operations."""

    def operations(first: int, count: int) -> None:
        for k in range(first, first + count):
            assert small_job(k).volume > 0

    operations(0, 2000)
    before = memory_mb()
    operations(2000, count)
    sys.stdout.write(f"{memory_mb() - before}\n")


def stack(count: int = 300) -> None:
    """Combine many solids at one point in a thread with a small stack."""
    corners = np.array([(0, 0, 0), (1, 0, 0), (0, 1, 0), (0, 0, 1)])
    faces = [(0, 2, 1), (0, 1, 3), (0, 3, 2), (1, 2, 3)]
    steps = np.array([0.0003, 0.0002, 0.0001])
    solids = [
        b.Solid(corners * (10 + 0.001 * k) - 2 - k * steps, faces, pitch=-9) for k in range(count)
    ]
    found: list[b.Solid] = []
    b.set_threads(1)
    threading.stack_size(count // 75 << 17)
    thread = threading.Thread(target=lambda: found.append(b.xor(*solids)))
    thread.start()
    thread.join()
    half = count // 2
    assert found[0].equals(b.xor(*solids[:half]) ^ b.xor(*solids[half:]))


PROGRAMS: dict[str, Callable[..., None]] = {
    "fork": fork,
    "crowd": crowd,
    "with-fork": method("fork"),
    "with-spawn": method("spawn"),
    "with-forkserver": method("forkserver"),
    "joblib": joblib,
    "preload": preload,
    "busy": busy,
    "casting": casting,
    "handler": handler,
    "threads": threads,
    "many": many,
    "ending": ending,
    "memory": memory,
    "stack": stack,
}

if __name__ == "__main__":
    # Under this name children find the jobs, too.
    module = importlib.import_module("support.processes")
    module.PROGRAMS[sys.argv[1]](*map(int, sys.argv[2:]))
