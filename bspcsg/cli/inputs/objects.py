"""Names of objects in the results of set operations: the rest of an object keeps its name.

A result is one set of points, which a file divides into connected parts. Each part is named after
the objects that its surface comes from.
"""

from collections.abc import Sequence
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from ...errors import Finding
    from ...formats.raw import RawMesh
    from ...mesh.mesh import Mesh
    from ...solid.solid import Solid

#: What separates the names of objects that became one part, and the largest number of names that
#: are shown.
_NAME_SEPARATOR, _MAX_NAMES_SHOWN = " + ", 3


class ObjectNames:
    """The objects that the triangles of input meshes belong to."""

    def __init__(self) -> None:
        #: By the identity of a mesh: names, and the first triangle behind each object.
        self._known: dict[int, tuple[list[str], list[int]]] = {}
        self._has_names = False

    def note(self, solid: "Solid", raw: "RawMesh", stem: str) -> None:
        """Remember the objects of a file that became a solid; an unnamed one is called `stem`."""
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
            The subtracted solids, whose objects give no names.
        in_single : bool
            True to round the parts to single precision.

        Returns
        -------
        tuple of RawMesh and findings, or None
            None if no named object of the files is left.
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
        settled = [_settled(part) if in_single else (part, ()) for part in parts]
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


def _settled(part: "Mesh") -> "tuple[Mesh, tuple[Finding, ...]]":
    from ...formats.single import settled

    try:
        return settled(part)
    except OverflowError:  # which the writer refuses with the name of the file
        return part, ()
