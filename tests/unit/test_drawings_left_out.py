"""Content of drawings that regions lack is reported; everything else is read."""

from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

import bspcsg as b
from bspcsg import bsp, csg

ezdxf = pytest.importorskip("ezdxf")

Draw = Callable[[Any, Any], Any]

SQUARE = [(0, 0), (3, 0), (3, 3), (0, 3)]


def square(space: Any) -> Any:
    return space.add_lwpolyline(SQUARE, close=True)


def dot(space: Any) -> Any:
    return space.add_circle((7, 7), 0)


def written(folder: Path, draw: Draw) -> Path:
    """Return the path of a DXF file that `draw` has filled."""
    document = ezdxf.new()
    draw(document.modelspace(), document)
    document.saveas(folder / "a.dxf")
    return folder / "a.dxf"


def imported(path: Path, script: str = 'import("{}");') -> bsp.Region:
    found = csg.evaluate(csg.parse(script.format(path.name), folder=path.parent))
    assert isinstance(found, bsp.Region)
    return found


def in_blocks(space: Any, document: Any) -> None:
    square(space)
    part = document.blocks.new("part")
    part.add_hatch().paths.add_polyline_path(SQUARE, is_closed=True)
    space.add_blockref("part", (5, 5)).add_attrib("name", "shown")
    space.add_blockref("part", (9, 5)).add_attrib("name", "hidden").is_invisible = True


# Found: DXF: hatches, solids, faces and text were passed over in silence, alone or beside outlines.
LEFT_OUT: dict[str, tuple[Draw, str]] = {
    "hatch": (
        lambda space, _: space.add_hatch().paths.add_polyline_path(SQUARE, is_closed=True),
        r"left out: HATCH \(1\)\. The region is empty\.",
    ),
    "solid": (lambda space, _: space.add_solid(SQUARE), r"left out: SOLID \(1\)\. The region"),
    "face": (lambda space, _: space.add_3dface(SQUARE), r"left out: 3DFACE \(1\)\. The region"),
    "texts": (
        lambda space, _: (space.add_text("A"), space.add_text("B"), space.add_mtext("C")),
        r"left out: MTEXT \(1\), TEXT \(2\)\. The region is empty\.",
    ),
    "beside an outline": (
        lambda space, _: (square(space), space.add_point((1, 1))),
        r"left out: POINT \(1\)\.$",
    ),
    "meshes": (
        lambda space, _: (square(space), space.add_polymesh((3, 3)), space.add_polyface()),
        r"left out: POLYLINE \(2\)\.$",
    ),
    "points": (
        lambda space, _: (square(space), space.add_line((9, 9), (9, 9)), dot(space)),
        r"left out: line that encloses no area \(2\)\.$",
    ),
    "in blocks": (in_blocks, r"left out: ATTRIB \(1\), HATCH \(2\)\.$"),
    "nothing": (lambda *_: None, "the region is empty: the drawing has no closed outline"),
    "twice": (
        lambda space, _: (square(space), square(space)),
        "the region is empty: its outlines cancel each other out",
    ),
    "paper space": (
        lambda space, document: (square(space), square(document.layout("Layout1"))),
        r"left out: entity in paper space \(1\)\.$",
    ),
}


@pytest.mark.parametrize("name", LEFT_OUT)
def test_what_a_dxf_file_holds_beside_outlines_is_told(tmp_path: Path, name: str) -> None:
    draw, says = LEFT_OUT[name]
    path = written(tmp_path, draw)
    area = 0 if "empty" in says or "The region" in says else 9
    with pytest.warns(bsp.DrawingWarning, match=says):
        assert bsp.load_dxf(path).area == area
    with pytest.warns(csg.CsgWarning, match=rf"^<csg>:1:1: import\(\): a\.dxf: {says}"):
        assert imported(path).area == area


def test_layers_that_do_not_count_are_not_missed(tmp_path: Path) -> None:
    def draw(space: Any, _: Any) -> None:
        square(space)
        space.add_text("A", dxfattribs={"layer": "words"})

    path = written(tmp_path, draw)
    assert bsp.load_dxf(path, layers=["0"]).area == 9
    assert imported(path, 'import("{}", layer = "0");').area == 9


def test_kinds_of_openscad_are_fewer(tmp_path: Path) -> None:
    path = written(tmp_path, lambda space, _: space.add_polyline2d(SQUARE, close=True))
    assert bsp.load_dxf(path).area == 9
    with pytest.warns(csg.CsgWarning, match=r"left out: POLYLINE \(1\)"):
        assert imported(path).is_empty


def test_extrusions_tell_of_their_drawing(tmp_path: Path) -> None:
    path = written(tmp_path, lambda space, _: (square(space), space.add_text("A")))
    with pytest.warns(csg.CsgWarning, match=r"linear_extrude\(\): a\.dxf: left out: TEXT \(1\)"):
        assert (
            csg.loads('linear_extrude(file = "a.dxf", height = 2);', folder=path.parent).volume
            == 18
        )


# Found: DXF: with everything in paper space, the region was empty.
@pytest.mark.parametrize("layout", ["Layout1", "Layout2"])
def test_paper_space_is_read_where_the_model_is_empty(tmp_path: Path, layout: str) -> None:
    def draw(_: Any, document: Any) -> None:
        if layout not in document.layouts:
            document.layouts.new(layout)
        square(document.layout(layout))

    path = written(tmp_path, draw)
    assert bsp.load_dxf(path).area == imported(path).area == 9


def tags(kind: str, *pairs: tuple[int, object]) -> str:
    return "".join(f"{code}\n{value}\n" for code, value in [(0, kind), (8, "cut"), *pairs])


CORNERS = [(code, value) for point in SQUARE for code, value in zip((10, 20), point, strict=True)]
POLYLINE = tags("LWPOLYLINE", (90, 4), (70, 1), *CORNERS)
CURVE = tags(
    "SPLINE", (70, 8), (71, 1), *((40, knot) for knot in (0, 0, 1, 2, 3, 4, 4)),
    *CORNERS, (10, 0), (20, 0),
)  # fmt: skip
MARKED = "0\nLWPOLYLINE\n5\n1F\n100\nAcDbEntity\n8\ncut\n100\nAcDbPolyline\n" + "".join(
    f"{code}\n{value}\n" for code, value in [(90, 4), (70, 1), *CORNERS]
)


# Found: DXF: one entity without subclass markers, and the whole file was refused; with them in a
# file of R12, polylines were open.
@pytest.mark.parametrize("version", ["", "AC1009", "AC1015", "AC1027"])
@pytest.mark.parametrize("entity", [POLYLINE, CURVE, MARKED])
def test_entities_need_no_subclass_markers(tmp_path: Path, version: str, entity: str) -> None:
    head = f"0\nSECTION\n2\nHEADER\n9\n$ACADVER\n1\n{version}\n0\nENDSEC\n" if version else ""
    text = f"{head}0\nSECTION\n2\nENTITIES\n{entity}0\nENDSEC\n0\nEOF\n"
    (tmp_path / "a.dxf").write_text(text)
    assert bsp.load_dxf(tmp_path / "a.dxf", layers=["cut"]).area == 9


@pytest.mark.parametrize(
    "entity",
    [
        tags("MTEXT", (10, 1), (20, 1), (40, 1), (1, "words")),
        tags("SPLINE", (70, 8), (71, 3)),
        tags("LEADER", (10, 0), (20, 0)),
        tags("REGION", (70, 1)),
        tags("HATCH", (2, "SOLID"), (70, 1), (91, 0)),
    ],
)
def test_bad_entities_leave_the_others(tmp_path: Path, entity: str) -> None:
    text = f"0\nSECTION\n2\nENTITIES\n{POLYLINE}{entity}0\nENDSEC\n0\nEOF\n"
    (tmp_path / "a.dxf").write_text(text)
    kind = entity.split()[1]
    with pytest.warns(bsp.DrawingWarning, match=rf"left out: {kind} \(1\)\.$"):
        assert bsp.load_dxf(tmp_path / "a.dxf").area == 9


def test_binary_dxf_is_refused_with_the_way_out(tmp_path: Path) -> None:
    document = ezdxf.new()
    square(document.modelspace())
    document.saveas(tmp_path / "a.dxf", fmt="bin")
    with pytest.raises(
        b.FormatError, match=r"a\.dxf: binary DXF files cannot be read; .* ezdxf\.readfile"
    ):
        bsp.load_dxf(tmp_path / "a.dxf")
    ezdxf.readfile(tmp_path / "a.dxf").saveas(tmp_path / "b.dxf")
    assert bsp.load_dxf(tmp_path / "b.dxf").area == 9


SVG = (
    '<svg xmlns="http://www.w3.org/2000/svg" xmlns:xlink="http://www.w3.org/1999/xlink"'
    ' viewBox="0 0 9 9"><rect x="5" width="2" height="2"/>{}</svg>'
)
RECT = '<rect width="3" height="3" {}/>'


# Found: SVG: text, strokes, images and uses of nothing were passed over in silence.
@pytest.mark.parametrize(
    ("body", "kinds"),
    [
        ("<text>A<tspan>B</tspan></text><g><text>C</text></g>", r"text \(2\)"),
        ('<defs><text id="t">A</text></defs><use href="#t"/><use href="#t"/>', r"text \(2\)"),
        (RECT.format('fill="none" stroke="black"'), r"stroke \(1\)"),
        ('<g style="stroke:red"><line x2="3"/><path d="M0 0L1 1"/></g>', r"stroke \(2\)"),
        ('<image width="3" height="3" xlink:href="a.png"/>', r"image \(1\)"),
        ('<use xlink:href="#a"/><use href="b.svg#a"/>', r"use of a missing element \(2\)"),
        (f"<foreignObject>{RECT.format('')}</foreignObject>", r"foreignObject \(1\)"),
        ('<switch><rect systemLanguage="xx" width="3" height="3"/></switch>', r"switch \(1\)"),
    ],
)
def test_what_an_svg_file_shows_beside_shapes_is_told(
    tmp_path: Path, body: str, kinds: str
) -> None:
    (tmp_path / "a.svg").write_text(SVG.format(body))
    with pytest.warns(bsp.DrawingWarning, match=rf"a\.svg: left out: {kinds}\.$"):
        assert bsp.load_svg(tmp_path / "a.svg").area == 4


@pytest.mark.parametrize(
    "body",
    [
        '<text display="none">A</text><g visibility="hidden"><text>B</text></g><text> </text>',
        '<defs><text>A</text><image/><use href="#a"/></defs>',
        RECT.format('fill="none"'),
        '<g id="a"/><use href="#a"/>',
        "<metadata><text>A</text></metadata><title>A</title><desc>B</desc>",
    ],
)
def test_what_an_svg_file_does_not_show_is_not_missed(tmp_path: Path, body: str) -> None:
    (tmp_path / "a.svg").write_text(SVG.format(body))
    assert bsp.load_svg(tmp_path / "a.svg").area == 4


# Found: SVG: `switch` drew a child of another language.
@pytest.mark.parametrize(
    ("children", "area"),
    [
        (RECT.format('systemLanguage="xx"') + RECT.format(""), 9),
        (RECT.format('systemLanguage="de, en-GB"') + '<rect width="1" height="1"/>', 9),
        (RECT.format('systemLanguage=""') + '<rect width="1" height="1"/>', 1),
        ("<title>A</title>" + RECT.format("") + '<rect width="1" height="1"/>', 9),
        (f"<foreignObject>{RECT.format('')}</foreignObject><g>{RECT.format('')}</g>", 9),
        ("", 0),
    ],
)
def test_a_switch_draws_the_first_child_that_fits(
    tmp_path: Path, children: str, area: float
) -> None:
    (tmp_path / "a.svg").write_text(SVG.format(f'<switch transform="scale(1)">{children}</switch>'))
    assert bsp.load_svg(tmp_path / "a.svg").area == 4 + area


def test_scripts_tell_what_svg_files_hold_beside_shapes(tmp_path: Path) -> None:
    (tmp_path / "a.svg").write_text(SVG.format('<switch><text>A</text></switch><use href="#a"/>'))
    says = r"import\(\): a\.svg: left out: text \(1\), use of a missing element \(1\)\.$"
    with pytest.warns(csg.CsgWarning, match=says):
        assert not imported(tmp_path / "a.svg").is_empty
