"""Regions as DXF drawings: `load_dxf` reads closed outlines, `save_dxf` writes polylines."""

import io
import os
import threading
from collections.abc import Iterable, Iterator
from contextlib import contextmanager
from functools import partial
from typing import Any

import numpy as np

from ..._types import FloatArray, Scalar, WindingRule
from ...errors import FormatError, format_errors, invalid_parameter, message_of
from ...formats.atomic import write_file
from ...formats.source import limited_content
from ...parameters import file_path, instance_of, positive, shown
from ..sets.region import Region
from .dxf_curves import chains_of
from .dxf_layouts import layout_with_content
from .dxf_markers import module_of_ezdxf, with_markers
from .unread_content import UnreadContent


def load_dxf(
    path: str | os.PathLike[str],
    *,
    tolerance: Scalar = 0.01,
    layers: Iterable[str] | None = None,
    winding: WindingRule = "even-odd",
    pitch: int | None = None,
) -> Region:
    """Return the region that the closed outlines in the model space of a DXF file enclose.

    Lines, arcs, circles, ellipses, splines and polylines are read, also those of inserted blocks.
    Open curves are joined if their ends lie within a millionth of the drawing's extent. If the
    model space is empty, the paper space is read.

    Parameters
    ----------
    path : path
    tolerance : float
        Largest distance between a curve and the chords that replace it, in drawing units.
    layers : iterable of str, optional
        The layers to read, regardless of case; all by default.
    winding : {"even-odd", "nonzero", "positive"}
        By default an outline inside another is a hole, for any orientation.
    pitch : int, optional

    Raises
    ------
    FormatError
        If the file cannot be read, is no DXF, lacks one of the layers (`code`
        ``"unknown_name"``), or an outline is open or branches (``"not_closed"``). Binary DXF is
        refused (``"unsupported"``).

    Warns
    -----
    DrawingWarning
        Names the kinds of skipped entities, such as hatches and text, and reports an empty region.
    """
    chord = positive(tolerance, "tolerance")
    names = None if layers is None else _names(layers)
    document = read_document(path)
    with format_errors(os.fspath(path), "DXF"):
        wanted = None if names is None else _known_layers(names, document, os.fspath(path))
        lost = UnreadContent()
        is_wanted = partial(_is_among, wanted)
        layout = layout_with_content(document, is_wanted, lost)
        chains = list(chains_of(layout, is_wanted, chord, lost))
    region = Region(
        lost.surrounding(_closed(chains, os.fspath(path))), winding=winding, pitch=pitch
    )
    lost.warn(path, region)
    return region


def _names(layers: Any) -> set[str]:
    try:
        names = set(layers)
    except TypeError as error:
        raise invalid_parameter(
            f"layers must be a list of layer names, not {shown(layers)}."
        ) from error
    if isinstance(layers, (str, bytes)) or not all(isinstance(name, str) for name in names):
        raise invalid_parameter(f"layers must be a list of layer names, not {shown(layers)}.")
    return names


def _known_layers(names: set[str], document: Any, file: str) -> set[str]:
    """Return layer names in lower case, since DXF ignores case, or raise an error for unknown ones.

    A layer need not be declared: an entity on it suffices.
    """
    declared = [layer.dxf.name for layer in document.layers]
    entities = document.chain_layouts_and_blocks()
    used = [entity.dxf.layer for entity in entities if entity.dxf.hasattr("layer")]
    there = {name.casefold(): name for name in [*used, *declared]}
    unknown = sorted(name for name in names if name.casefold() not in there)
    if unknown:
        known = ", ".join(map(shown, sorted(there.values())))
        message = f"{file}: the drawing has no layer {shown(unknown[0])}; its layers are {known}."
        raise FormatError(message, "unknown_name")
    return {name.casefold() for name in names}


def _is_among(layers: set[str] | None, layer: str) -> bool:
    return layers is None or layer.casefold() in layers


def save_dxf(region: Region, path: str | os.PathLike[str]) -> None:
    """Write the outlines of a bounded region as closed polylines on layer 0.

    Coordinates read back as the same doubles.

    Raises
    ------
    UnboundedError
        If the region reaches to infinity.
    FormatError
        If the file cannot be written.
    """
    write_file(path, [dxf_data(region)])


def dxf_data(region: Region) -> bytes:
    """Return the bytes of the DXF file that `save_dxf` writes for a region."""
    ezdxf = module_of_ezdxf()
    outlines = instance_of(Region, region, "region").to_polygons()
    text = io.StringIO()
    with _reproducible_output(ezdxf.options):
        document = ezdxf.new("R2010")
        for points in outlines:
            document.modelspace().add_lwpolyline(points.tolist(), close=True)
        # ezdxf orders them as a set does, which differs between processes.
        for name in sorted(document.entitydb.dxf_types_in_use()):
            document.classes.add_class(name)
        document.write(text)
    data: bytes = text.getvalue().encode(document.output_encoding, errors="dxfreplace")
    return data


#: Locked while the options of ezdxf, which all threads share, are changed.
_OPTIONS_LOCK = threading.Lock()


@contextmanager
def _reproducible_output(options: Any) -> Iterator[None]:
    """Make ezdxf write no time and no random number within a ``with`` block.

    So the output is reproducible.
    """
    with _OPTIONS_LOCK:
        before = options.write_fixed_meta_data_for_testing
        options.write_fixed_meta_data_for_testing = True
        try:
            yield
        finally:
            options.write_fixed_meta_data_for_testing = before


#: The first bytes of binary DXF files.
_BINARY = b"AutoCAD Binary DXF"

_TEXT_OF_BINARY = (
    "{}: binary DXF files cannot be read; save it as a text DXF first, for example in Python"
    ' with ezdxf.readfile("in.dxf").saveas("out.dxf").'
)


def read_document(path: str | os.PathLike[str]) -> Any:
    """Return the ezdxf document of a DXF file, or raise a `FormatError` if it cannot be read."""
    ezdxf = module_of_ezdxf()
    name = file_path(path)
    data = limited_content(name)
    if data.startswith(_BINARY):
        raise FormatError(_TEXT_OF_BINARY.format(name), "unsupported")
    try:
        text = _decoded(data.replace(b"\r\n", b"\n"))
        return ezdxf.document.Drawing.load(with_markers(io.StringIO(text)))
    except Exception as error:  # ezdxf raises errors of any type on damaged files
        raise FormatError(
            f"{name}: the file is not a valid DXF drawing: {message_of(error)}.", "syntax"
        ) from error


def _decoded(data: bytes) -> str:
    """Return the text of a DXF file, decoded by the code page that it names, by default UTF-8."""
    text = data.decode("utf-8", errors="surrogateescape")
    if "$DWGCODEPAGE" not in text:
        return text
    management = module_of_ezdxf("ezdxf.filemanagement")
    # From R2007 on files are UTF-8 for any code page; ezdxf's function handles this.
    encoding = management.dxf_stream_info(io.StringIO(text)).encoding
    return data.decode(encoding, errors="surrogateescape")


def _closed(chains: list[FloatArray], name: str) -> list[FloatArray]:
    """Return closed loops: the closed chains, and open chains joined at equal ends."""
    loops = [chain[:-1] for chain in chains if (chain[0] == chain[-1]).all()]
    rest = [chain for chain in chains if (chain[0] != chain[-1]).any()]
    if rest:
        ends = np.array([(chain[0], chain[-1]) for chain in rest])
        size = float(np.ptp(np.concatenate(chains), axis=0).max())
        loops += _joined(rest, _end_groups(ends, size), name)
    return loops


#: Ends of chains are joined up to this distance, as a fraction of the drawing's extent.
_MAX_GAP = 1e-6


def _end_groups(ends: FloatArray, size: float) -> Any:
    """Return a group number for each end of chains, (n, 2); ends with one number are joined.

    `ends` is (n, 2, 2); `size` is the extent of the drawing.
    """
    flat = ends.reshape(-1, 2) + 0.0
    _, places = np.unique(flat, axis=0, return_inverse=True)
    places = places.ravel()
    # Compare only ends without an equal one, since a chain may be shorter than a step.
    loose = np.flatnonzero(np.bincount(places)[places] == 1)
    step = max(size * _MAX_GAP, np.finfo(np.float64).tiny)
    places[loose] = len(flat) + _near_groups(flat[loose], step)
    return places.reshape(-1, 2)


def _near_groups(points: FloatArray, step: float) -> Any:
    """Return a group number for each point; points at most `step` apart in x and y share it."""
    numbers = np.arange(len(points))
    # Two such points share a cell in at least one of these four grids.
    for shift in ((0, 0), (0, 1), (1, 0), (1, 1)):
        cells = np.floor((points / step + shift) / 2)
        _, cell = np.unique(cells, axis=0, return_inverse=True)
        numbers = _merged_groups(numbers, cell.ravel())
    return numbers


def _merged_groups(first: Any, second: Any) -> Any:
    """Return group numbers for points, equal if the points share a group in either list.

    Groups are joined transitively.
    """
    numbers = first
    while True:
        before = numbers
        for classes in (first, second):
            least = np.full(len(numbers), len(numbers))
            np.minimum.at(least, classes, numbers)
            numbers = least[classes]
        if np.array_equal(numbers, before):
            return numbers


def _joined(chains: list[FloatArray], places: Any, name: str) -> list[FloatArray]:
    at: dict[int, list[int]] = {}
    for chain, pair in enumerate(places.tolist()):
        for place in pair:
            at.setdefault(place, []).append(chain)
    for place, found in at.items():
        if len(found) != 2:
            x, y = chains[found[0]][0 if places[found[0]][0] == place else -1]
            what = "open" if len(found) == 1 else "branching"
            raise FormatError(
                f"{name}: the outline of the region is not closed, for it is {what} at ({x:g},"
                f" {y:g}); exactly two lines must meet there.",
                "not_closed",
            )
    loops, left = [], set(range(len(chains)))
    while left:
        loops.append(_joined_loop(chains, places, at, left))
    return loops


def _joined_loop(
    chains: list[FloatArray], places: Any, at: dict[int, list[int]], left: set[int]
) -> FloatArray:
    """Return the loop that starts with the first chain in `left` and follows chains end to end.

    Removes its chains from `left`.
    """
    chain = min(left)
    start = place = int(places[chain][0])
    parts = []
    while True:
        left.discard(chain)
        forward = places[chain][0] == place
        parts.append(chains[chain][:-1] if forward else chains[chain][:0:-1])
        place = int(places[chain][1 if forward else 0])
        following = [other for other in at[place] if other in left]
        if place == start or not following:
            return np.concatenate(parts)
        chain = following[0]
