"""Measures how long a page of the view takes for a frame, turning and still, in headless Chromium.

    scripts/frames mesh.stl

Where there is no graphics card the processor draws, so that a loaded machine tells the processor's
time for each frame rather than the frames in a second.
"""

import argparse
import statistics
import sys
import tempfile
import time
from pathlib import Path

import psutil

from bspcsg.cli.main import run
from support.browser import Browser, started

_TURN = """
    const done = arguments[arguments.length - 1];
    const { view } = document.querySelector(".stage");
    const gl = view.renderer.getContext();
    const pixel = new Uint8Array(4);
    const times = [];
    const start = performance.now();
    (function step() {
      const began = performance.now();
      view.eye.turn(0.05, 0);
      view.move();
      view.render();
      gl.readPixels(0, 0, 1, 1, gl.RGBA, gl.UNSIGNED_BYTE, pixel);
      times.push(performance.now() - began);
      if (times.length < 60) requestAnimationFrame(step);
      else done([times, performance.now() - start]);
    })();
"""

_STILL = """
    const { view } = document.querySelector(".stage");
    const gl = view.renderer.getContext();
    view.isMoving = false;
    const began = performance.now();
    view.render();
    gl.readPixels(0, 0, 1, 1, gl.RGBA, gl.UNSIGNED_BYTE, new Uint8Array(4));
    return performance.now() - began;
"""


def processor_seconds() -> float:
    children = psutil.Process().children(recursive=True)
    return float(sum(sum(child.cpu_times()[:2]) for child in children))


def measured(browser: Browser, page: Path) -> None:
    began = time.perf_counter()
    browser.open(page)
    browser.wait("document.querySelector('.stage[data-drawn]')")
    print(f"opened after {time.perf_counter() - began:.1f} s")
    browser.run_later(_TURN)
    spent = processor_seconds()
    times, whole = browser.run_later(_TURN)
    spent = (processor_seconds() - spent) / len(times)
    print(
        f"turning: {statistics.median(times):.0f} ms a frame (fastest {min(times):.0f} ms),"
        f" {1000 * len(times) / whole:.0f} frames a second,"
        f" {1000 * spent:.0f} ms of processors' time a frame"
    )
    print(f"still: {browser.run(_STILL):.0f} ms a frame")


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("mesh")
    with tempfile.TemporaryDirectory() as folder:
        page = Path(folder, "view.html")
        code = run(["view", parser.parse_args().mesh, "-o", str(page), "--no-open"])
        if code == 0:
            with started(webgl=True) as browser:
                measured(browser, page)
    return code


if __name__ == "__main__":
    sys.exit(main())
