"""Pages of Markdown whose code is run, and whose shown output is compared with what is printed."""

import contextlib
import glob
import io
import itertools
import os
import re
import shlex
import shutil
import subprocess
import sys
from collections.abc import Iterator
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np
from PIL import Image

from bspcsg.cli.main import run

ROOT = Path(__file__).resolve().parents[2]
DOCS = ROOT / "docs"

_BLOCK = re.compile(r"^```(\w+)\n(.*?)^```$", re.DOTALL | re.MULTILINE)

#: Languages whose blocks are run, and that of blocks that only show something.
RUN = ("console", "python")
SHOWN = ("json", "openscad", "py", "text", "yaml")

#: The signs of what only a shell can do.
_SHELL = re.compile(r"[|<>;&`]|\$[^?]|\n")

#: The prompt of a shell before the further lines of a command.
_GOES_ON = "> "

#: A line that stands for any number of lines.
ANYTHING = "…"


@dataclass
class Session:
    """The state that the blocks of one page share: variables, and the last exit code."""

    variables: dict[str, Any] = field(default_factory=dict)
    code: int = 0

    def python(self, text: str) -> str:
        """Run a block of Python, and return what it prints."""
        printed = io.StringIO()
        with contextlib.redirect_stdout(printed):
            exec(compile(text, "block", "exec"), self.variables)
        return printed.getvalue()

    def command(self, line: str) -> str:
        """Run a line of a console, and return what it prints on both streams."""
        if line == "echo $?":
            return f"{self.code}\n"
        words = shlex.split(line)
        if words[0] != "bspcsg" or _SHELL.search(_bare(line)):
            return self._shell(line)
        printed = io.StringIO()
        with contextlib.redirect_stdout(printed), contextlib.redirect_stderr(printed):
            self.code = run([name for word in words[1:] for name in _expanded(word)])
        return printed.getvalue()

    def _shell(self, line: str) -> str:
        script = f'bspcsg() {{ "{sys.executable}" -m bspcsg "$@"; }}\n{line}'
        done = subprocess.run(
            ["bash", "-c", script],
            stdout=subprocess.PIPE,
            stderr=subprocess.STDOUT,
            text=True,
            env={**os.environ, "PYTHONPATH": str(ROOT)},
            check=False,
        )
        self.code = done.returncode
        return done.stdout


def _bare(line: str) -> str:
    """Return a line without what is quoted."""
    return re.sub(r"'[^']*'|\"[^\"]*\"", "", line)


def _expanded(word: str) -> list[str]:
    return sorted(glob.glob(word)) or [word] if "*" in word else [word]


def blocks(page: str) -> list[tuple[str, str]]:
    """Return language and text of each block."""
    return _BLOCK.findall(page)


def exchanges(block: str) -> Iterator[tuple[str, str]]:
    """Yield each command of a console block with the output shown below it."""
    for part in re.split(r"^\$ ", block, flags=re.MULTILINE)[1:]:
        first, *rest = part.splitlines(keepends=True)
        more = list(itertools.takewhile(lambda line: line.startswith(_GOES_ON), rest))
        typed = "".join([first, *(line.removeprefix(_GOES_ON) for line in more)])
        yield typed.rstrip("\n"), "".join(rest[len(more) :])


def expected_of(block: str) -> list[str]:
    """Return what the comments of a Python block say is printed."""
    return re.findall(r"# -> (.*)$", block, re.MULTILINE)


def same(printed: str, shown: str) -> bool:
    """Say whether an output is the one that is shown, but for times, versions and sizes."""
    pattern = "\n".join(re.escape(line) for line in _lines(shown))
    anything = re.escape(ANYTHING)
    pattern = re.sub(rf"^{anything}$", r"[\\s\\S]*", pattern, flags=re.MULTILINE)
    return re.fullmatch(pattern, "\n".join(_lines(printed))) is not None


def _lines(text: str) -> list[str]:
    """Return the lines without blanks at their ends, times, versions and sizes of files."""
    text = re.sub(r"\d+(\.\d+)? (m?s|minutes?)\b", "# s", text)
    text = re.sub(r"\b\d+ kB\b", "# kB", text)
    text = re.sub(r"\b\d+\.\d+\.\d+\b", "#.#.#", text)
    return [line.rstrip() for line in text.strip("\n").splitlines()]


def pictures(page: str) -> list[str]:
    """Return the pictures that the code of a page makes; they lie in `pictures` beside it."""
    return re.findall(r"!\[[^\]]+\]\(pictures/([^)]+)\)", page)


def looks_like(path: Path, expected: Path) -> bool:
    """Say whether two pictures are of one size, and the same but for how edges are smoothed."""
    with Image.open(path) as one, Image.open(expected) as other:
        if one.size != other.size:
            return False
        colours = [np.asarray(image.convert("RGB")).astype(int) for image in (one, other)]
    return float(np.abs(colours[0] - colours[1]).mean()) < 1


def page_files() -> list[Path]:
    """Return the pages written by hand."""
    return sorted(path for path in DOCS.rglob("*.md") if path.parent.name != "api")


def rewritten(path: Path) -> str:
    """Return a page with the output of its commands as it is, and put its pictures beside it.

    Output that has “…” in it is kept.
    """
    import tempfile

    page, session = path.read_text("utf-8"), Session()

    def anew(match: "re.Match[str]") -> str:
        language, block = match.groups()
        if language == "python":
            session.python(block)
        if language != "console":
            return match.group()
        text = ""
        for command, shown in exchanges(block):
            printed = session.command(command)
            kept = same(printed, shown)
            typed = command.replace("\n", f"\n{_GOES_ON}")
            text += f"$ {typed}\n{shown if kept else _trimmed(printed)}"
        return f"```console\n{text}```"

    with tempfile.TemporaryDirectory() as folder, contextlib.chdir(folder):
        prepare(Path())
        text = _BLOCK.sub(anew, page)
        for name in pictures(page):
            kept = path.parent / "pictures" / name
            kept.parent.mkdir(exist_ok=True)
            if not kept.exists() or not looks_like(Path(name), kept):
                shutil.copyfile(name, kept)
        return text


def _trimmed(printed: str) -> str:
    return "".join(f"{line.rstrip()}\n" for line in printed.splitlines())


def prepare(folder: Path) -> None:
    """Fill a folder with the meshes that the pages speak of."""
    for path in (ROOT / "examples" / "meshes").iterdir():
        if path.suffix != ".md":
            (folder / path.name).symlink_to(path)
