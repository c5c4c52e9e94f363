"""The command bench, with small items of its cases."""

import json
from pathlib import Path
from typing import Any
from xml.etree import ElementTree

import pytest

from bspcsg.bench import runner
from bspcsg.bench.cases import CASES, SHORT
from support.cli import Capture, ran

#: A worker of which one engine kills the process, and another never ends.
_WORKER = """
import json, os, sys, time
task = json.loads(sys.argv[-1])
def say(**what): print(json.dumps(what), flush=True)
say(say="extent", area=1.0, size=1.0, triangles=24, names=[])
facts = dict(triangles=12, euler_number=2, open_edges=0, volume=1.0, volume_error=0.0)
for name in task["engines"]:
    say(say="begin", engine=name)
    if name == "manifold3d":
        os.abort()
    if name == "trueform":
        say(say="step", engine=name, done=17)
        time.sleep(60)
    say(say="plan", engine=name, runs=0)
    say(say="run", engine=name, seconds=0.5, cpu=0.4, memory_mb=1.0, peak_mb=9.0, facts=facts)
say(say="end")
"""


def test_the_list_names_all_cases(capsys: Capture) -> None:
    code, out, _ = ran(capsys, "bench", "--list")
    assert code == 0
    assert [line.split()[0] for line in out.splitlines()[2:]] == list(CASES)
    document = json.loads(ran(capsys, "bench", "--list", "--json")[1])
    assert document["schema"] == 1 and [one["case"] for one in document["cases"]] == list(CASES)


# Found: `bench --json` required a file.
@pytest.mark.timeout(300)
def test_cases_are_measured_recorded_and_shown_again(capsys: Capture, tmp_path: Path) -> None:
    record_path, plot_path = tmp_path / "r.json", tmp_path / "sizes.svg"
    cases = ["cubes", "drilled-steps", "sizes"]
    code, out, err = ran(
        capsys,
        *["bench", *cases, "--quick", "--runs", "1", "--against", "manifold3d", "-q"],
        *["-o", str(record_path), "--plot", str(plot_path)],
    )
    assert (code, err) == (0, ""), out
    record = json.loads(record_path.read_text("utf-8"))
    assert (record["schema"], record["type"]) == (1, "bench")
    assert record["machine"]["cores"] >= 1
    assert {"bspcsg", "manifold3d", "python"} <= set(record["versions"])
    assert [row["case"] for row in record["cases"]] == cases
    for item in (item for row in record["cases"] for item in row["items"]):
        ours, theirs = item["engines"]["bspcsg"], item["engines"]["manifold3d"]
        assert ours["state"] == theirs["state"] == "ok"
        assert len(ours["seconds"]) == 2 and ours["median"] == ours["seconds"][1] > 0
        assert theirs["agrees"] and theirs["difference"] <= theirs["bound"]
        assert ours["facts"]["open_edges"] == 0 < ours["facts"]["triangles"]
    chain = record["cases"][1]["items"][0]["engines"]["bspcsg"]
    assert set(chain["parts"]) == {"build", "steps", "mesh out"} and chain["steps"] == 8
    assert chain["cold"] == chain["seconds"][0] and chain["faults"] >= 0
    assert record["cases"][0]["items"][0]["engines"]["bspcsg"]["peak_mb"] > 20
    drawing = ElementTree.parse(plot_path)
    assert len(drawing.findall(".//{*}circle")) == 2 * len(CASES["sizes"].small)
    code, again, _ = ran(capsys, "bench", "--from", str(record_path))
    assert (code, again) == (0, out)
    code, printed, _ = ran(capsys, "bench", "--from", str(record_path), "--json")
    assert code == 0 and json.loads(printed) == record
    code, details, _ = ran(capsys, "bench", "--from", str(record_path), "--details")
    assert details.startswith(out) and "page faults" in details[len(out) :]
    code, counters, _ = ran(capsys, "bench", "--from", str(record_path), "--counters")
    assert counters.startswith(out) and "nodes" in counters[len(out) :]
    code, table, _ = ran(capsys, "bench", "--from", str(record_path), "--format", "md")
    assert code == 0 and "| two cubes (small: 2 × 12) | < 40 µs |" in table


def _measured_at_once(monkeypatch: pytest.MonkeyPatch, stop_at: str = "") -> list[str]:
    """Make cases empty and interrupt at one of them; return the list of cases that were run."""
    measured: list[str] = []

    def run_case(key: str, *_: object) -> dict[str, Any]:
        if key == stop_at:
            raise KeyboardInterrupt
        measured.append(key)
        return {"case": key, "title": key, "items": []}

    monkeypatch.setattr(runner, "run_case", run_case)
    return measured


def test_what_was_measured_before_an_interrupt_stays_and_is_continued(
    capsys: Capture, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    path = tmp_path / "r.json"
    asked = ["bench", "--cliffs", "--against", "manifold3d", "-q", "-o", str(path)]
    names = [name for name in CASES if name.startswith("dense-")]
    measured = _measured_at_once(monkeypatch, stop_at=names[2])
    assert ran(capsys, *asked)[0] == 130
    assert [row["case"] for row in json.loads(path.read_text("utf-8"))["cases"]] == names[:2]
    measured = _measured_at_once(monkeypatch)
    assert ran(capsys, *asked, "--continue")[0] == 0
    assert measured == names[2:]
    assert [row["case"] for row in json.loads(path.read_text("utf-8"))["cases"]] == names
    measured.clear()
    assert ran(capsys, *asked, "--continue", names[5])[0] == 0
    assert measured == [names[5]]
    assert [row["case"] for row in json.loads(path.read_text("utf-8"))["cases"]] == names


def test_records_of_other_places_are_not_continued(
    capsys: Capture, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    _measured_at_once(monkeypatch)
    path = tmp_path / "r.json"
    asked = ["bench", "cubes", "-q", "-o", str(path), "--continue"]
    assert ran(capsys, *asked)[0] == 0
    record = json.loads(path.read_text("utf-8"))
    for changed in ("machine", "versions"):
        path.write_text(json.dumps({**record, changed: {}}))
        code, _, err = ran(capsys, *asked)
        assert code == 3 and "measure again without --continue" in err
    assert ran(capsys, "bench", "cubes", "--continue")[0] == 2


def test_a_few_cases_are_measured_without_names(
    capsys: Capture, monkeypatch: pytest.MonkeyPatch
) -> None:
    measured = _measured_at_once(monkeypatch)
    assert ran(capsys, "bench", "-q")[0] == 0 and measured == list(SHORT)
    measured.clear()
    assert ran(capsys, "bench", "-q", "--all")[0] == 0 and measured == list(CASES)


def test_an_answer_that_its_proof_refutes_fails(capsys: Capture, tmp_path: Path) -> None:
    record = _record_of_growth(2.2)
    ours = record["cases"][0]["items"][0]["engines"]["bspcsg"]
    path = tmp_path / "r.json"
    for agrees, code in ((True, 0), (False, 1)):
        ours["proof"] = {"agrees": agrees, "text": "wrong at 3 of 9 points"}
        path.write_text(json.dumps(record))
        found, out, _ = ran(capsys, "bench", "--from", str(path))
        assert found == code and ("bspcsg: wrong at 3 of 9 points (n)" in out) == (not agrees)


def test_an_engine_that_crashes_or_hangs_is_left_out(
    capsys: Capture, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    worker = tmp_path / "worker.py"
    worker.write_text(_WORKER)
    monkeypatch.setattr(runner, "_BOOT", worker)
    engines = ["bspcsg", "manifold3d", "trueform", "meshlib"]
    row = runner.run_case("cubes", runner.Settings(engines, limit=0.5), lambda _: None)
    found = row["items"][0]["engines"]
    states = {name: found[name]["state"] for name in engines}
    assert states == {
        "bspcsg": "ok",
        "manifold3d": "crashed",
        "trueform": "stopped",
        "meshlib": "ok",
    }
    assert found["trueform"]["steps_done"] == 17
    assert found["trueform"]["stopped_after"] >= 0.5
    assert found["meshlib"]["agrees"] and found["bspcsg"]["median"] == 0.5


def test_cases_without_their_data_are_left_out(capsys: Capture, tmp_path: Path) -> None:
    code, out, _ = ran(capsys, "bench", "capsules", "--quick", "--data", str(tmp_path), "-q")
    assert code == 0
    assert "left out" in out and "swept-capsules-100.npz does not exist" in out


@pytest.mark.parametrize(
    ("arguments", "code", "said"),
    [
        (["cubs"], 2, "'cubs' is not a known case; --list shows all cases."),
        (
            ["cubes", "--against", "blender"],
            2,
            "'blender' is not a known engine; known are manifold3d,",
        ),
        (
            ["--from", "pyproject.toml"],
            3,
            "pyproject.toml: the file is not a record of measurements",
        ),
        (["--from", "missing.json"], 3, "missing.json: cannot read this file: No such file or"),
        (["cubes", "-o", "no/such/x.json"], 5, "no/such/x.json: the folder no/such"),
        (
            ["cubes", "-o", "-"],
            2,
            "-o and --plot need the name of a file, not “-”; --json prints the record.",
        ),
        (["cubes", "--plot", "no/such/x.svg"], 5, "no/such/x.svg: the folder no/such"),
        (
            ["cubes", "--core", "none.so"],
            3,
            "none.so: the compiled core for --core does not exist.",
        ),
    ],
)
def test_wrong_use_is_said(capsys: Capture, arguments: list[str], code: int, said: str) -> None:
    found, out, err = ran(capsys, "bench", *arguments)
    assert (found, out) == (code, "")
    assert said in err and err.count("bspcsg: error: ") == 1


@pytest.mark.parametrize("left", ["{}", '{"cases": [{"case": "cubes"}]}', '{"cases": 3}'])
def test_damaged_records_are_refused(capsys: Capture, tmp_path: Path, left: str) -> None:
    path = tmp_path / "r.json"
    path.write_text(json.dumps({"type": "bench", "schema": 1, **json.loads(left)}))
    code, out, err = ran(capsys, "bench", "--from", str(path))
    said = f"{path}: this record of measurements is damaged; run bspcsg bench again."
    assert (code, out, err) == (3, "", f"bspcsg: error: {said}\n")


def test_records_of_another_schema_are_refused(capsys: Capture, tmp_path: Path) -> None:
    path = tmp_path / "old.json"
    path.write_text('{"type": "bench", "schema": 0}')
    code, _, err = ran(capsys, "bench", "--from", str(path))
    assert (
        code == 3
        and "the record has schema 0, but this version reads 1 only; run bspcsg bench again." in err
    )


def _record_of_growth(cpu: float) -> dict[str, Any]:
    facts = {"triangles": 50, "open_edges": 0}
    items = [
        {
            "item": label,
            "triangles": triangles,
            "engines": {"bspcsg": _found(used, facts)},
        }
        for label, triangles, used in (("n", 100, 1.0), ("2n", 200, cpu))
    ]
    row = {"case": "dense-cones", "title": "cones", "small": False, "items": items}
    machine = {"processor": "p", "cores": 2, "memory_gb": 4, "system": "s"}
    return {
        "schema": 1,
        "type": "bench",
        "runs": 1,
        "cases": [row],
        "machine": machine,
        "versions": {},
    }


def _found(cpu: float, facts: dict[str, int]) -> dict[str, Any]:
    return {"state": "ok", "median": cpu, "cpu": cpu, "runs": 5, "facts": facts}


@pytest.mark.parametrize(("cpu", "code"), [(2.2, 0), (3.0, 1)])
def test_a_cost_that_grows_too_fast_fails(
    capsys: Capture, tmp_path: Path, cpu: float, code: int
) -> None:
    path = tmp_path / "r.json"
    path.write_text(json.dumps(_record_of_growth(cpu)))
    found, out, _ = ran(capsys, "bench", "--from", str(path))
    assert found == code and f"cost × {cpu:.3g}, input and answer × 2" in out


def test_dense_places_are_a_suite_of_their_own(capsys: Capture) -> None:
    code, out, _ = ran(capsys, "bench", "--cliffs", "--list")
    names = [line.split()[0] for line in out.splitlines()[2:]]
    assert code == 0 and names and all(name.startswith("dense-") for name in names)
    code, _, err = ran(capsys, "bench", "--cliffs", "cubes")
    assert code == 2 and "none of these cases" in err


@pytest.mark.deep
@pytest.mark.timeout(300)
def test_dense_places_are_measured_at_two_sizes(capsys: Capture, tmp_path: Path) -> None:
    path = tmp_path / "r.json"
    asked = ["dense-cones", "--quick", "--runs", "1", "--against", "manifold3d", "-q"]
    assert ran(capsys, "bench", "--cliffs", *asked, "-o", str(path))[0] == 0
    [row] = json.loads(path.read_text("utf-8"))["cases"]
    assert [item["item"] for item in row["items"]] == ["12", "24"]
    assert all(item["engines"]["manifold3d"]["agrees"] for item in row["items"])
