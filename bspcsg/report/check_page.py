"""The page that `bspcsg check` writes, with a card for each file and for each object."""

import re
from collections import Counter
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any, NamedTuple

from .._types import FloatArray
from ..assembly.object_diagnosis import Examination
from ..bsp import Camera
from ..errors import Finding
from ..formats.raw import RawMesh
from ..repair.diagnosis import Diagnosis
from .assets import asset, bundle, rendered
from .campaign_cards import Figure, PageBudget, model_within
from .formatting import NO_NUMBER, number, vector, whole
from .viewer.defect_layers import layers_of_defects, layers_of_objects
from .viewer.face_colours import OWN
from .viewer.landmark import Landmark
from .viewer.layer import Layer, drawn_points
from .viewer.still_pictures import camera_for, rings, still_picture

#: The largest number of characters of a page: browsers take seconds to open a longer one.
_MAX_PAGE_CHARACTERS = 20_000_000

_FILES = ("page.css", "report.css", "loader.js", "table.js")

_SIZE = (320, 240)

#: The verdict on a file that could not be read.
UNREADABLE = "unreadable"

#: The meanings of verdicts on a mesh, in the order of verdicts, the worst first.
_MEANINGS = {
    UNREADABLE: "the file is missing, damaged or of an unknown format",
    "refused": "the numbers are too large, or not finite",
    "not closed": "it has holes, or triangles turned round, so it bounds nothing",
    "empty": "there is no triangle",
    "inside out": "it is closed, but its triangles face inwards",
    "solid": "every edge has as many triangles one way as the other: it bounds a set of points",
}


@dataclass(frozen=True)
class Sheet:
    """The card of one file, or of one object of a file, on the page of checked meshes.

    Parameters
    ----------
    address : str
        The id of the card's element in the page.
    file, name : str
        Names of the file and of the object in it; the object's is empty for the whole file.
    verdict, tone : str
        The verdict on the mesh, and its tone, which gives the colour: good, warn or bad.
    findings : sequence of Finding
    facts : mapping of str to str
        Counts and measures of the mesh as text, by name.
    figures : list of Figure
    model : dict or None
        The data of the 3D view, which the viewer unpacks.
    note : str
        A note on omitted content, and the reason.
    """

    address: str
    file: str
    name: str
    verdict: str
    tone: str
    findings: Sequence[Finding]
    facts: Mapping[str, str]
    figures: Sequence[Figure] = ()
    model: dict[str, Any] | None = None
    note: str = ""

    @property
    def title(self) -> str:
        """The title of the card: the file, and the object's name if it has one."""
        return f"{self.file}: {self.name}" if self.name else self.file


class Row(NamedTuple):
    """One row of the table of checked meshes; `card` is the id of the card in the page."""

    tone: str
    rank: int
    card: str
    cells: list[str]


class CheckPage:
    """The page of checked meshes, built file by file, so that each mesh is released once drawn.

    Parameters
    ----------
    files : int
        The total number of files.
    thin : float, optional
        Walls thinner than this, in model units, are marked.
    """

    def __init__(self, files: int, thin: float | None = None) -> None:
        spent = len(bundle()) + sum(len(asset(name)) for name in _FILES)
        self._budget = PageBudget(files, spent, _MAX_PAGE_CHARACTERS)
        self._thin = thin
        self._sheets: list[Sheet] = []

    def add(self, file: str, whole_file: Examination) -> None:
        """Add a card for a file, and one for each of its objects if there are several."""
        allowance = self._budget.allowance() / (1 + len(whole_file.objects))
        if whole_file.objects:
            scene = layers_of_objects(whole_file)
        else:
            scene = layers_of_defects(whole_file.mesh, whole_file.diagnosis, self._thin)
        self._show(file, "", whole_file.mesh, whole_file.diagnosis, scene, allowance)
        for one in whole_file.objects:
            scene = layers_of_defects(one.mesh, one.diagnosis, self._thin)
            self._show(file, one.name, one.mesh, one.diagnosis, scene, allowance)

    def add_unreadable(self, file: str, error: str) -> None:
        """Add a card for a file that could not be read, with the reason."""
        found = Finding(UNREADABLE, "error", error, (), 1)
        self._sheets.append(Sheet(self._address, file, "", UNREADABLE, "bad", [found], {}))

    @property
    def _address(self) -> str:
        return f"mesh-{len(self._sheets) + 1}"

    def _show(
        self,
        file: str,
        name: str,
        mesh: RawMesh,
        found: Diagnosis,
        scene: tuple[list[Layer], list[Landmark]],
        allowance: float,
    ) -> None:
        layers, landmarks = scene
        figures = _figures(layers, landmarks)
        paints = {paint.name for layer in layers for paint in layer.paints}
        paint = next((own for own in OWN if own in paints), "")
        told = {"unit": mesh.unit, "landmarks": landmarks, "paint": paint}
        model, note = (None, "") if not figures else model_within(layers, allowance, **told)
        self._budget.spend(sum(len(image) for one in figures for image in one.images))
        self._budget.spend(len(model["data"]) if model else 0)
        sheet = Sheet(
            self._address,
            file,
            name,
            found.verdict,
            _tone(found),
            found.findings,
            _facts(found, mesh.unit),
            figures,
            model,
            note,
        )
        self._sheets.append(sheet)

    def text(self) -> str:
        """Return the page as HTML.

        Raises
        ------
        MissingPartError
            If Jinja2 is not installed.
        """
        files = [sheet for sheet in self._sheets if not sheet.name]
        bad = sum(sheet.verdict != "solid" for sheet in files)
        counts = Counter(sheet.verdict for sheet in self._sheets)
        page = rendered(
            "examined.html",
            title=f"Check of {files[0].file if len(files) == 1 else f'{whole(len(files))} meshes'}",
            lead=_lead(bad, files),
            failed=bad > 0,
            verdicts=[
                (one, counts[one], "good" if one == "solid" else "bad", meaning)
                for one, meaning in _MEANINGS.items()
                if counts[one]
            ],
            columns=_COLUMNS,
            rows=[_row(sheet) for sheet in self._sheets],
            sheets=self._sheets,
            alone=len(self._sheets) == 1,
        )
        return re.sub(r"\n\s+", "\n", page)


def _lead(bad: int, files: Sequence[Sheet]) -> str:
    if len(files) == 1:
        return f"no solid: {files[0].verdict}" if bad else "a solid"
    if not bad:
        return "all of them solids"
    return f"{whole(bad)} of {whole(len(files))} {'is no solid' if bad == 1 else 'are no solids'}"


def _tone(found: Diagnosis) -> str:
    if not found.is_solid:
        return "bad"
    return "warn" if any(one.severity == "warning" for one in found.findings) else "good"


def _count(found: Diagnosis, code: str) -> int:
    return sum(one.count for one in found.findings if one.code == code)


def _facts(found: Diagnosis, unit: str) -> dict[str, str]:
    """Return counts and measures of a mesh as text, by name; lengths are in `unit`."""
    after = f" {unit}" if unit else ""
    size = ""
    if found.bounds is not None:
        low, high = found.bounds
        size = " × ".join(number(b - a) for a, b in zip(low, high, strict=True)) + after
    volume = found.signed_volume if found.volume is None else found.volume
    named = "volume" if found.volume is not None else "signed volume"
    return {
        "triangles": whole(found.triangles),
        "vertices": whole(found.vertices),
        "surfaces": whole(found.surfaces),
        "genus": whole(found.genus),
        "open edges": whole(_count(found, "open_edges")),
        "edges of more than two": whole(_count(found, "non_manifold")),
        "pairs that cross": whole(found.crossings),
        named: number(volume, 9) + (f"{after}³" if unit else ""),
        "area": number(found.area, 9) + (f"{after}²" if unit else ""),
        "size": size or NO_NUMBER,
        "from": vector(found.bounds[0]) if found.bounds else NO_NUMBER,
    }


#: The columns of the table: the name, and whether cells are texts or numbers.
_COLUMNS = (
    ("verdict", "text"),
    ("file", "text"),
    ("object", "text"),
    ("triangles", "number"),
    ("surfaces", "number"),
    ("open edges", "number"),
    ("pairs that cross", "number"),
    ("volume", "number"),
    ("area", "number"),
    ("size", "number"),
)


def _row(sheet: Sheet) -> Row:
    rank = list(_MEANINGS).index(sheet.verdict)
    facts = [sheet.facts.get(name, NO_NUMBER) for name, _ in _COLUMNS[3:]]
    return Row(sheet.tone, rank, sheet.address, [sheet.verdict, sheet.file, sheet.name, *facts])


def _figures(layers: Sequence[Layer], landmarks: Sequence[Landmark]) -> list[Figure]:
    """Return pictures of layers from two sides, with rings around the landmarks."""
    if not any(len(layer.faces) for layer in layers):
        return []
    # The thinnest wall gets no ring, since every closed mesh has one.
    places = [place.at.tolist() for place in landmarks if not place.name.startswith("thinnest")]
    front = camera_for(layers, _SIZE)
    sides = (("right, front and above", front), ("left, back and below", _behind(front, layers)))
    return [_figure(f"from the {name}", camera, layers, places) for name, camera in sides]


def _behind(front: Camera, layers: Sequence[Layer]) -> Camera:
    points: FloatArray = drawn_points(layers)
    return Camera.orthographic(-front.direction).fitted(points, _SIZE[0] / _SIZE[1])


def _figure(
    caption: str, camera: Camera, layers: Sequence[Layer], places: list[list[float]]
) -> Figure:
    image = still_picture(layers, camera, _SIZE)
    if not image:
        return Figure(caption, text="too large for a picture")
    return Figure(caption, [image, rings(places, camera, _SIZE)] if places else [image])
