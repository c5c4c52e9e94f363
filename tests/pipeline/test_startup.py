"""The command line imports only the modules that a command needs."""

import shutil
import subprocess
import sys
import tomllib
from pathlib import Path

import pytest

import bspcsg as b

#: Modules that take a tenth of a second or more to import, or import dozens of others; no small
#: boolean of STL files needs them. numpy.unique imports numpy.ma, xml.sax.saxutils imports
#: urllib.request.
HEAVY = [
    "PIL",
    "email",
    "ezdxf",
    "importlib.metadata",
    "jinja2",
    "meshio",
    "numpy.ma",
    "pyclipper",
    "rich",
    "scipy",
    "tempfile",
    "trimesh",
    "uharfbuzz",
    "urllib.request",
    "zipfile",
]

#: A program that runs the command line and then prints the imported modules.
PROGRAM = """
import sys
try:
    from bspcsg.cli.main import main
    main(sys.argv[1:])
finally:
    print(*sys.modules, file=sys.stderr)
"""


def imported(*arguments: str) -> set[str]:
    command = [sys.executable, "-c", PROGRAM, *arguments]
    done = subprocess.run(command, capture_output=True, text=True, timeout=100, check=True)
    return set(done.stderr.splitlines()[-1].split())


@pytest.fixture(scope="module")
def cubes(tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("cubes")
    b.cube(2).save(folder / "a.stl")
    b.cube(2).translate(1, 1, 1).save(folder / "b.stl")
    return folder


@pytest.mark.parametrize("arguments", [("--version",), ("difference", "--help")])
def test_the_version_and_the_help_need_no_numpy(arguments: tuple[str, ...]) -> None:
    assert imported(*arguments).isdisjoint({*HEAVY, "numpy", "manifold3d"})


def test_the_list_of_verbs_needs_no_numpy() -> None:
    assert imported("--help").isdisjoint({"numpy", "trimesh"})


# Found: using GLB files imported trimesh.
@pytest.mark.sampled(3)
@pytest.mark.parametrize("kind", ["stl", "obj", "ply"])
def test_a_checked_boolean_imports_little(cubes: Path, kind: str) -> None:
    result = str(cubes / f"c.{kind}")
    found = imported("difference", str(cubes / "a.stl"), str(cubes / "b.stl"), "-o", result)
    assert {"numpy", "manifold3d"} <= found
    assert found.isdisjoint(HEAVY)


def test_importing_the_package_needs_no_numpy() -> None:
    program = "import sys, bspcsg; print(*sys.modules)"
    done = subprocess.run([sys.executable, "-c", program], capture_output=True, check=True)
    assert b"numpy" not in done.stdout.split()


def test_methods_import_what_lies_above_them_only_when_called() -> None:
    # import-linter lets these pass wherever they stand.
    project = tomllib.loads((Path(__file__).parents[2] / "pyproject.toml").read_text("utf-8"))
    above: dict[str, set[str]] = {}
    for way in project["tool"]["importlinter"]["contracts"][0]["ignore_imports"]:
        method, function = way.split(" -> ")
        above.setdefault(method, set()).add(function)
    for module, functions in above.items():
        program = f"import sys, {module}; print(*sys.modules)"
        done = subprocess.run(
            [sys.executable, "-c", program], capture_output=True, text=True, check=True
        )
        assert functions.isdisjoint(done.stdout.split()), module


def test_sources_that_are_not_compiled_say_so(tmp_path: Path) -> None:
    compiled = shutil.ignore_patterns("_core.*", "__pycache__", "assets")
    shutil.copytree(Path(b.__file__).parent, tmp_path / "bspcsg", ignore=compiled)
    command = [sys.executable, "-c", "import bspcsg"]
    done = subprocess.run(
        command, cwd=tmp_path, capture_output=True, text=True, timeout=100, check=False
    )
    last = done.stderr.splitlines()[-1]
    assert last.startswith("ImportError: ") and "Run Python in another folder" in last
    assert str(tmp_path) in last
