"""Suggestions for mistyped or foreign names."""

from collections.abc import Iterable

#: Names in other libraries and languages, by the names of the same things here.
_ELSEWHERE = {
    "difference": "diff subtract subtraction minus cut sub remove",
    "union": "add fuse join merge unite combine plus append",
    "intersection": "intersect common and_ inter overlap intersects_with",
    "symmetric_difference": "xor symdiff exclusive_or",
    "xor": "symmetric_difference symdiff exclusive_or",
    "translate": "move shift translated moved",
    "rotate": "turn rotated",
    "scale": "resize scaled",
    "mirror": "flip reflect mirrored",
    "bounds": "bbox bounding_box boundingbox extents",
    "volume": "mass",
    "area": "surface_area",
    "centroid": "center_of_mass center",
    "is_empty": "empty",
    "components": "parts solids bodies",
    "decompose": "split_components disjoint",
    "save": "export write dump to_file to_stl",
    "load": "import_stl read open from_file",
    "show": "display plot",
    "section": "cross_section",
    "slice": "cross_section section",
    "classify": "contains",
    "hull": "convex_hull",
    "project": "projection shadow",
    "extrude": "linear_extrude",
    "revolve": "rotate_extrude",
    "cube": "cuboid",
    "box": "cuboid make_box",
    "sphere": "ball icosphere uv_sphere",
    "circle": "disc disk",
}


def meant(word: str, known: Iterable[str]) -> str | None:
    """Return the known name that a word means or resembles, or None."""
    from difflib import get_close_matches

    names = [name for name in known if not name.startswith("_")]
    key = word.lower().replace("-", "_")
    for name, others in _ELSEWHERE.items():
        if name in names and key in others.split():
            return name
    close = get_close_matches(key, names, n=1)
    return close[0] if close else None


def question(word: object, known: Iterable[str]) -> str:
    """Return a question to end an error with, or nothing if no known name is close."""
    name = meant(word, known) if isinstance(word, str) else None
    return f" Is {name} meant?" if name else ""


def no_attribute(owner: object, name: str, what: str) -> AttributeError:
    """Return the error for a missing attribute.

    Parameters
    ----------
    owner : object
        The object that lacks it.
    name : str
    what : str
        The owner in the message: ``"'Solid' object"``.
    """
    # Programs probe private names often, and nobody reads those errors.
    asks = "" if name.startswith("_") else question(name, dir(owner))
    return AttributeError(f"{what} has no attribute {name!r}{asks and '.'}{asks}")
