"""`Attributes`: named arrays of the vertices, corners and faces of a mesh."""

from collections.abc import Callable, Container, Mapping
from dataclasses import dataclass, field, replace
from functools import cached_property, partial
from typing import Any, Literal, TypeAlias

import numpy as np
import numpy.typing as npt

from .._types import BoolArray, FloatArray, IndexArray
from ..errors import InvalidMeshError
from ..geometry.arrays import is_masked
from ..parameters import shown
from .colours import COLOR, colors_of, in_bytes
from .material import Material

#: An array with one value, or an array of values, per vertex, corner or face.
Values: TypeAlias = npt.NDArray[Any]

#: The elements of a mesh for which an attribute has values.
Kind: TypeAlias = Literal["vertex", "corner", "face"]

KINDS: tuple[Kind, ...] = ("vertex", "corner", "face")

#: The allowed `dtype.kind` of values: truth values, whole numbers, floats, text.
_TYPES = "biufU"

#: The names of normals, which rotate with the solid and are reversed where it is subtracted.
NORMALS = frozenset({"normal", "normals"})


@dataclass(frozen=True, eq=False)
class Attributes:
    """Named arrays of values for the vertices, corners or faces of a mesh.

    Parameters
    ----------
    faces : (m, 3) int64
        The triangles of the mesh.
    vertex : dict of str to (n, …) array
        The values of each vertex, by name; a name is in only one of the dictionaries.
    corner : dict of str to (m, 3, …) array
        The values of each corner of each face, by name.
    face : dict of str to (m, …) array
        The values of each face, by name.
    materials : dict of str to Material
        The materials that the face attribute ``"material"`` names.
    """

    faces: IndexArray
    vertex: Mapping[str, Values] = field(default_factory=dict)
    corner: Mapping[str, Values] = field(default_factory=dict)
    face: Mapping[str, Values] = field(default_factory=dict)
    materials: Mapping[str, Material] = field(default_factory=dict)

    @property
    def is_empty(self) -> bool:
        """True if there are no attributes of vertices, corners or faces."""
        return not (self.vertex or self.corner or self.face)

    @property
    def names(self) -> tuple[str, ...]:
        """The names of all attributes: first of vertices, then of corners, then of faces."""
        return (*self.vertex, *self.corner, *self.face)

    def of(self, kind: Kind) -> Mapping[str, Values]:
        """Return the arrays of the vertices, the corners or the faces, by name."""
        return {"vertex": self.vertex, "corner": self.corner, "face": self.face}[kind]

    def kind_of(self, name: str) -> Kind | None:
        """Return whether an attribute belongs to vertices, corners or faces; None if unknown."""
        return next((kind for kind in KINDS if name in self.of(kind)), None)

    def at_corners(self, name: str, faces: IndexArray | None = None) -> Values:
        """Return the values of an attribute at the corners of the given or all faces, (k, 3, …)."""
        chosen: Any = slice(None) if faces is None else faces
        values: Values
        if name in self.vertex:
            values = self.vertex[name][self.faces[chosen]]
        elif name in self.corner:
            values = self.corner[name][chosen]
        else:
            values = np.repeat(self.face[name][chosen][:, None], 3, axis=1)
        return values

    def for_faces(self, faces: IndexArray) -> "Attributes":
        """Return the attributes of a part of the faces, in the order of the given face numbers."""
        return replace(
            self,
            faces=self.faces[faces],
            corner={name: values[faces] for name, values in self.corner.items()},
            face={name: values[faces] for name, values in self.face.items()},
        )

    def with_used_materials(self) -> "Attributes":
        """Return the attributes without the materials that no face uses."""
        used = set(np.unique(self.face.get("material", np.array([""]))).tolist())
        kept = {name: one for name, one in self.materials.items() if name in used}
        return replace(self, materials=kept)

    def without(self, names: Container[str]) -> "Attributes":
        """Return the attributes without the arrays of the given names."""
        vertex, corner, face = (
            {name: values for name, values in self.of(kind).items() if name not in names}
            for kind in KINDS
        )
        return replace(self, vertex=vertex, corner=corner, face=face)

    def without_empty_material(self) -> "Attributes":
        """Return the attributes without ``"material"`` if no face has a material."""
        names = self.face.get("material")
        is_empty = names is not None and names.dtype.kind == "U" and not (names != "").any()
        return self.without({"material"}) if is_empty else self

    def turned(self, linear: FloatArray) -> "Attributes":
        """Return the attributes after a linear map of the mesh, which changes normals.

        Normals keep their lengths.
        """
        if not NORMALS.intersection(self.names):
            return self
        vertex, corner, face = (
            {
                name: _rotated_normals(values, linear) if is_normal(name, values) else values
                for name, values in self.of(kind).items()
            }
            for kind in KINDS
        )
        return replace(self, vertex=vertex, corner=corner, face=face)

    def reordered(self, order: list[int]) -> "Attributes":
        """Return the attributes with the corners of every face permuted: corner order[k] as k."""
        corner = {name: values[:, order] for name, values in self.corner.items()}
        return replace(self, faces=self.faces[:, order], corner=corner)

    def onto(self, faces: IndexArray, kept: IndexArray) -> "Attributes":
        """Return the attributes of new triangles, each of which replaces the old face `kept[k]`."""
        corner = {name: self.at_corners(name, kept) for name in (*self.vertex, *self.corner)}
        face = {name: values[kept] for name, values in self.face.items()}
        return Attributes(faces, {}, corner, face, self.materials)

    def among(self, taken: dict[str, Material]) -> "Attributes":
        """Add the materials to `taken`, and return the attributes with their new names.

        A number is appended to a name that another material in `taken` has.
        """
        names = {}
        for name, material in self.materials.items():
            names[name] = _unused_name(name, partial(_means_another, taken, material))
            taken[names[name]] = material
        values = self.face.get("material")
        if values is None or all(old == new for old, new in names.items()):
            return self
        kinds, numbers = np.unique(values, return_inverse=True)
        image = np.array([names.get(kind, kind) for kind in kinds.tolist()])[numbers]
        return replace(self, face={**self.face, "material": image})

    def with_renamed_materials(self, new_name: Callable[[str], str]) -> "Attributes":
        """Return the attributes with renamed materials; equal new names get numbers appended."""
        values = self.face.get("material")
        if values is None:
            return self
        kinds, numbers = np.unique(values, return_inverse=True)
        image = {kind: kind for kind in kinds.tolist() if new_name(kind) == kind}
        if len(image) == len(kinds):
            return self
        taken = set(image)
        for kind in kinds.tolist():
            if kind not in image:
                image[kind] = _unused_name(new_name(kind), taken.__contains__)
                taken.add(image[kind])
        materials = {image[name]: one for name, one in self.materials.items() if name in image}
        told = np.array([image[kind] for kind in kinds.tolist()])[numbers]
        return replace(self, face={**self.face, "material": told}, materials=materials)

    @cached_property
    def patches(self) -> tuple[IndexArray, list[bytes]]:
        """The patches, groups of faces with equal values: a number for each face, and the values.

        The (m,) numbers below the length of the list of values are positions in it. Each face whose
        corners differ is a patch of its own, with a larger number.
        """
        rows, is_even = self._rows()
        count = len(self.faces)
        as_bytes = np.ascontiguousarray(rows).view(f"V{rows.shape[1]}").ravel()
        kept, numbers = np.unique(as_bytes[is_even], return_inverse=True)
        patches = np.zeros(count, dtype=np.int64)
        patches[is_even] = numbers
        patches[~is_even] = len(kept) + np.arange(count - len(numbers))
        signature = repr(self._signature()).encode()
        return patches, [signature + value.tobytes() for value in kept]

    def _rows(self) -> tuple[npt.NDArray[np.uint8], BoolArray]:
        """Return the bytes of all values at corner 0 of each face, and if its corners agree."""
        count = len(self.faces)
        is_even = np.ones(count, dtype=bool)
        rows = [np.zeros((count, 1), dtype=np.uint8)]
        for name in self.names:
            values = _bytes_of(self.at_corners(name), 3 * count)
            corners = values.reshape(count, 3, values.shape[1])
            is_even &= (corners == corners[:, :1]).all(axis=(1, 2))
            rows.append(corners[:, 0])
        return np.concatenate(rows, axis=1), is_even

    def _signature(self) -> list[tuple[str, str, tuple[int, ...]]]:
        arrays = [(name, self.at_corners(name, np.zeros(0, np.int64))) for name in self.names]
        return [(name, array.dtype.str, array.shape[2:]) for name, array in arrays]


def _means_another(taken: Mapping[str, Material], material: Material, name: str) -> bool:
    return taken.get(name, material) != material


def _unused_name(name: str, is_taken: Callable[[str], bool]) -> str:
    """Return a name that is not taken: the given one, with a number appended if necessary."""
    number, free = 1, name
    while is_taken(free):
        number += 1
        free = f"{name} ({number})"
    return free


def _bytes_of(values: Values, count: int) -> npt.NDArray[np.uint8]:
    flat = np.ascontiguousarray(values)
    width = flat.nbytes // count if count else 0
    return np.frombuffer(flat.tobytes(), np.uint8).reshape(count, width)


def is_normal(name: str, values: Values) -> bool:
    """Return True for normals: a name in `NORMALS`, with three floats per element."""
    return name in NORMALS and values.dtype.kind == "f" and values.shape[-1:] == (3,)


def _rotated_normals(values: Values, linear: FloatArray) -> Values:
    """Return normals after a linear map of the mesh, with unchanged lengths.

    They are multiplied by the cofactors of the map.
    """
    a, b, c = np.asarray(linear, dtype=np.float64)
    cofactors = np.array([np.cross(b, c), np.cross(c, a), np.cross(a, b)])
    if np.dot(a, cofactors[0]) < 0:
        cofactors = -cofactors
    if np.abs(linear).sum() == 3 and (np.abs(linear).sum(axis=0) == 1).all():
        # If the map only permutes and mirrors axes, permute the coordinates without rounding.
        axes = np.abs(linear).argmax(axis=1)
        signs = linear[np.arange(3), axes].astype(values.dtype)
        return np.ascontiguousarray(values[..., axes] * signs)
    image = values @ cofactors.T
    with np.errstate(invalid="ignore", divide="ignore"):
        lengths = np.linalg.norm(values, axis=-1, keepdims=True)
        scaled = image * (lengths / np.linalg.norm(image, axis=-1, keepdims=True))
    turned: Values = np.where(lengths > 0, scaled, image).astype(values.dtype)
    return turned


def corners_to_faces(attributes: Attributes, only: str | None = None) -> Attributes:
    """Turn attributes of corners into attributes of faces if the corners of every face agree.

    Parameters
    ----------
    attributes : Attributes
    only : str, optional
        The only attribute to change; by default all are tested.
    """
    even = {}
    for name, values in attributes.corner.items():
        if only not in (None, name):
            continue
        same = values == values[:, :1]
        if values.dtype.kind == "f":
            same |= np.isnan(values) & np.isnan(values[:, :1])
        if same.all():
            even[name] = values[:, 0]
    rest = attributes.without(even)
    return Attributes(
        attributes.faces, rest.vertex, rest.corner, {**rest.face, **even}, attributes.materials
    )


@dataclass(frozen=True, eq=False)
class GivenAttributes:
    """Attributes as a caller gives them: dictionaries of values that numpy can convert."""

    vertex: Mapping[str, Any] | None = None
    corner: Mapping[str, Any] | None = None
    face: Mapping[str, Any] | None = None
    materials: Mapping[str, Material] | None = None

    @property
    def _by_kind(self) -> tuple[Mapping[str, Any] | None, ...]:
        return self.vertex, self.corner, self.face

    def over(self, vertex_count: int, faces: IndexArray) -> Attributes | None:
        """Return the checked attributes of a mesh, or None if there are none.

        Raises
        ------
        InvalidMeshError
            If an array has a wrong length or type, or a name is used twice; code ``"attributes"``.
        """
        tables = [_named(given, kind) for kind, given in zip(KINDS, self._by_kind, strict=True)]
        materials = _materials(self.materials)
        if not any(tables):
            return None
        shapes: dict[Kind, tuple[int, ...]]
        shapes = {"vertex": (vertex_count,), "corner": (len(faces), 3), "face": (len(faces),)}
        found: dict[Kind, dict[str, Values]] = {}
        for kind, arrays in zip(KINDS, tables, strict=True):
            found[kind] = {name: _array(v, name, kind, shapes[kind]) for name, v in arrays}
        names = [name for kind in KINDS for name in found[kind]]
        twice = sorted({name for name in names if names.count(name) > 1})
        if twice:
            raise _attributes_error(
                f"the attribute “{twice[0]}” is given twice, for different ones of vertices,"
                " corners and faces; rename one of them."
            )
        own = faces.copy()
        own.flags.writeable = False
        return Attributes(own, **found, materials=materials)


def _named(given: Mapping[str, Any] | None, kind: Kind) -> list[tuple[str, Any]]:
    if given is None:
        return []
    if not isinstance(given, Mapping):
        raise _attributes_error(
            f"{kind}_attributes must be a dictionary from attribute names to arrays, not"
            f" {shown(given)}."
        )
    for name in given:
        if not isinstance(name, str) or not name:
            raise _attributes_error(
                f"the name of an attribute must be a non-empty string, not {name!r}."
            )
    return list(given.items())


def array_of(values: Any, name: str) -> Values:
    """Return the values of an attribute as a new array.

    Raise `InvalidMeshError` if they are masked or cannot form an array.
    """
    if is_masked(values):
        raise _attributes_error(
            f"the attribute “{name}” is a masked array with masked values; fill them before you"
            " pass it."
        )
    try:
        return np.array(values, order="C")
    except ValueError as error:
        raise _attributes_error(
            f"the values of the attribute “{name}” do not form an array: {error}."
        ) from error


def _array(values: Any, name: str, kind: Kind, shape: tuple[int, ...]) -> Values:
    array = _colors(values, shape) if name == COLOR else array_of(values, name)
    if array.dtype.kind not in _TYPES:
        allowed = "bool, integers, floats and strings"
        raise _attributes_error(
            f"the attribute “{name}” has the unsupported dtype {array.dtype}; supported are"
            f" {allowed}."
        )
    if array.shape[: len(shape)] != shape:
        wanted = ", ".join(map(str, shape))
        raise _attributes_error(
            f"{kind}_attributes[{name!r}] must have shape ({wanted}, …), not {array.shape}."
        )
    array.flags.writeable = False
    return array


def _colors(given: Any, shape: tuple[int, ...]) -> Values:
    """Return the values of the attribute "color", with colours in text or integers converted.

    A single colour is repeated for all elements.
    """
    is_mixed = isinstance(given, (list, tuple)) and any(isinstance(one, str) for one in given)
    array = colors_of(given) if is_mixed else array_of(given, COLOR)
    if array.dtype.kind == "U":
        array = colors_of(array)
    elif array.dtype.kind == "i" and array.shape[-1:] in ((3,), (4,)):
        found = in_bytes(array)
        array = array if found is None else found
    if array.shape in ((3,), (4,)):
        array = np.broadcast_to(array, (*shape, *array.shape))
    return np.array(array, order="C")


def _materials(given: Mapping[str, Material] | None) -> Mapping[str, Material]:
    if given is not None and not isinstance(given, Mapping):
        raise _attributes_error(
            "materials must be a mapping from names to bspcsg.Material objects."
        )
    for name, material in (given or {}).items():
        if not isinstance(material, Material):
            raise _attributes_error(
                f"the material “{name}” must be a bspcsg.Material, not {shown(material)}."
            )
    return dict(given or {})


def _attributes_error(message: str) -> InvalidMeshError:
    return InvalidMeshError(f"Attributes: {message}", "attributes")


class Later:
    """Attributes that are computed when they are first used, and then stored.

    Parameters
    ----------
    make : callable
    """

    def __init__(self, make: Callable[[], Attributes]) -> None:
        self._make: Callable[[], Attributes] | None = make
        self._made: Attributes | None = None

    def now(self) -> Attributes:
        """Return the attributes; compute them if this is the first use."""
        make = self._make
        if make is not None:
            self._made, self._make = make(), None
        if self._made is None:  # made by another thread, between the two lines above
            return self.now()
        return self._made

    def __reduce__(self) -> tuple[Any, tuple[Attributes]]:
        """Return what pickle needs: the computed attributes."""
        return made, (self.now(),)


def made(attributes: Attributes) -> Later:
    """Return a `Later` of attributes that are already computed."""
    later = Later(lambda: attributes)
    later.now()
    return later
