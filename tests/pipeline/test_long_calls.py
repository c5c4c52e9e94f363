"""Ctrl-C ends every long call soon, whatever the call does and however small its input is."""

import gc
import os
import signal
import subprocess
import sys
import time
from pathlib import Path

import numpy as np
import pytest

import bspcsg as b
from support.cli import heed_interrupts

#: The time that a call may go on after the signal, on a loaded machine, in seconds.
SOON = 2.0

#: The time for which saving some hundred thousand triangles may work without hearing a signal, in
#: seconds of the processor.
DEAF = 0.1

_COMMON = """
import numpy as np
import bspcsg as b
rng = np.random.default_rng(1)

def turned(n):
    return [b.cube(1, center=True).rotate(tuple(rng.uniform(0, 360, 3))) for _ in range(n)]

def many_boxes(n):
    lows = rng.integers(0, 90, (n, 3))
    return [b.box(tuple(rng.integers(5, 60, 3))).translate(tuple(low)) for low in lows]

def ball(n):
    return b.sphere(1, segments=n)

def arrays(solids):
    vertices, faces, first = [], [], 0
    for solid in solids:
        mesh = solid.to_mesh()
        vertices.append(mesh.vertices)
        faces.append(mesh.faces + first)
        first += len(mesh.vertices)
    return np.concatenate(vertices), np.concatenate(faces)
"""

#: The needs of a call, and the call. Each takes far longer than the test waits.
CALLS = {
    "half-spaces in one expression": (
        "cuts = [b.half_space(tuple(rng.normal(size=3)), 1.0) for _ in range(60_000)]",
        "b.intersection(*cuts).tree",
    ),
    "turned cubes at one place": ("cubes = turned(500)", "b.union(*cubes).tree"),
    "crowds of few faces": (
        "cubes = turned(60)",
        "[b.union(*cubes[k:]).tree for k in range(30) for _ in range(9)]",
    ),
    "turned cubes in one mesh": ("mesh = arrays(turned(500))", "b.Solid(*mesh).volume"),
    "boxes in one mesh": ("mesh = arrays(many_boxes(15_000))", "b.Solid(*mesh).volume"),
    "a mesh that is there two hundred times": (
        "mesh = arrays([ball(32)] * 200)",
        "[b.Solid(*mesh).volume for _ in range(2_000)]",
    ),
    "a mesh that is there two hundred times, its faces in another order each time": (
        "v, f = arrays([ball(32)]); order = rng.permutation;"
        " mesh = np.tile(v, (200, 1)), np.vstack([order(f) + k * len(v) for k in range(200)])",
        "[b.Solid(*mesh).volume for _ in range(99)]",
    ),
    "import": (
        "mesh = arrays([ball(64).translate((3 * k, 0, 0)) for k in range(200)])",
        "[b.Solid(*mesh) for _ in range(99)]",
    ),
    "extraction": (
        "A, B = ball(700), ball(700).rotate((10, 20, 30)).translate((0.01, 0.02, 0.03))",
        "[(A - B).to_mesh() for _ in range(99)]",
    ),
    "exact volumes": (
        "D = b.union(*[ball(200).rotate((k, 2 * k, 3)).translate((0.1 * k, 0, 0)) "
        "for k in range(9)]); D.to_mesh()",
        "[D.exact_volume(10**9) for _ in range(99)]",
    ),
    "points": (
        "A = ball(300); points = rng.uniform(-1, 1, (10**7, 3))",
        "A.classify(points)",
    ),
    "trees of facets": (
        "facets = rng.uniform(-1, 1, (20000, 3, 3))",
        "b.bsp.PartitionTree(facets)",
    ),
    "rays": (
        "caster = b.bsp.RayCaster(ball(300)); heads = rng.normal(size=(2 * 10**6, 3))",
        "[caster.first_hit(np.zeros_like(heads), heads) for _ in range(99)]",
    ),
    "the check of a result": (
        "A, B = ball(200), ball(200).rotate((10, 20, 30)).translate((0.01, 0.02, 0.03))",
        "[b.validate('union', A, B) for _ in range(99)]",
    ),
}

_PROGRAM = """
import sys, time
{common}
{given}
print("ready", flush=True)
try:
    {call}
except KeyboardInterrupt:
    print("stopped", flush=True)
else:
    print("ended", flush=True)
"""


# Found: exact volumes and half-spaces did not respond to SIGINT.
@pytest.mark.deep
@pytest.mark.skipif(os.name != "posix", reason="signals as POSIX has them")
@pytest.mark.parametrize("name", CALLS)
def test_an_interrupt_ends_the_call_soon(name: str) -> None:
    given, call = CALLS[name]
    program = _PROGRAM.format(common=_COMMON, given=given, call=call)
    running = subprocess.Popen(
        [sys.executable, "-c", program],
        stdout=subprocess.PIPE,
        text=True,
        preexec_fn=heed_interrupts,  # noqa: PLW1509
    )
    assert running.stdout is not None
    try:
        assert running.stdout.readline() == "ready\n"
        time.sleep(0.7)
        began = time.monotonic()
        running.send_signal(signal.SIGINT)
        said = running.stdout.readline()
        taken = time.monotonic() - began
    finally:
        running.kill()
        running.communicate()
    assert said == "stopped\n"
    assert taken < SOON, f"{taken:.1f} s"


@pytest.mark.skipif(os.name != "posix", reason="signals as POSIX has them")
@pytest.mark.sampled(7)
@pytest.mark.parametrize("name", CALLS)
def test_an_interrupt_after_a_tenth_of_a_second_of_work_ends_the_call(name: str) -> None:
    """The same by the processor's time, which no other process takes away."""
    given, call = CALLS[name]
    names: dict[str, object] = {}
    exec(_COMMON + given, names)
    before = signal.signal(signal.SIGPROF, signal.default_int_handler)
    began = time.process_time()
    signal.setitimer(signal.ITIMER_PROF, 0.1)
    try:
        with pytest.raises(KeyboardInterrupt):
            exec(call, names)
    finally:
        signal.setitimer(signal.ITIMER_PROF, 0)
        signal.signal(signal.SIGPROF, before)
    assert time.process_time() - began < SOON


# Found: saving a large mesh responded to Ctrl-C only after up to a second.
@pytest.mark.deep
@pytest.mark.skipif(os.name != "posix", reason="signals as POSIX has them")
@pytest.mark.parametrize("suffix", [".stl", ".obj", ".off", ".3mf"])
def test_signals_are_heard_all_the_time_while_a_mesh_is_saved(tmp_path: Path, suffix: str) -> None:
    ball = b.sphere(1, segments=566)
    ball.to_mesh()
    gc.collect()
    gc.freeze()  # What other tests have left is none of what saving makes Python look through.
    heard = [time.process_time()]
    before = signal.signal(signal.SIGPROF, lambda *_: heard.append(time.process_time()))
    signal.setitimer(signal.ITIMER_PROF, 0.005, 0.005)
    try:
        ball.save(tmp_path / f"ball{suffix}")
    finally:
        signal.setitimer(signal.ITIMER_PROF, 0)
        signal.signal(signal.SIGPROF, before)
        gc.unfreeze()
    heard.append(time.process_time())
    assert len(heard) > 10
    assert max(np.diff(heard)) < DEAF
