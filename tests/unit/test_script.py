import contextlib
import io
import math
import sys
import webbrowser
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import pytest

import bspcsg as b
from bspcsg.script import run as running
from support.cli import Capture


@pytest.fixture
def here(monkeypatch: pytest.MonkeyPatch) -> None:
    """Run scripts in this process, since a new process takes a third of a second."""

    def run_child(task: bytes, name: str, timeout: float | None) -> int:
        known = set(sys.modules)
        with monkeypatch.context() as patch, contextlib.redirect_stdout(sys.stderr):
            patch.setattr(running, "_shown", [])
            patch.setattr("sys.argv", [])
            patch.setattr("sys.path", list(sys.path))
            patch.setitem(sys.modules, "__main__", sys.modules["__main__"])
            patch.setattr("sys.stdin", SimpleNamespace(buffer=io.BytesIO(task)))
            running.serve()
        for module in set(sys.modules) - known:
            if str(getattr(sys.modules[module], "__file__", "")).startswith(str(Path(name).parent)):
                del sys.modules[module]
        return 0

    monkeypatch.setattr(running, "_run_child", run_child)


def script(folder: Path, text: str) -> Path:
    path = folder / "part.py"
    path.write_text(text)
    return path


def test_a_result_is_the_solid(tmp_path: Path) -> None:
    path = script(tmp_path, "import bspcsg as b\nresult = b.cube(3) - b.cube(1)\n")
    assert b.run_script(path).volume == 26


@pytest.mark.usefixtures("here")
def test_results_know_what_made_them(tmp_path: Path) -> None:
    text = "import bspcsg as b\nresult = (b.cube(3) - b.half_space((1, 0, 0), 1)).scale(2)\n"
    result = b.run_script(script(tmp_path, text))
    made = result.last_operation
    assert made is not None and [op for op, _ in made.program] == ["leaf", "leaf", "not", "and"]
    assert made.operands[0].equals(b.cube(3)) and not made.operands[1].is_bounded
    assert made.result.volume == 18 and result.volume == 144
    path = script(tmp_path, "import bspcsg as b\nresult = b.cube(1)\n")
    assert b.run_script(path).last_operation is None


@pytest.mark.usefixtures("here")
def test_results_may_be_several_or_meshes(tmp_path: Path) -> None:
    path = script(tmp_path, "import bspcsg as b\nresult = [b.cube(1), b.cube(2)]\n")
    assert b.run_script(path).volume == 8
    path = script(tmp_path, "import trimesh\nresult = trimesh.creation.box((1, 2, 3))\n")
    assert b.run_script(path).volume == pytest.approx(6)


def test_what_is_shown_is_united_even_after_exit(tmp_path: Path) -> None:
    path = script(
        tmp_path,
        "import sys\nimport bspcsg as b\nb.show(b.cube(1))\nb.show(b.cube(1).translate(3, 0, 0))\n"
        "sys.exit(0)\n",
    )
    assert b.run_script(path).volume == 2


@pytest.mark.usefixtures("here")
def test_scripts_see_their_folder_their_arguments_and_defines(tmp_path: Path) -> None:
    (tmp_path / "sizes.py").write_text("HEIGHT = 5\n")
    path = script(
        tmp_path,
        "import sys\nimport bspcsg as b\nfrom sizes import HEIGHT\nassert __name__ == '__main__'\n"
        "w = 1\nresult = b.box((w, float(sys.argv[1]), HEIGHT))\n",
    )
    assert b.run_script(path, arguments=["3"], defines={"w": 2}).volume == 30


ASSIGNING = """import sys
import bspcsg as b
size: float = 1
a = c = 2
d, (e, *f) = 3, (4, 5)
if size > 7:
    late = 1
try:
    early
except NameError:
    early = 1
def half(size):
    a = 100
    return size / 2
result = b.box((half(2 * size), 1, 1))
assert [a, c, d, e, f, early, "late" in globals()] == eval(sys.argv[1])
if early == 9: raise ValueError("line 17")
"""


# Found: `-D` did nothing where the script assigns the name, and took any name.
@pytest.mark.usefixtures("here")
@pytest.mark.parametrize(
    ("defines", "volume", "left"),
    [
        ({}, 1, "[2, 2, 3, 4, [5], 1, False]"),
        ({"size": 5}, 5, "[2, 2, 3, 4, [5], 1, False]"),
        ({"size": 8, "late": 2}, 8, "[2, 2, 3, 4, [5], 1, True]"),
        ({"a": [1]}, 1, "[[1], 2, 3, 4, [5], 1, False]"),
        ({"a": "x", "c": None}, 1, "['x', None, 3, 4, [5], 1, False]"),
        ({"e": 7, "f": {1: 2}, "early": 3}, 1, "[2, 2, 3, 7, {1: 2}, 3, False]"),
    ],
)
def test_values_take_the_place_of_what_the_top_level_assigns(
    tmp_path: Path, defines: dict[str, object], volume: float, left: str
) -> None:
    path = script(tmp_path, ASSIGNING)
    assert b.run_script(path, arguments=[left], defines=defines).volume == volume


@pytest.mark.usefixtures("here")
def test_names_that_are_not_assigned_cannot_be_set(tmp_path: Path) -> None:
    path = script(tmp_path, ASSIGNING)
    with pytest.raises(b.FormatError) as caught:
        b.run_script(path, defines={"size": 1, "sise": 2})
    assert caught.value.code == "unknown_name"
    assert str(caught.value) == (
        f"{path}: the script does not assign the variable sise at its top level. Is size meant? It"
        " assigns size, a, c, d, e, f, result, late, early."
    )
    for name in "half", "sys", "b":
        with pytest.raises(b.FormatError, match=f"does not assign the variable {name} at"):
            b.run_script(path, defines={name: 1})
    path = script(tmp_path, "import bspcsg as b\nb.show(b.cube(1))\n")
    with pytest.raises(b.FormatError, match="at its top level; it assigns no variable"):
        b.run_script(path, defines={"w": 1})


@pytest.mark.usefixtures("here")
def test_lines_keep_their_numbers_where_values_are_set(tmp_path: Path) -> None:
    path = script(tmp_path, ASSIGNING)
    with pytest.raises(b.FormatError, match=r"part\.py:17: ValueError: line 17"):
        b.run_script(path, arguments=["[0, 2, 3, 4, [5], 9, False]"], defines={"a": 0, "early": 9})


def test_what_scripts_print_goes_to_standard_error(
    tmp_path: Path, capfd: pytest.CaptureFixture[str]
) -> None:
    path = script(tmp_path, "import bspcsg as b\nprint('made')\nresult = b.cube(1)\n")
    b.run_script(path)
    assert "made" not in capfd.readouterr().out


@pytest.mark.parametrize(
    ("text", "code", "says"),
    [
        ("def f():\n    return 1 / 0\nf()\n", "script_failed", "part.py:2: ZeroDivisionError: div"),
        ("x = (\n", "script_failed", "part.py:1: SyntaxError: '(' was never closed"),
        ("import bspcsg\nbspcsg.cube(-1)\n", "invalid_parameter", "part.py:2: size must be above"),
        ("x = 1\n", "no_result", "gave no result"),
        ("result = 3\n", "invalid_parameter", "The int is not a mesh"),
        (
            "import bspcsg as b\nresult = [b.cube(1), None]\n",
            "invalid_parameter",
            "The NoneType is not a mesh",
        ),
    ],
)
@pytest.mark.usefixtures("here")
def test_scripts_that_fail(tmp_path: Path, text: str, code: str, says: str) -> None:
    with pytest.raises(b.BspcsgError) as caught:
        b.run_script(script(tmp_path, text))
    assert caught.value.code == code
    assert says in str(caught.value)


def test_scripts_that_end_without_an_answer(tmp_path: Path) -> None:
    with pytest.raises(b.FormatError, match="ended its process with exit code 3") as caught:
        b.run_script(script(tmp_path, "import os\nos._exit(3)\n"))
    assert caught.value.code == "script_died"
    with pytest.raises(b.FormatError, match=r"time limit of 0\.5 seconds") as caught:
        b.run_script(script(tmp_path, "while True:\n    pass\n"), timeout=0.5)
    assert caught.value.code == "timeout"


def test_a_script_that_is_not_there(tmp_path: Path) -> None:
    with pytest.raises(b.FormatError, match="No such file"):
        b.run_script(tmp_path / "none.py")


@pytest.fixture
def pages(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> list[Path]:
    """Return the list of pages that a browser is asked to open, as on a desktop."""
    asked: list[Path] = []

    def opening(address: str) -> bool:
        asked.append(Path(address.removeprefix("file://")))
        return True

    monkeypatch.setattr(webbrowser, "open", opening)
    monkeypatch.setattr("tempfile.tempdir", str(tmp_path))
    for name in ("SSH_CONNECTION", "SSH_TTY"):
        monkeypatch.delenv(name, raising=False)
    monkeypatch.setenv("DISPLAY", ":0")
    return asked


# Found: `show` did nothing, silently.
@pytest.mark.parametrize(
    "thing",
    [
        b.cube(2) - b.cube(1),
        b.Region.circle(2),
        b.Assembly("two", [b.cube(1), b.Assembly("lid", b.cube(1).translate(z=2))]),
    ],
)
def test_show_opens_a_page(thing: Any, pages: list[Path], capsys: Capture) -> None:
    thing.show()
    b.show(thing)
    assert [page.suffix for page in pages] == [".html", ".html"]
    texts = [page.read_text("utf-8") for page in pages]
    assert texts[0] == texts[1] and 'id="bspcsg-viewer"' in texts[0]
    assert capsys.readouterr() == ("", "")


def test_several_things_are_on_one_page(pages: list[Path]) -> None:
    b.show()
    assert not pages
    b.show(b.cube(1), (b.cube(2).vertices, b.cube(2).faces))
    assert len(pages) == 1 and pages[0].read_text("utf-8").count("12 triangles") >= 2


def test_without_a_browser_show_says_where_the_page_is(
    pages: list[Path], capsys: Capture, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("DISPLAY", "")
    monkeypatch.setenv("WAYLAND_DISPLAY", "")
    b.cube(1).show()
    monkeypatch.setenv("DISPLAY", ":0")
    monkeypatch.setattr(webbrowser, "open", lambda _: False)
    b.cube(1).show()
    out, err = capsys.readouterr()
    first, second = err.splitlines()
    assert not pages and out == ""
    for line, words in (
        (first, "this machine has no display"),
        (second, "no browser could be started"),
    ):
        assert Path(line.partition(":")[0]).is_file() and words in line


def test_what_cannot_be_shown_is_refused(pages: list[Path]) -> None:
    things: list[Any] = [b.Solid.empty(), b.Region.empty(), object()]
    for thing in things:
        with pytest.raises(b.InvalidMeshError):
            b.show(thing)
    for endless in (~b.cube(1), ~b.Region.circle(1)):
        with pytest.raises(b.UnboundedError):
            endless.show()
    assert not pages


# Found: `run` took a script that gives up by `sys.exit("…")` for done, and lost a `result` before
# `sys.exit(0)`.
@pytest.mark.usefixtures("here")
def test_scripts_may_exit_with_a_result(tmp_path: Path) -> None:
    for end in ("sys.exit()", "sys.exit(0)", "sys.exit(None)"):
        text = f"import sys\nimport bspcsg as b\nresult = b.cube(2)\n{end}\n"
        assert b.run_script(script(tmp_path, text)).volume == 8


@pytest.mark.usefixtures("here")
@pytest.mark.parametrize(("code", "says"), [('"no width"', "no width"), ("3", "code 3")])
def test_scripts_that_give_up(tmp_path: Path, code: str, says: str) -> None:
    text = f"import sys\nimport bspcsg as b\nb.show(b.cube(1))\nsys.exit({code})\n"
    with pytest.raises(b.FormatError, match=rf"part.py:4: the script exited with {says}") as failed:
        b.run_script(script(tmp_path, text))
    assert failed.value.code == "script_failed"


# Found: errors of scripts that run held the line breaks and control characters of what these
# said.
@pytest.mark.usefixtures("here")
@pytest.mark.parametrize("end", ["sys.exit({})", "raise ValueError({})"])
def test_errors_of_scripts_are_one_line(tmp_path: Path, end: str) -> None:
    for words in ("'first\\n  \\x1b[3msecond'", "''"):
        with pytest.raises(b.FormatError, match=r"part.py:2: .*\w") as failed:
            b.run_script(script(tmp_path, f"import sys\n{end.format(words)}\n"))
        assert failed.value.message.isprintable()


# Found: an error of syntax in a module was told at a line of the script that imports it.
@pytest.mark.usefixtures("here")
def test_errors_of_syntax_in_modules_are_told_at_their_import(tmp_path: Path) -> None:
    Path(tmp_path, "broken.py").write_text("x = 1\n\n\ndef f(:\n    pass\n")
    with pytest.raises(b.FormatError, match=r"part.py:2: SyntaxError.*broken.py, line 4"):
        b.run_script(script(tmp_path, "x = 1\nimport broken\n"))


# Found: `run_script` took texts for lists of words, and times and values that make no sense ended
# in raw errors of Python.
@pytest.mark.usefixtures("here")
@pytest.mark.parametrize(
    "wrong",
    [
        *({"timeout": value} for value in ("5", math.nan, 0, -1, 1e7, True)),
        *({"arguments": value} for value in (5, "abc", [5], None)),
        *({"defines": value} for value in ("size=4", {4: 4}, {"size": lambda: 4})),
    ],
)
def test_parameters_that_make_no_sense(tmp_path: Path, wrong: dict[str, Any]) -> None:
    with pytest.raises(b.InvalidParameterError, match=next(iter(wrong))):
        b.run_script(script(tmp_path, "size = 3\n"), **wrong)


def test_times_without_end(tmp_path: Path) -> None:
    path = script(tmp_path, "import bspcsg\nresult = bspcsg.cube(2)\n")
    for timeout in (None, math.inf):
        assert b.run_script(path, timeout=timeout).volume == 8


def test_names_too_long_for_a_script() -> None:
    with pytest.raises(b.FormatError, match="No such file"):
        b.run_script("a" * 300)
