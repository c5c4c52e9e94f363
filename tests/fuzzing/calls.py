"""Random calls of the public interface, each of which must return or raise a clear error."""

import pickle
import random
import re

import numpy as np

import bspcsg as b
from bspcsg import bsp

#: The texts of each kind of expression; a name in braces stands for any text of that kind.
GRAMMAR = {
    "number": [
        "0",
        "1",
        "2",
        "-1",
        "0.5",
        "1/3",
        "-2.5",
        "1e-3",
        "1e-9",
        "7",
        "45",
        "1e6",
        "1e-20",
    ],
    "size": ["1", "2", "3", "0.5", "1/3", "1e-3", "2.5", "1e-6", "10"],
    "angle": ["0", "30", "45", "90", "-90", "180", "360", "1e-7", "31.7"],
    "count": ["3", "4", "5", "8", "12"],
    "axis": ["'x'", "'y'", "'z'", "(1, 2, 3)", "(0, 1, 1)", "(0, 0, -1)"],
    "vector": ["({number}, {number}, {number})"],
    "pair": ["({number}, {number})"],
    "sign": ["|", "&", "-", "^"],
    "join": ["'round'", "'miter'", "'square'", "'bevel'"],
    "anchor": ["'min'", "'max'", "'center'"],
    "winding": ["'positive'", "'nonzero'", "'even-odd'"],
    "policy": ["'first'", "'random'", "'least-splits'", "'balanced'", "'weighted'"],
    "solid": [
        "b.cube({size})",
        "b.box({size}, {size}, {size})",
        "b.sphere({size}, segments={count})",
        "b.cylinder({size}, {size}, segments={count})",
        "b.cone({size}, {size}, segments={count})",
        "b.torus({number}, {size}, segments={count}, tube_segments={count})",
        "b.prism({count}, {size}, {size})",
        "b.rounded_box(({size}, {size}, {size}), {size}, segments={count})",
        "b.half_space({axis}, {number})",
        "b.Solid.empty()",
        "b.Solid.full()",
        "({solid} {sign} {solid})",
        "({solid} {sign} {solid})",
        "({solid} {sign} {solid})",
        "({solid} {sign} {solid})",
        "(~{solid})",
        "{solid}.translate({vector})",
        "{solid}.rotate({angle}, {axis})",
        "{solid}.scale({number})",
        "{solid}.scale({vector})",
        "{solid}.mirror({axis})",
        "{solid}.transform([[{number}, {number}, 0, 1], [0, {number}, 0, 2], [1, 0, 1, 0]])",
        "{solid}.normalized()",
        "{solid}.simplify({size})",
        "{solid}.tagged(layer={count})",
        "{solid}.refine(2)",
        "{solid}.smooth(2)",
        "{solid}.trim({axis}, {number})",
        "{solid}.split({axis}, {number})[1]",
        "{solid}.split({solid})[0]",
        "{solid}.align(x={anchor}, to={vector})",
        "{solid}.align(z={anchor}, to={solid})",
        "b.Solid.from_mesh({solid}.to_mesh(), winding={winding})",
        "pickle.loads(pickle.dumps({solid}))",
        "b.hull({solid}, {solid})",
        "b.linear_pattern({solid}, {count}, {vector})",
        "b.polar_pattern({solid}, {count})",
        "{region}.extrude({number}, twist={angle}, scale={pair}, slices={count})",
        "{region}.extrude({size}, taper={number})",
        "{region}.revolve(angle={angle}, segments={count})",
        "b.pipe([{vector}, {vector}, {vector}], {size}, inner={number}, segments={count})",
        "b.loft([[{vector}, {vector}, {vector}], [{vector}, {vector}, {vector}]])",
    ],
    "region": [
        "b.Region.rectangle({size}, {size})",
        "b.Region.circle({size}, {count})",
        "b.Region.polygon([{pair}, {pair}, {pair}, {pair}])",
        "b.Region.half_plane({pair}, {number})",
        "b.Region.empty()",
        "b.Region.full()",
        "({region} {sign} {region})",
        "({region} {sign} {region})",
        "(~{region})",
        "{region}.translate({pair})",
        "{region}.rotate({angle})",
        "{region}.scale({number})",
        "{region}.mirror({pair})",
        "{region}.transform([[{number}, 1, 0], [{number}, {number}, 1]])",
        "{region}.offset({number}, {join}, segments={count})",
        "{region}.hull()",
        "{region}.fillet({size})",
        "{region}.chamfer({size})",
        "{region}.simplify({size})",
        "{region}.split({pair}, {number})[0]",
        "pickle.loads(pickle.dumps({region}))",
        "b.Region.compose({region}.decompose())",
        "{solid}.project()",
        "{solid}.slice({number}, {axis})",
    ],
    "triangle": ["[{vector}, {vector}, {vector}]"],
    "tree": [
        "bsp.PartitionTree([{triangle}, {triangle}, {triangle}], {policy}, degenerate='drop')",
        "bsp.PartitionTree([[{pair}, {pair}], [{pair}, {pair}]], {policy}, degenerate='drop')",
        "bsp.PartitionTree.from_json({tree}.to_json())",
    ],
    "question": [
        *(
            f"{{solid}}.{name}"
            for name in (
                "volume",
                "area",
                "bounds",
                "centroid",
                "inertia",
                "findings",
                "components",
                "genus",
                "volume_exact",
                "is_empty",
                "to_mesh()",
                "to_csg()",
                "to_manifold()",
                "curvature()",
                "normals()",
                "edges()",
                "faces()",
                "decompose()",
                "closest_points(b.cube(1))",
                "equals({solid})",
                "isdisjoint({solid})",
                "ray_cast((0, 0, 5), (0, 0, -1))",
                "classify([(0, 0, 0), {vector}])",
            )
        ),
        *(
            f"{{region}}.{name}"
            for name in (
                "area",
                "bounds",
                "centroid",
                "perimeter",
                "outlines",
                "convex_parts()",
                "decompose()",
                "to_polygons()",
                "classify([(0, 0), {pair}])",
                "cast({pair}, {pair})",
                "isdisjoint({region})",
            )
        ),
        "{tree}.stats()",
        "{tree}.cost()",
        "{tree}.to_svg()",
        "{tree}.leaf_form()",
    ],
}

#: The variables that the texts use.
NAMES = {"b": b, "bsp": bsp, "pickle": pickle}

_PLACE = re.compile(r"\{(\w+)\}")

#: The kinds whose texts may contain texts of the same kind.
_DEEP = {kind for kind, texts in GRAMMAR.items() if any(f"{{{kind}}}" in text for text in texts)}


def random_call(seed: int, depth: int = 5) -> str:
    """Return the text of a random call, with other calls nested up to a depth."""
    return _text("question", random.Random(seed), depth)


def _text(kind: str, draw: random.Random, depth: int) -> str:
    texts = GRAMMAR[kind]
    if depth == 0:
        texts = [text for text in texts if not _DEEP.intersection(_PLACE.findall(text))]
    below = depth - 1 if kind in _DEEP else depth
    return _PLACE.sub(lambda place: _text(place[1], draw, below), draw.choice(texts))


def judge_call(call: str) -> str | None:
    """Return what is wrong with the outcome of a call, or None."""
    try:
        with np.errstate(all="ignore"):
            answer = eval(call, dict(NAMES))
            if type(answer).__module__.startswith("bspcsg"):
                repr(answer)
    except b.InternalError as error:
        return f"{call}: {error}"
    except b.BspcsgError:
        return None
    except Exception as error:
        return f"{call}: {type(error).__name__}: {error}"
    return None
