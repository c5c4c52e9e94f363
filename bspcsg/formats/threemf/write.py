"""3MF, writing: one object per named part, in millimetres, every coordinate's double kept.

A package is a ZIP archive of three XML parts, so the standard library is enough. Transforms are
never written: slicers disagree on whether a unit applies to them.
"""

import io
import re
import zipfile
from collections.abc import Iterator
from xml.sax.saxutils import quoteattr

import numpy as np

from ..._types import FloatArray, IndexArray
from ...errors import Finding
from ...mesh.mesh import Mesh
from ..raw import RawMesh, compacted, empty_set, parts_of, says_empty_set

_CORE = "http://schemas.microsoft.com/3dmanufacturing/core/2015/02"
_MODEL = "http://schemas.microsoft.com/3dmanufacturing/2013/01/3dmodel"
_HEAD = '<?xml version="1.0" encoding="UTF-8"?>\n'

_TYPES = (
    _HEAD + '<Types xmlns="http://schemas.openxmlformats.org/package/2006/content-types">'
    '<Default Extension="rels"'
    ' ContentType="application/vnd.openxmlformats-package.relationships+xml"/>'
    '<Default Extension="model"'
    ' ContentType="application/vnd.ms-package.3dmanufacturing-3dmodel+xml"/></Types>\n'
)
_RELATIONS = (
    _HEAD + '<Relationships xmlns="http://schemas.openxmlformats.org/package/2006/relationships">'
    f'<Relationship Id="rel0" Target="/3D/3dmodel.model" Type="{_MODEL}"/></Relationships>\n'
)

#: The same bytes for the same mesh, whenever it is written.
_EPOCH = (1980, 1, 1, 0, 0, 0)


def binary(mesh: Mesh | RawMesh) -> Iterator[bytes]:
    """Yield the package; every coordinate reads back as the same double."""
    packed = io.BytesIO()
    with zipfile.ZipFile(packed, "w", zipfile.ZIP_DEFLATED) as archive:
        for name, text in (
            ("[Content_Types].xml", iter([_TYPES])),
            ("_rels/.rels", iter([_RELATIONS])),
            ("3D/3dmodel.model", _model(mesh)),
        ):
            entry = zipfile.ZipInfo(name, _EPOCH)
            entry.compress_type = zipfile.ZIP_DEFLATED
            with archive.open(entry, "w", force_zip64=True) as part:
                part.writelines(line.encode() for line in text)
    yield packed.getvalue()


def losses(mesh: Mesh | RawMesh) -> tuple[Finding, ...]:
    """Return what the format has no room for: triangles that name a vertex twice."""
    count = int(_repeats_corner(mesh.faces).sum())
    if not count:
        return ()
    message = f"3MF has no triangles with a repeated corner; {count} of them were left out."
    return (Finding("degenerate", "warning", message, (), count),)


def _repeats_corner(faces: IndexArray) -> "np.ndarray[tuple[int], np.dtype[np.bool_]]":
    repeats: np.ndarray[tuple[int], np.dtype[np.bool_]]
    repeats = (faces == np.roll(faces, 1, axis=1)).any(axis=1)
    return repeats


def _model(mesh: Mesh | RawMesh) -> Iterator[str]:
    yield f'{_HEAD}<model unit="millimeter" xml:lang="en-US" xmlns="{_CORE}">\n'
    if says_empty_set(mesh):
        yield "<!-- bspcsg: the empty set -->\n"
    yield "<resources>\n"
    count = 0
    for name, faces in parts_of(mesh):
        proper = faces[~_repeats_corner(faces)]
        if len(proper):
            count += 1
            yield from _object(count, name, mesh.vertices, proper)
    yield "</resources>\n<build>\n"
    yield from (f'<item objectid="{number}"/>\n' for number in range(1, count + 1))
    yield "</build>\n</model>\n"


def _object(number: int, name: str, vertices: FloatArray, faces: IndexArray) -> Iterator[str]:
    used, corners = compacted(faces)
    named = f" name={quoteattr(called(name))}" if name else ""
    yield f'<object id="{number}" type="model"{named}><mesh><vertices>\n'
    for point in vertices[used].tolist():
        yield '<vertex x="{!r}" y="{!r}" z="{!r}"/>\n'.format(*point)
    yield "</vertices><triangles>\n"
    for face in corners.tolist():
        yield '<triangle v1="{}" v2="{}" v3="{}"/>\n'.format(*face)
    yield "</triangles></mesh></object>\n"


def called(name: str) -> str:
    """Return a name with a replacement for the characters that XML forbids."""
    return _FORBIDDEN.sub("\N{REPLACEMENT CHARACTER}", name)


#: Control characters, lone surrogates, and the two that are no characters.
_FORBIDDEN = re.compile("[\x00-\x08\x0b\x0c\x0e-\x1f\ud800-\udfff\ufffe\uffff]")


#: The model part of the empty set; the archives around it differ by system.
NOTHING = "".join(_model(empty_set())).encode()
