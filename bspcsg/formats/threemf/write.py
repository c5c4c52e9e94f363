"""Writing of 3MF: one object for each named part, in millimetres, every coordinate as its double.

A package is a ZIP archive of XML files, so the standard library is enough. The build items of a
mesh have no transforms: slicers disagree on whether a unit applies to them.
"""

import io
import itertools
import re
import zipfile
from collections.abc import Iterable, Iterator, Mapping, Sequence
from xml.sax.saxutils import quoteattr

import numpy as np

from ..._types import FloatArray, IndexArray
from ...attributes.attributes import Attributes, Values
from ...attributes.colours import hexadecimal
from ...attributes.material import Material
from ...errors import Finding
from ...mesh.mesh import Mesh
from ..blocks import listed
from ..raw import RawMesh, compacted, empty_set, parts_of, represents_empty_set
from ..storable_attributes import attributes_or_none
from .textures import PackedPicture, Resources, content_types, relations

_CORE = "http://schemas.microsoft.com/3dmanufacturing/core/2015/02"
_MATERIALS = "http://schemas.microsoft.com/3dmanufacturing/material/2015/02"
_MODEL = "http://schemas.microsoft.com/3dmanufacturing/2013/01/3dmodel"
_HEAD = '<?xml version="1.0" encoding="UTF-8"?>\n'

_TYPES = (
    _HEAD + '<Types xmlns="http://schemas.openxmlformats.org/package/2006/content-types">'
    '<Default Extension="rels"'
    ' ContentType="application/vnd.openxmlformats-package.relationships+xml"/>'
    '<Default Extension="model"'
    ' ContentType="application/vnd.ms-package.3dmanufacturing-3dmodel+xml"/>'
)
_RELATIONS = (
    _HEAD + '<Relationships xmlns="http://schemas.openxmlformats.org/package/2006/relationships">'
)
_ROOT = f'<Relationship Id="rel0" Target="/3D/3dmodel.model" Type="{_MODEL}"/>'
_END = "</Relationships>\n"

#: The date of all files in the archive, so that equal meshes give equal bytes.
_EPOCH = (1980, 1, 1, 0, 0, 0)


def binary(mesh: Mesh | RawMesh) -> Iterator[bytes]:
    """Yield the bytes of a 3MF file; every coordinate reads back as the same double."""
    attributes, resources = attributes_or_none(mesh), Resources(_GROUP)
    for name, one in ({} if attributes is None else attributes.materials).items():
        if one.texture is not None:
            resources.picture(name, one)
    yield packed(_model(mesh, resources), resources.pictures)


def packed(model: Iterator[str], pictures: Sequence[PackedPicture]) -> bytes:
    """Return the bytes of a 3MF package: a model, given as XML lines, and its pictures."""
    stream = io.BytesIO()
    with zipfile.ZipFile(stream, "w", zipfile.ZIP_DEFLATED) as archive:
        for name, text in (
            ("[Content_Types].xml", iter([_TYPES, content_types(pictures), "</Types>\n"])),
            ("_rels/.rels", iter([_RELATIONS, _ROOT, _END])),
            ("3D/3dmodel.model", model),
        ):
            _pack(archive, name, (line.encode() for line in text))
        if pictures:
            lines = [_RELATIONS, *relations(pictures), _END]
            _pack(archive, "3D/_rels/3dmodel.model.rels", (line.encode() for line in lines))
        for picture in pictures:
            _pack(archive, picture.path[1:], iter([picture.data]))
    return stream.getvalue()


def _pack(archive: zipfile.ZipFile, name: str, chunks: Iterator[bytes]) -> None:
    entry = zipfile.ZipInfo(name, _EPOCH)
    entry.compress_type = zipfile.ZIP_DEFLATED
    with archive.open(entry, "w", force_zip64=True) as part:
        part.writelines(chunks)


def losses(mesh: Mesh | RawMesh) -> tuple[Finding, ...]:
    """Return findings about data that 3MF cannot store.

    These are triangles with repeated corners, and colours of materials with a picture.
    """
    found = []
    count = int(_repeats_corner(mesh.faces).sum())
    if count:
        message = (
            f"3MF does not allow triangles with a repeated corner, so {count} triangles were left"
            " out."
        )
        found.append(Finding("degenerate", "warning", message, (), count))
    attributes = attributes_or_none(mesh)
    materials = {} if attributes is None else attributes.materials
    behind = [one for one in materials.values() if one.texture and one.color != Material().color]
    if behind:
        message = (
            f"3MF cannot store a colour together with a texture, so the colours of {len(behind)}"
            " materials were left out."
        )
        found.append(Finding("colors_left_out", "warning", message, (), len(behind)))
    return tuple(found)


def _repeats_corner(faces: IndexArray) -> "np.ndarray[tuple[int], np.dtype[np.bool_]]":
    repeats: np.ndarray[tuple[int], np.dtype[np.bool_]]
    repeats = (faces == np.roll(faces, 1, axis=1)).any(axis=1)
    return repeats


def _model(mesh: Mesh | RawMesh, resources: Resources) -> Iterator[str]:
    attributes = attributes_or_none(mesh)
    yield beginning([] if attributes is None else [attributes])
    if represents_empty_set(mesh):
        yield "<!-- bspcsg: the empty set -->\n"
    yield "<resources>\n"
    count = start = 0
    groups, words = ([], None) if attributes is None else properties(attributes, resources)
    yield from groups
    for name, faces in parts_of(mesh):
        is_proper = ~_repeats_corner(faces)
        proper = faces[is_proper]
        own = None if words is None else words[start : start + len(faces)][is_proper]
        start += len(faces)
        if len(proper):
            count += 1
            yield from _object(count, name, mesh.vertices, proper, own)
    yield "</resources>\n<build>\n"
    yield from (f'<item objectid="{number}"/>\n' for number in range(1, count + 1))
    yield "</build>\n</model>\n"


#: The id of the first group of properties; the ids of objects begin at 1.
_GROUP = 1 << 30


def beginning(attributes: Iterable[Attributes]) -> str:
    """Return the first lines of a model part, with the namespaces that the attributes need."""
    needs_more = any(not {"color", "uv"}.isdisjoint(one.names) for one in attributes)
    more = f' xmlns:m="{_MATERIALS}"' if needs_more else ""
    return f'{_HEAD}<model unit="millimeter" xml:lang="en-US" xmlns="{_CORE}"{more}>\n'


def mesh_object(
    number: int, name: str, mesh: RawMesh, painted: str, words: Values | None
) -> Iterator[str]:
    """Yield the XML of a mesh object, with XML attributes for its properties.

    `painted` has the XML attributes of the object, `words` the XML attributes of each triangle.
    """
    is_proper = ~_repeats_corner(mesh.faces)
    own = None if words is None else words[is_proper]
    lines = _object(number, name, mesh.vertices, mesh.faces[is_proper], own)
    yield next(lines).replace("><mesh>", f"{painted}><mesh>", 1)
    yield from lines


def hex_of(color: Sequence[float]) -> str:
    """Return a colour in the notation of 3MF: upper-case hexadecimal, “#RRGGBBAA” or shorter."""
    return hexadecimal(color).upper()


def properties(attributes: Attributes, resources: Resources) -> tuple[list[str], Values]:
    """Return the XML of property groups, and the property attributes of each triangle's XML."""
    if "material" in attributes.face:
        return _materials(attributes, resources)
    corners = attributes.at_corners("color").reshape(-1, 4)
    colors, numbers = np.unique(corners, axis=0, return_inverse=True)
    lines = [f'<m:color color="#{bytes(color).hex().upper()}"/>\n' for color in colors.tolist()]
    group = resources.free()
    words = _corner_words(group, numbers)
    return [f'<m:colorgroup id="{group}">\n', *lines, "</m:colorgroup>\n"], words


def _materials(attributes: Attributes, resources: Resources) -> tuple[list[str], Values]:
    """Return the XML of base materials and textures, and the attributes of each triangle's XML."""
    names = attributes.face["material"]
    plain = {name: one for name, one in attributes.materials.items() if one.texture is None}
    lines, words = _bases(names, plain, resources)
    for name, material in attributes.materials.items():
        if name in plain:
            continue
        texture, told = resources.texture(resources.picture(name, material))
        group, rows = resources.free(), np.flatnonzero(names == name)
        corners = attributes.at_corners("uv", rows).reshape(-1, 2)
        places, numbers = np.unique(corners, axis=0, return_inverse=True)
        words[rows] = _corner_words(group, numbers)
        lines += [*told, f'<m:texture2dgroup id="{group}" texid="{texture}">\n']
        lines += [f'<m:tex2coord u="{u!r}" v="{v!r}"/>\n' for u, v in places.tolist()]
        lines.append("</m:texture2dgroup>\n")
    return lines, words


def _bases(
    names: Values, plain: Mapping[str, Material], resources: Resources
) -> tuple[list[str], Values]:
    """Return the XML of materials without pictures, and the attributes of each triangle's XML."""
    if not plain:
        return [], np.full(len(names), "", dtype=object)
    group = resources.free()
    lines = [
        f'<base name={quoteattr(stored_name(name))} displaycolor="{hex_of(material.color)}"/>\n'
        for name, material in plain.items()
    ]
    told = {name: f' pid="{group}" p1="{k}"' for k, name in enumerate(plain)}
    words = np.array([told.get(name, "") for name in names.tolist()], dtype=object)
    return [f'<basematerials id="{group}">\n', *lines, "</basematerials>\n"], words


def _corner_words(group: int, numbers: IndexArray) -> Values:
    """Return the attributes of each triangle's XML, given the property index at each corner."""
    words: list[str] = []
    for first, second, third in listed(numbers.reshape(-1, 3)):
        same = first == second == third
        more = "" if same else f' p2="{second}" p3="{third}"'
        words.append(f' pid="{group}" p1="{first}"{more}')
    return np.array(words, dtype=object)


def _object(
    number: int, name: str, vertices: FloatArray, faces: IndexArray, words: Values | None = None
) -> Iterator[str]:
    used, corners = compacted(faces)
    named = f" name={quoteattr(stored_name(name))}" if name else ""
    yield f'<object id="{number}" type="model"{named}><mesh><vertices>\n'
    for point in listed(vertices[used]):
        yield '<vertex x="{!r}" y="{!r}" z="{!r}"/>\n'.format(*point)
    yield "</vertices><triangles>\n"
    told = itertools.repeat("") if words is None else listed(words)
    for face, properties in zip(listed(corners), told, strict=False):
        yield '<triangle v1="{}" v2="{}" v3="{}"{}/>\n'.format(*face, properties)
    yield "</triangles></mesh></object>\n"


def stored_name(name: str) -> str:
    """Return a name in which U+FFFD replaces the characters that XML forbids."""
    return _FORBIDDEN.sub("\N{REPLACEMENT CHARACTER}", name)


#: The characters that XML forbids: controls, lone surrogates, U+FFFE and U+FFFF.
_FORBIDDEN = re.compile("[\x00-\x08\x0b\x0c\x0e-\x1f\ud800-\udfff\ufffe\uffff]")


#: The model part of the empty set; the bytes of the archive around it depend on the system.
NOTHING = "".join(_model(empty_set(), Resources(_GROUP))).encode()
