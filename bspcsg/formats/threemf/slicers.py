"""Parts of 3MF objects that slicers do not treat as material, or subtract from other parts.

PrusaSlicer and related programs write all volumes of an object as one mesh; a part beside the model
gives the kind of each range of triangles. Bambu Studio and OrcaSlicer give a kind for each
component. Cura uses the metadata of objects, which the reader of model parts collects.
"""

import re
from collections import Counter
from dataclasses import dataclass, field, replace

import numpy as np

from ...errors import Finding, FormatError
from .package import Package
from .part import BooleanShape, ModelPart, Object, PlacedObject

#: The names, in lower case, of the package parts with the settings of slicers.
_SETTINGS = re.compile(r"metadata/(\w+_model|model_settings)\.config")

#: The kind of parts that slicers subtract from all other parts of an object.
NEGATIVE = "negative volumes"

#: Kinds of parts by the words of slicers; the kind of plain material is empty.
_KINDS = {
    **dict.fromkeys(("ModelPart", "normal_part"), ""),
    **dict.fromkeys(("NegativeVolume", "negative_part"), NEGATIVE),
    **dict.fromkeys(("ParameterModifier", "modifier_part"), "modifiers"),
    **dict.fromkeys(("SupportBlocker", "support_blocker"), "support blockers"),
    **dict.fromkeys(("SupportEnforcer", "support_enforcer"), "support enforcers"),
}


@dataclass
class Slicing:
    """The parts of a package that slicers do not treat as plain material.

    Parameters
    ----------
    counts : Counter of str
        The number of parts of each kind that is no material.
    inner : set of (str, str)
        Package part and id of each object that is used only inside another object.
    findings : list of Finding
        Findings about invalid settings of slicers.
    shapes : int
        The number of meshes from which negative volumes are to be subtracted.
    unmade : list of str
        The reasons why negative volumes are not subtracted.
    """

    counts: Counter[str] = field(default_factory=Counter)
    inner: set[tuple[str, str]] = field(default_factory=set)
    findings: list[Finding] = field(default_factory=list)
    shapes: int = 0
    unmade: list[str] = field(default_factory=list)


@dataclass
class _SlicerSettings:
    """The settings of slicers by object id, for ranges of triangles and for components."""

    volumes: dict[str, list[tuple[int, int, dict[str, str]]]] = field(default_factory=dict)
    components: dict[str, dict[str, str]] = field(default_factory=dict)
    current: str = ""

    def take(self, tag: str, attributes: dict[str, str]) -> None:
        """Read one XML element of a slicer's settings."""
        if tag == "object":
            self.current = attributes["id"]
        elif tag == "volume":
            first, last = int(attributes["firstid"]), int(attributes["lastid"])
            self.volumes.setdefault(self.current, []).append((first, last, {}))
        elif tag == "metadata" and attributes.get("type") == "volume":
            for _, _, told in self.volumes.get(self.current, [])[-1:]:
                told[attributes.get("key", "")] = attributes.get("value", "")
        elif tag == "part":
            kind = attributes.get("subtype", "normal_part")
            self.components.setdefault(self.current, {})[attributes["id"]] = kind


def apply_slicer_settings(package: Package, root: str) -> Slicing:
    """Change the objects of a package according to the settings of slicers.

    Parts that are no material are removed; negative volumes become operands of a boolean shape.
    """
    slicing, part = Slicing(), package.part(root)
    settings = _settings_of(package, slicing)
    for item, volumes in settings.volumes.items():
        if item in part.objects:
            _divide(slicing, root, part, item, volumes)
    for item, kinds in settings.components.items():
        if item in part.objects:
            _sort(slicing, package, root, item, kinds)
    return slicing


def _settings_of(package: Package, slicing: Slicing) -> _SlicerSettings:
    settings = _SlicerSettings()
    for name in package.named(_SETTINGS):
        try:
            package.parse(name, settings.take)
        except FormatError as error:
            message = (
                "the settings of a slicer in the file cannot be read and were ignored:"
                f" {error.message}"
            )
            slicing.findings.append(Finding("ignored", "warning", message, (), 1))
    return settings


def _kind(slicing: Slicing, word: str) -> str:
    """Return the kind of part that a slicer's word names, empty for material; count the kind.

    An unknown word means material, and adds a finding.
    """
    if word not in _KINDS:
        message = f"a part of the unknown kind “{word}” was read as an ordinary solid part."
        slicing.findings.append(Finding("unknown_part", "warning", message, (), 1))
    kind = _KINDS.get(word, "")
    slicing.counts[kind] += bool(kind)
    return kind


def _divide(
    slicing: Slicing,
    root: str,
    part: ModelPart,
    item: str,
    volumes: list[tuple[int, int, dict[str, str]]],
) -> None:
    """Remove from an object the triangles that are no material, and subtract negative volumes."""
    whole = part.objects[item]
    is_body = np.ones(len(whole.triangles), dtype=bool)
    negatives = []
    for first, last, told in volumes:
        usual = "ParameterModifier" if told.get("modifier") == "1" else "ModelPart"
        kind = _kind(slicing, told.get("volume_type", usual))
        rows = np.arange(max(first, 0), min(last + 1, len(is_body)))
        if kind:
            is_body[rows] = False
        if kind == NEGATIVE and len(rows):
            negatives.append(_sub_object(whole, rows.tolist()))
    if is_body.all():
        return
    body = _sub_object(whole, np.flatnonzero(is_body).tolist())
    part.objects[item] = body
    if negatives and body.triangles:
        base = _added(slicing, root, part, item, body)
        operands = [_added(slicing, root, part, item, one) for one in negatives]
        shape = BooleanShape("difference", base, operands, is_optional=True)
        slicing.shapes += 1
        part.objects[item] = replace(body, vertices=[], triangles=[], properties={}, shape=shape)


def _sort(slicing: Slicing, package: Package, root: str, item: str, kinds: dict[str, str]) -> None:
    """Remove components that are no material from an object; subtract its negative components."""
    whole = package.part(root).objects[item]
    kept, negatives = [], []
    for one in whole.components:
        kind = _kind(slicing, kinds.get(one.item, "normal_part"))
        if not kind:
            kept.append(one)
            continue
        slicing.inner.add((one.path or root, one.item))
        negatives += [one] if kind == NEGATIVE else []
    if negatives:
        kept = [
            _with_negatives_subtracted(slicing, package, root, item, one, negatives) for one in kept
        ]
    whole.components[:] = kept


def _with_negatives_subtracted(
    slicing: Slicing,
    package: Package,
    root: str,
    item: str,
    one: PlacedObject,
    negatives: list[PlacedObject],
) -> PlacedObject:
    """Return a component from which negative components are subtracted."""
    known = package.part(one.path or root).objects.get(one.item)
    if known is None or not known.is_body:
        slicing.unmade.append(f"object {one.item} is not a mesh.")
        return one
    slicing.shapes += 1
    shape = BooleanShape("difference", one, negatives, is_optional=True)
    made = Object(known.kind, name=known.name, shape=shape)
    return _added(slicing, root, package.part(root), item, made)


def _added(slicing: Slicing, root: str, part: ModelPart, item: str, one: Object) -> PlacedObject:
    """Add an object under a free id, and return a reference to it without a transform."""
    number = len(part.objects)
    while f"{item}.{number}" in part.objects:
        number += 1
    part.objects[f"{item}.{number}"] = one
    slicing.inner.add((root, f"{item}.{number}"))
    return PlacedObject("", f"{item}.{number}", np.eye(4, 3))


def _sub_object(whole: Object, rows: list[int]) -> Object:
    """Return an object with the triangles `rows` of another, and the vertices that they use."""
    triangles = [whole.triangles[row] for row in rows]
    used = sorted({corner for triangle in triangles for corner in triangle})
    numbers = {corner: number for number, corner in enumerate(used)}
    faces = [(numbers[a], numbers[b], numbers[c]) for a, b, c in triangles]
    properties = {
        number: whole.properties[row] for number, row in enumerate(rows) if row in whole.properties
    }
    vertices = [whole.vertices[corner] for corner in used]
    return replace(whole, vertices=vertices, triangles=faces, components=[], properties=properties)
