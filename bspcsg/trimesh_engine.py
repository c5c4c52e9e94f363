"""A boolean engine of trimesh, which keeps double precision.

trimesh itself rounds vertices to single precision before it calls manifold3d. One line makes
existing scripts exact::

    import bspcsg.trimesh_engine

    bspcsg.trimesh_engine.register(default=True)

trimesh has no public hook for engines: `register` writes into its table of engines.
"""

from collections.abc import Iterable
from typing import TYPE_CHECKING, Any

from .errors import MissingPartError, invalid_parameter
from .meant import question
from .operations.setops import OPERATIONS
from .solid.counting import uncounted
from .solid.solid import Solid

if TYPE_CHECKING:
    import trimesh

#: The name by which trimesh calls this engine.
NAME = "bspcsg"

#: The operations that trimesh can ask for.
_KNOWN = ("difference", "intersection", "union")


def register(default: bool = False) -> None:
    """Make ``engine="bspcsg"`` known to trimesh; calling it again changes nothing.

    Parameters
    ----------
    default : bool
        True to use this engine where an operation names none.

    Raises
    ------
    MissingPartError
        If this version of trimesh keeps its engines elsewhere; code ``"missing_part"``.

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
    """Combine meshes, with the signature of trimesh's engines.

    Parameters
    ----------
    meshes : iterable of trimesh.Trimesh
        Or anything else that `Solid.from_mesh` takes.
    operation : {"difference", "intersection", "union"}
        A difference subtracts all others from the first.
    check_volume : bool
        Refuse meshes whose ``is_volume`` is false: open, inconsistent or inside out. Without it,
        meshes still have to be closed.
    **options
        As for `Solid`: ``pitch``, ``trusted``, ``winding``; they apply to meshes, not to a `Solid`
        among them.

    Returns
    -------
    trimesh.Trimesh
        With float64 vertices and the attributes of the operands, such as their colours (see
        `Solid.to_trimesh`); empty if nothing is left.

    Raises
    ------
    InvalidMeshError
        A ValueError, if a mesh is refused, the operation is another, or a difference is asked of
        fewer than two meshes.
    """
    given: list[Any] = list(meshes)
    if operation not in _KNOWN:
        known = ", ".join(_KNOWN)
        message = f"Unknown operation {operation!r}; known are {known}."
        raise invalid_parameter(message + question(operation, _KNOWN))
    if operation == "difference" and len(given) < 2:
        raise invalid_parameter("A difference needs at least two meshes.")
    if check_volume:
        _refuse_surfaces(given)
    solids = [
        mesh if isinstance(mesh, Solid) else Solid.from_mesh(mesh, **options) for mesh in given
    ]
    return OPERATIONS[operation](*solids).to_trimesh()


def _refuse_surfaces(meshes: list[Any]) -> None:
    """Refuse meshes that are not volumes for trimesh; objects of other types pass."""
    bad = [number for number, mesh in enumerate(meshes) if not getattr(mesh, "is_volume", True)]
    if bad:
        which = ", ".join(map(str, bad))
        raise invalid_parameter(
            "These meshes (counted from 0) are open, inconsistently oriented or inside out:"
            f" {which}. If they are closed, check_volume=False allows them."
        )
