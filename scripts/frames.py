"""Measures how long a page of the view takes for a frame, turning and still, in headless Chromium.

    scripts/frames mesh.stl

Where there is no graphics card the processor draws, so that a loaded machine tells the processor's
time for each frame rather than the frames in a second. The level is how many steps rougher than
standing still the view turns, as it has decided by the time of its pictures. Beside them stands
what the same triangles take in as many pixels and samples with bare WebGL: one call, one light, and
nothing of ours. With --record the figures are kept.
"""

import argparse
import os
import statistics
import sys
import tempfile
import time
from pathlib import Path

import psutil

from bspcsg.cli.main import run
from recording import keep
from support.browser import Browser, started
from support.cli import put
from support.shapes import icosphere

#: Sizes of the page, in pixels.
_WINDOWS = ((640, 640), (1280, 900))

_TURN = """
    const done = arguments[arguments.length - 1];
    const { view } = document.querySelector(".stage");
    const gl = view.screen.renderer.getContext();
    const times = [];
    const start = performance.now();
    let last = start;
    (function step(now) {
      if (now) times.push(now - last);
      last = now ?? last;
      view.eye.turn(0.05, 0);
      view.move();
      if (times.length < 60) requestAnimationFrame(step);
      else {
        gl.readPixels(0, 0, 1, 1, gl.RGBA, gl.UNSIGNED_BYTE, new Uint8Array(4));
        done([times, performance.now() - start, view.pace.level, view.canvas.width]);
      }
    })();
"""

_STILL = """
    const { view } = document.querySelector(".stage");
    const gl = view.screen.renderer.getContext();
    view.isMoving = false;
    const began = performance.now();
    view.render();
    gl.readPixels(0, 0, 1, 1, gl.RGBA, gl.UNSIGNED_BYTE, new Uint8Array(4));
    return performance.now() - began;
"""


_BARE = """
    const { view } = document.querySelector(".stage");
    const canvas = document.createElement("canvas");
    [canvas.width, canvas.height] = [view.canvas.width, view.canvas.height];
    const gl = canvas.getContext("webgl2", { antialias: !view.screen.isHalved });
    const program = gl.createProgram();
    for (const [kind, source] of [
      [gl.VERTEX_SHADER, `#version 300 es
        in vec3 place; out float light;
        void main() { gl_Position = vec4(place.xy * 0.8, place.z * 0.5, 1.0); light = place.z; }`],
      [gl.FRAGMENT_SHADER, `#version 300 es
        precision mediump float; in float light; out vec4 colour;
        void main() { colour = vec4(vec3(0.3 - 0.7 * light), 1.0); }`],
    ]) {
      const shader = gl.createShader(kind);
      gl.shaderSource(shader, source);
      gl.compileShader(shader);
      gl.attachShader(program, shader);
    }
    gl.linkProgram(program);
    gl.useProgram(program);
    gl.enable(gl.DEPTH_TEST);
    gl.viewport(0, 0, canvas.width, canvas.height);
    const { positions, indices } = view.layers[0].given;
    gl.bindBuffer(gl.ARRAY_BUFFER, gl.createBuffer());
    gl.bufferData(gl.ARRAY_BUFFER, positions, gl.STATIC_DRAW);
    gl.bindBuffer(gl.ELEMENT_ARRAY_BUFFER, gl.createBuffer());
    gl.bufferData(gl.ELEMENT_ARRAY_BUFFER, indices, gl.STATIC_DRAW);
    const place = gl.getAttribLocation(program, "place");
    gl.enableVertexAttribArray(place);
    gl.vertexAttribPointer(place, 3, gl.FLOAT, false, 0, 0);
    const kind = indices.BYTES_PER_ELEMENT === 4 ? gl.UNSIGNED_INT : gl.UNSIGNED_SHORT;
    const times = [];
    for (let round = 0; round < 10; round += 1) {
      const began = performance.now();
      gl.clear(gl.COLOR_BUFFER_BIT | gl.DEPTH_BUFFER_BIT);
      gl.drawElements(gl.TRIANGLES, indices.length, kind, 0);
      gl.readPixels(0, 0, 1, 1, gl.RGBA, gl.UNSIGNED_BYTE, new Uint8Array(4));
      times.push(performance.now() - began);
    }
    const middle = new Uint8Array(4);
    gl.readPixels(canvas.width / 2, canvas.height / 2, 1, 1, gl.RGBA, gl.UNSIGNED_BYTE, middle);
    if (gl.getError() || middle[3] !== 255) throw new Error("bare WebGL drew nothing");
    return times;
"""


def processor_seconds() -> float:
    children = psutil.Process().children(recursive=True)
    return float(sum(sum(child.cpu_times()[:2]) for child in children))


def measured(browser: Browser, page: Path) -> dict[str, float]:
    """Return what one page takes, in seconds and milliseconds, and print it."""
    began = time.perf_counter()
    browser.open(page)
    browser.wait("document.querySelector('.stage[data-drawn]')")
    opened = time.perf_counter() - began
    browser.run_later(_TURN)
    spent = processor_seconds()
    times, whole, level, width = browser.run_later(_TURN)
    spent = (processor_seconds() - spent) / len(times)
    stills, bares = [browser.run(_STILL) for _ in range(10)], browser.run(_BARE)
    figures = {
        "opened_seconds": opened,
        "turning_ms": statistics.median(times),
        "turning_slowest_ms": max(times),
        "frames_a_second": 1000 * len(times) / whole,
        "turning_processor_ms": 1000 * spent,
        "turning_level": level,
        "turning_pixels_wide": width,
        "still_ms": statistics.median(stills),
        "still_bare_webgl_ms": statistics.median(bares),
    }
    for name, value in figures.items():
        print(f"{name:22} {value:8.1f}")
    return {name: round(value, 1) for name, value in figures.items()}


def shown(mesh: Path) -> dict[str, dict[str, float]]:
    """Write the page of a mesh and measure it in windows of some sizes."""
    found = {}
    with tempfile.TemporaryDirectory() as folder:
        page = Path(folder, "view.html")
        if run(["view", str(mesh), "-o", str(page), "--no-open"]):
            raise SystemExit(1)
        for width, height in _WINDOWS:
            name = f"{width} x {height}"
            print(f"{mesh.stem}, {name}:")
            with started(webgl=True) as browser:
                looks = {"width": width, "height": height, "deviceScaleFactor": 1, "mobile": False}
                browser.device(looks)
                found[name] = measured(browser, page)
    return found


def balls(folder: Path) -> list[Path]:
    """Write balls of 1 280, 81 920 and 1 310 720 triangles."""
    paths = []
    for level in (3, 6, 8):
        mesh = icosphere(level)
        paths.append(folder / f"ball of {len(mesh[1])} triangles.ply")
        put(str(paths[-1]), mesh)
    return paths


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("meshes", nargs="*", type=Path, help="by default three balls")
    parser.add_argument("--record", action="store_true", help="keep the figures")
    options = parser.parse_args()
    with tempfile.TemporaryDirectory() as folder:
        meshes = options.meshes or balls(Path(folder))
        found = {mesh.stem: shown(mesh) for mesh in meshes}
    if options.record:
        load = os.getloadavg()[0]
        print(f"kept in {keep('frames', {'load': round(load, 1), 'pages': found})}")
    return 0


if __name__ == "__main__":
    sys.exit(main())
