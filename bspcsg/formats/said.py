"""The attributes in files besides the shape: those that a format keeps, and those it leaves out."""

from collections.abc import Callable
from dataclasses import replace

from ..attributes.attributes import KINDS, Attributes, Kind, Values
from ..errors import Finding
from ..mesh.mesh import Mesh
from .raw import RawMesh


def said_of(mesh: Mesh | RawMesh) -> Attributes | None:
    """Return the attributes of a mesh, or None if it has none or no triangles."""
    has_none = isinstance(mesh, Mesh) and mesh.carried is None
    said = None if has_none or not len(mesh.faces) else mesh.attributes
    return None if said is None or said.is_empty else said


def saying(mesh: Mesh | RawMesh, attributes: Attributes | None) -> RawMesh:
    """Return a mesh with other attributes."""
    if isinstance(mesh, RawMesh):
        return replace(mesh, attributes=attributes)
    return RawMesh(mesh.vertices, mesh.faces, attributes=attributes)


def chosen(said: Attributes, keep: Callable[[Kind, str, Values], Values | None]) -> Attributes:
    """Return the attributes of which something is kept, as it is kept."""
    vertex, corner, face = (
        {
            name: values
            for name, given in said.of(kind).items()
            if (values := keep(kind, name, given)) is not None
        }
        for kind in KINDS
    )
    names = face.get("material")
    materials = said.materials if names is not None and names.dtype.kind == "U" else {}
    return Attributes(said.faces, vertex, corner, face, materials)


def left_out(said: Attributes, kept: Attributes | None, suffix: str) -> tuple[Finding, ...]:
    """Return the finding about attributes that a file does not hold, if there are any."""
    held = () if kept is None else kept.names
    lost = [name for name in said.names if name not in held]
    if not lost:
        return ()
    told = ", ".join(f"“{name}” of {_PLURAL[said.kind_of(name) or 'face']}" for name in lost)
    message = f"{suffix[1:].upper()} has no room for attributes: {told} were left out."
    return (Finding("attributes_left_out", "warning", message, (), len(lost)),)


_PLURAL: dict[Kind, str] = {"vertex": "vertices", "corner": "corners", "face": "faces"}
