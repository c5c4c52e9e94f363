"""Insertion of missing subclass markers into DXF entities, which simple programs omit.

Without them, ezdxf refuses some kinds of entities, and with these the whole file.

# Source
DXF reference, "Subclass Markers": group 100 before the values of each class of an entity.
"""

from collections.abc import Iterator
from typing import Any, TextIO

from ...mesh.interop import optional

#: Entities of which ezdxf looks for the values behind a second marker, whatever that is called.
_MARKED = frozenset(
    [
        *("LWPOLYLINE", "SPLINE", "HELIX", "HATCH", "MPOLYGON", "MTEXT", "MESH", "LEADER"),
        *("MULTILEADER", "MLEADER", "IMAGE", "WIPEOUT", "REGION", "3DSOLID", "BODY", "SURFACE"),
        *("PDFUNDERLAY", "DWFUNDERLAY", "DGNUNDERLAY"),
    ]
)

_MARKER, _NAME, _VARIABLE = 100, 0, 9

#: Groups before the first marker (handles, reactors and owners), and between the two.
_FIRST = frozenset([5, 102, 330, 360])
_COMMON = frozenset([6, 8, 48, 60, 62, 67, 284, 347, 348, 370, 380, 390, 410, 420, 430, 440])

#: The last version without markers, which files without a version have; groups that others add.
_PLAIN = "AC1009"
_FIRST_OF_OTHERS = 1000


def module_of_ezdxf(name: str = "ezdxf") -> Any:
    """Import a module of ezdxf, an optional dependency."""
    return optional(name, '"bspcsg[dxf]"')


def with_markers(stream: TextIO) -> Iterator[Any]:
    """Yield the tags of a file for ezdxf, with the markers that entities lack."""
    types = module_of_ezdxf("ezdxf.lldxf.types")
    lines = module_of_ezdxf("ezdxf.lldxf.tagger").ascii_tags_loader(stream)
    version, variable = _PLAIN, ""
    entity: list[Any] = []
    for tag in lines:
        if tag.code == _VARIABLE:
            variable = tag.value
        elif variable == "$ACADVER":
            version, variable = tag.value, ""
        if tag.code == _NAME:
            yield from _marked(entity, types.DXFTag, version)
            entity = []
        if entity or (tag.code == _NAME and tag.value in _MARKED):
            entity.append(tag)
        else:
            yield tag
    yield from _marked(entity, types.DXFTag, version)


def _marked(entity: list[Any], tag: Any, version: str) -> list[Any]:
    """Return the tags of an entity with both markers; the first tag names the entity."""
    has_markers = any(one.code == _MARKER for one in entity)
    if not entity or (has_markers and version != _PLAIN):
        return entity
    own = [one for one in entity[1:] if one.code not in _FIRST | _COMMON | {_MARKER}]
    first = [one for one in entity[1:] if one.code in _FIRST]
    common = [one for one in entity[1:] if one.code in _COMMON]
    markers = tag(_MARKER, "AcDbEntity"), tag(_MARKER, f"AcDb{entity[0].value.title()}")
    if version == _PLAIN:
        # There ezdxf expects points after the markers, and all other tags before them.
        common += [one for one in own if one.code < _FIRST_OF_OTHERS]
        return [entity[0], *first, *common, *markers, *own]
    return [entity[0], *first, markers[0], *common, markers[1], *own]
