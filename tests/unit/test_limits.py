"""Too large or damaged input is refused early, with a clear message."""

import io
import time
import tracemalloc
import zipfile
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

import bspcsg as b
from bspcsg import csg
from bspcsg.bsp import Intervals, Region, load_dxf, load_svg
from bspcsg.formats.registry import MAKERS, Format
from bspcsg.io import decoded

HUGE = 10**5000


# Found: absurd numbers of segments filled memory or never ended.
@pytest.mark.parametrize(
    "make",
    [
        lambda: b.cylinder(1, 1, segments=10**10),
        lambda: b.cylinder(1, 1, segments=HUGE),
        lambda: b.sphere(1, segments=10**5),
        lambda: b.sphere(1, segments=1 << 16),
        lambda: b.torus(3, 1, segments=1 << 16, tube_segments=1 << 16),
        lambda: b.prism(10**9, 1, 1),
        lambda: b.revolve([(1, 0), (2, 0), (2, 1)], segments=10**9),
        lambda: Region.circle(1, 10**9),
        lambda: b.Solid([(0, 0, 0)], [(0, 0, 0)], pitch=HUGE),
    ],
)
def test_absurd_numbers_are_refused_at_once(make: Callable[[], Any]) -> None:
    begun = time.perf_counter()
    with pytest.raises(b.LimitError) as caught:
        make()
    assert caught.value.code in ("too_many", "too_large") and len(str(caught.value)) < 200
    assert time.perf_counter() - begun < 5


# Found: solids or sets too far apart in size for one lattice ended in an `InternalError` or a
# bare `OverflowError`.
@pytest.mark.parametrize(
    "make",
    [
        lambda: (b.cube(1e25) | b.cube(3)).volume,
        lambda: Region.rectangle(1e25, 1e25) | Region.rectangle(1, 1),
        lambda: Region.compose([Region.rectangle(1e25, 1e25), Region.rectangle(1, 1)]),
        lambda: Intervals([(0, 1e25)]) - Intervals([(0, 1)]),
    ],
)
def test_what_fits_no_common_lattice_is_refused(make: Callable[[], Any]) -> None:
    with pytest.raises(
        b.LimitError, match=r"lattice of 2\^53 steps|beyond the 2\^53 steps"
    ) as caught:
        make()
    assert caught.value.code == "too_large"


def test_nothing_and_everything_fit_any_lattice() -> None:
    solid, region = b.cube(1e25), Region.rectangle(1e25, 1e25)
    nothing = solid & solid.translate(2e25, 0, 0)
    assert nothing.is_empty
    assert nothing | b.cube(1) == ~nothing & b.cube(1) == b.cube(1)
    assert (region & region.translate(2e25, 0) | Region.rectangle(1, 1)).area == 1


@pytest.mark.parametrize("make", [b.cube, lambda huge: b.cube(1).translate(huge, 0, 0)])
def test_numbers_of_thousands_of_digits_are_refused(make: Callable[[int], Any]) -> None:
    with pytest.raises(b.InvalidMeshError) as caught:
        make(HUGE)
    assert len(str(caught.value)) < 200


@pytest.mark.parametrize(
    "text",
    [
        "cylinder($fn = 1e10);",
        "sphere($fn = 1e5);",
        "sphere($fn = 1e99);",
        "circle($fn = 1e9);",
        "rotate_extrude($fn = 1e9) square(1);",
        "rotate_extrude(angle = 1e-9, $fn = 1e9) square(1);",
        "linear_extrude(1, twist = 1e9, slices = 1e9) square(1);",
        "offset(r = 1, $fn = 1e9) square(1);",
    ],
)
def test_absurd_numbers_in_scripts_are_refused_at_once(text: str) -> None:
    with pytest.raises(b.FormatError, match=r"<csg>:1:1: .* would (have|take) more than") as caught:
        csg.loads(text)
    assert caught.value.code == "too_large"


def packed(parts: dict[str, bytes]) -> bytes:
    file = io.BytesIO()
    with zipfile.ZipFile(file, "w", zipfile.ZIP_DEFLATED) as archive:
        for name, data in parts.items():
            archive.writestr(name, data)
    return file.getvalue()


def bomb(size: int) -> bytes:
    return packed({"3D/3dmodel.model": b"<model>" + b" " * size + b"</model>"})


def refused(data: bytes) -> b.FormatError:
    with pytest.raises(b.FormatError) as caught:
        decoded("x.3mf", data, ".3mf")
    assert caught.value.code == "too_large"
    return caught.value


# Found: small archives unpacked to gigabytes.
def test_archives_that_grow_too_much_are_refused_unread() -> None:
    data = bomb(1 << 27)
    tracemalloc.start()
    assert "unpacks to too much data" in str(refused(data))
    _, most = tracemalloc.get_traced_memory()
    tracemalloc.stop()
    assert most < 1 << 23


def test_archives_that_lie_about_their_size_are_stopped() -> None:
    data = bytearray(packed({"3D/3dmodel.model": b"<model>" + b" " * (1 << 27) + b"</model>"}))
    promised = ((1 << 27) + 15).to_bytes(4, "little")
    assert data.count(promised) >= 2
    honest = bytes(data)
    with pytest.raises(b.FormatError):
        decoded("x.3mf", honest.replace(promised, (1 << 20).to_bytes(4, "little")), ".3mf")


def test_many_small_parts_count_together() -> None:
    part = b"<model>" + b" " * (1 << 24) + b"<resources/></model>"
    names = [f"3D/{k}.model" for k in range(6)]
    items = "".join(f'<item objectid="1" path="/{name}"/>' for name in names)
    inner = part.replace(b"<resources/>", b'<resources><object id="1"><mesh/></object></resources>')
    root = f"<model><build>{items}</build></model>".encode()
    data = packed({"3D/3dmodel.model": root} | dict.fromkeys(names, inner))
    assert "unpacks to too much data" in str(refused(data))


def test_archives_of_too_many_parts_are_refused() -> None:
    data = packed({f"a{k}": b"" for k in range((1 << 14) + 1)})
    assert "more than 16,384 parts" in str(refused(data))


# Found: encodings that nobody knows were a `LookupError`.
@pytest.mark.parametrize("encoding", ["utf-99", "gb18030", "hex", "idna", "undefined", "utf-7"])
def test_encodings_that_nobody_knows_are_format_errors(tmp_path: Path, encoding: str) -> None:
    head = f'<?xml version="1.0" encoding="{encoding}"?>'.encode()
    with pytest.raises(b.FormatError) as caught:
        decoded("x.3mf", packed({"3D/3dmodel.model": head + b"<model/>"}), ".3mf")
    assert "x.3mf" in str(caught.value) and caught.value.code in ("syntax", "truncated")
    pytest.importorskip("svgelements")
    (tmp_path / "x.svg").write_bytes(head + b'<svg xmlns="http://www.w3.org/2000/svg"/>')
    with pytest.raises(b.FormatError):
        load_svg(tmp_path / "x.svg")


@pytest.mark.parametrize(
    "error",
    [
        LookupError("no codec"),
        RecursionError("too deep"),
        MemoryError("8 EiB"),
        OverflowError("too large"),
        UnicodeDecodeError("utf-8", b"\xff", 0, 1, "bad"),
        AttributeError("no such thing"),
        ZeroDivisionError(),
    ],
)
def test_whatever_a_parser_raises_names_the_file_and_keeps_its_cause(
    monkeypatch: pytest.MonkeyPatch, error: Exception
) -> None:
    def fails(source: object) -> Any:
        raise error

    monkeypatch.setitem(MAKERS, ".off", lambda: Format(fails))
    with pytest.raises(b.FormatError, match=r"part.off: .* as OFF \(") as caught:
        decoded("part.off", b"OFF", ".off")
    assert caught.value.code == "malformed" and caught.value.__cause__ is error
    assert type(error).__name__ in str(caught.value)


def test_interrupts_and_our_own_errors_pass(monkeypatch: pytest.MonkeyPatch) -> None:
    for error in (KeyboardInterrupt(), b.LimitError("full", "too_large")):

        def fails(source: object, error: BaseException = error) -> Any:
            raise error

        monkeypatch.setitem(MAKERS, ".off", lambda: Format(fails))
        with pytest.raises(type(error)) as caught:
            decoded("part.off", b"OFF", ".off")
        assert caught.value is error


@pytest.mark.parametrize("box", ["a b c d", "1 1 1 1e", "0 0 nan nan"])
def test_drawings_with_a_damaged_page_are_format_errors(tmp_path: Path, box: str) -> None:
    pytest.importorskip("svgelements")
    text = f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="{box}"><rect width="1"/></svg>'
    (tmp_path / "x.svg").write_text(text)
    try:
        csg.evaluate(csg.parse('import("x.svg");', folder=tmp_path))
    except b.BspcsgError as error:
        assert "x.svg" in str(error) or "import()" in str(error)


@pytest.mark.parametrize("load", [load_svg, load_dxf])
def test_drawings_beyond_all_measure_are_not_read(
    tmp_path: Path, load: Callable[[Path], Region]
) -> None:
    with (tmp_path / "x").open("wb") as file:
        file.truncate((1 << 28) + 1)
    with pytest.raises(b.FormatError, match="larger than") as caught:
        load(tmp_path / "x")
    assert caught.value.code == "too_large"
