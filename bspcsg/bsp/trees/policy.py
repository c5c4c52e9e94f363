"""Pivot policies: the rules that choose the hyperplane to divide a region.

first
    The first facet in the order given.
random
    The first facet in one random order of all; the seed makes it reproducible. The expected number
    of fragments of n disjoint segments is at most n + 2 n ln n (de Berg et al., Computational
    Geometry, section 12.3; Paterson, Yao 1990).
least-splits
    Of `sample` candidates, evenly spaced in the region's list, the one that cuts the fewest facets.
balanced
    The candidate with the least ``|n⁻ - n⁺|``, where n⁻ and n⁺ are the numbers of facets on its
    minus and its plus side.
weighted
    The candidate with the least ``alpha * |n⁻ - n⁺| + (1 - alpha) * splits``; with ``alpha=0.5``
    this is the candidate whose larger side has the fewest facets.
least-cost
    The candidate with the least P⁻n⁻ + P⁺n⁺, where P⁻ and P⁺ are the fractions of the region's
    volume on the two sides: the expected number of facets on the side of a random point (after
    Naylor 1993, section 4, who uses the expected costs of the subtrees, unknown at this time,
    instead of n⁻ and n⁺). Regions are stored during construction, so that this policy is several
    times slower than all others.

end-points
    In the plane the lines through two end points of segments, in space the planes through three
    corners: of `sample` of these, evenly spaced among all, and as many supporting hyperplanes, the
    one whose larger side has the fewest pieces of facets. A restricted partition rather than an
    autopartition, and not one of `POLICIES`.

All policies but end-points divide only by supporting hyperplanes, in which facets lie
(autopartition). With ``top=k``, regions with more than k facets are divided by axis-parallel
hyperplanes through the median instead, as long as neither side gets more than three quarters of the
facets (general partition).
"""

from typing import Any, Literal, TypeAlias, get_args

from ...errors import invalid_parameter
from ...parameters import at_least, number, optional_pitch, seed_number, shown

#: The names of the pivot policies.
Policy: TypeAlias = Literal[
    "first", "random", "least-splits", "balanced", "weighted", "least-cost", "end-points"
]

#: All policies of autopartitions.
POLICIES: tuple[Policy, ...] = get_args(Policy)[:-1]


#: A count above that of the facets of any tree; it stands for all facets.
_ALL = 2**31


def checked_policy(policy: Any) -> Policy:
    """Return the name of a known policy, or raise an error that lists all names."""
    for name in get_args(Policy):
        if isinstance(policy, str) and policy == name:
            known: Policy = name
            return known
    names = ", ".join(get_args(Policy))
    message = f"Unknown policy {shown(policy)}; known are {names}, or pass a function."
    raise invalid_parameter(message)


def core_options(seed: Any, sample: Any, alpha: Any, top: Any, pitch: Any) -> dict[str, Any]:
    """Return the checked options of a tree's construction as keyword arguments for the core.

    Raises
    ------
    InvalidParameterError
        If one is out of its range.
    """
    weight = number(alpha, "alpha")
    if not 0 <= weight <= 1:
        raise invalid_parameter(f"alpha must be from 0 to 1, not {alpha}.")
    return {
        "seed": seed_number(seed),
        "sample": min(at_least(1, sample, "sample"), _ALL),
        "alpha": weight,
        "top": min(at_least(0, top, "top"), _ALL),
        "pitch": optional_pitch(pitch),
    }
