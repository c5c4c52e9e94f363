"""Measurements with bounds: each function returns the violations and the measured figures."""

import gc
import time
from collections import Counter
from collections.abc import Callable
from pathlib import Path
from statistics import median
from tempfile import TemporaryDirectory
from typing import BinaryIO, TypeAlias
from unittest.mock import patch

import numpy as np

import bspcsg as b
from bspcsg.formats import atomic
from bspcsg.formats.atomic import write_file
from bspcsg.formats.files import Encoded, decoded, encoded, read, write
from bspcsg.formats.registry import FORMATS

from .degenerate import scene
from .probes import Failure

#: What went wrong, and figures by their names.
Measured: TypeAlias = tuple[list[Failure], dict[str, float]]

#: The largest share of the time of writing or reading that a proof may take.
MAX_PROOF_SHARE = 0.15

#: The smallest number of triangles of a file whose share counts. Smaller files are written in a few
#: milliseconds, most of which do not depend on triangles.
MIN_TRIANGLES_TIMED = 300_000

#: The codes of findings that tell of a crossing, in doubles and in single precision.
SAID = frozenset({"crossing", "turned", "collapsed"})
SAID_IN_SINGLE = frozenset({"crossing_in_single"})

#: The codes of findings that name vertices in one place.
CONTACTS = frozenset({"edge_contact", "vertex_contact", "rounded_contact", "given_contact"})

#: The largest share of meshes that may cross even if a finding reports it.
MAX_REPORTED_SHARE = 0.01


def crossings(rounds: int) -> Measured:
    """Count the scenes of nearly coincident parts whose meshes cross themselves.

    Both the delivered mesh and the triangles of a binary STL file, joined at equal coordinates, are
    tested. A failure is a crossing without a finding, too many crossings, or vertices with equal
    coordinates without a finding.
    """
    failed, counts = [], Counter[str]()
    for seed in range(rounds):
        try:
            solid = scene(seed).normalized()
            mesh = solid.to_mesh()
        except (b.InvalidMeshError, b.LimitError):
            continue
        if len(mesh.faces) == 0:
            continue
        made = encoded(mesh, "scene.stl", ".stl")
        raw = decoded("scene.stl", b"".join(made.chunks), ".stl")
        stored = b.Mesh(raw.vertices, raw.faces, mesh.source)
        counts["meshes"] += 1
        if _touches(mesh) and not CONTACTS & {finding.code for finding in solid.findings}:
            failed.append(Failure(seed, "vertices in one place that nothing tells of"))
        for place, told, one, codes in (
            ("in doubles", solid.findings, mesh, SAID),
            ("in a binary STL", made.findings, stored, SAID_IN_SINGLE),
        ):
            crosses = bool(one.certificate.crossings or one.certificate.flat)
            is_said = bool(codes & {finding.code for finding in told})
            counts[f"{place}, said"] += crosses and is_said
            counts[f"{place}, silent"] += crosses and not is_said
            if crosses and not is_said:
                failed.append(Failure(seed, f"a crossing {place} that nothing tells of"))
    for what, count in counts.items():
        if what.endswith("said") and count > MAX_REPORTED_SHARE * counts["meshes"]:
            failed.append(Failure(rounds, f"{count} meshes of {counts['meshes']} cross {what}"))
    return failed, dict(counts)


def _touches(mesh: "b.Mesh") -> bool:
    return len(np.unique(mesh.vertices, axis=0)) < len(mesh.vertices)


def shares_of_proofs(triangles: int, turns: int = 5) -> Measured:
    """Return the fraction of the time of writing a file that proofs take, by format.

    The time is wall-clock time until the file is on the disk.
    """
    mesh = b.sphere(1, segments=round(triangles**0.5)).rotate((10, 20, 30)).to_mesh()
    failed, figures = [], {}
    with TemporaryDirectory() as folder:
        for suffix, known in FORMATS.items():
            for text in (True, False):
                if (known.text if text else known.binary) is None:
                    continue
                path = Path(folder) / f"ball{suffix}"
                share = _share(mesh, path, text, turns)
                name = f"{suffix[1:]}{' as text' if text and known.binary else ''}"
                figures[name] = round(share, 3)
                if share > MAX_PROOF_SHARE and triangles >= MIN_TRIANGLES_TIMED:
                    failed.append(Failure(triangles, f"{name}: {share:.1%}"))
                path.unlink()
    return failed, figures


def _share(mesh: "b.Mesh", path: Path, text: bool, turns: int) -> float:
    """Return the median fraction of the time of writing a file that its proof takes.

    The proof runs while the file is written, so both times are measured separately.
    """
    shares = []
    for _ in range(turns):
        gc.collect()
        began, spent = time.perf_counter(), 0.0
        made = encoded(mesh, path, path.suffix, text)

        def prove(file: BinaryIO, made: Encoded = made) -> None:
            nonlocal spent
            start, _Watched.writing = time.perf_counter(), 0.0
            made.prove(file)
            spent = time.perf_counter() - start - _Watched.writing

        with patch.object(atomic, "_Growing", _Watched):
            write_file(path, made.chunks, prove)
        shares.append(spent / (time.perf_counter() - began))
    return median(shares)


class _Watched(atomic._LazyFile):
    """A file that is written while it is read back, with the time spent on writing."""

    writing = 0.0

    def _watched(self, write: Callable[[], None]) -> None:
        began = time.perf_counter()
        super()._watched(write)
        _Watched.writing += time.perf_counter() - began


def shares_of_checks(triangles: int, turns: int = 15) -> Measured:
    """Return the fraction of the time from a binary file to its volume that checks take.

    The checks are those that `trusted` omits: the proof that faces meet only in edges and vertices.
    """
    mesh = b.sphere(1, segments=round(triangles**0.5)).rotate((10, 20, 30)).to_mesh()
    failed, figures = [], {}
    with TemporaryDirectory() as folder:
        for suffix in (suffix for suffix, known in FORMATS.items() if known.binary):
            path = Path(folder) / f"ball{suffix}"
            write(mesh, path)

            def work(proves: bool, path: Path = path) -> None:
                raw = read(path)
                assert b.Solid(raw.vertices, raw.faces, trusted=not proves).volume > 4

            share = _share_of_proof(work, turns)
            figures[suffix[1:]] = round(share, 3)
            if share > MAX_PROOF_SHARE and triangles >= MIN_TRIANGLES_TIMED:
                failed.append(Failure(triangles, f"{suffix[1:]}: {share:.1%}"))
            path.unlink()
    return failed, figures


def _share_of_proof(work: Callable[[bool], None], turns: int) -> float:
    """Return the fraction of the least time that the proof takes, from turns with and without it.

    Other load on the machine only makes times longer, so the least times are the best estimates.
    """
    times: dict[bool, list[float]] = {False: [], True: []}
    for turn in range(turns):
        for proves in (bool(turn % 2), not turn % 2):
            times[proves].append(_time_of(work, proves))
    return max(0.0, 1 - min(times[False]) / min(times[True]))


def _time_of(work: Callable[[bool], None], proves: bool) -> float:
    """Return the processor time of one call of `work`, in seconds."""
    gc.collect()
    began = time.process_time()
    work(proves)
    return time.process_time() - began
