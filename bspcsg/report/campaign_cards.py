"""The cards of a campaign's report: the choice of cases, and pictures and 3D views that fit."""

from collections.abc import Iterable
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from ..campaign.record import CaseRecord, Results, is_failure
from ..errors import BspcsgError
from .formatting import tone, whole
from .merging import rank
from .stored_meshes import StoredMeshes, stored_meshes
from .viewer.layer import Layer
from .viewer.packing import packed
from .viewer.still_pictures import camera_for, rings, still_picture

#: A page may have 1 450 000 characters if it has up to 40 cards; with more cards, more in
#: proportion.
_PAGE_CHARACTERS, _CARDS_PER_PAGE = 1_450_000, 40

#: The smallest share of a page that is left for cards if the table is long.
_MIN_CARD_SHARE = 0.3

#: Grid cells along the longest side to which a 3D view is simplified, one by one until it fits.
_CELLS = (128, 64, 40, 24)

#: An estimate of the number of characters of one card's pictures.
_PICTURE_CHARACTERS = 10_000

#: A view may use at most this multiple of an equal share of the characters that are left.
_MAX_VIEW_SHARES = 2


@dataclass(frozen=True)
class Figure:
    """A picture on a card: data URLs of images, drawn one over another in order.

    `text` replaces a missing picture; `is_same` is true if it is missing because two sets are
    equal.
    """

    caption: str
    images: list[str] = field(default_factory=list)
    text: str = ""
    is_same: bool = False


@dataclass(frozen=True)
class Card:
    """The card of one case on the page of a campaign.

    Parameters
    ----------
    address : str
        The id of the card's element in the page.
    case : CaseRecord
    tone : str
        The tone of the verdict, which gives its colour: good, near, warn, mute or bad.
    figures : list of Figure
    model : dict or None
        The data of the 3D view, which the viewer unpacks.
    note : str
        A note on omitted content, and the reason.
    """

    address: str
    case: CaseRecord
    tone: str
    figures: list[Figure]
    model: dict[str, Any] | None
    note: str


class PageBudget:
    """A count of the characters of a page that are left for cards.

    Parameters
    ----------
    cards : int
        The number of cards.
    spent : int
        The number of characters of the page without cards.
    page : float, optional
        The limit of characters of the page; by default it depends on the number of cards.
    """

    def __init__(self, cards: int, spent: int, page: float | None = None) -> None:
        self._cards = cards
        page = _PAGE_CHARACTERS * max(1.0, cards / _CARDS_PER_PAGE) if page is None else page
        self.left = max(page - spent, _MIN_CARD_SHARE * page)

    def spend(self, characters: int) -> None:
        """Subtract a number of characters that a card uses."""
        self.left -= characters

    def allowance(self) -> float:
        """Return the number of characters that the next card's 3D view may use; count the card."""
        cards = max(self._cards, 1)
        self._cards = cards - 1
        free = self.left - self._cards * _PICTURE_CHARACTERS
        return min(free, _MAX_VIEW_SHARES * free / cards)


def cases_for_cards(results: Results, count: int) -> list[CaseRecord]:
    """Return the first `count` cases for cards: failures, then cases with meshes, worst first."""
    return sorted(results.cases.values(), key=_urgency)[:count]


def _urgency(case: CaseRecord) -> tuple[bool, bool, int, float, str]:
    found, bounds = case["set_difference"], case["bounds"]
    known = found is not None and bounds is not None and bounds["same_set"] > 0
    doubt = found["thickness"] / bounds["same_set"] if found and bounds and known else 0.0
    failed, unseen = is_failure(case), case["meshes"] is None
    return not failed, unseen and not failed, rank(case), -doubt, case["case"]


def cards_of(cases: Iterable[CaseRecord], results: Results, budget: PageBudget) -> Iterable[Card]:
    """Yield a card for each case; content that does not fit is omitted with a note."""
    for number, case in enumerate(cases):
        address = f"case-{number + 1}"
        if case["meshes"] is None:
            yield Card(
                address,
                case,
                tone(case["verdict"]),
                [],
                None,
                "The meshes of this case were not stored.",
            )
            continue
        try:
            stored = stored_meshes(results.folders[case["key"]], case["meshes"])
            figures = _figures(case, stored)
        except BspcsgError as error:
            yield Card(address, case, tone(case["verdict"]), [], None, error.message)
            continue
        budget.spend(sum(len(image) for figure in figures for image in figure.images))
        model, note = model_within(stored.layers, budget.allowance())
        budget.spend(len(model["data"]) if model else 0)
        yield Card(address, case, tone(case["verdict"]), figures, model, note)


def _figures(case: CaseRecord, stored: StoredMeshes) -> list[Figure]:
    """Return pictures of a case's operands, result and difference, all with the same camera."""
    if not stored.layers:
        return []
    camera = camera_for(stored.layers, (4, 3))
    names = [Path(operand["file"] or operand["name"]).name for operand in case["operands"]]
    named = dict(zip((layer.name for layer in stored.operands), names, strict=False))
    figures = [
        _figure(
            f"{layer.name} · {named.get(layer.name, '')}", layer, still_picture([layer], camera)
        )
        for layer in stored.operands
    ]
    result = still_picture([stored.result], camera)
    figures.append(_figure("result", stored.result, result))
    if len(stored.difference.faces):
        found = case["set_difference"]
        place = found["place"] if found else None
        images = [result, still_picture([stored.difference], camera, edges=False)]
        images += [] if place is None else [rings([place], camera)]
        caption = f"difference, {found['thickness']:.2g} thick" if found else "difference"
        return [*figures, Figure(caption, [image for image in images if image])]
    return [*figures, _no_difference(case)]


def _figure(name: str, layer: Layer, image: str) -> Figure:
    if len(layer.faces) == 0:
        return Figure(name, text="empty")
    caption = f"{name} · {whole(len(layer.faces))} triangles"
    return Figure(caption, [image]) if image else Figure(caption, text="too large for a picture")


def _no_difference(case: CaseRecord) -> Figure:
    found = case["set_difference"]
    name = "difference"
    if found is None:
        return Figure(name, text="not compared")
    if found["equal"]:
        return Figure(name, text="exactly the same set", is_same=True)
    return Figure(name, text=f"{found['thickness']:.2g} thick, without a surface")


def model_within(
    layers: list[Layer], allowance: float, **told: Any
) -> tuple[dict[str, Any] | None, str]:
    """Return the data of a 3D view, simplified if necessary, and a note on omitted content.

    Return None and a note if even the simplest view is too long.

    Parameters
    ----------
    layers : list of Layer
    allowance : float
        The largest number of characters of the data.
    **told
        As for `packed`.
    """
    if not layers:
        return None, "The result is empty, so there is no 3D view."
    model = packed(layers, quantised=True, **told)
    if len(model["data"]) <= allowance:
        return model, ""
    for cells in _CELLS:
        simple = packed([layer.simplified(cells) for layer in layers], quantised=True, **told)
        if len(simple["data"]) <= allowance:
            before, after = (
                sum(layer["triangles"] for layer in m["layers"]) for m in (model, simple)
            )
            return simple, (
                f"The 3D view is simplified to {whole(after)} of {whole(before)} triangles to"
                " fit on this page; the numbers refer to the full meshes."
            )
    size = f"{len(model['data']) / 1000:.0f} kB"
    return None, (
        f"The 3D view is left out because it would add {size} to the page; a smaller number of"
        " cards leaves more space for each."
    )
