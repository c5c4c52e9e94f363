"""Check that wheels and source distributions contain the whole package and nothing else.

`python scripts/wheel_contents.py dist/*` prints a line for each file, and ends with 1 if something
is wrong. It needs only Python.
"""

import re
import sys
import tarfile
import zipfile
from email.message import Message
from email.parser import Parser
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent

#: The largest number of bytes of a wheel or a source distribution.
MAX_BYTES = 8_000_000

#: The files that must not be in a source distribution.
_FOREIGN = re.compile(r"(^|/)(\.git|\.venv|target|out|dist|__pycache__)/|\.(so|pyd|pyc)$")

#: The files of a source distribution besides the package.
_SOURCES = (
    "pyproject.toml",
    "README.md",
    "LICENSE",
    "CHANGELOG.md",
    "Cargo.toml",
    "core/Cargo.toml",
)

#: The names of sections of a library that is not stripped.
_SYMBOLS = (b".symtab\0", b".debug_info\0")

#: The folders of the build machine that messages of a library may contain.
_BUILDERS = re.compile(
    rb"(?:/root|/home/[\w.-]+|/Users/[\w.-]+|[A-Z]:[/\\]Users[/\\][\w.-]+)[/\\][\w./\\-]*"
    rb"|(?:/|[A-Z]:)[\w./\\-]*[/\\]registry[/\\]src[/\\][\w./\\-]*"
)


def package(root: Path = ROOT) -> set[str]:
    """Return the relative paths of the package's files in a source tree, without built files."""
    found = (path for path in (root / "bspcsg").rglob("*") if path.is_file())
    names = {path.relative_to(root).as_posix() for path in found}
    return {name for name in names if not _FOREIGN.search(name)}


def problems_of_wheel(path: Path, root: Path) -> list[str]:
    """Return the defects of a wheel, each as a text; empty if there are none."""
    with zipfile.ZipFile(path) as archive:
        names = {name for name in archive.namelist() if not name.endswith("/")}
        info = next(name.split("/")[0] for name in names if ".dist-info/" in name)
        about = archive.read(f"{info}/METADATA").decode("utf-8")
        tags = archive.read(f"{info}/WHEEL").decode("utf-8")
        cores = [name for name in names if re.fullmatch(r"bspcsg/_core\.(abi3\.so|pyd)", name)]
        libraries = [archive.read(name) for name in cores]
    own = {name for name in names if not name.startswith(f"{info}/")} - set(cores)
    problems = [f"{name} is missing" for name in sorted(package(root) - own)]
    problems += [f"{name} should not be there" for name in sorted(own - package(root))]
    problems += _problems_of_metadata(Parser().parsestr(about))
    if len(cores) != 1:
        problems.append(f"it has {len(cores)} native cores")
    for library in libraries:
        problems += problems_of_core(library)
    if "-abi3-" not in tags:
        problems.append("it is for one version of Python only")
    return problems + _problems_of_size(path)


def problems_of_core(library: bytes) -> list[str]:
    """Return the defects of the compiled core, each as a text; empty if there are none."""
    stripped = all(mark not in library for mark in _SYMBOLS)
    problems = [] if stripped else ["the native core is not stripped"]
    named = _BUILDERS.search(library)
    if named:
        folder = named[0].decode("ascii")
        problems.append(f"the native core names a folder of its builder: {folder}")
    return problems


def problems_of_source(path: Path, root: Path) -> list[str]:
    """Return the defects of a source distribution, each as a text; empty if there are none."""
    with tarfile.open(path) as archive:
        names = {name.partition("/")[2] for name in archive.getnames()}
    core = {f.relative_to(root).as_posix() for f in (root / "core/src").rglob("*.rs")}
    wanted = package(root) | core | {*_SOURCES, "Cargo.lock", "PKG-INFO"}
    problems = [f"{name} is missing" for name in sorted(wanted - names)]
    foreign = [name for name in sorted(names) if _FOREIGN.search(name)]
    return problems + [f"{name} should not be there" for name in foreign] + _problems_of_size(path)


def _problems_of_size(path: Path) -> list[str]:
    size = path.stat().st_size
    return [f"it has {size:,} bytes, more than {MAX_BYTES:,}"] if size > MAX_BYTES else []


def _problems_of_metadata(about: Message) -> list[str]:
    wanted = {"Author": "bspcsg contributors", "License-Expression": "Apache-2.0"}
    problems = [f"{key} is not {word}" for key, word in wanted.items() if about[key] != word]
    return problems if about.get_all("Classifier") else [*problems, "it has no classifiers"]


def problems_of(path: Path, root: Path = ROOT) -> list[str]:
    """Return the defects of a wheel or source distribution, each as a text; empty for none."""
    found = problems_of_wheel if path.suffix == ".whl" else problems_of_source
    return found(path, root)


def main() -> int:
    code = 0
    for path in map(Path, sys.argv[1:]):
        problems = problems_of(path)
        print(f"{path.name}: {path.stat().st_size / 1e6:.2f} MB, {len(problems)} problems")
        for problem in problems:
            print(f"  {problem}")
            code = 1
    return code


if __name__ == "__main__":
    sys.exit(main())
