"""The verb that evaluates scripts: run."""

import warnings
from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from ..errors import FormatError
from .files import shown
from .job import Job
from .options import TIMEOUT, common, making

if TYPE_CHECKING:
    from ..solid import Solid

_EPILOG = """\b
Example:
  bspcsg run bracket.scad -o bracket.3mf --polish
"""

_SUFFIXES = (".csg", ".scad", ".py")


@click.command(
    "run", short_help="Write the solid that an OpenSCAD or Python script makes.", epilog=_EPILOG
)
@click.argument("script", type=click.Path(path_type=Path, readable=False), metavar="SCRIPT")
@click.option(
    "--polish", is_flag=True, help="Undo OpenSCAD's rounding to six digits; not for Python."
)
@click.option(
    "--skip-open",
    is_flag=True,
    help="Leave out meshes that are not closed, with a warning; not for Python.",
)
@TIMEOUT
@making
@common
def run(script: Path, **given: Any) -> int:
    """Evaluate a script and write the solid it makes.

    A .csg file is read as OpenSCAD writes it, a .scad file needs the program openscad. A .py file
    leaves its solid in the variable result, or calls bspcsg.show; it runs with all your rights, and
    what it prints goes to standard error.
    """
    return _Run(script, **given).run()


class _Run(Job):
    """One script."""

    def __init__(self, script: Path, **settings: Any) -> None:
        super().__init__("run", **settings)
        self._script = script
        self._suffix = script.suffix.lower()

    def paths(self) -> Sequence[Path]:
        return [self._script]

    def refuse_inputs(self) -> None:
        if self._suffix not in _SUFFIXES:
            known = ", ".join(_SUFFIXES)
            message = f"{shown(self._script)}: this is no script; known are {known}."
            raise FormatError(message, "unknown_format")
        self._refuse_options()

    def _refuse_options(self) -> None:
        for name, useless in (("polish", ".py"), ("skip_open", ".py"), ("timeout", ".csg")):
            if self.settings[name] and self._suffix == useless:
                option = name.replace("_", "-")
                raise click.UsageError(f"--{option} is not for {useless} files.")

    def combined(self) -> "Solid":
        from ..script import run_script

        limits = {} if self.settings["timeout"] is None else {"timeout": self.settings["timeout"]}
        if self._suffix == ".py":
            return run_script(self._script, **limits)
        return self._loaded(**limits)

    def _loaded(self, **limits: float) -> "Solid":
        """Return the solid of OpenSCAD's script; what was left out is told."""
        from .. import csg

        with warnings.catch_warnings(record=True) as caught:
            warnings.simplefilter("always", csg.CsgWarning)
            solid = csg.load(
                self._script,
                polish=self.settings["polish"],
                on_invalid="warn" if self.settings["skip_open"] else "error",
                **limits,
            )
        # A polished model is evaluated twice, and warns as often.
        for said in dict.fromkeys(str(warning.message) for warning in caught):
            self.out.warning(said)
        return solid
