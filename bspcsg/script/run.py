"""Python scripts that make a solid: they assign a variable `result`, or call `show`.

A script is an ordinary Python program; ``python part.py`` runs it as well, and then `show` opens a
page in a browser. `run_script` runs it in a separate process, so that it can be stopped and cannot
crash its caller; its output goes to standard error, not to the caller's standard output. The script
still has all rights of its user: run no script that you would not run with ``python``.
"""

import contextlib
import os
import pickle
import signal
import subprocess
import sys
import tempfile
import traceback
from collections.abc import Iterable, Iterator, Mapping, Sequence
from pathlib import Path
from types import ModuleType
from typing import Any, TypeAlias

from ..errors import BspcsgError, FormatError, invalid_parameter, message_of, unreadable
from ..geometry.chain import FactorChain
from ..operations.setops import union
from ..parameters import file_path, seconds, text_list, values_by_name
from ..processes import parent_pipe
from ..solid.ledger import counted, uncounted
from ..solid.solid import LastOperation, Solid, expression_of, with_record
from .values import VALUES, compiled

#: The default time limit of a script, in seconds.
TIMEOUT = 600.0

#: The exit code of a process that Ctrl-C ended.
_STOPPED = 130

#: True if this system lets a thread block signals.
_CAN_BLOCK_SIGNALS = hasattr(signal, "pthread_sigmask")

#: The program of the child process. Ctrl-C also reaches the child and ends it silently; the parent
#: reports it. The child starts with Ctrl-C blocked, since Python would report it during startup.
_SERVE = (
    f"import os, signal, sys; signal.signal(signal.SIGINT, lambda *_: os._exit({_STOPPED}));"
    f" {_CAN_BLOCK_SIGNALS} and signal.pthread_sigmask(signal.SIG_UNBLOCK, {{signal.SIGINT}});"
    " from bspcsg.processes import end_with_parent; end_with_parent(*map(int, sys.argv[1:]));"
    " from bspcsg.script.run import serve; serve()"
)

#: The result of a script: a solid, or the operation that made it and its transform, which the
#: pickle of a solid lacks.
_ScriptResult: TypeAlias = Solid | tuple[LastOperation, FactorChain]

#: The solids that the script has passed to `show`; None in a process that is not such a child.
_shown: list[Solid] | None = None


@uncounted
def show(*solids: Any) -> None:
    """Show solids in a notebook or browser, or make them the result of a script.

    In a script that `run_script` or the command line runs, the solids are only its result.

    A notebook displays each solid. Elsewhere, a page with an interactive view of all solids is
    written into the folder for temporary files and opened in the browser. Without a browser, a
    message on standard error names the file.

    Parameters
    ----------
    *solids : Solid, Region, Assembly, object, or lists of these
        Any object that `Solid.from_mesh` takes counts as a solid. A region is shown as a slab.

    Raises
    ------
    UnboundedError
        If a solid reaches to infinity.
    InvalidParameterError
        If a solid is empty.
    """
    if _shown is None:
        from ..report.viewer.show import show as show_here

        show_here(*_flattened(solids))
    else:
        _shown.extend(Solid.from_mesh(solid) for solid in _flattened(solids))


def _flattened(items: Iterable[Any]) -> Iterator[Any]:
    """Yield the given objects; replace each list by its entries, also in nested lists."""
    for thing in items:
        yield from _flattened(thing) if isinstance(thing, list) else [thing]


@counted
def run_script(
    path: str | os.PathLike[str],
    *,
    arguments: Sequence[str] = (),
    defines: Mapping[str, Any] | None = None,
    timeout: float | None = TIMEOUT,
) -> Solid:
    """Run a Python script in a separate process and return the solid that it makes.

    Parameters
    ----------
    path : path
        The script. Its folder is first in ``sys.path``, and its ``__name__`` is ``"__main__"``.
    arguments : sequence of str
        The entries after the path in ``sys.argv``.
    defines : mapping, optional
        Values of variables by name. Each replaces the value in every assignment to the variable at
        the script's top level; line numbers stay the same.
    timeout : float, optional
        The time limit in seconds, up to a million; None or infinity for no limit.

    Returns
    -------
    Solid
        The global variable ``result``, or the union of the solids in it if it is a list, or the
        union of all shown solids. It has its operation in `Solid.last_operation`.

    Raises
    ------
    FormatError
        If the script cannot be read ("unreadable"), fails ("script_failed": the message names file
        and line), ends its process ("script_died"), takes too long ("timeout"), makes no solid
        ("no_result") or does not assign a variable in `defines` ("unknown_name").
    """
    name, limit = file_path(path), seconds(timeout, "timeout")
    words, values = text_list(arguments, "arguments"), values_by_name(defines, "defines")
    if not os.path.isfile(name):
        raise unreadable(name)
    with tempfile.TemporaryDirectory(prefix="bspcsg-") as folder:
        answer = Path(folder, "answer")
        code = _run_child(_pickled((name, words, values, str(answer))), name, limit)
        if not answer.is_file():
            message = (
                f"{name}: the script ended its process with exit code {code} before it gave a"
                " result."
            )
            raise FormatError(message, "script_died")
        answered = pickle.loads(answer.read_bytes())
    if isinstance(answered, BspcsgError):
        raise answered
    return answered if isinstance(answered, Solid) else with_record(*answered)


def _pickled(task: tuple[str, list[str], dict[str, Any], str]) -> bytes:
    try:
        return pickle.dumps(task)
    except Exception as error:  # whatever the values do when they are asked
        message = (
            "The values of defines cannot be sent to the process of the script, because they"
            f" cannot be pickled: {message_of(error)}."
        )
        raise invalid_parameter(message) from error


def _run_child(task: bytes, name: str, timeout: float | None) -> int:
    # With -P, modules in the current folder do not shadow this package and its dependencies.
    command = [sys.executable, "-P", "-c", _SERVE]
    package = str(Path(__file__).parents[2])
    search = os.pathsep.join([package, *filter(None, [os.environ.get("PYTHONPATH")])])
    environment = {**os.environ, "PYTHONPATH": search}
    with contextlib.ExitStack() as start:
        start.enter_context(_interrupts_held())
        with (
            parent_pipe() as read_by_child,
            subprocess.Popen(
                [*command, *map(str, read_by_child)],
                stdin=subprocess.PIPE,
                stdout=_standard_error(),
                env=environment,
                pass_fds=read_by_child,
            ) as child,
        ):
            try:
                start.close()
                child.communicate(task, timeout)
            except subprocess.TimeoutExpired as error:
                child.kill()
                message = (
                    f"{name}: the script took longer than the time limit of {timeout:g} seconds"
                    " and was stopped; raise the limit, or simplify the script."
                )
                raise FormatError(message, "timeout") from error
            except BaseException:
                child.kill()
                raise
    return child.returncode


@contextlib.contextmanager
def _interrupts_held() -> Iterator[None]:
    """Block Ctrl-C in this thread and in processes that it starts, if the system supports it."""
    if not _CAN_BLOCK_SIGNALS:
        yield
        return
    before = signal.pthread_sigmask(signal.SIG_BLOCK, {signal.SIGINT})
    try:
        yield
    finally:
        signal.pthread_sigmask(signal.SIG_SETMASK, before)


def _standard_error() -> int:
    """Return the file descriptor of standard error, or `DEVNULL` if it has none."""
    try:
        return sys.stderr.fileno()
    except (AttributeError, OSError, ValueError):
        return subprocess.DEVNULL


def _result_or_error(
    name: str, arguments: list[str], defines: dict[str, Any]
) -> _ScriptResult | BspcsgError:
    global _shown  # noqa: PLW0603  a process runs one script
    _shown = []
    sys.argv = [name, *arguments]
    sys.path.insert(0, str(Path(name).parent.absolute()))
    program = ModuleType("__main__")
    try:
        _run_program(program, name, defines)
        result = _result(name, vars(program))
        return result if isinstance(result, BspcsgError) else _with_operation(result)
    except BspcsgError as error:
        return _located(error, name)
    except Exception as error:
        return _located(error, name)


def _run_program(program: ModuleType, name: str, defines: dict[str, Any]) -> None:
    """Run a script as the main program of this process, until its end or an exit with code 0.

    Raises
    ------
    FormatError
        If the script exits with a message or with a code other than 0; code ``"script_failed"``.
    """
    code = compiled(Path(name).read_bytes(), name, defines)
    vars(program).update({"__file__": name, VALUES: defines} if defines else {"__file__": name})
    sys.modules["__main__"] = program
    try:
        exec(code, vars(program))
    except SystemExit as end:
        if end.code not in (None, 0):
            told = f"code {end.code}" if isinstance(end.code, int) else message_of(end)
            message = f"the script exited with {told} before it gave a result."
            raise FormatError(message, "script_failed").with_traceback(end.__traceback__) from end


def _result(name: str, variables: dict[str, Any]) -> Solid | BspcsgError:
    result = variables.get("result")
    if isinstance(result, (list, tuple)) and (not result or _has_solids(result)):
        return union([Solid.from_mesh(one) for one in result])
    if result is not None:
        return Solid.from_mesh(result)
    if not _shown:
        message = (
            f"{name}: the script gave no result; assign a solid to the variable “result”, or call"
            " bspcsg.show(solid)."
        )
        return FormatError(message, "no_result")
    return union(_shown)


def _has_solids(values: Sequence[Any]) -> bool:
    """Return True if an entry is a solid, so that the values are not the arrays of one mesh."""
    return any(isinstance(one, Solid) for one in values)


def _with_operation(result: Solid) -> _ScriptResult:
    """Return a solid, or if an operation made it, that operation and the transform.

    The caller in another process makes the solid from them.
    """
    last = result.last_operation
    return result if last is None else (last, expression_of(result).factors)


def _located(error: Exception, name: str) -> BspcsgError:
    """Return an error whose message begins with the script's name and the line that raised it."""
    detail = message_of(error) if str(error) else ""
    if isinstance(error, SyntaxError) and error.filename == name:
        line, detail = error.lineno, error.msg
    else:
        frames = traceback.extract_tb(error.__traceback__)
        line = next((f.lineno for f in reversed(frames) if f.filename == name), None)
    place = name if line is None else f"{name}:{line}"
    if isinstance(error, BspcsgError):
        return type(error)(f"{place}: {error.message}", error.code, error.where)
    message = f"{place}: {type(error).__name__}: {detail}".rstrip(": ")
    return FormatError(message, "script_failed", [] if line is None else [line])


def serve() -> None:
    """Run the script that standard input describes, in the child process.

    The pickled result or error is written to a file, completely or not at all.
    """
    try:
        name, arguments, defines, answer = pickle.load(sys.stdin.buffer)
    except (EOFError, pickle.UnpicklingError):
        # The parent was interrupted while it wrote the task, and reports that.
        sys.exit(_STOPPED)
    pickled = pickle.dumps(_result_or_error(name, arguments, defines))
    unfinished = Path(f"{answer}.part")
    unfinished.write_bytes(pickled)
    unfinished.rename(answer)
