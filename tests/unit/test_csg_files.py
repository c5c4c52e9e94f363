"""Files that scripts read: meshes, drawings, tables and height maps."""

from contextlib import nullcontext
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import bspcsg as b
from bspcsg import csg
from bspcsg.bsp import Region
from bspcsg.csg.making import dxf_import
from bspcsg.csg.syntax import arguments

# Files


# Found: `surface()` failed if the last row was short.
@pytest.mark.parametrize(
    ("rows", "expected"),
    [
        ("1 2 3\n4 5 6\n7 8\n", (12 + 16 + 24 + 19) / 4),
        ("1 2 3\n4 5 6\n7 8", (12 + 16 + 24 + 19) / 4),
        ("1 1 1\n1 1 1\n1\n", 1 + 1 + 3 / 4 + 2 / 4),
        ("1 1 1\n\n# two\n1\n1 1 1\n", (3 + 2) / 2),
        ("-1 -1\n-1\n", 2 - 3 / 4),
    ],
)
def test_rows_of_a_surface_may_be_shorter(tmp_path: Path, rows: str, expected: float) -> None:
    (tmp_path / "x.dat").write_text(rows)
    text = 'surface(file = "x.dat");'
    assert csg.loads(text, folder=tmp_path).volume == pytest.approx(expected)


DRAWING = '<svg xmlns="http://www.w3.org/2000/svg">{}</svg>'


# Found: drawings in scripts honoured `fill: none`, which OpenSCAD ignores.
@pytest.mark.parametrize(
    ("shapes", "area"),
    [
        ('<path fill="none" d="M0 0 L10 0 L10 10 L0 10 Z"/>', 100),
        ('<rect style="fill:none" width="10" height="2"/>', 20),
        ('<path fill-rule="nonzero" d="M0 0H10V10H0Z M2 2H4V4H2Z"/>', 96),
        ('<polyline points="0,0 10,0" stroke-width="2" stroke-linecap="butt"/>', 20),
        ('<line x2="10" stroke-width="2"/>', 24),
        ('<g transform="scale(2)"><path d="M0 0H10" stroke-linecap="butt"/></g>', 40),
        ('<rect display="none" width="10" height="2"/>', 0),
        ('<style>.a { stroke-width: 4 }</style><line class="a" x2="9"/>', 10),
        ('<defs><rect id="r" width="9" height="9"/></defs><use href="#r"/>', 0),
    ],
)
def test_drawings_are_filled_as_openscad_fills_them(
    tmp_path: Path, shapes: str, area: float
) -> None:
    pytest.importorskip("svgelements")
    (tmp_path / "x.svg").write_text(DRAWING.format(shapes))
    told = nullcontext() if area else pytest.warns(csg.CsgWarning, match="region is empty")
    with told:
        found = csg.evaluate(csg.parse('import("x.svg");', folder=tmp_path))
    assert isinstance(found, Region) and found.area == pytest.approx(area)


def test_imports_are_relative_to_the_script(tmp_path: Path) -> None:
    b.cube(2).save(tmp_path / "part.stl")
    b.cube(2).save(tmp_path / "part.off")
    for name in ("part.stl", "part.off"):
        (tmp_path / "all.csg").write_text(f'import(file = "{name}", layer = "", timestamp = 1);')
        assert b.load(tmp_path / "all.csg").volume == 8


# Found: `center` counted for SVG files alone, and what does not concern a file was passed over.
def test_imports_are_centered() -> None:
    folder = Path(__file__).parents[1] / "corpus" / "csg"
    for name in ("block.stl", "drawing.svg", "drawing.dxf"):
        plain, centered = (
            csg.evaluate(csg.parse(f'import("{name}", center = {word});', folder=folder))
            for word in ("false", "true")
        )
        assert isinstance(plain, (b.Solid, Region)) and type(centered) is type(plain)
        assert plain.bounds is not None and centered.bounds is not None
        middle = plain.bounds.mean(axis=0)
        np.testing.assert_allclose(centered.bounds, plain.bounds - middle, atol=1e-9)


@pytest.mark.parametrize(
    ("arguments", "unused"),
    [
        ('"block.stl", scale = 2', "scale"),
        ('"block.stl", origin = [1, 0]', "origin"),
        ('"block.stl", layer = "walls"', "layer"),
        ('"drawing.svg", id = "a"', "id"),
        ('"drawing.svg", scale = 2', "scale"),
        ('"drawing.dxf", dpi = 96', "dpi"),
    ],
)
def test_what_does_not_concern_a_file_is_told(arguments: str, unused: str) -> None:
    folder = Path(__file__).parents[1] / "corpus" / "csg"
    with pytest.warns(csg.CsgWarning, match=f"its {unused} is ignored for this file format"):
        csg.evaluate(csg.parse(f"import({arguments});", folder=folder))


# Found: `import` of a name too long for a file ended in an `OSError`.
def test_names_that_no_file_can_have(tmp_path: Path) -> None:
    for name in ("a" * 300 + ".stl", "a" * 5000 + ".stl"):
        with pytest.warns(csg.CsgWarning, match="does not exist"):
            assert csg.loads(f'cube(1); import("{name}");', folder=tmp_path).volume == 1


def inside_and_outside(folder: Path) -> Path:
    """Return a script's folder with other files beside it and, by a link, inside it."""
    own = folder / "own"
    (own / "parts").mkdir(parents=True)
    (own / "parts" / "table.dat").write_text("1 1\n1 1\n")
    (folder / "table.dat").write_text("secret 1\n1 1\n")
    (folder / "heights.dat").write_text("1 1\n1 1\n")
    (own / "link.dat").symlink_to(folder / "heights.dat")
    (own / "round.dat").symlink_to(own / "round.dat")
    return own


@pytest.mark.parametrize("name", ["parts/table.dat", "parts/../parts/table.dat"])
def test_files_in_the_scripts_folder_are_read(tmp_path: Path, name: str) -> None:
    own = inside_and_outside(tmp_path)
    assert csg.loads(f'surface("{name}");', folder=own).volume == 1


# Found: scripts could read any file, and errors quoted its first line.
@pytest.mark.parametrize("node", ["surface", "import"])
@pytest.mark.parametrize(
    "name", ["../heights.dat", "../none.dat", "link.dat", "parts/../../heights.dat", "/etc/passwd"]
)
def test_files_elsewhere_are_not_even_looked_for(tmp_path: Path, node: str, name: str) -> None:
    own = inside_and_outside(tmp_path)
    with pytest.raises(b.FormatError, match="outside the script's folder") as caught:
        csg.loads(f'{node}("{name}");', folder=own)
    assert caught.value.code == "forbidden_path" and caught.value.where == (1, 1)


def test_further_folders_can_be_allowed(tmp_path: Path) -> None:
    own = inside_and_outside(tmp_path)
    for name in ("../heights.dat", "link.dat"):
        text = f'surface("{name}");'
        assert csg.loads(text, folder=own, allow_paths=[tmp_path]).volume == 1
        assert csg.evaluate(csg.parse(text, folder=own), allow_paths=[str(tmp_path)]) is not None
    with pytest.raises(b.FormatError, match="outside"):
        csg.loads('surface("../heights.dat");', folder=own, allow_paths=[own / "parts"])
    with pytest.raises(b.FormatError):
        csg.loads('surface("round.dat");', folder=own)


def test_errors_do_not_repeat_what_stands_in_files(tmp_path: Path) -> None:
    own = inside_and_outside(tmp_path)
    with pytest.raises(
        b.FormatError, match=r"table.dat:1: this line has an entry that is not a number"
    ) as caught:
        csg.loads('surface("../table.dat");', folder=own, allow_paths=[tmp_path])
    assert "secret" not in str(caught.value)


@pytest.mark.parametrize(
    ("text", "code", "says"),
    [
        ('import(file = "x.amf");', "unsupported", "“.amf” files are not supported"),
        ('import(file = "x.stl");', "empty_file", "empty"),
        ('surface(file = "x.amf");', "syntax", "two rows and two columns"),
        ('surface(file = "words.dat");', "syntax", "words.dat:1"),
        ('surface(file = "x.png");', "malformed", "x.png"),
        ('surface(file = "words.png");', "malformed", "cannot be read as PNG"),
        ('import(file = "words.dxf");', "syntax", "not a valid DXF"),
        ('import(file = "words.svg");', "syntax", "words.svg"),
    ],
)
def test_files_that_are_not_what_they_should(
    tmp_path: Path, text: str, code: str, says: str
) -> None:
    for name in ("x.amf", "x.stl", "x.png"):
        (tmp_path / name).touch()
    for name in ("words.dat", "words.dxf", "words.svg", "words.png"):
        (tmp_path / name).write_text("not at all\n")
    with pytest.raises(b.FormatError) as caught:
        csg.loads(text, folder=tmp_path)
    assert caught.value.code == code
    assert str(caught.value).startswith("<csg>:1:1: ")
    assert says in str(caught.value)


# Polish


def test_blocks_of_drawings_have_a_bound(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(dxf_import, "MAX_BLOCK_ENTITIES", 300)
    ezdxf = pytest.importorskip("ezdxf")
    document = ezdxf.new()
    document.blocks.new("0").add_circle((0, 0), 1)
    for level in range(1, 12):
        for place in range(1 if level < 3 else 9):
            block = document.blocks.get(str(level)) or document.blocks.new(str(level))
            block.add_blockref(str(level - 1), (5 * place, 0))
    for name, top in (("good", "2"), ("bomb", "11")):
        insert = document.modelspace().add_blockref(top, (3, 4))
        document.saveas(tmp_path / f"{name}.dxf")
        insert.destroy()
    text = 'linear_extrude(1) import("{}.dxf", $fn = 4);'
    assert csg.loads(text.format("good"), folder=tmp_path).volume == 2
    with pytest.raises(b.FormatError, match="contain more than"):
        csg.loads(text.format("bomb"), folder=tmp_path)


# Found: drawings that scripts import had arcs of any number of sides, which filled the memory.
@pytest.mark.parametrize(
    ("sides", "most"), [(70_000, 4_000_000), (1_000_000_000, 4_000_000), (9, 40)]
)
def test_arcs_of_drawings_have_a_bound(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, sides: int, most: int
) -> None:
    monkeypatch.setattr(arguments, "MAX_CORNERS", most)
    ezdxf = pytest.importorskip("ezdxf")
    document = ezdxf.new()
    for place in range(4):
        document.modelspace().add_circle((5 * place, 0), 1)
    document.modelspace().add_ellipse((0, 9), (2, 0), 0.5)
    document.saveas(tmp_path / "a.dxf")
    text = 'linear_extrude(1) import("a.dxf", $fn = {});'
    assert csg.loads(text.format(4), folder=tmp_path).volume == pytest.approx(12)
    with pytest.raises(b.FormatError, match="this drawing") as caught:
        csg.loads(text.format(sides), folder=tmp_path)
    assert caught.value.code == "too_large"


def test_extrusions_that_name_their_drawing(tmp_path: Path) -> None:
    ezdxf = pytest.importorskip("ezdxf")
    document = ezdxf.new()
    document.modelspace().add_lwpolyline([(1, 0), (3, 0), (3, 2)], close=True)
    document.saveas(tmp_path / "a.dxf")
    upright = 'linear_extrude(file = "a.dxf", origin = [1, 0], height = 3, scale = [0, 0]);'
    assert csg.loads(upright, folder=tmp_path).volume == 2
    turned = csg.loads('rotate_extrude(file = "a.dxf", $fn = 4);', folder=tmp_path)
    assert turned == csg.loads('rotate_extrude($fn = 4) import("a.dxf");', folder=tmp_path)


# Surfaces of pictures


def picture(path: Path, pixels: Any, dtype: Any = np.uint8) -> Path:
    image = pytest.importorskip("PIL.Image")
    image.fromarray(np.array(pixels, dtype=dtype)).save(path)
    return path


# Found: `surface()` took no pictures.
@pytest.mark.parametrize(
    ("pixels", "dtype", "heights"),
    [
        ([[0, 51], [102, 255]], np.uint8, [[40, 100], [0, 20]]),
        # Of 16 bits the upper half counts.
        ([[0, 51 * 256 + 255], [102 * 256, 65535]], np.uint16, [[40, 100], [0, 20]]),
        ([[[255, 0, 0], [0, 255, 0]], [[0, 0, 255], [255, 255, 255]]], np.uint8,
         [[7.22, 100], [21.26, 71.52]]),
        # However opaque.
        ([[[0, 0, 0, 9], [51, 51, 51, 0]], [[102, 102, 102, 1], [255] * 4]], np.uint8,
         [[40, 100], [0, 20]]),
    ],
)  # fmt: skip
def test_pictures_are_tables_of_heights(
    tmp_path: Path, pixels: Any, dtype: Any, heights: list[list[float]]
) -> None:
    path = picture(tmp_path / "a.png", pixels, dtype)
    assert b.surface(path) == b.surface(np.round(heights, 9))
    assert csg.loads('surface("a.png");', folder=tmp_path) == b.surface(path)
    turned = csg.loads('surface("a.png", invert = true);', folder=tmp_path)
    assert turned == b.surface(100 / 255 - np.array(heights))


def test_pictures_that_are_none_are_refused(tmp_path: Path) -> None:
    with pytest.raises(b.FormatError, match="two rows and two columns of pixels"):
        b.surface(picture(tmp_path / "a.png", [[1, 2, 3]]))
    with pytest.raises(b.LimitError, match="This surface"):
        b.surface(picture(tmp_path / "b.png", np.zeros((1500, 1500))))


# Found: `import` of an SVG with `dpi = 0` ended in a `ZeroDivisionError`, and its `id` and
# `layer` did nothing in silence.
@pytest.mark.parametrize("argument", ["dpi = 0", "dpi = -9", 'id = "a"', 'layer = "a"'])
def test_what_does_not_count_for_a_drawing_is_told(tmp_path: Path, argument: str) -> None:
    pytest.importorskip("svgelements")
    (tmp_path / "x.svg").write_text(DRAWING.format('<rect id="b" width="72" height="72"/>'))
    plain = csg.evaluate(csg.parse('import("x.svg", layer = "");', folder=tmp_path))
    with pytest.warns(csg.CsgWarning, match=argument.partition(" ")[0]):
        told = csg.evaluate(csg.parse(f'import("x.svg", {argument});', folder=tmp_path))
    assert isinstance(told, Region) and told == plain
