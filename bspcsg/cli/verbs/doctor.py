"""The verb `doctor`, which lists the installed and the missing parts of the installation."""

import platform
import shutil
import subprocess
import sys
from dataclasses import asdict, dataclass
from importlib.metadata import PackageNotFoundError, version
from importlib.util import find_spec
from typing import Any

from ..._core import __version__
from ...machine import system
from ..console import output
from ..console.output import Output
from ..console.tables import table_text
from ..options.shared import common_options, verb

_EPILOG = """\b
Example:
  bspcsg doctor
"""

_REQUIRED = {
    "click": "the command line",
    "jinja2": "pages of report and view",
    "manifold3d": "checking results",
    "numpy": "everything",
    "pillow": "PNG pictures",
    "pyclipper": "offsets",
    "rich": "tables",
    "svgelements": "reading SVG files",
    "uharfbuzz": "text",
}

#: Optional packages, the purpose of each, and the extra that installs it.
_OPTIONAL = (
    ("ezdxf", "DXF files", "dxf"),
    ("pymeshlab", "repair", "repair"),
    ("meshio", "VTK and VTU files", "vtk"),
    ("trimesh", "the trimesh engine, to_trimesh, meshes of bench", "trimesh"),
    ("distributed", "crosscheck on a cluster", "cluster"),
)

#: The names under which packages are imported, where they differ from the package's name.
_MODULES = {"pillow": "PIL"}

#: Optional programs, the purpose of each, and the command that installs it.
_PROGRAMS = (("openscad", ".scad files, crosscheck", "apt-get install openscad"),)

#: The longest time for a program to print its version or load its plug-ins, in seconds.
_PROGRAM_TIMEOUT = 30

_ASK_PLUGINS = "import pymeshlab; print('plugins', pymeshlab.plugin_number())"


@dataclass(frozen=True)
class _Part:
    """One part of the installation: a package or a program.

    Parameters
    ----------
    name, found : str
        The name of the part, and its version; empty if the part is missing.
    purpose : str
        The features that need the part.
    remedy : str
        The command to type if the part is missing or incomplete, else empty.
    required : bool
    """

    name: str
    found: str
    purpose: str
    remedy: str = ""
    required: bool = False


@verb("doctor", short_help="Say what is installed, and how to get the rest.", epilog=_EPILOG)
@common_options
def doctor(**given: Any) -> int:
    """Say which parts are installed, and how to get those that are not.

    Missing optional parts are no failure; the exit code is 6 if a required one is missing.
    """
    out = Output.of(given)
    parts = [*_own(), *map(_required, _REQUIRED), *_packages(), *_programs()]
    broken = any(part.required and part.remedy for part in parts)
    document = {"parts": [asdict(part) for part in parts], "complete": not broken}
    out.result(_text(parts), document)
    return output.MISSING if broken else output.DONE


def _own() -> list[_Part]:
    python = f"{platform.python_version()} ({sys.executable})"
    return [
        _Part("bspcsg", __version__, ""),
        _Part("Python", python, ""),
        _Part("system", system(), ""),
    ]


def _required(name: str) -> _Part:
    found = _version_of(name)
    return _Part(
        name, found, _REQUIRED[name], "" if found else f"pip install {name}", required=True
    )


def _packages() -> list[_Part]:
    parts = []
    for name, purpose, extra in _OPTIONAL:
        found = _version_of(name)
        install = f'pip install "bspcsg[{extra}]"'
        parts.append(_Part(name, found, purpose, "" if found else install))
    return [_with_libraries(part) if part.name == "pymeshlab" else part for part in parts]


def _version_of(name: str) -> str:
    """Return the version of an installed package; an empty string if it cannot be imported."""
    try:
        return version(name) if find_spec(_MODULES.get(name, name)) is not None else ""
    except (PackageNotFoundError, ImportError, ValueError):
        return ""


def _with_libraries(part: _Part) -> _Part:
    """Return the part pymeshlab, with a remedy if a system library that it needs is missing.

    pymeshlab is loaded in a separate process.
    """
    from ...repair.pymeshlab_child import PLUGINS
    from ...repair.repair import install_command

    if not part.found:
        return part
    said = _output_of([sys.executable, "-P", "-c", _ASK_PLUGINS])
    count = said.rpartition("plugins ")[2].strip()
    if count.isdigit() and int(count) >= PLUGINS:
        return part
    reason = f"{count} of {PLUGINS} plug-ins" if count.isdigit() else "cannot be loaded"
    remedied = install_command("plug-ins" if count.isdigit() else said)
    return _Part(part.name, f"{part.found}, {reason}", part.purpose, remedied)


def _programs() -> list[_Part]:
    parts = []
    for name, purpose, install in _PROGRAMS:
        path = shutil.which(name)
        found = _output_of([path, "--version"]).strip().splitlines()[-1:] if path else []
        parts.append(_Part(name, " ".join(found) or path or "", purpose, "" if path else install))
    return parts


def _output_of(command: list[str]) -> str:
    try:
        done = subprocess.run(command, capture_output=True, timeout=_PROGRAM_TIMEOUT, check=False)
    except (OSError, subprocess.TimeoutExpired):
        return ""
    return (done.stdout + done.stderr).decode("utf-8", "replace")


def _text(parts: list[_Part]) -> str:
    rows = [(part.name, part.found or "missing", part.purpose) for part in parts]
    lacking = [part for part in parts if part.remedy]
    return "\n".join([table_text(("part", "found", "needed for"), rows), *map(_advice, lacking)])


def _advice(part: _Part) -> str:
    """Return a text on a missing or incomplete part, with the command that installs it."""
    state = "incomplete" if part.found else "missing"
    return f"{part.name} is {state}; it is needed for {part.purpose}. Try:\n  {part.remedy}"
