"""Try an installed package with the examples of the README and of the manual's first pages.

Run it with the Python of a clean environment, in any folder: `python scripts/smoke.py`. It needs
only the package and no network. It prints what was done; a failure is an exception.
"""

import json
import math
import os
import subprocess
import sys
import tempfile
from collections.abc import Callable, Iterator
from importlib.util import find_spec
from pathlib import Path

SCRIPT = """
difference() {
  linear_extrude(height = 2, center = false) text("Abc", size = 10);
  multmatrix([[1,0,0,5],[0,1,0,0],[0,0,1,-1],[0,0,0,1]]) cube(size = [2, 20, 4], center = false);
}
"""


def command(*arguments: str, code: int = 0) -> str:
    """Run the package's command line, check its exit code, and return its output."""
    line = [sys.executable, "-m", "bspcsg", *arguments]
    done = subprocess.run(
        line, capture_output=True, text=True, encoding="utf-8", timeout=300, check=False
    )
    if done.returncode != code:
        raise SystemExit(f"{line}: code {done.returncode}\n{done.stdout}{done.stderr}")
    return done.stdout


def made() -> Iterator[str]:
    """Make the README's first parts, and write files of all formats; yield a text for each step."""
    import bspcsg as b

    plate = b.box((0.3, 0.2, 0.1)) - b.box((0.1, 0.1, 0.1)).translate(0.1, 0.1, 0)
    assert str(plate.volume_exact) == "1/200"
    assert (plate & plate).equals(plate) and (plate - plate).is_empty
    part = b.cube(10, center=True) - b.cylinder(h=20, r=3, segments=32, center=True)
    for suffix in ("stl", "obj", "ply", "off", "3mf", "glb"):
        part.save(f"part.{suffix}")
        assert math.isclose(b.load(f"part.{suffix}").volume, part.volume, rel_tol=1e-6)
        yield f"part.{suffix}"
    b.sphere(5, segments=24).save("ball.stl")


def flat() -> Iterator[str]:
    """Offset a region, and write and read drawings."""
    from bspcsg import bsp

    region = bsp.Region.rectangle(40, 20) - bsp.Region.circle(5, 32).translate(10, 10)
    wider = region.offset(1)
    assert wider.area > region.area
    wider.to_svg("outline.svg")
    assert math.isclose(bsp.Region.from_svg("outline.svg").area, wider.area, rel_tol=1e-6)
    yield "outline.svg"
    if find_spec("ezdxf"):
        wider.to_dxf("outline.dxf")
        assert math.isclose(bsp.Region.from_dxf("outline.dxf").area, wider.area, rel_tol=1e-6)
        yield "outline.dxf"


def pictures() -> Iterator[str]:
    """Render pictures, write an HTML page, and cut a section."""
    for name in ("part.png", "part.svg"):
        command("render", "part.stl", "-o", name, "--size", "200x150")
        yield name
    command("slice", "part.stl", "--z", "1", "-o", "section.svg")
    yield "section.svg"
    # Without the optional ezdxf, the command fails with code 6.
    code = 0 if find_spec("ezdxf") else 6
    command("slice", "part.stl", "--z", "1", "-o", "section.dxf", code=code)
    command("view", "part.stl", "-o", "page.html", "--no-open")
    yield "page.html"


def checked() -> Iterator[str]:
    """Combine, check, compare and crosscheck meshes; an open mesh must be refused."""
    said = json.loads(command("difference", "part.stl", "ball.stl", "-o", "cut.stl", "--json"))
    assert said["check"]["verdict"] == "agree", said
    command("check", "cut.stl")
    command("compare", "part.stl", "cut.stl", code=1)
    command("compare", "part.ply", "part.obj")
    command("crosscheck", "part.stl", "ball.stl", "--results", "results.jsonl")
    command("report", "results.jsonl", "-o", "report.html")
    lines = Path("part.off").read_text("utf-8").splitlines()
    counts = lines[1].split()
    lines[1] = f"{counts[0]} {int(counts[1]) - 1} 0"
    Path("open.off").write_text("\n".join(lines[:-1]) + "\n")
    command("union", "open.off", "ball.stl", "-o", "refused.stl", code=4)
    assert not Path("refused.stl").exists()
    yield from ("cut.stl", "results.jsonl", "report.html")


def scripts() -> Iterator[str]:
    """Run a script with text, and run ``bspcsg doctor``."""
    Path("letters.csg").write_text(SCRIPT)
    command("run", "letters.csg", "-o", "letters.stl")
    command("doctor")
    yield "letters.stl"


STEPS: tuple[Callable[[], Iterator[str]], ...] = (made, flat, pictures, checked, scripts)


def main() -> None:
    with tempfile.TemporaryDirectory() as folder:
        home = Path.cwd()
        os.chdir(folder)
        try:
            for step in STEPS:
                names = list(step())
                missing = [name for name in names if not Path(name).stat().st_size]
                assert not missing, missing
                print(f"ok: {step.__name__}: {', '.join(names)}", flush=True)
        finally:
            os.chdir(home)


if __name__ == "__main__":
    main()
