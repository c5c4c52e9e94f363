"""Insert subclass markers into DXF entities, which some programs omit.

Without these markers ezdxf refuses some kinds of entities, and so the whole file.

# Source
DXF reference, "Subclass Markers": group 100 before the values of each class of an entity.
"""

from collections.abc import Iterator
from typing import Any, TextIO

from ...mesh.interop import import_optional

#: The kinds of entities whose values ezdxf expects after a second marker of any name.
_MARKED = frozenset(
    [
        *("LWPOLYLINE", "SPLINE", "HELIX", "HATCH", "MPOLYGON", "MTEXT", "MESH", "LEADER"),
        *("MULTILEADER", "MLEADER", "IMAGE", "WIPEOUT", "REGION", "3DSOLID", "BODY", "SURFACE"),
        *("PDFUNDERLAY", "DWFUNDERLAY", "DGNUNDERLAY"),
    ]
)

_MARKER, _NAME, _VARIABLE = 100, 0, 9

#: The group codes before the first marker (handles, reactors, owners) and between both markers.
_FIRST = frozenset([5, 102, 330, 360])
_COMMON = frozenset([6, 8, 48, 60, 62, 67, 284, 347, 348, 370, 380, 390, 410, 420, 430, 440])

#: The last version of DXF without markers, assumed for files without a version; and the first group
#: code of extended data.
_PLAIN = "AC1009"
_FIRST_OF_OTHERS = 1000


def module_of_ezdxf(name: str = "ezdxf") -> Any:
    """Return a module of ezdxf, an optional dependency, or raise an error if it is missing."""
    return import_optional(name, '"bspcsg[dxf]"')


def with_markers(stream: TextIO) -> Iterator[Any]:
    """Yield the tags of a DXF file for ezdxf, with missing subclass markers added."""
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
            yield from _with_both_markers(entity, types.DXFTag, version)
            entity = []
        if entity or (tag.code == _NAME and tag.value in _MARKED):
            entity.append(tag)
        else:
            yield tag
    yield from _with_both_markers(entity, types.DXFTag, version)


def _with_both_markers(entity: list[Any], tag: Any, version: str) -> list[Any]:
    """Return an entity's tags with both subclass markers; the first tag names the entity's kind."""
    has_markers = any(one.code == _MARKER for one in entity)
    if not entity or (has_markers and version != _PLAIN):
        return entity
    own = [one for one in entity[1:] if one.code not in _FIRST | _COMMON | {_MARKER}]
    first = [one for one in entity[1:] if one.code in _FIRST]
    common = [one for one in entity[1:] if one.code in _COMMON]
    markers = tag(_MARKER, "AcDbEntity"), tag(_MARKER, f"AcDb{entity[0].value.title()}")
    if version == _PLAIN:
        # In this version ezdxf expects points after the markers, all other tags before them.
        common += [one for one in own if one.code < _FIRST_OF_OTHERS]
        return [entity[0], *first, *common, *markers, *own]
    return [entity[0], *first, markers[0], *common, markers[1], *own]
