"""Tracebacks end at the user's line, and errors are short."""

import pickle
import subprocess
import sys
from pathlib import Path

import pytest

import bspcsg as b

#: Each fails in its last line, deep inside the package.
PROGRAMS = [
    "b.Solid([[0, 0, 0], [1, 0, 0], [0, 1, 0]], [[0, 1, 2]])\n",
    "b.cube(-1)\n",
    "b.load('none.stl')\n",
    "b.half_space((0, 0, 1), 0).to_mesh()\n",
    "b.half_space((0, 0, 1), 0).volume\n",
    "b.cube(1).chamfer(b.cube(1).edges(), 9)\n",
    "b.text('a', size=-1)\n",
    "b.Assembly.load('none.3mf')\n",
    "(~b.cube(1)).save('x.stl')\n",
]

#: The user's frame, and the one place that lets go of the others.
FRAMES = 2


def failure(program: str, folder: Path, **more: str) -> str:
    path = folder / "user.py"
    path.write_text(f"import bspcsg as b\n\n\n{program}")
    root = str(Path(b.__file__).parent.parent)
    done = subprocess.run(
        [sys.executable, str(path)],
        cwd=folder,
        env={"PYTHONPATH": root, **more},
        capture_output=True,
        text=True,
        check=False,
    )
    assert done.returncode == 1
    return done.stderr


# Found: tracebacks carried seven frames of ours.
@pytest.mark.parametrize("program", PROGRAMS)
def test_tracebacks_end_at_the_user(program: str, tmp_path: Path) -> None:
    said = failure(program, tmp_path)
    lines = [line for line in said.splitlines() if line.startswith("  File ")]
    assert "user.py" in lines[0] and ", line 4" in lines[0]
    assert len(lines) == FRAMES, said
    assert "direct cause" not in said and "During handling" not in said


def test_all_frames_stay_if_asked_for(tmp_path: Path) -> None:
    said = failure("b.cube(-1)\n", tmp_path, BSPCSG_TRACEBACKS="full")
    assert said.count("  File ") > FRAMES


def test_what_other_libraries_said_stays_without_frames(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.delenv("BSPCSG_TRACEBACKS")
    path = tmp_path / "bad.3mf"
    path.write_bytes(b"PK\x03\x04nothing")
    with pytest.raises(b.FormatError) as caught:
        b.load(path)
    cause = caught.value.__cause__
    assert cause is not None and cause.__traceback__ is None


def test_defects_keep_all_frames(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.delenv("BSPCSG_TRACEBACKS")
    from bspcsg.errors import InternalError
    from bspcsg.tracebacks import shortened

    def inner() -> None:
        raise InternalError("a defect", "internal", ())

    @shortened
    def outer() -> None:
        inner()

    with pytest.raises(InternalError) as caught:
        outer()
    assert caught.traceback[-1].name == "inner"


def test_public_functions_are_the_ones_of_their_modules() -> None:
    public = b.union
    from bspcsg.operations.setops import union

    assert union is public and pickle.loads(pickle.dumps(b.union)) is b.union
    assert b.union.__name__ == "union" and (b.Solid.__or__.__doc__ or "").startswith("Union")


# Found: errors told twenty digits.
def test_messages_round_numbers() -> None:
    ball = b.sphere(1, segments=12).rotate((10, 20, 33))
    with pytest.raises(b.InvalidMeshError) as caught:
        b.Solid(ball.vertices * 1e-5, ball.faces[1:])
    numbers = [word.strip("(),.") for word in caught.value.message.split() if "e-" in word]
    assert len(numbers) == 6 and all(len(number) <= len("-1.23456e-10") for number in numbers)


# Found: `dir` leaked what is not public.
def test_dir_shows_public_names_only() -> None:
    names = dir(b)
    assert set(b.__all__) <= set(names)
    leaked = {"Any", "import_module", "TYPE_CHECKING", "above", "conveniences"}
    assert not leaked & set(names)
    assert dir(b.io) == sorted(b.io.__all__)
