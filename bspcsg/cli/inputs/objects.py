"""Names of objects in the results of set operations.

A result is one set of points; it is written as connected parts. Each part is named after the
objects of the input files from which its surface comes.
"""

from collections.abc import Sequence
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from ...errors import Finding
    from ...formats.raw import RawMesh
    from ...mesh.mesh import Mesh
    from ...solid.solid import Solid

#: The text between the names of objects that form one part, and the largest number of such names.
_NAME_SEPARATOR, _MAX_NAMES_SHOWN = " + ", 3


class ObjectNames:
    """A record of the objects to which the triangles of input meshes belong."""

    def __init__(self) -> None:
        #: For the number of an input mesh: the names of its objects, and each object's end among
        #: the triangles.
        self._known: dict[int, tuple[list[str], list[int]]] = {}
        self._has_names = False

    def note(self, solid: "Solid", raw: "RawMesh", stem: str) -> None:
        """Record the objects of a file that was read as a solid; unnamed ones are called `stem`."""
        import numpy as np

        names = [name or stem for name, _ in raw.objects] or [stem]
        counts = [count for _, count in raw.objects] or [len(raw.faces)]
        self._has_names |= any(name for name, _ in raw.objects)
        for source in solid.sources:
            self._known[source] = (names, np.cumsum(counts).tolist())

    def parted(
        self, result: "Solid", cutters: "Sequence[Solid]", in_single: bool
    ) -> "tuple[RawMesh, tuple[Finding, ...]] | None":
        """Return the mesh of a result as named parts, and findings about single precision.

        Parameters
        ----------
        result : Solid
        cutters : sequence of Solid
            The subtracted solids; the names of their objects are not used.
        in_single : bool
            True to round the parts to single precision.

        Returns
        -------
        tuple of RawMesh and findings, or None
            None if no part of the result comes from a named object.
        """
        from ...formats.raw import joined
        from ...operations.parts import connected_parts

        if not self._has_names:
            return None
        silent = {source for solid in cutters for source in solid.sources}
        sources = result.normalized().sources
        parts = connected_parts(result)
        names = [self._name(part, sources, silent) for part in parts]
        if not any(names):
            return None
        settled = [_in_single_precision(part) if in_single else (part, ()) for part in parts]
        meshes = [_raw(part, name) for (part, _), name in zip(settled, names, strict=True)]
        return joined(meshes), tuple(finding for _, found in settled for finding in found)

    def _name(self, part: "Mesh", sources: Sequence[int], silent: set[int]) -> str:
        import numpy as np

        found: dict[str, None] = {}
        for slot in np.unique(part.source[:, 0]).tolist():
            names, ends = self._known.get(sources[slot], ([], []))
            if names and sources[slot] not in silent:
                faces = part.source[part.source[:, 0] == slot, 1]
                rows = np.unique(np.searchsorted(ends, faces, side="right")).tolist()
                found |= dict.fromkeys(names[min(row, len(names) - 1)] for row in rows)
        shown = list(found)[:_MAX_NAMES_SHOWN]
        more = [f"{len(found) - _MAX_NAMES_SHOWN} more"] if len(found) > _MAX_NAMES_SHOWN else []
        return _NAME_SEPARATOR.join([*shown, *more])


def _raw(part: "Mesh", name: str) -> "RawMesh":
    from ...formats.raw import RawMesh

    said = None if part.carried is None else part.attributes
    return RawMesh(part.vertices, part.faces, name, attributes=said)


def _in_single_precision(part: "Mesh") -> "tuple[Mesh, tuple[Finding, ...]]":
    from ...formats.single_precision import in_single_precision

    try:
        return in_single_precision(part)
    except OverflowError:  # the writer raises an error that names the file
        return part, ()
