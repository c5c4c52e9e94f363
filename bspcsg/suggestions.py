"""Suggestions for mistyped names, and for names from other libraries."""

import sys
from collections.abc import Collection, Iterable

#: For names of this package, the names of the same function or property in other libraries.
_SYNONYMS = {
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
    "centroid": "center_of_mass center center_mass",
    "is_empty": "empty",
    "findings": "is_valid is_volume is_watertight is_winding_consistent status",
    "components": "parts solids bodies",
    "split": "split_by_plane slice_plane",
    "trim": "trim_by_plane",
    "decompose": "split_components disjoint",
    "save": "export write dump to_file to_stl",
    "load": "import_stl read open from_file",
    "show": "display plot",
    "Region": "crosssection cross_section polygon2d",
    "section": "cross_section",
    "slice": "cross_section section",
    "from_mesh": "from_trimesh from_manifold from_arrays",
    "tagged": "color colour paint set_color",
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


def closest_name(word: str, known: Iterable[str]) -> str | None:
    """Return the known name that is a synonym of a word or is spelled like it; None without any."""
    from difflib import get_close_matches

    names = [name for name in known if not name.startswith("_")]
    key = word.lower().replace("-", "_")
    close = get_close_matches(key, names, n=1)
    return _name_in_other_library(key, names) or (close[0] if close else None)


def _name_in_other_library(word: str, names: Collection[str]) -> str | None:
    """Return this package's name for a name of other libraries, if it is in `names`, else None."""
    found = (name for name, others in _SYNONYMS.items() if word in others.split())
    return next((name for name in found if name in names), None)


def suggestion_text(word: object, known: Iterable[str]) -> str:
    """Return " Is NAME meant?" for the end of an error message; empty if no known name is close."""
    name = closest_name(word, known) if isinstance(word, str) else None
    return f" Is {name} meant?" if name else ""


def attribute_error(owner: object, name: str, what: str) -> AttributeError:
    """Return the error for a missing attribute.

    Parameters
    ----------
    owner : object
        The object without the attribute.
    name : str
        The name of the attribute.
    what : str
        The name of the owner in the message: ``"'Solid' object"``.
    """
    text = f"{what} has no attribute {name!r}"
    # Programs often probe private names, and nobody reads those errors.
    if name.startswith("_"):
        return AttributeError(text)
    known = dir(owner)
    asks = suggestion_text(name, known)
    if not _name_in_other_library(name, known):
        asks = _function_suggestion(name) or asks
    return AttributeError(f"{text}{asks and '.'}{asks}")


def _function_suggestion(name: str) -> str:
    """Return a question that suggests the package's function of a name; empty if there is none."""
    functions = getattr(sys.modules.get("bspcsg"), "__all__", ())
    return f" Is the function bspcsg.{name} meant?" if name in functions else ""
