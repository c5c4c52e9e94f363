"""The workflows, the action and the hook are well formed, and their commands work."""

import os
import re
import shlex
import subprocess
import sys
from pathlib import Path
from typing import Any

import pytest
from ruamel.yaml import YAML

import bspcsg as b

ROOT = Path(__file__).parents[2]
WORKFLOWS = sorted((ROOT / ".github/workflows").glob("*.yml"))


def document(path: Path) -> Any:
    return YAML(typ="safe").load(path.read_text(encoding="utf-8"))


def schema_findings(schema: str, *paths: Path) -> str:
    command = [sys.executable, "-m", "check_jsonschema", "--builtin-schema", schema]
    done = subprocess.run([*command, *map(str, paths)], capture_output=True, text=True, check=False)
    return "" if done.returncode == 0 else done.stdout + done.stderr


def test_workflows_and_action_are_well_formed() -> None:
    assert [path.name for path in WORKFLOWS] == ["check.yml", "nightly.yml", "release.yml"]
    assert schema_findings("vendor.github-workflows", *WORKFLOWS) == ""
    assert schema_findings("vendor.github-actions", ROOT / "action.yml") == ""


def test_a_fault_in_a_workflow_is_found(tmp_path: Path) -> None:
    text = WORKFLOWS[-1].read_text("utf-8").replace("runs-on:", "run-on:")
    (tmp_path / "broken.yml").write_text(text)
    assert "run-on" in schema_findings("vendor.github-workflows", tmp_path / "broken.yml")


@pytest.mark.parametrize("path", WORKFLOWS, ids=lambda path: path.stem)
def test_what_workflows_name_exists(path: Path) -> None:
    text = path.read_text(encoding="utf-8")
    names = re.findall(r"(?<![\w/.])((?:scripts|core)/[\w./]+\w)", text)
    assert names and all((ROOT / name).exists() for name in names)
    jobs = document(path)["jobs"]
    needed = [job.get("needs", []) for job in jobs.values()]
    assert {name for one in needed for name in ([one] if isinstance(one, str) else one)} <= set(
        jobs
    )
    assert all("timeout-minutes" in job for job in jobs.values())


# Found: no workflow built wheels.
def test_every_kind_of_wheel_is_built_and_those_of_the_runners_are_tried() -> None:
    jobs = document(ROOT / ".github/workflows/release.yml")["jobs"]
    built = {row["name"] for row in jobs["wheels"]["strategy"]["matrix"]["include"]}
    tried = {row["wheel"] for row in jobs["try"]["strategy"]["matrix"]["include"]}
    assert len(built) == 6 and tried <= built
    steps = [step for job in jobs.values() for step in job["steps"]]
    assert not [step for step in steps if "password" in step.get("with", {})]
    assert jobs["publish"]["permissions"] == {"id-token": "write"}


# Found: a tag without a package on any index also offered no wheels for download.
def test_a_tag_gets_the_files_that_were_tried() -> None:
    job = document(ROOT / ".github/workflows/release.yml")["jobs"]["release-files"]
    assert set(job["needs"]) == {"source", "try", "try-musl"}
    assert job["permissions"] == {"contents": "write"} and "refs/tags/v" in job["if"]
    assert "gh release create" in job["steps"][-1]["run"]


@pytest.fixture
def repository(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """Return a git repository with a solid in a folder with a space; bspcsg is on the PATH."""
    folder = tmp_path / "my parts"
    folder.mkdir()
    b.cube(2).save(folder / "cube.stl")
    programs = str(Path(sys.executable).parent)
    monkeypatch.setenv("PATH", programs + os.pathsep + os.environ["PATH"])
    monkeypatch.chdir(tmp_path)
    subprocess.run(["git", "init", "-q"], check=True)
    return tmp_path


def put_open(name: str) -> None:
    b.cube(1).save("cube.off")
    lines = Path("cube.off").read_text("utf-8").splitlines()
    Path("cube.off").unlink()
    Path(name).write_text("\n".join(["OFF", "8 11 0", *lines[2:-1]]) + "\n")


def act(files: str = "", options: str = "") -> tuple[int, str]:
    """Run the last step of the action on the files that git tracks; return code and output."""
    subprocess.run(["git", "add", "-A"], check=True)
    action = document(ROOT / "action.yml")
    files = files or action["inputs"]["files"]["default"]
    return stepped(-1, {"FILES": files, "OPTIONS": options})


def stepped(number: int, variables: dict[str, str]) -> tuple[int, str]:
    """Run a step of the action; return its exit code and output."""
    step = document(ROOT / "action.yml")["runs"]["steps"][number]
    assert set(step["env"]) == set(variables)
    done = subprocess.run(
        ["bash", "-e", "-o", "pipefail", "-c", step["run"]],
        env=os.environ | variables,
        capture_output=True,
        encoding="utf-8",
        check=False,
    )
    return done.returncode, done.stdout + done.stderr


# Found: the action installed the package from an index, but no index has it.
def test_the_action_installs_what_lies_beside_it_or_what_is_named(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    programs = tmp_path / "programs"
    programs.mkdir()
    (programs / "python").write_text('#!/bin/sh\nfor last; do :; done; echo "installs $last"\n')
    (programs / "python").chmod(0o755)
    monkeypatch.setenv("PATH", f"{programs}{os.pathsep}{os.environ['PATH']}")
    alone = {"PACKAGE": "", "BESIDE": str(tmp_path)}
    code, said = stepped(1, alone)
    assert code == 1 and "::error::" in said and "'package'" in said
    assert stepped(1, alone | {"PACKAGE": "a b.whl"}) == (0, "installs a b.whl\n")
    assert stepped(1, alone | {"BESIDE": str(ROOT)}) == (0, f"installs {ROOT}\n")


def test_the_action_checks_all_meshes(repository: Path) -> None:
    code, said = act()
    assert code == 0 and "my parts/cube.stl" in said
    put_open("my parts/open.off")
    code, said = act()
    assert code != 0 and "1 of 2 files is not a solid" in said
    assert act("*.stl", "--strict")[0] == 0


def test_the_action_without_meshes_and_with_wrong_options(repository: Path) -> None:
    assert act("*.glb") == (0, "no file matches: *.glb\n")
    assert act("*.stl", "--strickt")[0] != 0


def test_the_hook_checks_the_files_it_is_given(repository: Path) -> None:
    hook = document(ROOT / ".pre-commit-hooks.yaml")[0]
    put_open("open.off")
    names = ["my parts/cube.stl", "open.off", "notes.txt", "stl"]
    matching = [name for name in names if re.search(hook["files"], name)]
    assert matching == names[:2]
    entry = shlex.split(hook["entry"])
    assert subprocess.run([*entry, matching[0]], check=False, capture_output=True).returncode == 0
    done = subprocess.run([*entry, *matching], capture_output=True, encoding="utf-8", check=False)
    assert done.returncode == 1 and "open.off" in done.stdout
