"""Repair of files with several objects: each separately, since objects that touch stay separate."""

from typing import Any

from ..formats.raw import RawMesh, joined
from ..repair.repair import Repair, losses_of, repair
from .object_diagnosis import Examination, ExaminedObject, examine


def repaired(raw: RawMesh, **options: Any) -> Repair:
    """Repair a mesh; if it has several objects, repair each of them separately.

    Parameters
    ----------
    raw : RawMesh
    **options
        The options of `repair`.
    """
    return repaired_objects(examine(raw), **options)


def repaired_objects(whole: Examination, **options: Any) -> Repair:
    """Repair a mesh that was already examined, object by object; objects keep their names."""
    raw = whole.mesh
    if not whole.objects:
        return repair(raw, **options)
    each = [_repaired_object(one, **options) for one in whole.objects]
    mesh = joined([one.mesh for one in each])
    return Repair(
        RawMesh(mesh.vertices, mesh.faces, raw.name, (), mesh.objects, raw.unit),
        {step: reason for one in each for step, reason in one.failed.items()},
        sum(one.turned for one in each),
        sum(one.dropped for one in each),
        tuple(found for found in losses_of(raw) if found.code != "names_left_out"),
    )


def _repaired_object(one: ExaminedObject, **options: Any) -> Repair:
    if all(found.severity == "note" for found in one.diagnosis.findings):
        # The object needs no repair.
        return Repair(RawMesh(one.mesh.vertices, one.mesh.faces, one.name), {}, 0)
    return repair(one.mesh, **options)
