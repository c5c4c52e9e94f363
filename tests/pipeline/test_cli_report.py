"""The command report: reports of campaigns."""

import json
from pathlib import Path
from xml.etree import ElementTree

import pytest

import bspcsg as b
from support.cli import Capture, Piped, ran
from support.results import case, disagreeing, header, write_results


@pytest.fixture
def shards(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """Return the current folder, a temporary one with the results of two parts of a campaign."""
    monkeypatch.chdir(tmp_path)
    agreeing = case("corner", "union", b.cube(2), b.cube(2).translate(1, 1, 1))
    write_results(tmp_path / "r-1.jsonl", [header(), agreeing])
    write_results(tmp_path / "r-2.jsonl", [header(), disagreeing()])
    return tmp_path


def test_html(shards: Path, capsys: Capture) -> None:
    code, out, err = ran(capsys, "report", "r-1.jsonl", "r-2.jsonl", "-o", "r.html")
    assert (code, err) == (0, "") and out.startswith("r.html  2 cases  1 failure  ")
    page = Path("r.html").read_text(encoding="utf-8")
    assert page.startswith("<!doctype html>") and "2 cases, 1 failure" in page


def test_the_order_of_the_shards_does_not_matter(shards: Path, capsys: Capture) -> None:
    for target, order in (("x.html", "12"), ("y.html", "21")):
        files = [f"r-{number}.jsonl" for number in order]
        assert ran(capsys, "report", *files, "-o", target)[0] == 0
    assert Path("x.html").read_bytes() == Path("y.html").read_bytes()


def test_json(shards: Path, capsys: Capture) -> None:
    command = ["report", "r-1.jsonl", "r-2.jsonl", "-o", "r.json", "--json"]
    code, out, _ = ran(capsys, *command)
    told = json.loads(out)
    assert code == 0 and told["format"] == "json" and (told["cases"], told["failures"]) == (2, 1)
    kept = json.loads(Path("r.json").read_text("utf-8"))
    assert kept["verdicts"] == {"DISAGREE": 1, "agree": 1} and len(kept["results"]) == 2


def test_junit_by_suffix_and_markdown_to_a_stream(shards: Path, piped: Piped) -> None:
    assert piped("report", "r-1.jsonl", "r-2.jsonl", "-o", "r.xml")[0] == 0
    root = ElementTree.parse("r.xml").getroot()
    assert (root.get("tests"), root.get("failures")) == ("2", "1")
    code, out, err = piped("report", "r-1.jsonl", "-o", "-", "--format", "md")
    assert (code, err) == (0, b"") and out.startswith(b"# Validation") and b"| agree |" in out


def test_results_from_a_stream(shards: Path, piped: Piped) -> None:
    both = Path("r-1.jsonl").read_bytes() + Path("r-2.jsonl").read_bytes()
    arguments = ("report", "-", "-o", "-", "--format", "md")
    code, out, _ = piped(*arguments, given=both)
    assert code == 0 and b"1 of 2 cases failed" in out


@pytest.mark.parametrize(
    ("arguments", "code", "words"),
    [
        (["none.jsonl", "-o", "r.html"], 3, "none.jsonl: cannot read"),
        (
            ["r-1.jsonl", "-o", "r.pdf"],
            3,
            "r.pdf: the format is unknown; the output name must end in one of .html",
        ),
        (["r-1.jsonl", "-o", "no/r.html"], 5, "does not exist or is not writable"),
        (["r-1.jsonl", "-o", "-"], 2, "give the format, such as --format md"),
        (["r-1.jsonl", "-o", "-", "--format", "html", "--json"], 2, "cannot both go"),
        (["r-1.jsonl", "-o", "r.html", "--cards", "-1"], 2, "-1"),
        (["r-1.jsonl", "-o", "r.html", "--format", "pdf"], 2, "pdf"),
        (["r-1.jsonl"], 2, "-o"),
        (["-o", "r.html"], 2, "RESULTS"),
        (
            ["r-1.jsonl", "-o", "r-1.jsonl", "--format", "md"],
            2,
            "would overwrite the input r-1.jsonl",
        ),
        (
            ["bad.jsonl", "-o", "r.html"],
            3,
            "bad.jsonl:1: this line is not a record of a results file",
        ),
        (
            ["short.jsonl", "-o", "r.html"],
            3,
            "short.jsonl: the results file is not valid: case has no 'bounds'",
        ),
        (
            ["void.jsonl", "-o", "r.html"],
            3,
            "void.jsonl: the results contain no case; run bspcsg crosscheck --results first.",
        ),
        (
            ["void.jsonl", "void.jsonl", "-o", "r.md"],
            3,
            "void.jsonl, void.jsonl: the results contain no case",
        ),
    ],
)
def test_refusals(
    shards: Path, capsys: Capture, arguments: list[str], code: int, words: str
) -> None:
    Path("void.jsonl").touch()
    Path("bad.jsonl").write_bytes(b"\xff\x00\n")
    write_results(Path("short.jsonl"), [{"schema": 1, "type": "case", "key": "k"}])
    before = sorted(shards.iterdir())
    found, out, err = ran(capsys, "report", *arguments)
    assert found == code and words in err
    assert out == "" or json.loads(out)["exit"] == code
    assert sorted(shards.iterdir()) == before


def test_a_missing_part_is_code_6(
    shards: Path, capsys: Capture, monkeypatch: pytest.MonkeyPatch
) -> None:
    import sys

    from bspcsg.report import assets

    monkeypatch.setitem(sys.modules, "jinja2", None)
    assets._environment.cache_clear()
    code, _, err = ran(capsys, "report", "r-1.jsonl", "-o", "r.html")
    assert code == 6 and "Try: pip install 'jinja2>=3.1'" in err and not Path("r.html").exists()
    assert ran(capsys, "report", "r-1.jsonl", "-o", "r.md")[0] == 0
