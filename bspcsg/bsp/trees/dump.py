"""Partition trees as text: JSON for storage, DOT and SVG for display."""

import json
import zlib
from typing import TYPE_CHECKING, Any, TypeAlias

import numpy as np

from ..._core import FragmentTree
from ..._types import FloatArray, IndexArray
from ...errors import BspcsgError, FormatError, LimitError, core_errors, invalid_parameter
from ...parameters import at_least, shown

if TYPE_CHECKING:
    from .tree import PartitionTree

#: The arguments of `PartitionTree.from_core` for a stored tree: core object, whether non-planar
#: facets are triangulated and degenerate ones dropped, and margin in model units.
TreeParts: TypeAlias = tuple[FragmentTree, tuple[bool, bool], float]

_FORMAT = "bspcsg partition tree"
_VERSION = 3
#: The version without hyperplanes given by the caller; trees that have none are still written in
#: it.
_VERSION_WITHOUT_HYPERPLANES = 2
#: The version without a checksum.
_VERSION_WITHOUT_CHECKSUM = 1


def to_json(tree: "PartitionTree") -> str:
    """Return a tree as JSON text: facets as lattice integers, cuts in preorder, a checksum."""
    corners, offsets = tree.core.lattice()
    content = {
        "format": _FORMAT,
        "version": _VERSION if tree.own_hyperplanes else _VERSION_WITHOUT_HYPERPLANES,
        "dimension": tree.dimension,
        "pitch": tree.pitch,
        "non_planar": "triangulate" if tree.lenience[0] else "error",
        "degenerate": "drop" if tree.lenience[1] else "error",
        "margin": tree.margin,
        "corners": corners.tolist(),
        "offsets": offsets.tolist(),
        "cuts": tree.arrays["cut"].tolist(),
    }
    if tree.own_hyperplanes:
        # As strings, since some JSON readers limit the size of integers.
        content["own"] = [[str(entry) for entry in row] for row in tree.own_hyperplanes]
    return _text(content | {"checksum": _checksum(content)})


def parsed(text: str) -> TreeParts:
    """Return the arguments of `PartitionTree.from_core` from the text that `to_json` wrote."""
    try:
        content = json.loads(text)
        known = content["format"] == _FORMAT and content["version"] in (
            _VERSION_WITHOUT_CHECKSUM,
            _VERSION_WITHOUT_HYPERPLANES,
            _VERSION,
        )
    except (ValueError, TypeError, KeyError) as error:
        raise FormatError(
            "The text is not a stored partition tree: it is no JSON, or lacks format and version.",
            "bad_snapshot",
        ) from error
    if not known:
        message = (
            f"The stored tree has the format {content['format']!r} in version"
            f" {content.get('version')!r}, but only {_FORMAT!r} up to version {_VERSION} is read."
        )
        raise FormatError(message, "bad_snapshot")
    checksum = content.pop("checksum", None)
    if content["version"] != _VERSION_WITHOUT_CHECKSUM and checksum != _checksum(content):
        message = (
            "The stored tree was changed or damaged after it was written: its checksum does not"
            " match."
        )
        raise FormatError(message, "bad_snapshot")
    try:
        return _rebuilt(content)
    except BspcsgError as error:
        raise FormatError(str(error), "bad_snapshot", error.where) from error
    except (ValueError, TypeError, KeyError, OverflowError) as error:
        message = f"The stored tree is incomplete or damaged ({error})."
        raise FormatError(message, "bad_snapshot") from error


def _text(content: dict[str, Any]) -> str:
    return json.dumps(content, separators=(",", ":"))


def _checksum(content: dict[str, Any]) -> int:
    """Return the CRC-32 of a stored tree's content; whitespace and key order do not affect it."""
    return zlib.crc32(json.dumps(content, separators=(",", ":"), sort_keys=True).encode())


def _rebuilt(content: dict[str, Any]) -> TreeParts:
    lenience = content["non_planar"] == "triangulate", content["degenerate"] == "drop"
    own = content["own"] if content["version"] == _VERSION else ()
    with core_errors():
        core = FragmentTree.rebuild(
            _whole(content["corners"], int(content["dimension"])),
            _whole(content["offsets"], 0),
            int(content["pitch"]),
            _whole(content["cuts"], 2),
            lenience,
            [[int(entry) for entry in row] for row in own],
        )
    return core, lenience, float(content["margin"])


def _whole(values: Any, columns: int) -> IndexArray:
    """Return integers as an int64 array: (n, columns), or of the given shape if `columns` is 0."""
    array = np.asarray(values if len(values) else np.zeros(0, dtype=np.int64))
    if array.dtype.kind != "i":
        raise ValueError("an array has numbers that are not integers")
    integers = np.ascontiguousarray(array, dtype=np.int64)
    if not columns:
        return integers
    rows = integers if integers.size else integers.reshape(0, columns)
    if rows.ndim != 2 or rows.shape[1] != columns:
        raise ValueError(f"an array has rows that do not have {columns} numbers each")
    return rows


def to_dot(tree: "PartitionTree") -> str:
    """Return the tree as text in Graphviz's DOT language: minus edges solid, plus edges dashed."""
    arrays = tree.arrays
    lines = ["digraph partition_tree {", '  node [shape=box, fontname="sans-serif"];']
    sources = tree.fragments.source
    for index in range(len(tree)):
        held = sources[arrays["start"][index] : arrays["end"][index]].tolist()
        label = "free cut" if not held else " ".join(map(str, held))
        lines.append(f'  n{index} [label="{label}"];')
        for side, style in (("minus", "solid"), ("plus", "dashed")):
            child = int(arrays[side][index])  # type: ignore[literal-required]
            name = f"n{child}" if child >= 0 else f"{side}{index}"
            if child < 0:
                lines.append(f"  {name} [shape=point];")
            lines.append(f"  n{index} -> {name} [style={style}];")
    return "\n".join([*lines, "}", ""])


#: The largest width of a picture in pixels, at which doubles still have three decimals.
_MAX_WIDTH_PIXELS = 1 << 20


def to_svg(tree: "PartitionTree", size: int = 480) -> str:
    """Return a picture of a 2D tree as SVG text, `size` pixels wide."""
    if tree.dimension != 2:
        raise invalid_parameter(
            "Only trees of dimension 2 can be drawn as SVG, and this tree has dimension"
            f" {tree.dimension}."
        )
    width = at_least(1, size, "size")
    if width > _MAX_WIDTH_PIXELS:
        raise LimitError(
            f"size must be at most {_MAX_WIDTH_PIXELS} pixels, not {shown(size)}.", "too_large"
        )
    outline = np.asarray(tree.region())
    low, high = outline.min(axis=0), outline.max(axis=0)
    scale = width / float(high[0] - low[0])
    height = scale * float(high[1] - low[1])

    def line(ends: FloatArray, style: str) -> str:
        (x1, y1), (x2, y2) = (ends - low) * scale
        return (
            f'<line x1="{x1:.3f}" y1="{height - y1:.3f}" x2="{x2:.3f}" y2="{height - y2:.3f}"'
            f" {style}/>"
        )

    spans = [node.span for node in tree.nodes]
    cuts = [line(span, 'stroke="#bbb"') for span in spans if len(span)]
    pieces = [line(piece, 'stroke="#000" stroke-width="2"') for piece in tree.fragments]
    head = (
        f'<svg xmlns="http://www.w3.org/2000/svg" width="{width}" height="{height:.0f}"'
        f' viewBox="0 0 {width} {height:.3f}">'
    )
    frame = f'<rect width="{width}" height="{height:.3f}" fill="#fff" stroke="#bbb"/>'
    return "\n".join([head, frame, *cuts, *pieces, "</svg>", ""])
