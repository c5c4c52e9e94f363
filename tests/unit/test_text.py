"""Text as regions: fonts, layout, curves."""

import shutil
import warnings
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import bspcsg as b
from bspcsg import Region, csg
from bspcsg.modelling.planar.lettering import fonts
from bspcsg.modelling.planar.lettering.fonts import FontFile

FACES = Path(fonts.__file__).parent / "faces"


def box(region: Region) -> np.ndarray:
    assert region.bounds is not None
    return region.bounds


# Found: text, sweeps, lofts and assemblies were missing.
def test_letters_have_the_size_of_the_design() -> None:
    # The I of Liberation Sans: from 189 to 380 and 0 to 1409 of 2048 to the em.
    unit = 10 * 100 / 72 / 2048
    expected = np.array([[189, 0], [380, 1409]]) * unit
    np.testing.assert_allclose(box(b.text("I")), expected, atol=2e-9)
    np.testing.assert_allclose(box(b.text("I", 20)), 2 * expected, atol=2e-9)
    assert b.text("I").area == pytest.approx(191 * 1409 * unit**2, rel=1e-8)


def test_letters_have_their_holes_and_parts() -> None:
    assert [len(part.outlines) for part in b.text("B").decompose()] == [3]
    assert len(b.text("ij").decompose()) == 4
    assert b.text("").is_empty and b.text("   ").is_empty
    # What overlaps is united.
    close, apart = b.text("OO", spacing=0.6), b.text("OO")
    assert close.area < apart.area and len(close.decompose()) == 1


def test_kerning_moves_letters_together() -> None:
    alone = sum(box(b.text(letter, halign="right"))[0, 0] for letter in "AV")
    together = box(b.text("AV", halign="right"))[0, 0]
    assert together > alone + 0.5


@pytest.mark.parametrize(
    ("options", "axis", "part"),
    [
        ({"halign": "left"}, 0, 0.0),
        ({"halign": "center"}, 0, 0.5),
        ({"halign": "right"}, 0, 1.0),
        ({"valign": "bottom"}, 1, 0.0),
        ({"valign": "center"}, 1, 0.5),
        ({"valign": "top"}, 1, 1.0),
    ],
)
def test_alignments(options: dict[str, Any], axis: int, part: float) -> None:
    low, high = box(b.text("HHg", **options))
    plain_low, plain_high = box(b.text("HHg"))
    np.testing.assert_allclose(high - low, plain_high - plain_low, atol=5e-9)
    np.testing.assert_allclose(low[1 - axis], plain_low[1 - axis])
    if axis == 0:
        # The advance is that of the letters with the space around them.
        advance = (2 * 1479 + 1139) * 10 / 0.72 / 2048
        assert plain_low[0] - low[0] == pytest.approx(part * advance, abs=5e-9)
    else:
        assert low[1] + part * (high - low)[1] == pytest.approx(0, abs=0.01)


def test_curves_have_openscads_steps() -> None:
    def corners(segments: int) -> int:
        return len(b.text("o", segments=segments).outlines[0].points)

    fewest, four, ten = corners(3), corners(30), corners(72)
    assert fewest == corners(15) < four == corners(24) < ten
    # Eight steps more for each of as many curves.
    assert (ten - fewest) / 8 == (four - fewest) / 2


def test_directions() -> None:
    low, high = box(b.text("abc", direction="ttb"))
    assert high[1] < 0 and (high - low)[1] > 30 and (high - low)[0] < 10
    left, right = b.text("ab").area, b.text("ba", direction="rtl").area
    assert left == pytest.approx(right)
    # Hebrew runs from right to left by itself.
    ours = b.text("אב", font="Liberation Sans")
    np.testing.assert_allclose(box(ours), box(b.text("אב", direction="rtl", script="Hebr")))


def test_bold_is_there_and_bolder() -> None:
    bold = b.text("Ab", font="Liberation Sans:style=Bold")
    assert bold.area > 1.3 * b.text("Ab").area
    assert b.text("Ab", font=" liberation sans : style = bold ").area == bold.area
    assert b.text("Ab", font="").area == b.text("Ab").area


def test_fonts_by_their_path() -> None:
    path = FACES / "LiberationSans-Bold.ttf"
    bold = b.text("Ab", font="Liberation Sans:style=Bold")
    assert b.text("Ab", font=path) == bold and b.text("Ab", font=str(path)) == bold


def test_fonts_of_the_system(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    program = tmp_path / "fc-match"
    face = FACES / "LiberationSans-Bold.ttf"
    program.write_text(f"#!/bin/sh\nprintf '0\\n{face}\\nSome Sans,Some Sans Heavy'\n")
    program.chmod(0o755)
    monkeypatch.setenv("PATH", str(tmp_path))
    fonts._fontconfig.cache_clear()
    assert fonts.font_file("some sans:style=Heavy") == FontFile(face)
    # What stands in for another font is not that font.
    with pytest.raises(b.InvalidParameterError, match="no font 'Other Sans'"):
        fonts.font_file("Other Sans")
    program.unlink()
    fonts._fontconfig.cache_clear()
    with pytest.raises(b.InvalidParameterError, match="no font"):
        fonts.font_file("Some Sans")
    fonts._fontconfig.cache_clear()


def test_fonts_of_equal_metrics_stand_for_each_other(
    monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    face = FACES / "LiberationSans-Regular.ttf"

    def answers(families: str) -> None:
        says = {"fc-match": f"0\n{face}\nSome Sans", "fc-pattern": f"\tfamily: {families}\n"}
        for name, text in says.items():
            (tmp_path / f"{name}.txt").write_text(text)
            (tmp_path / name).write_text(f"#!/bin/sh\nexec {cat} '{tmp_path / name}.txt'\n")
            (tmp_path / name).chmod(0o755)
        fonts._fontconfig.cache_clear()

    cat = shutil.which("cat")
    monkeypatch.setenv("PATH", str(tmp_path))
    answers('"Equal Sans"(s) "Some Sans"(s) "Liberation Sans"(w)')
    assert fonts.font_file("Equal Sans:style=Bold") == FontFile(face)
    # The package's own font counts, too, if it is as near as that.
    answers('"Arial"(s) "Liberation Sans"(s) "Some Sans"(w)')
    own = FontFile(FACES / "LiberationSans-Bold.ttf")
    assert fonts.font_file("Arial:style=Bold") == own
    answers('"Other Sans"(s) "Liberation Sans"(w) "Some Sans"(w)')
    with pytest.raises(b.InvalidParameterError, match="no font 'Other Sans'"):
        fonts.font_file("Other Sans")
    fonts._fontconfig.cache_clear()


@pytest.mark.parametrize(
    ("call", "code"),
    [
        (lambda: b.text(3), "invalid_parameter"),  # type: ignore[arg-type]
        (lambda: b.text("a\nb"), "invalid_parameter"),
        (lambda: b.text("a\x00b"), "invalid_parameter"),
        (lambda: b.text("a", 0), "invalid_parameter"),
        (lambda: b.text("a", float("inf")), "invalid_parameter"),
        (lambda: b.text("a", halign="middle"), "invalid_parameter"),  # type: ignore[arg-type]
        (lambda: b.text("a", valign="left"), "invalid_parameter"),  # type: ignore[arg-type]
        (lambda: b.text("a", spacing=0), "invalid_parameter"),
        (lambda: b.text("a", direction="up"), "invalid_parameter"),  # type: ignore[arg-type]
        (lambda: b.text("a", script="Latin"), "invalid_parameter"),
        (lambda: b.text("a", language="日"), "invalid_parameter"),
        (lambda: b.text("a", segments=2), "invalid_parameter"),
        (lambda: b.text("a", font="No Such Sans"), "unknown_font"),
        (lambda: b.text("a", font="-v"), "unknown_font"),
        (lambda: b.text("a", font="a\x00b"), "unknown_font"),
        (lambda: b.text("a", font="missing.ttf"), "unreadable"),
        (lambda: b.text("a" * 3_000, segments=60_000), "too_many"),
        (lambda: b.text("日本"), "missing_glyph"),
    ],
)
def test_what_is_no_text_is_refused(call: Callable[[], Any], code: str) -> None:
    with pytest.raises(b.BspcsgError) as caught:
        call()
    assert caught.value.code == code


def test_files_that_hold_no_font_are_refused(tmp_path: Path) -> None:
    whole = (FACES / "LiberationSans-Regular.ttf").read_bytes()
    for name, data in {"empty": b"", "text": b"no font", "cut": whole[:300]}.items():
        path = tmp_path / f"{name}.ttf"
        path.write_bytes(data)
        with pytest.raises(b.FormatError, match="not a font that can be read"):
            b.text("a", font=path)


# In scripts


def figure(script: str) -> Region:
    found = csg.evaluate(csg.parse(script))
    assert isinstance(found, Region)
    return found


# Found: scripts with `text()` failed.
def test_text_in_scripts_stands_as_close_as_openscads() -> None:
    # OpenSCAD 2021.01 measures advances in 1600ths of the size, and glyphs in 1562.5ths.
    own, plain = box(figure('text("HH");')), box(b.text("HH"))
    step = 1479 * 10 / 0.72 / 2048
    assert (plain - own)[1, 0] == pytest.approx(step * (1 - 1000 / 1024), abs=2e-3)


# Found: `text` in a script lost the `$fn`, `$fa` and `$fs` of the nodes around it.
def test_text_takes_the_special_variables_around_it() -> None:
    coarse = figure('text("O", $fn = 3);')
    assert figure('group($fn = 3) { text("O"); }') == coarse != figure('text("O");')


def test_text_without_letters_or_size_is_empty() -> None:
    for script in ('text("");', 'text("a", size = 0);', 'text("a", size = -1);', "text();"):
        assert figure(script).is_empty


@pytest.mark.parametrize(
    ("script", "says"),
    [
        (
            'text("a", font = "No Such Sans:style=Bold");',
            "“No Such Sans:style=Bold” is not installed",
        ),
        (
            'text("a", font = "LiberationSans-Bold.ttf");',
            "is not installed; Liberation Sans is used",
        ),
        ('text("日");', "no glyph for 日"),
        (
            'text("a", halign = "middle");',
            "its halign “middle” is unknown and ignored; known are left, center, right",
        ),
        ('text("a", direction = "up");', "its direction “up” is unknown"),
    ],
)
def test_what_openscad_replaces_is_told(script: str, says: str) -> None:
    with pytest.warns(csg.CsgWarning, match=says):
        assert not figure(script).is_empty
    if "Such" in script:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")
            stands_in = figure(script)
        assert stands_in == figure('text("a", font = "Liberation Sans:style=Bold");')
