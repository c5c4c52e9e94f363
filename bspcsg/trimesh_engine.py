"""A boolean engine for trimesh in double precision.

trimesh itself rounds vertices to single precision before it calls manifold3d. One line makes
existing scripts exact::

    import bspcsg.trimesh_engine

    bspcsg.trimesh_engine.register(default=True)

trimesh has no public hook for engines: `register` writes into its table of engines.
"""

from collections.abc import Iterable
from typing import TYPE_CHECKING, Any

from .errors import MissingPartError, invalid_parameter
from .operations.setops import OPERATIONS
from .solid.ledger import uncounted
from .solid.solid import Solid
from .suggestions import suggestion_text

if TYPE_CHECKING:
    import trimesh

#: The name of this engine in trimesh.
NAME = "bspcsg"

#: The operations that trimesh supports.
_KNOWN = ("difference", "intersection", "union")


def register(default: bool = False) -> None:
    """Register ``engine="bspcsg"`` in trimesh; further calls change nothing.

    Parameters
    ----------
    default : bool
        True to use this engine for operations that name no engine.

    Raises
    ------
    MissingPartError
        If this version of trimesh has no known table of engines; code ``"missing_part"``.

    Examples
    --------
    >>> import trimesh
    >>> from bspcsg import trimesh_engine
    >>> trimesh_engine.register()
    >>> a = trimesh.creation.box((2, 2, 2))
    >>> float(a.difference(trimesh.creation.box((1, 1, 4)), engine="bspcsg").volume)
    6.0
    """
    import trimesh.boolean

    engines = getattr(trimesh.boolean, "_engines", None)
    available = getattr(trimesh.boolean, "engines_available", None)
    if not isinstance(engines, dict) or not isinstance(available, set):
        message = (
            f"trimesh {trimesh.__version__} has no registry of boolean engines, so bspcsg"
            " cannot be registered. Try: pip install 'trimesh>=5,<6'"
        )
        raise MissingPartError(message, "missing_part")
    engines[NAME] = boolean
    available.add(NAME)
    if default:
        engines[None] = boolean


@uncounted
def boolean(
    meshes: "Iterable[trimesh.Trimesh]",
    operation: str,
    check_volume: bool = True,
    **options: Any,
) -> "trimesh.Trimesh":
    """Combine meshes by a set operation, with the signature of trimesh's engines.

    Parameters
    ----------
    meshes : iterable of trimesh.Trimesh
        The operands, or any other objects that `Solid.from_mesh` takes.
    operation : {"difference", "intersection", "union"}
        The operation; a difference subtracts all other meshes from the first.
    check_volume : bool
        True to refuse meshes whose ``is_volume`` is false: open, inconsistently oriented or inside
        out. With False, meshes must still be closed.
    **options
        The options of `Solid`: ``pitch``, ``trusted``, ``winding``; they do not apply to operands
        of type `Solid`.

    Returns
    -------
    trimesh.Trimesh
        The result, with float64 vertices and the attributes of the operands, such as their colours
        (see `Solid.to_trimesh`); it may be empty.

    Raises
    ------
    InvalidMeshError
        If a mesh is refused, the operation is unknown, or a difference has fewer than two meshes.
        It is also a ValueError.
    """
    given: list[Any] = list(meshes)
    if operation not in _KNOWN:
        known = ", ".join(_KNOWN)
        message = f"Unknown operation {operation!r}; known are {known}."
        raise invalid_parameter(message + suggestion_text(operation, _KNOWN))
    if operation == "difference" and len(given) < 2:
        raise invalid_parameter("A difference needs at least two meshes.")
    if check_volume:
        _refuse_surfaces(given)
    solids = [
        mesh if isinstance(mesh, Solid) else Solid.from_mesh(mesh, **options) for mesh in given
    ]
    return OPERATIONS[operation](*solids).to_trimesh()


def _refuse_surfaces(meshes: list[Any]) -> None:
    """Raise an error if `is_volume` of a mesh is false; accept objects without `is_volume`."""
    bad = [number for number, mesh in enumerate(meshes) if not getattr(mesh, "is_volume", True)]
    if bad:
        which = ", ".join(map(str, bad))
        raise invalid_parameter(
            "These meshes (counted from 0) are open, inconsistently oriented or inside out:"
            f" {which}. If they are closed, check_volume=False allows them."
        )
