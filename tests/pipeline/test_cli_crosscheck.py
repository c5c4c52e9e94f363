"""The command crosscheck: verdicts, files, limits, interruptions."""

import json
import os
import re
import signal
import time
from pathlib import Path
from typing import Any
from xml.etree import ElementTree as Xml

import pytest

import bspcsg as b
from bspcsg.campaign.cases.meshes import unpacked
from bspcsg.campaign.record import CaseRecord, read_results
from support import drawn
from support.cli import Capture, finished, process, put, ran
from support.shapes import cuboid, icosphere, moved

OPEN = (cuboid((0, 0, 0), (1, 1, 1))[0], cuboid((0, 0, 0), (1, 1, 1))[1][1:])


def lines(path: str = "r.jsonl") -> list[dict[str, Any]]:
    return [json.loads(line) for line in Path(path).read_text("utf-8").splitlines()]


def many(count: int) -> None:
    """Write cubes into a folder, each of which touches the others differently."""
    Path("parts").mkdir()
    for number in range(count):
        put(f"parts/{number:02d}.off", cuboid((number, 0, 0), (number + 3, 2, 2 + number % 3)))


def test_pair_is_compared_in_all_operations(folder: Path, capsys: Capture) -> None:
    code, out, err = ran(capsys, "crosscheck", "a.off", "c.stl", "-j", "1", "--results", "r.jsonl")
    assert code == 0 and err == ""
    assert "agree" in out and "None of 4 cases failed." in out
    head, *cases = lines()
    assert head["type"] == "run" and head["versions"]["bspcsg"] == b.__version__
    assert head["command"] == "bspcsg crosscheck a.off c.stl -j 1 --results r.jsonl"
    assert [case["operation"] for case in cases] == ["union", "difference", "intersection", "xor"]
    volumes = {case["operation"]: case["ours"]["volume"] for case in cases}
    assert volumes == {"union": 15.0, "difference": 7.0, "intersection": 1.0, "xor": 14.0}
    union = cases[0]
    assert union["ours"]["centroid"] == [1.5, 1.5, 1.5]
    assert union["ours"]["self_intersections"] == 0
    assert union["ours"]["inertia"][0] == pytest.approx([18.5, -4.0, -4.0])
    assert union["set_difference"] == {
        "volume": 0.0, "exact": "0", "thickness": 0.0, "equal": True, "place": None,
    }  # fmt: skip
    assert union["identity"]["holds"] and union["memory_mb"] > 10
    assert union["oracles"][0]["name"] == "manifold3d" and union["oracles"][0]["agrees"]


def test_command_of_a_case_runs_that_case(folder: Path, capsys: Capture) -> None:
    put("s.ply", moved(icosphere(2), (0.5, 0.3, 0.1)))
    given = ["crosscheck", "a.off", "s.ply", "-j", "1", "--poses", "2", "--seed", "5"]
    ran(capsys, *given, "--op", "xor", "--results", "r.jsonl")
    for case in drawn(lines()[1:], 2):
        words = case["command"].split()[1:]
        assert ran(capsys, *words, "-j", "1", "--results", "again.jsonl")[0] == 0
        again = lines("again.jsonl")[-1]
        same = ("case", "key", "pose", "operands", "verdict", "ours", "set_difference")
        assert {name: again[name] for name in same} == {name: case[name] for name in same}


def test_summary_as_json_counts_identities(folder: Path, capsys: Capture) -> None:
    code, out, _ = ran(capsys, "crosscheck", "a.off", "c.stl", "-j", "1", "--json")
    found = json.loads(out)
    assert code == 0 and found["cases"] == 4 and found["verdicts"] == {"agree": 4}
    assert found["identities"] == {"checked": 3, "broken": 0}
    assert found["operations"]["xor"] == {"agree": 1}


def test_reports_hold_every_case(folder: Path, capsys: Capture) -> None:
    put("open.off", OPEN)
    given = ["crosscheck", "a.off", "c.stl", "open.off", "--op", "union", "-j", "1"]
    code, _, _ = ran(capsys, *given, "--junit", "j.xml", "--markdown", "m.md")
    assert code == 0
    root = Xml.parse("j.xml").getroot()
    assert (root.get("tests"), root.get("failures"), root.get("skipped")) == ("3", "0", "2")
    skipped = [case for case in root.iter("testcase") if case.find("skipped") is not None]
    assert [case.get("name") for case in skipped] == ["0001-a-open-union", "0002-c-open-union"]
    text = Path("m.md").read_text("utf-8")
    assert "**None of 3 cases failed.**" in text
    assert "| refused | 2 | 2 |" in text and "open.off" in text


def test_each_pose_that_is_named_counts(folder: Path, capsys: Capture) -> None:
    given = ["crosscheck", "a.off", "c.stl", "--op", "union", "-j", "1", "--pose", "copy"]
    more = ["--pose", "random:3", "--pose", "random:4", "--pose", "copy", "--results", "r.jsonl"]
    assert ran(capsys, *given, *more)[0] == 0
    names = [case["case"] for case in lines()[1:]]
    assert sorted(names) == [
        f"000{k}-a-c-{pose}-union" for k, pose in [(0, "copy"), (3, "random"), (4, "random")]
    ]
    more = ["--pose", "mirror", "--poses", "2", "--results", "s.jsonl"]
    assert ran(capsys, *given, *more)[0] == 0
    names = [case["case"] for case in lines("s.jsonl")[1:]]
    wanted = {(k, pose) for k in ("0000", "0001") for pose in ("copy", "mirror")}
    found = [re.fullmatch(r"(\d+)-[ac]-[ac]-(\w+)-union", name) for name in names]
    assert {one.groups() for one in found if one} == wanted and len(names) == 4


def test_file_of_cases_names_operands_and_poses(folder: Path, capsys: Capture) -> None:
    vertices, faces = cuboid((0, 0, 0), (1, 1, 1))
    inline = {"vertices": vertices.tolist(), "faces": faces.tolist()}
    shift = [[1, 0, 0, 0.5], [0, 1, 0, 0], [0, 0, 1, 0]]
    operands = [{"file": "a.off"}, {**inline, "pose": shift}, {"file": "c.stl"}]
    entry = {"name": "three", "operation": ["union", "difference"], "operands": operands}
    Path("cases.json").write_text(json.dumps({"cases": [entry]}))
    given = ["crosscheck", "cases.json", "-j", "1", "--results", "r.jsonl"]
    assert ran(capsys, *given)[0] == 0
    cases = lines()[1:]
    assert [case["case"] for case in cases] == ["three-union", "three-difference"]
    assert [case["ours"]["volume"] for case in cases] == [15.0, 6.0]
    assert cases[0]["operands"][1]["pose"] == shift
    assert cases[1]["command"] == "bspcsg crosscheck cases.json --only three-difference"
    assert ran(capsys, *cases[1]["command"].split()[1:], "-j", "1", "-v")[2].count("agree") == 1


def test_script_is_compared(folder: Path, capsys: Capture) -> None:
    Path("m.csg").write_text("difference() { cube(size = 2); sphere(r = 1, $fn = 8); }")
    Path("flat.csg").write_text("square(size = 2);")
    code, _, _ = ran(capsys, "crosscheck", "m.csg", "flat.csg", "-j", "1", "--results", "r.jsonl")
    assert code == 0
    cases = {case["case"]: case for case in lines()[1:]}
    assert cases["m.csg"]["verdict"] == "agree" and cases["m.csg"]["kind"] == "csg"
    assert (
        cases["flat.csg"]["verdict"] == "refused"
        and "two-dimensional" in cases["flat.csg"]["reason"]
    )


def test_meshes_are_kept_on_request(folder: Path, capsys: Capture) -> None:
    given = ["crosscheck", "a.off", "c.stl", "-j", "1", "--results", "r.jsonl"]
    ran(capsys, *given)
    assert not Path("r.meshes").exists()
    ran(capsys, *given, "--keep-meshes", "1", "--results", "k.jsonl")
    kept = [case for case in lines("k.jsonl")[1:] if case["meshes"]]
    assert [case["operation"] for case in kept] == ["union"]
    found = unpacked(kept[0]["meshes"])
    assert [mesh.volume for mesh in (*found.operands.values(), found.result)] == [8, 8, 15]
    assert len(found.difference.faces) == 0


def test_resume_asks_only_what_is_open(folder: Path, capsys: Capture) -> None:
    given = ["crosscheck", "a.off", "c.stl", "-j", "1", "--results", "r.jsonl"]
    ran(capsys, *given, "--op", "union")
    with Path("r.jsonl").open("a") as torn:
        torn.write('{"schema": 1, "type": "ca')
    code, out, err = ran(capsys, *given, "--resume")
    assert code == 0 and "None of 4 cases failed." in out
    assert "note: 1 case of 4 already finished in r.jsonl" in err
    assert [line["type"] for line in lines()] == ["run", "case", "run", "case", "case", "case"]
    put("a.off", cuboid((0, 0, 0), (2, 2, 3)))
    ran(capsys, *given, "--resume")
    assert len(lines()) == 6 + 1 + 4


# Found: a case that had crashed was never run again, though another machine or more memory may
# solve it.
def test_what_crashed_is_asked_again_if_wished(folder: Path, capsys: Capture) -> None:
    given = ["crosscheck", "a.off", "c.stl", "-j", "1", "--results", "r.jsonl"]
    ran(capsys, *given, "--op", "union", "--op", "xor")
    head, union, xor = lines()
    crashed = {**union, "verdict": "crash", "reason": "the process was ended by SIGKILL"}
    Path("r.jsonl").write_text("".join(json.dumps(one) + "\n" for one in (head, crashed, xor)))
    code, _, err = ran(capsys, *given, "--op", "union", "--op", "xor", "--resume")
    assert code == 1 and "note: 2 cases of 2 already finished in r.jsonl" in err
    more = ["--op", "union", "--op", "xor", "--resume", "--retry-crashed"]
    code, out, err = ran(capsys, *given, *more)
    assert code == 0 and "None of 2 cases failed." in out
    assert "note: 1 case of 2 already finished in r.jsonl" in err
    assert read_results(["r.jsonl"]).cases[union["key"]]["verdict"] == "agree"


def test_shards_are_the_whole(folder: Path, capsys: Capture) -> None:
    many(3)
    for shard in ("1/3", "2/3", "3/3"):
        given = ["--shard", shard, "--results", f"r-{shard[0]}of3.jsonl"]
        assert ran(capsys, "crosscheck", "parts", "-j", "1", *given)[0] == 0
    shards = read_results(sorted(Path().glob("r-*.jsonl")))
    assert len(shards.runs) == 3
    assert sorted(case["case"] for case in shards.cases.values()) == sorted(
        f"{number:04d}-{pair}-{op}"
        for number, pair in enumerate(("00-01", "00-02", "01-02"))
        for op in ("union", "difference", "intersection", "xor")
    )


def test_time_and_memory_limits_are_failures(folder: Path, capsys: Capture) -> None:
    given = ["crosscheck", "a.off", "c.stl", "-j", "1", "--op", "union"]
    code, out, _ = ran(capsys, *given, "--timeout", "0.0001")
    assert code == 1 and "The one case failed." in out and "timeout" in out
    assert "Again: bspcsg crosscheck a.off c.stl --op union" in out
    code, out, _ = ran(capsys, *given, "--memory", "1M")
    assert code == 1 and "crash" in out


def test_fail_fast_stops_at_the_first_failure(folder: Path, capsys: Capture) -> None:
    given = ["crosscheck", "a.off", "c.stl", "-j", "1", "--timeout", "0.0001"]
    given += ["--op", "union", "--op", "xor"]
    assert "The one case failed." in ran(capsys, *given, "--fail-fast")[1]
    assert "2 of 2 cases failed." in ran(capsys, *given, "--keep-going")[1]


@pytest.mark.parametrize(
    ("given", "code", "says"),
    [
        (["a.off"], 2, "nothing to compare"),
        (["a.off", "c.stl", "--only", "zzz"], 2, "no case has a name that matches zzz"),
        (["a.off", "c.stl", "--resume"], 2, "--results r.jsonl"),
        (["a.off", "c.stl", "--results", "r.jsonl", "--retry-crashed"], 2, "used with --resume"),
        (["a.off", "c.stl", "--shard", "3/2"], 2, "as in 2/8"),
        (["a.off", "c.stl", "--memory", "much"], 2, "as in 4G"),
        (["a.off", "c.stl", "--pose", "upside"], 2, "random:17"),
        (["a.off", "c.stl", "--poses", "3", "--pose", "copy:1"], 2, "is one of them"),
        (["a.off", "c.stl", "--keep-meshes", "some"], 2, "interesting"),
        (["a.off", "c.stl", "--against", "abacus"], 2, "abacus"),
        (["a.off", "missing.stl"], 3, "missing.stl"),
        (["a.off", "a.step"], 3, "a.step"),
        (["bad.json"], 3, "not a valid list of cases"),
        (["a.off", "c.stl", "--results", "bad.json", "--resume"], 3, "bad.json:1"),
        (["a.off", "c.stl", "--junit", "nowhere/j.xml"], 5, "nowhere"),
        (["a.off", "c.stl", "--against", "openscad"], 6, "apt-get install openscad"),
    ],
)
def test_wrong_input_is_told(
    folder: Path,
    capsys: Capture,
    monkeypatch: pytest.MonkeyPatch,
    given: list[str],
    code: int,
    says: str,
) -> None:
    Path("bad.json").write_text('{"cases": [{"operands": 3}]}\n')
    Path("a.step").write_text("ISO-10303-21;")
    monkeypatch.setenv("PATH", "")
    found, _, err = ran(capsys, "crosscheck", *given, "-j", "1")
    assert (found, says in err) == (code, True), err
    assert err.startswith("bspcsg: error: ")


def children_of(process: int) -> list[int]:
    """Return the ids of the child processes of all threads of a process."""
    lists = Path(f"/proc/{process}/task").glob("*/children")
    return [int(pid) for each in lists for pid in each.read_text("utf-8").split()]


def are_gone(processes: list[int]) -> bool:
    for _ in range(600):
        if not any(_lives(pid) for pid in processes):
            return True
        time.sleep(0.05)
    return False


def _lives(pid: int) -> bool:
    try:
        return Path(f"/proc/{pid}/stat").read_text("utf-8").rpartition(")")[2].split()[0] != "Z"
    except OSError:
        return False


def started_campaign(folder: Path) -> Any:
    """Start a campaign, and return its process after a few cases are recorded."""
    many(14)
    running = process(
        "crosscheck", "parts", "-j", "2", "--results", "r.jsonl", stderr=-1, stdout=-1, cwd=folder
    )
    for _ in range(3000):
        if Path("r.jsonl").exists() and Path("r.jsonl").read_bytes().count(b"\n") > 6:
            return running
        time.sleep(0.02)
    raise AssertionError("the campaign did not begin")


@pytest.mark.deep
@pytest.mark.skipif(not Path("/proc/self/task").is_dir(), reason="needs Linux's /proc")
def test_killing_the_runner_loses_nothing(folder: Path, capsys: Capture) -> None:
    running = started_campaign(folder)
    children = children_of(running.pid)
    assert len(children) == 2
    os.kill(running.pid, signal.SIGKILL)
    running.communicate()
    assert are_gone(children)
    done = read_results(["r.jsonl"]).cases
    assert 6 <= len(done) < 91 * 4
    code, out, err = ran(capsys, "crosscheck", "parts", "--results", "r.jsonl", "--resume")
    assert code == 0 and "None of 364 cases failed." in out
    assert f"{len(done)} cases of 364 known" in err
    keys = [line["key"] for line in lines() if line["type"] == "case"]
    assert len(keys) == len(set(keys)) == 364


@pytest.mark.deep
@pytest.mark.skipif(not Path("/proc/self/task").is_dir(), reason="needs Linux's /proc")
def test_interrupt_is_quiet(folder: Path) -> None:
    running = started_campaign(folder)
    children = children_of(running.pid)
    running.send_signal(signal.SIGINT)
    out, err = running.communicate(timeout=60)
    assert (running.returncode, out, err) == (130, b"", b"")
    assert are_gone(children)
    assert all(line["verdict"] == "agree" for line in lines()[1:])


def test_broken_file_costs_its_cases_only(folder: Path, capsys: Capture) -> None:
    Path("cut.stl").write_bytes(b"\0" * 84 + b"\1")
    given = ["crosscheck", "a.off", "c.stl", "cut.stl", "-j", "1", "--op", "union"]
    code, out, err = ran(capsys, *given)
    assert code == 0 and "refused" in out and "None of 3 cases failed." in out
    # Two cases were refused for one reason, which is told once.
    assert err.startswith("note: refused: cut.stl: ") and err.count("note: ") == 1
    assert ran(capsys, *given, "-q")[2] == ""


# Found: outputs of `validate` overwrote each other.
@pytest.mark.parametrize(
    ("options", "said"),
    [
        (["--results", "-"], "--results needs the name of a file, not “-”."),
        (["--junit", "-"], "--junit needs the name of a file, not “-”."),
        (
            ["--markdown", "./a.off"],
            "--markdown would overwrite the input a.off; choose another name.",
        ),
        (["--results", "c.stl"], "--results would overwrite the input c.stl; choose another name."),
        (
            ["--results", "r.jsonl", "--junit", "./r.jsonl"],
            "--junit would overwrite r.jsonl, which --results also writes; choose different names.",
        ),
        (["-"], "crosscheck cannot read standard input; give the names of files."),
    ],
)
def test_files_that_cannot_be(folder: Path, capsys: Capture, options: list[str], said: str) -> None:
    before = {path: path.read_bytes() for path in folder.iterdir()}
    code, out, err = ran(capsys, "crosscheck", "a.off", "c.stl", *options)
    assert (code, out) == (2, "") and err.startswith(f"bspcsg: error: {said}\n")
    assert {path: path.read_bytes() for path in folder.iterdir()} == before


@pytest.mark.parametrize("data", [b"mine", b"mine\nand mine", b"{}\n"])
def test_what_is_no_results_file_stays_as_it_is(folder: Path, capsys: Capture, data: bytes) -> None:
    Path("notes.txt").write_bytes(data)
    given = ["crosscheck", "a.off", "c.stl", "-j", "1", "--op", "xor", "--results", "notes.txt"]
    code, out, err = ran(capsys, *given)
    assert (code, out) == (5, "") and Path("notes.txt").read_bytes() == data
    assert err.startswith("bspcsg: error: notes.txt: this existing file is not a results file")


def test_help_has_an_example(capsys: Capture) -> None:
    code, out, _ = ran(capsys, "crosscheck", "--help")
    assert code == 0 and "bspcsg crosscheck a.stl b.stl" in out


def test_failed_case_is_a_failure_of_the_build(folder: Path) -> None:
    given = ["crosscheck", "a.off", "c.stl", "-j", "1", "--op", "xor", "--timeout", "0.0001"]
    code, out, _ = finished(*given, "--junit", "j.xml", "--markdown", "m.md")
    assert code == 1 and b"timeout" in out
    case = next(Xml.parse("j.xml").getroot().iter("testcase"))
    error = case.find("error")
    assert error is not None and error.get("type") == "timeout"
    assert "again: bspcsg crosscheck a.off c.stl --op xor" in str(error.text)
    assert "## Failures" in Path("m.md").read_text("utf-8")


def test_records_have_the_declared_fields(folder: Path, capsys: Capture) -> None:
    ran(capsys, "crosscheck", "a.off", "c.stl", "-j", "1", "--results", "r.jsonl", "--op", "xor")
    assert set(lines()[1]) == set(CaseRecord.__annotations__)


def test_the_former_name_is_an_alias_with_a_note(folder: Path, capsys: Capture) -> None:
    line = ["a.off", "c.stl", "-j", "1", "--op", "xor", "--json"]
    code, out, err = ran(capsys, "validate", *line)
    again = ran(capsys, "crosscheck", *line)
    assert code == again[0] == 0
    assert json.loads(out)["verdicts"] == json.loads(again[1])["verdicts"]
    assert err.startswith("note: validate is now called crosscheck; the old name will be removed")
    assert err.count("\n") == 1
    assert again[2] == ran(capsys, "validate", *line, "-q")[2] == ""
    assert "validate" not in ran(capsys, "--help")[1]
