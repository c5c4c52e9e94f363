"""Build wheels of the committed state, check their content, and try them without Rust.

Zig links them against an old C library, so that they also run on old systems; it and maturin are
installed into out/wheel. A wheel for this machine is installed into an environment of its own,
without compilers on the PATH: there the time from `pip install` to the first checked set operation
is measured, then scripts/smoke.py and the demo run. With --record the figures are recorded.
"""

import argparse
import json
import os
import platform
import resource
import shutil
import subprocess
import sys
import tarfile
import tempfile
import time
from dataclasses import dataclass
from io import BytesIO
from pathlib import Path
from typing import TypeAlias

from recording import RECORDS, REPOSITORY, machine, write_record
from wheel_contents import problems_of

#: The size of a wheel and the times of its trial, by name.
Figures: TypeAlias = dict[str, str | float]

OUT = REPOSITORY / "out" / "wheel"
DIST = REPOSITORY / "dist"

#: For each kind of wheel the target of the compiler, and the platform tag.
TARGETS = {
    "manylinux": ("x86_64-unknown-linux-gnu", "manylinux_2_17"),
    "musllinux": ("x86_64-unknown-linux-musl", "musllinux_1_2"),
    "manylinux-aarch64": ("aarch64-unknown-linux-gnu", "manylinux_2_17"),
    "musllinux-aarch64": ("aarch64-unknown-linux-musl", "musllinux_1_2"),
}

#: The time limit until a user has a checked result, downloads included, in seconds.
MAX_SECONDS = 60

#: A PATH without compilers.
_PLAIN_PATH = "/usr/bin:/bin"

_BOOLEAN = ("examples/meshes/plate_holes.stl", "examples/meshes/half_plate.off")


def run(*command: object, **settings: object) -> None:
    """Run a command, and end this program if the command fails."""
    line = [str(word) for word in command]
    done = subprocess.run(line, check=False, **settings)  # type: ignore[call-overload]
    if done.returncode:
        raise SystemExit(f"{' '.join(line)}: code {done.returncode}")


def tools() -> Path:
    """Return the folder of the build programs, after installing them if they are missing."""
    folder = OUT / "tools"
    if not (folder / "bin" / "maturin").exists():
        run(sys.executable, "-m", "venv", folder)
        run(folder / "bin" / "pip", "install", "--quiet", "maturin>=1.8,<2", "ziglang")
    return folder / "bin"


def committed(folder: Path) -> Path:
    """Extract the committed files into a folder, and return it."""
    done = subprocess.run(
        ["git", "-C", str(REPOSITORY), "archive", "HEAD"], capture_output=True, check=True
    )
    with tarfile.open(fileobj=BytesIO(done.stdout)) as archive:
        archive.extractall(folder, filter="data")
    return folder


def anonymous(tree: Path, environment: dict[str, str]) -> list[str]:
    """Return the options of rustc that replace this machine's folders in messages."""
    cargo = Path(environment.get("CARGO_HOME") or Path.home() / ".cargo")
    names = {cargo / "registry" / "src": "crates", cargo: "cargo", tree: "bspcsg"}
    # rustc uses the last prefix that matches.
    return [f"--remap-path-prefix={path}={name}" for path, name in reversed(names.items())]


def built(kind: str, tree: Path) -> Path:
    """Build one kind of wheel from a source tree, and return its path."""
    target, tag = TARGETS[kind]
    run("rustup", "target", "add", target, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    binaries = tools()
    known = {"CARGO_TARGET_DIR": str(REPOSITORY / "target")} | dict(os.environ)
    known |= {"CARGO_ENCODED_RUSTFLAGS": "\x1f".join(anonymous(tree, known))}
    environment = known | {"PATH": f"{binaries}:{os.environ['PATH']}"}
    options = ["--zig", "--compatibility", tag, "--target", target]
    command = [binaries / "maturin", "build", "--quiet", *options, "--out", tree / "dist"]
    run(*command, cwd=tree, env=environment)
    return moved_to_dist(next((tree / "dist").glob("*.whl")))


def source(tree: Path) -> Path:
    """Build the source distribution from a source tree, and return its path."""
    run(tools() / "maturin", "sdist", "--out", tree / "dist", cwd=tree)
    return moved_to_dist(next((tree / "dist").glob("*.tar.gz")))


def moved_to_dist(found: Path) -> Path:
    """Move a distribution to the folder of distributions, and return its new path."""
    DIST.mkdir(exist_ok=True)
    return Path(shutil.move(found, DIST / found.name))


@dataclass
class Trial:
    """The cost of getting from a wheel to the first checked set operation.

    Parameters
    ----------
    seconds, processor_seconds : float
    packages : int
        The number of packages that were installed.
    installed_megabytes : float
        The size of the environment after that, in 10^6 bytes.
    """

    seconds: float
    processor_seconds: float
    packages: int
    installed_megabytes: float


def tried(wheel: Path, tree: Path) -> Trial:
    """Install a wheel without Rust, combine two meshes, then run the smoke test and the demo.

    All packages are downloaded; pip's cache is not used.
    """
    with tempfile.TemporaryDirectory() as name:
        home = Path(name)
        plain = {"PATH": _PLAIN_PATH, "HOME": name, "LANG": "C.UTF-8"}
        plain |= {key: value for key, value in os.environ.items() if key.startswith("PIP_")}
        if shutil.which("cargo", path=_PLAIN_PATH):
            raise SystemExit(f"a cargo in {_PLAIN_PATH} makes this no trial")
        python, before, start = home / "venv/bin/python", _used(), time.monotonic()
        run(Path(sys.base_prefix) / "bin" / "python3", "-m", "venv", home / "venv", env=plain)
        pip = [python, "-m", "pip", "install", "--quiet", "--no-cache-dir"]
        run(*pip, "--disable-pip-version-check", wheel, env=plain, cwd=home)
        program = home / "venv/bin/bspcsg"
        run(program, "difference", *_BOOLEAN, "-o", home / "half.stl", env=plain, cwd=tree)
        trial = Trial(time.monotonic() - start, _used() - before, *_sizes(home / "venv"))
        run(python, tree / "scripts" / "smoke.py", env=plain, cwd=home)
        demo = plain | {"BSPCSG": str(program)}
        run(tree / "scripts" / "demo", env=demo, stdout=subprocess.DEVNULL, cwd=home)
        return trial


def _used() -> float:
    """Return the processor time of all finished child processes, in seconds."""
    used = resource.getrusage(resource.RUSAGE_CHILDREN)
    return used.ru_utime + used.ru_stime


def _sizes(folder: Path) -> tuple[int, float]:
    files = [path for path in folder.rglob("*") if path.is_file()]
    packages = [path for path in files if path.name == "METADATA"]
    return len(packages), sum(path.stat().st_size for path in files) / 1e6


def kind_of(path: Path) -> str:
    """Return the kind of a distribution, from its file name."""
    if path.suffix != ".whl":
        return "sdist"
    for kind, (target, tag) in TARGETS.items():
        if f"{tag}_{target.partition('-')[0]}" in path.name:
            return kind
    raise SystemExit(f"{path.name}: not one of {', '.join(TARGETS)}")


def runs_here(kind: str) -> bool:
    """Return true if a kind of wheel can be installed on this machine."""
    library = "manylinux" if platform.libc_ver()[0] == "glibc" else "musllinux"
    return TARGETS[kind][0].startswith(platform.machine()) and kind.startswith(library)


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("kinds", nargs="*", metavar="kind", help=f"of {', '.join(TARGETS)}, sdist")
    parser.add_argument(
        "--built",
        nargs="+",
        default=[],
        metavar="file",
        type=lambda name: Path(name).resolve(),
        help="wheels and sources that are there, to be looked at and tried only",
    )
    parser.add_argument("--record", action="store_true", help="keep the figures")
    options = parser.parse_args()
    there = {kind_of(path): path for path in options.built}
    kinds = options.kinds or list(there) or ["manylinux"]
    unknown = [kind for kind in kinds if kind not in {*TARGETS, "sdist"}]
    if unknown:
        parser.error(f"no such kind: {', '.join(unknown)}")
    if options.built and options.record:
        parser.error("--record is for what is built here: of other files the commit is not known")
    # The machine and commit now, since commits may be made while wheels are built.
    found, here = {}, machine()
    with tempfile.TemporaryDirectory() as name:
        tree = committed(Path(name))
        for kind in kinds:
            path = there.get(kind) or (source(tree) if kind == "sdist" else built(kind, tree))
            found[kind] = examined(kind, path, tree)
    if options.record:
        kept = with_earlier(found, str(here["commit"]))
        print(f"kept in {write_record('wheel', {'machine': here, 'wheels': kept})}")
    return 0


def with_earlier(found: dict[str, Figures], commit: str) -> dict[str, Figures]:
    """Return the figures of a commit, and the recorded figures of all other kinds."""
    path = RECORDS / "wheel.json"
    earlier = json.loads(path.read_text("utf-8"))["wheels"] if path.is_file() else {}
    return earlier | {kind: {**figures, "commit": commit} for kind, figures in found.items()}


def examined(kind: str, path: Path, tree: Path) -> Figures:
    """Check a distribution, try it if it runs here, and return its figures."""
    megabytes, problems = path.stat().st_size / 1e6, problems_of(path, tree)
    print(f"{path.name}: {megabytes:.2f} MB", *problems, sep="\n  ", flush=True)
    if problems:
        raise SystemExit(1)
    figures: dict[str, str | float] = {"file": path.name, "megabytes": round(megabytes, 2)}
    if kind == "sdist" or not runs_here(kind):
        return figures
    trial = tried(path, tree)
    print(
        f"  {trial.packages} packages of {trial.installed_megabytes:.0f} MB; first checked boolean"
        f" after {trial.seconds:.1f} s, {trial.processor_seconds:.1f} s of them on a processor"
        f" (at most {MAX_SECONDS} s)",
        flush=True,
    )
    if trial.seconds > MAX_SECONDS:
        raise SystemExit("that is too long")
    return figures | {name: round(value, 1) for name, value in vars(trial).items()}


if __name__ == "__main__":
    sys.exit(main())
