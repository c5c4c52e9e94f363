"""The table of mesh formats by suffix; the modules of a format are imported on first use."""

from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass
from functools import partial
from typing import TypeAlias

from .._types import FloatArray
from ..attributes.attributes import Attributes
from ..errors import Finding
from ..mesh.mesh import Mesh
from .raw import RawMesh
from .source import Source
from .verification import NameInFile, ObjectReader

Encoder: TypeAlias = Callable[[Mesh | RawMesh], Iterator[bytes]]
Keeper: TypeAlias = Callable[[Attributes, FloatArray], Attributes]
Companions: TypeAlias = Callable[[RawMesh, str], tuple[bytes, dict[str, bytes]]]
LossFinder: TypeAlias = Callable[[Mesh | RawMesh], tuple[Finding, ...]]
Limit: TypeAlias = Callable[[Mesh | RawMesh], str]


@dataclass(frozen=True)
class Form:
    """The text or the binary form of a format: functions that write a file and check it.

    Parameters
    ----------
    encode : callable
        Yields the bytes of a file.
    scan : callable
        Returns the objects of a written file, to check it.
    name_in_file : callable, optional
        Returns the name that a file has for an object; None if files have no separate objects.
    losses : callable, optional
        Returns the findings about losses; raises OverflowError if a number is too large.
    repeats : bool
        True if the form can store triangles that name a vertex twice.
    is_single : bool
        True if the form stores single precision only.
    storable : callable, optional
        Returns the attributes that the form can store, as they read back; None if it stores none.
    size_problem : callable, optional
        Returns why a mesh is too large for the form, or an empty string if it fits.
    companion_files : callable, optional
        Takes the mesh and the stem of the file; returns the beginning of the file, which names its
        companion files, and these files.
    needs_vertices : bool
        True if the reader refuses files without vertices, except for the empty set.
    """

    encode: Encoder
    scan: ObjectReader
    name_in_file: NameInFile | None = None
    losses: LossFinder | None = None
    repeats: bool = True
    is_single: bool = False
    storable: Keeper | None = None
    size_problem: Limit | None = None
    companion_files: Companions | None = None
    needs_vertices: bool = False


@dataclass(frozen=True)
class Format:
    """A mesh format: the function that reads it, and the forms in which it is written.

    Parameters
    ----------
    read : callable
    text, binary : Form, optional
    unit : str
        ``"mm"`` if files state their unit, and are read and written in millimetres.
    up : {"z", "y"}
        The axis that is up in files; meshes in memory have z up.
    """

    read: Callable[[Source], RawMesh]
    text: Form | None = None
    binary: Form | None = None
    unit: str = ""
    up: str = "z"


def _stl() -> Format:
    from . import stl
    from .readback import stl_obj_off_ply

    return Format(
        stl.read,
        Form(stl.text, stl_obj_off_ply.text_stl, stl.stored_name),
        Form(stl.binary, stl_obj_off_ply.binary_stl, losses=stl.losses, is_single=True),
    )


def _obj() -> Format:
    from . import obj
    from .readback import stl_obj_off_ply

    text = Form(
        obj.text,
        stl_obj_off_ply.obj,
        obj.stored_name,
        storable=lambda attributes, _: obj.storable(attributes),
        companion_files=obj.companion_files,
        needs_vertices=True,
    )
    return Format(obj.read, text)


def _ply() -> Format:
    from .ply import columns, file
    from .readback import stl_obj_off_ply

    return Format(
        file.read,
        Form(
            file.text,
            stl_obj_off_ply.text_ply,
            storable=lambda attributes, _: columns.storable(attributes),
        ),
        Form(
            file.binary,
            stl_obj_off_ply.binary_ply,
            storable=lambda attributes, _: columns.storable(attributes),
            size_problem=file.size_problem,
        ),
    )


def _off() -> Format:
    from . import off
    from .readback import stl_obj_off_ply

    return Format(
        off.read,
        Form(
            off.text,
            stl_obj_off_ply.off,
            storable=lambda attributes, _: off.storable(attributes),
        ),
    )


def _threemf() -> Format:
    from .readback import threemf
    from .threemf import file, properties, write

    binary = Form(
        write.binary,
        threemf.archive,
        write.stored_name,
        write.losses,
        repeats=False,
        storable=lambda attributes, _: properties.storable(attributes),
    )
    return Format(file.read, None, binary, "mm")


def _glb() -> Format:
    from .glb import attribute_conversion, file
    from .readback import glb

    binary = Form(
        file.binary,
        glb.objects,
        attribute_conversion.stored_name,
        file.losses,
        is_single=True,
        storable=attribute_conversion.storable,
        size_problem=file.size_problem,
    )
    return Format(file.read, None, binary, "mm", "y")


def _vtk(suffix: str) -> Format:
    from . import vtk
    from .readback.vtk import legacy, xml

    scan = legacy if suffix == ".vtk" else xml
    return Format(vtk.reader(suffix), None, Form(vtk.writer(suffix), scan))


#: The function that makes the `Format` of each suffix.
MAKERS: dict[str, Callable[[], Format]] = {
    ".stl": _stl,
    ".obj": _obj,
    ".ply": _ply,
    ".off": _off,
    ".3mf": _threemf,
    ".glb": _glb,
    ".vtk": partial(_vtk, ".vtk"),
    ".vtu": partial(_vtk, ".vtu"),
}


class _Formats(Mapping[str, Format]):
    """A mapping from suffix to `Format`, which is made when it is looked up."""

    def __getitem__(self, suffix: str) -> Format:
        return MAKERS[suffix]()

    def __iter__(self) -> Iterator[str]:
        return iter(MAKERS)

    def __len__(self) -> int:
        return len(MAKERS)

    def __contains__(self, suffix: object) -> bool:
        return suffix in MAKERS


FORMATS: Mapping[str, Format] = _Formats()
"""The mesh formats by suffix, such as ``".stl"``; a mapping."""
