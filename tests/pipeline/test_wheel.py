"""Checks of wheels and source distributions accept complete ones and name faults."""

import json
import re
import subprocess
import sys
import tarfile
import tomllib
import zipfile
from collections.abc import Callable
from pathlib import Path

import pytest

import wheel
import wheel_contents
from wheel_contents import ROOT, package, problems_of

PROJECT = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))["project"]

ABOUT = """Metadata-Version: 2.4
Name: bspcsg
Author: bspcsg contributors
License-Expression: Apache-2.0
Classifier: Typing :: Typed

A page.
"""


def put_wheel(folder: Path, change: Callable[[dict[str, bytes]], object] = len) -> Path:
    """Write a wheel of this package with a tiny core, after a change of its files."""
    files = {name: (ROOT / name).read_bytes() for name in package()}
    files["bspcsg/_core.abi3.so"] = b"\x7fELF"
    files["bspcsg-1.dist-info/METADATA"] = ABOUT.encode()
    files["bspcsg-1.dist-info/WHEEL"] = b"Tag: cp311-abi3-manylinux_2_17_x86_64\n"
    change(files)
    path = folder / "bspcsg-1-cp311-abi3-linux_x86_64.whl"
    with zipfile.ZipFile(path, "w", zipfile.ZIP_DEFLATED) as archive:
        for name, data in files.items():
            archive.writestr(name, data)
    return path


# Found: there were no wheels, and the core took 47 MB.
def test_a_wheel_of_all_files_is_in_order(tmp_path: Path) -> None:
    assert len(package()) > 300 and not [name for name in package() if "test" in name]
    assert problems_of(put_wheel(tmp_path)) == []


FAULTS: dict[str, tuple[Callable[[dict[str, bytes]], object], str]] = {
    "a font less": (
        lambda files: files.pop(next(name for name in files if name.endswith(".ttf"))),
        ".ttf is missing",
    ),
    "a page's part less": (
        lambda files: files.pop("bspcsg/report/assets/viewer.js"),
        "viewer.js is missing",
    ),
    "tests": (
        lambda files: files.update({"tests/unit/test_a.py": b""}),
        "tests/unit/test_a.py should not be there",
    ),
    "symbols": (
        lambda files: files.update({"bspcsg/_core.abi3.so": b"\x7fELF\0.symtab\0"}),
        "the native core is not stripped",
    ),
    "the builder's folders": (
        lambda files: files.update({"bspcsg/_core.abi3.so": b"\x7fELF/home/ann/.cargo/x.rs"}),
        "the native core names a folder of its builder: /home/ann/.cargo/x.rs",
    ),
    "no core": (lambda files: files.pop("bspcsg/_core.abi3.so"), "it has 0 native cores"),
    "no author": (
        lambda files: files.update({"bspcsg-1.dist-info/METADATA": b"\nA page.\n"}),
        "Author is not bspcsg contributors",
    ),
    "one version": (
        lambda files: files.update({"bspcsg-1.dist-info/WHEEL": b"Tag: cp311-cp311-linux\n"}),
        "it is for one version of Python only",
    ),
}


#: Of builders in a container, and on a Mac.
HOMES = ["/".join(["", *names]) for names in (["root"], ["Users", "ann"])]
WINDOWS_HOME = "\\".join(["C:", "Users", "ann"])

#: A registry of crates that is in nobody's home.
REGISTRY = "/".join(["", "opt", "cargo", "registry"])


@pytest.mark.parametrize("fault", FAULTS)
def test_faults_of_a_wheel_are_named(tmp_path: Path, fault: str) -> None:
    change, words = FAULTS[fault]
    assert words in "\n".join(problems_of(put_wheel(tmp_path, change)))


@pytest.mark.parametrize(
    ("text", "named"),
    [
        (
            f"at {HOMES[0]}/.cargo/registry/src/i/a.rs:1".encode(),
            f"{HOMES[0]}/.cargo/registry/src/i/a.rs",
        ),
        (f"\0{HOMES[1]}/crate/lib.rs\0".encode(), f"{HOMES[1]}/crate/lib.rs"),
        (f"{WINDOWS_HOME}\\.cargo\\a.rs".encode(), f"{WINDOWS_HOME}\\.cargo\\a.rs"),
        (f"{REGISTRY}/src/index/a.rs".encode(), f"{REGISTRY}/src/index/a.rs"),
        (rb"crates/index.crates.io-1/rayon/src/a.rs", None),
        (rb"/rustc/59807616/library/core/src/a.rs", None),
        (rb"/rust/deps/hashbrown-0.15.2/src/raw.rs", None),
    ],
)
def test_messages_name_no_folder_of_the_builder(text: bytes, named: str | None) -> None:
    said = [f"the native core names a folder of its builder: {named}"] if named else []
    assert wheel_contents.problems_of_core(text) == said


def test_the_compiler_leaves_the_builders_folders_out(tmp_path: Path) -> None:
    """As scripts/wheel calls it, for a crate of the registry and for the tree itself."""
    home, tree = tmp_path / "home", tmp_path / "tree"
    crate = home / "registry/src/index/some/a.rs"
    for path in (crate, tree / "a.rs"):
        path.parent.mkdir(parents=True)
        path.write_text('#[no_mangle] pub extern "C" fn f() { panic!("here") }')
    flags = wheel.anonymous(tree, {"CARGO_HOME": str(home)})
    for path, name in ((crate, b"crates/index/some/a.rs"), (tree / "a.rs", b"bspcsg/a.rs")):
        command = ["rustc", "--crate-type=cdylib", *flags, str(path), "-o", "a.so"]
        subprocess.run(command, cwd=tmp_path, check=True, capture_output=True)
        library = (tmp_path / "a.so").read_bytes()
        assert name in library and bytes(tmp_path) not in library


def test_a_large_wheel_is_named(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(wheel_contents, "MAX_BYTES", 1000)
    assert "more than 1,000" in "\n".join(problems_of(put_wheel(tmp_path)))


@pytest.fixture(scope="module")
def source(tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("source")
    command = [sys.executable, "-m", "maturin", "sdist", "--out", str(folder)]
    subprocess.run(command, cwd=ROOT, check=True, capture_output=True, timeout=300)
    return next(folder.glob("*.tar.gz"))


def test_the_source_distribution_has_what_a_build_needs(source: Path) -> None:
    assert problems_of(source) == []


# Found: there was no extra `all`.
def test_the_metadata_say_who(source: Path) -> None:
    with tarfile.open(source) as archive:
        found = next(name for name in archive.getnames() if name.endswith("/PKG-INFO"))
        stream = archive.extractfile(found)
        assert stream is not None
        about = stream.read().decode()
    assert "Author: bspcsg contributors" in about
    assert "\nProject-URL: " not in about
    assert "\nProvides-Extra: all\n" in about


def test_the_crate_has_what_an_index_shows_and_a_build_needs() -> None:
    command = ["cargo", "package", "--list", "--allow-dirty", "--offline"]
    done = subprocess.run(command, cwd=ROOT / "core", check=True, capture_output=True, text=True)
    names = set(done.stdout.split())
    sources = {f.relative_to(ROOT / "core").as_posix() for f in (ROOT / "core/src").rglob("*.rs")}
    wanted = {"LICENSE", "README.md", "ARCHITECTURE.md", "Cargo.lock", "examples/two_boxes.rs"}
    assert {*wanted, *sources} <= names and not any("target/" in name for name in names)
    about = tomllib.loads((ROOT / "core/Cargo.toml").read_text(encoding="utf-8"))["package"]
    fields = ("description", "license", "readme", "keywords")
    assert all(about[field] for field in (*fields, "categories", "rust-version"))
    assert (ROOT / "core/LICENSE").read_bytes() == (ROOT / "LICENSE").read_bytes()


def test_the_page_of_the_crate_shows_code_that_is_compiled() -> None:
    page = (ROOT / "core/README.md").read_text(encoding="utf-8")
    example = (ROOT / "core/examples/two_boxes.rs").read_text(encoding="utf-8")
    shown = page.partition("```rust\n")[2].partition("```")[0]
    uses, _, function = shown.partition("///")
    assert len(function.splitlines()) > 10 and function in example
    assert all(line in example for line in uses.splitlines())


def test_all_is_what_users_want() -> None:
    """All extras but those that measure, document and test."""
    extras = PROJECT["optional-dependencies"]
    named = re.findall(r"[\w-]+", extras["all"][0].partition("[")[2])
    assert set(named) == set(extras) - {"all", "bench", "docs", "examples", "test"}


# Found: offsets, `validate` and pictures failed in an installation without extras.
def test_what_a_plain_install_brings_is_what_doctor_asks_for() -> None:
    from bspcsg.cli.verbs import doctor

    brought = {re.match(r"[\w-]+", line)[0] for line in PROJECT["dependencies"]}  # type: ignore[index]
    assert brought == set(doctor._REQUIRED)


@pytest.mark.deep
def test_the_smoke_test_passes(tmp_path: Path) -> None:
    command = [sys.executable, str(ROOT / "scripts/smoke.py")]
    done = subprocess.run(command, cwd=tmp_path, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stdout + done.stderr
    assert done.stdout.count("ok: ") == 5


def test_a_record_keeps_other_kinds_with_their_commits(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(wheel, "RECORDS", tmp_path)
    first = wheel.with_earlier({"sdist": {"megabytes": 2.0}, "manylinux": {"megabytes": 5.0}}, "a")
    (tmp_path / "wheel.json").write_text(json.dumps({"wheels": first}))
    assert wheel.with_earlier({"manylinux": {"megabytes": 4.0}}, "b") == {
        "sdist": {"megabytes": 2.0, "commit": "a"},
        "manylinux": {"megabytes": 4.0, "commit": "b"},
    }
