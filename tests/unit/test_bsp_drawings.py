"""Regions in SVG and DXF files."""

import math
import os
import subprocess
import sys
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import numpy as np
import pytest

import bspcsg as b
from bspcsg import bsp
from bspcsg.bsp.drawings.dxf import dxf_data

R = bsp.Region
SVG = '<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 9 9" width="90mm">{}</svg>'


def drawn(tmp_path: Path, body: str, **options: float) -> bsp.Region:
    path = tmp_path / "drawing.svg"
    path.write_text(SVG.format(body))
    return R.from_svg(path, **options)


def odd_region() -> bsp.Region:
    """Return a region with corners off the lattice, a hole and an island."""
    ring = R.circle(1 / 3, 7).rotate(10) - R.circle(0.2, 5)
    return ring.translate(1e3 / 7, -2) | R.circle(0.05, 3).translate(1e3 / 7, -2)


@pytest.mark.parametrize("suffix", ["svg", "dxf"])
def test_round_trips_are_exact(suffix: str, tmp_path: Path) -> None:
    region = R(odd_region().to_polygons())
    path = tmp_path / f"region.{suffix}"
    getattr(region, f"to_{suffix}")(path)
    again = getattr(R, f"from_{suffix}")(path)
    assert again.exact_outlines == region.exact_outlines
    assert len(again.outlines) == 3


# Found: drawings of large and small shapes in SVG, and the empty region beside large ones, were
# refused.
@pytest.mark.parametrize("suffix", ["svg", "dxf"])
def test_drawings_far_out_and_of_large_and_small_parts_come_back(
    suffix: str, tmp_path: Path
) -> None:
    small = R([[(0, 0), (1.5, 0), (0, 2.25)]], pitch=-6)
    region = R.compose([R.empty(), small, R.rectangle(3e7, 2e7).translate(2, 0)])
    path = tmp_path / f"region.{suffix}"
    getattr(region, f"to_{suffix}")(path)
    again = getattr(R, f"from_{suffix}")(path)
    assert again == region and again.pitch == -6


@pytest.mark.parametrize("suffix", ["svg", "dxf"])
def test_the_empty_region_is_a_drawing_too(suffix: str, tmp_path: Path) -> None:
    path = tmp_path / f"empty.{suffix}"
    getattr(R.empty(), f"to_{suffix}")(path)
    with pytest.warns(bsp.DrawingWarning, match=f"empty.{suffix}: the region is empty"):
        assert getattr(R, f"from_{suffix}")(path).is_empty
    with pytest.raises(b.UnboundedError):
        getattr(R.full(), f"to_{suffix}")(path)


def test_svg_shapes(tmp_path: Path) -> None:
    moved = '<g transform="translate(3 1) rotate(90)"><rect width="4" height="2"/></g>'
    assert drawn(tmp_path, moved).equals(R.rectangle(2, 4).translate(1, -5))
    disc = drawn(tmp_path, '<circle cx="2" cy="3" r="2"/>', tolerance=1e-4)
    assert disc.area == pytest.approx(4 * math.pi, rel=1e-3)
    assert disc.bounds is not None
    assert np.allclose(disc.bounds, [[0, -5], [4, -1]])
    assert disc.area < 4 * math.pi < disc.area + disc.perimeter * 1e-4
    coarse = drawn(tmp_path, '<circle cx="2" cy="3" r="2"/>', tolerance=0.1)
    assert len(coarse.outlines[0].points) < len(disc.outlines[0].points)
    bow = drawn(tmp_path, '<path d="M0 0 C 0 4 4 4 4 0"/>', tolerance=1e-4)
    assert bow.area == pytest.approx(16 * 0.6, rel=1e-3)


def test_svg_fill_rules(tmp_path: Path) -> None:
    path = '<path {} d="M0 0 h4 v4 h-4z m1 1 h2 v2 h-2z"/>'
    assert drawn(tmp_path, path.format("")).area == 16
    assert drawn(tmp_path, path.format('fill-rule="evenodd"')).area == 12
    styled = f'<g style="fill-rule:evenodd">{path.format("")}</g>'
    assert drawn(tmp_path, styled).area == 12
    for hidden in ('fill="none"', 'style="fill:none"', 'display="none"'):
        with pytest.warns(bsp.DrawingWarning, match="no closed outline"):
            assert drawn(tmp_path, path.format(hidden)).is_empty
    two = '<rect width="2" height="2"/><rect x="1" width="2" height="2"/>'
    assert drawn(tmp_path, two).area == 6
    with pytest.warns(bsp.DrawingWarning, match=r"left out: stroke \(1\), text \(1\)\. The region"):
        assert drawn(tmp_path, '<line x2="4" y2="4" stroke="black"/><text>hi</text>').is_empty


BOMB = '<!DOCTYPE svg [<!ENTITY a "aaaa"><!ENTITY b "&a;&a;">]><svg>&b;</svg>'
OUTSIDE = '<!DOCTYPE svg [<!ENTITY a SYSTEM "file:///etc/passwd">]><svg>&a;</svg>'
#: The document type that most programs write.
DOCTYPE = (
    '<!DOCTYPE svg PUBLIC "-//W3C//DTD SVG 1.1//EN"'
    ' "http://www.w3.org/Graphics/SVG/1.1/DTD/svg11.dtd">'
)


@pytest.mark.parametrize("text", [BOMB, OUTSIDE, "", "<svg>", "<html/>", "plain", "<svg>&x;</svg>"])
def test_bad_svg(text: str, tmp_path: Path) -> None:
    path = tmp_path / "bad.svg"
    path.write_text(text)
    with pytest.raises(b.FormatError) as caught:
        R.from_svg(path)
    assert "bad.svg" in caught.value.message


# Found: drawings with a document type were refused.
@pytest.mark.parametrize("head", [DOCTYPE, '<!DOCTYPE svg SYSTEM "file:///etc/passwd">'])
def test_document_types_are_passed_over(head: str, tmp_path: Path) -> None:
    path = tmp_path / "a.svg"
    path.write_text(
        f'{head}<svg xmlns="http://www.w3.org/2000/svg"><rect width="2" height="3"/></svg>'
    )
    assert R.from_svg(path).area == 6


@pytest.mark.parametrize(
    "transform", ["skewX(20)", "matrix(1 0 0.5 2 0 0)", "rotate(33) scale(1, 2)"]
)
def test_svg_arcs_keep_their_area_where_they_are_skewed(transform: str, tmp_path: Path) -> None:
    circle = f'<circle cx="20" cy="20" r="5" transform="{transform}"/>'
    factor = 1 if "skew" in transform else 2
    assert drawn(tmp_path, circle).area == pytest.approx(25 * math.pi * factor, rel=2e-3)


def test_dxf_names_the_extra_that_it_needs(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    for name in [name for name in sys.modules if name.partition(".")[0] == "ezdxf"]:
        monkeypatch.delitem(sys.modules, name)
    monkeypatch.setitem(sys.modules, "ezdxf", None)
    (tmp_path / "a.dxf").write_text("0\nEOF\n")
    (tmp_path / "a.csg").write_text('import(file = "a.dxf");')
    for call in (
        lambda: R.from_dxf(tmp_path / "a.dxf"),
        lambda: R.rectangle(1).to_dxf(tmp_path / "b.dxf"),
        lambda: b.csg.load(tmp_path / "a.csg", lenient=True),
    ):
        with pytest.raises(b.MissingPartError) as caught:
            call()
        assert caught.value.code == "missing_package"
        words = 'The package ezdxf is needed but not installed. Try: pip install "bspcsg[dxf]"'
        assert words in str(caught.value)
    assert not (tmp_path / "b.dxf").exists()


def test_missing_files_and_packages(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    for load in (R.from_svg, R.from_dxf):
        with pytest.raises(b.FormatError):
            load(tmp_path / "nowhere")
    R.rectangle(1).to_svg(tmp_path / "a.svg")
    monkeypatch.setitem(sys.modules, "svgelements", None)
    with pytest.raises(b.MissingPartError, match=r"pip install svgelements"):
        R.from_svg(tmp_path / "a.svg")
    with pytest.raises(b.InvalidMeshError):
        R.from_svg(tmp_path / "a.svg", tolerance=0)


def test_dxf_entities(tmp_path: Path) -> None:
    ezdxf = pytest.importorskip("ezdxf")
    document = ezdxf.new()
    space = document.modelspace()
    # A slot of two lines and two arcs, in no order and direction, and a hole on another layer.
    space.add_line((0, 0), (4, 0))
    space.add_line((0, 2), (4, 2))
    space.add_arc((4, 1), 1, -90, 90)
    space.add_arc((0, 1), 1, 90, 270)
    space.add_circle((2, 1), 0.5, dxfattribs={"layer": "holes"})
    document.saveas(tmp_path / "slot.dxf")
    slot = R.from_dxf(tmp_path / "slot.dxf", tolerance=1e-4)
    assert slot.area == pytest.approx(8 + math.pi - math.pi / 4, rel=1e-3)
    assert [o.is_hole for o in slot.outlines] == [False, True]
    hole = R.from_dxf(tmp_path / "slot.dxf", layers=["holes"], tolerance=1e-4)
    assert hole.area == pytest.approx(math.pi / 4, rel=1e-3)


def test_the_same_region_gives_the_same_bytes_in_every_process(tmp_path: Path) -> None:
    def data(seed: str) -> list[bytes]:
        path = tmp_path / seed
        program = (
            "from bspcsg import bsp; region = bsp.Region.rectangle(2, 1);"
            f" region.to_svg({f'{path}.svg'!r}); region.to_dxf({f'{path}.dxf'!r})"
        )
        environment = {**os.environ, "PYTHONHASHSEED": seed}
        subprocess.run([sys.executable, "-c", program], env=environment, check=True)
        return [path.with_suffix(suffix).read_bytes() for suffix in (".svg", ".dxf")]

    assert data("1") == data("2") == data("3")


def test_threads_may_write_at_once() -> None:
    ezdxf = pytest.importorskip("ezdxf")
    before = ezdxf.options.write_fixed_meta_data_for_testing
    with ThreadPoolExecutor(8) as pool:
        data = set(pool.map(lambda _: dxf_data(R.rectangle(2, 1)), range(24)))
    assert len(data) == 1
    assert ezdxf.options.write_fixed_meta_data_for_testing == before


def test_bad_dxf(tmp_path: Path) -> None:
    ezdxf = pytest.importorskip("ezdxf")
    document = ezdxf.new()
    document.modelspace().add_line((0, 0), (4, 0))
    document.saveas(tmp_path / "open.dxf")
    with pytest.raises(b.FormatError, match="open at") as caught:
        R.from_dxf(tmp_path / "open.dxf")
    assert caught.value.code == "not_closed"
    for text in ("", "nonsense", "0\nSECTION\n2\nENTITIES\n0\nLINE\n"):
        (tmp_path / "bad.dxf").write_text(text)
        with pytest.raises(b.FormatError):
            R.from_dxf(tmp_path / "bad.dxf")


SQUARE_PATH = '<rect width="4" height="4" {}/>'


# Found: shapes of an SVG with `fill=" none "`, `NONE`, `none !important` or
# `visibility="collapse"` counted as filled.
@pytest.mark.parametrize(
    "said",
    [
        *('fill="none"', 'fill=" none "', 'fill="NONE"', 'style="fill:none !important"'),
        *('visibility="collapse"', 'visibility=" hidden "', 'style="display:none!important"'),
    ],
)
def test_what_is_not_filled_or_shown_is_left_out(tmp_path: Path, said: str) -> None:
    text = '<svg xmlns="http://www.w3.org/2000/svg">{}<rect x="9" width="1" height="1"/></svg>'
    (tmp_path / "x.svg").write_text(text.format(SQUARE_PATH.format(said)))
    assert R.from_svg(tmp_path / "x.svg").area == 1


# Found: an SVG whose outermost element is not displayed was no valid SVG.
@pytest.mark.parametrize("said", ['display="none"', 'style="display:none"', 'display="NONE"'])
def test_drawings_that_are_not_displayed_are_empty(tmp_path: Path, said: str) -> None:
    text = f'<svg xmlns="http://www.w3.org/2000/svg" {said}>{SQUARE_PATH.format("")}</svg>'
    (tmp_path / "x.svg").write_text(text)
    with pytest.warns(bsp.DrawingWarning, match="no closed outline"):
        assert R.from_svg(tmp_path / "x.svg").is_empty


def test_even_odd_is_told_in_any_case(tmp_path: Path) -> None:
    path = '<path style="fill-rule: EvenOdd !important" d="M0 0H4V4H0Z M1 1H3V3H1Z"/>'
    (tmp_path / "x.svg").write_text(f'<svg xmlns="http://www.w3.org/2000/svg">{path}</svg>')
    assert R.from_svg(tmp_path / "x.svg").area == 12


# Found: a negative or huge margin of an SVG wrote a page of negative or infinite size.
@pytest.mark.parametrize("margin", [-1, -0.1, 1e308])
def test_margins_without_a_page_are_refused(tmp_path: Path, margin: float) -> None:
    with pytest.raises(b.InvalidParameterError, match="margin"):
        bsp.save_svg(R.rectangle(4), tmp_path / "x.svg", margin=margin)
    assert not (tmp_path / "x.svg").exists()
