"""Ctrl-C is quiet from the moment at which the command line's own code starts."""

import os
import pickle
import signal
import subprocess
import sys
import time
from pathlib import Path

import pytest

import bspcsg as b
from bspcsg.script import run
from support.cli import heed_interrupts

#: As a console script, but that it tells when the package's entry has begun.
ENTRY = """
import os
from bspcsg.cli import entry
replace = entry._replace
entry._replace = lambda *ways: (replace(*ways), os.write(2, b"."))
entry.main()
"""

#: Interrupts itself while a module is imported, then where an exception gets lost, and then where
#: numpy takes one for an answer.
BADLY_TIMED = """
import signal, sys, time
import numpy as np
from bspcsg.cli import entry
signal.signal(signal.SIGINT, entry._end_in_order)
def npy_ctypes_check(cls):
    import signal
    signal.raise_signal(signal.SIGINT)
    return False
interrupted = npy_ctypes_check
sys.unraisablehook = entry._catch_lost
class Lost:
    def __del__(self):
        signal.raise_signal(signal.SIGINT)
np._core._internal.npy_ctypes_check.__code__ = interrupted.__code__
for moment in ("import interrupting", "Lost()", "np.dtype(Lost)"):
    try:
        exec(moment)
        print("passed", moment)
        time.sleep(60)
    except KeyboardInterrupt:
        print("interrupted")
"""

#: Interrupts itself where the core looks up numpy's functions.
AT_FIRST_ARRAYS = """
import signal, time
import numpy
from bspcsg.cli import entry
signal.signal(signal.SIGINT, entry._end_in_order)
start = numpy.lib.NumpyVersion.__init__
def interrupted(self, *words):
    signal.raise_signal(signal.SIGINT)
    start(self, *words)
numpy.lib.NumpyVersion.__init__ = interrupted
try:
    import bspcsg
    bspcsg.cube(1).to_mesh()
    time.sleep(60)
except KeyboardInterrupt:
    print("interrupted")
"""

#: Interrupts itself when a module is looked for, in a program of some name.
AT_AN_IMPORT = """
import signal, sys
program, name = sys.argv[1:]
sys.argv[0] = program
class Finder:
    @staticmethod
    def find_spec(found, path, target=None):
        if found == name:
            signal.raise_signal(signal.SIGINT)
sys.meta_path.insert(0, Finder)
import bspcsg.cli.entry
assert signal.getsignal(signal.SIGINT) is signal.default_int_handler
print("imported")
"""

SLOW = "import time\ntime.sleep(60)\n"


def interrupted(delay: float, *arguments: str) -> tuple[int, bytes, bytes]:
    """Run the command line, send Ctrl-C after a delay, and return exit code and both streams."""
    with subprocess.Popen(
        [sys.executable, "-c", ENTRY, *arguments],
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        start_new_session=True,
        preexec_fn=heed_interrupts,  # noqa: PLW1509
    ) as running:
        assert running.stderr is not None
        assert running.stderr.read(1) == b"."
        time.sleep(delay)
        os.killpg(running.pid, signal.SIGINT)
        out, err = running.communicate(timeout=60)
    return running.returncode, out, err


# Found: Ctrl-C in the first 0.1 s printed a traceback.
@pytest.mark.skipif(os.name != "posix", reason="signals of POSIX")
@pytest.mark.sampled(6)
@pytest.mark.parametrize("delay", [k / 20 for k in range(13)])
def test_interrupts_are_quiet_at_any_moment(tmp_path: Path, delay: float) -> None:
    b.sphere(1, segments=300).save(tmp_path / "a.stl")
    target = tmp_path / "x.stl"
    a = str(tmp_path / "a.stl")
    code, _, err = interrupted(delay, "union", a, a, "-o", str(target))
    assert b"Traceback" not in err and len(err.splitlines()) <= 1
    assert code == 130 or (code == 0 and target.exists())
    assert [path.name for path in tmp_path.iterdir() if path.suffix == ".part"] == []


@pytest.mark.sampled(4)
@pytest.mark.parametrize("program", ["/usr/bin/bspcsg", "bspcsg.exe", "-m", "other.py"])
@pytest.mark.parametrize("name", ["bspcsg._core", "bspcsg.suggestions", "nothing"])
def test_interrupts_are_quiet_while_the_package_is_imported(program: str, name: str) -> None:
    """As long as it is imported for the command line; other programs are told."""
    done = subprocess.run(
        [sys.executable, "-c", AT_AN_IMPORT, program, name],
        env={**os.environ, "PYTHONPATH": str(Path(b.__file__).parent.parent)},
        capture_output=True,
        text=True,
        timeout=60,
        check=False,
        preexec_fn=heed_interrupts if os.name == "posix" else None,
    )
    if name == "nothing":
        assert (done.returncode, done.stdout, done.stderr) == (0, "imported\n", "")
    elif program == "other.py":
        assert done.stderr.endswith("KeyboardInterrupt\n") and not done.stdout
    else:
        assert (done.returncode, done.stdout, done.stderr) == (130, "", "")


@pytest.mark.skipif(os.name != "posix", reason="signals of POSIX")
@pytest.mark.sampled(5)
@pytest.mark.parametrize("delay", [0.0, 0.1, 0.3, 0.6, 1.0])
def test_scripts_are_interrupted_quietly(tmp_path: Path, delay: float) -> None:
    (tmp_path / "slow.py").write_text(SLOW)
    code, _, err = interrupted(delay, "run", str(tmp_path / "slow.py"), "-o", "x.stl")
    assert code == 130 and len(err.splitlines()) <= 1 and b"Traceback" not in err


# Found: Ctrl-C while the process of a script starts printed a fatal error of Python.
@pytest.mark.skipif(os.name != "posix", reason="signals of POSIX")
def test_scripts_are_interrupted_quietly_while_python_starts(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capfd: pytest.CaptureFixture[str]
) -> None:
    (tmp_path / "sitecustomize.py").write_text(
        "import signal\nsignal.raise_signal(signal.SIGINT)\n"
    )
    (tmp_path / "cube.py").write_text("import bspcsg\nresult = bspcsg.box(1, 1, 1)\n")
    monkeypatch.setenv("PYTHONPATH", str(tmp_path))
    with pytest.raises(b.FormatError, match="with exit code 130"):
        run.run_script(str(tmp_path / "cube.py"))
    assert capfd.readouterr() == ("", "")
    assert signal.SIGINT not in signal.pthread_sigmask(signal.SIG_BLOCK, set())


@pytest.mark.sampled(3)
@pytest.mark.parametrize("written", [0, 1, 20])
def test_scripts_whose_parent_was_stopped_are_quiet(written: int) -> None:
    task = pickle.dumps(("slow.py", [], {}, "answer"))
    done = subprocess.run(
        [sys.executable, "-c", run._SERVE],
        env={**os.environ, "PYTHONPATH": str(Path(b.__file__).parent.parent)},
        input=task[:written],
        capture_output=True,
        timeout=60,
        check=False,
    )
    assert (done.returncode, done.stdout, done.stderr) == (130, b"", b"")


@pytest.mark.skipif(os.name != "posix", reason="signals of POSIX")
def test_interrupts_that_come_at_a_bad_moment_come_again(tmp_path: Path) -> None:
    (tmp_path / "interrupting.py").write_text(
        "import signal\nsignal.raise_signal(signal.SIGINT)\nprint('imported')\n"
    )
    done = subprocess.run(
        [sys.executable, "-c", BADLY_TIMED],
        cwd=tmp_path,
        env={**os.environ, "PYTHONPATH": f"{tmp_path}:{Path(b.__file__).parent.parent}"},
        capture_output=True,
        text=True,
        timeout=60,
        check=True,
    )
    assert done.stderr == ""
    assert done.stdout.splitlines() == [
        "imported",
        "passed import interrupting",
        "interrupted",
        "passed Lost()",
        "interrupted",
        "passed np.dtype(Lost)",
        "interrupted",
    ]


@pytest.mark.skipif(os.name != "posix", reason="signals of POSIX")
def test_interrupts_at_the_first_arrays_are_no_defect(tmp_path: Path) -> None:
    done = subprocess.run(
        [sys.executable, "-c", AT_FIRST_ARRAYS],
        cwd=tmp_path,
        env={**os.environ, "PYTHONPATH": str(Path(b.__file__).parent.parent)},
        capture_output=True,
        text=True,
        timeout=60,
        check=False,
    )
    assert (done.returncode, done.stdout, done.stderr) == (0, "interrupted\n", "")


#: Interrupts itself while a module is imported, and is done before the interrupt comes again.
AT_THE_END = """
import signal, sys
from bspcsg.cli import entry, main
class Finder:
    @staticmethod
    def find_spec(name, path, target=None):
        if name == "interrupting":
            signal.raise_signal(signal.SIGINT)
sys.meta_path.insert(0, Finder)
class Late:
    def __del__(self, raise_signal=signal.raise_signal, interrupt=signal.SIGINT):
        raise_signal(interrupt)
def done(began):
    if sys.argv[1] == "import":
        try:
            import interrupting
        except ModuleNotFoundError:
            pass
    elif sys.argv[1] == "finally":
        signal.getsignal = interrupted
    else:
        sys.late = Late()
    sys.exit(0)
def interrupted(number, getsignal=signal.getsignal):
    signal.getsignal = getsignal
    signal.raise_signal(signal.SIGINT)
    return getsignal(number)
main.main = done
entry.main()
"""


# Found: an interrupt that was raised a second time came when Python had no signal handlers any
# more, and killed the process by another signal; other interrupts came while handlers were being
# changed, or later.
@pytest.mark.skipif(os.name != "posix", reason="signals of POSIX")
@pytest.mark.parametrize(("moment", "code"), [("import", 130), ("finally", 130), ("after", 0)])
def test_interrupts_at_the_end_are_quiet(moment: str, code: int) -> None:
    done = subprocess.run(
        [sys.executable, "-c", AT_THE_END, moment],
        env={**os.environ, "PYTHONPATH": str(Path(b.__file__).parent.parent)},
        capture_output=True,
        text=True,
        timeout=60,
        check=False,
        preexec_fn=heed_interrupts,
    )
    assert (done.returncode, done.stdout, done.stderr) == (code, "", "")
