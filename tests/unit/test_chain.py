"""Chains of factors: equal to lists of factors, at the cost of the added factors."""

import math
import pickle
from collections.abc import Callable
from itertools import pairwise

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

import bspcsg as b
from bspcsg.geometry import transform
from bspcsg.geometry.chain import BLOCK, FactorChain, common_prefix
from bspcsg.geometry.transform import Factor, determinant_sign

PITCH = -9

#: Motions of the lattice, one that is off it, and maps that are no motions.
KNOWN = [
    transform.rotation(90, "x"),
    transform.mirroring((0, 0, 1)),
    transform.translation((1, 2, 3)),
    transform.translation((0.5, 0, -0.25)),
    transform.translation((1e-10, 0, 0)),
    transform.rotation(1, "z"),
    transform.scaling((0.75, 1.5, -1)),
]

#: Mostly long runs, so that the outermost factors that permute axes reach into several blocks.
LISTS = st.tuples(
    st.lists(st.sampled_from(KNOWN[:4]), max_size=3 * BLOCK),
    st.lists(st.sampled_from(KNOWN), max_size=2 * BLOCK + 2),
).map(lambda parts: tuple(parts[0] + parts[1]))


def grown(factors: tuple[Factor, ...]) -> FactorChain:
    """Return the chain of factors, built by adding one after the other."""
    chain = FactorChain()
    for factor in reversed(factors):
        chain = chain.under((factor,))
    return chain


@given(LISTS, st.integers(0, 3 * BLOCK))
def test_chains_hold_what_lists_hold(factors: tuple[Factor, ...], count: int) -> None:
    chain = grown(factors)
    assert tuple(chain) == factors and len(chain) == len(factors)
    assert chain == FactorChain.of(factors) and hash(chain) == hash(FactorChain.of(factors))
    rest = chain.without(min(count, len(factors)))
    assert tuple(rest) == factors[min(count, len(factors)) :]
    assert rest == FactorChain.of(tuple(rest)) and hash(rest) == hash(FactorChain.of(tuple(rest)))
    assert pickle.loads(pickle.dumps(chain)) == chain
    assert tuple(chain.around(rest)) == factors + tuple(rest)


@given(LISTS)
def test_chains_come_to_what_their_factors_come_to(factors: tuple[Factor, ...]) -> None:
    chain = grown(factors)
    assert np.allclose(chain.product, transform.product(factors), rtol=1e-12, atol=1e-12)
    assert chain.mirrors is (math.prod(determinant_sign(factor.matrix) for factor in factors) < 0)
    outer = transform.permuting_run(factors)
    assert tuple(chain.inner) == factors[len(outer) :]
    for pitch in (PITCH, -10, PITCH):
        assert chain.outer_motion(pitch) == transform.lattice_motion(outer, pitch)


@given(LISTS, LISTS, LISTS)
def test_what_chains_share_is_what_lists_share(
    shared: tuple[Factor, ...], first: tuple[Factor, ...], second: tuple[Factor, ...]
) -> None:
    lists = [shared + first, shared + second, shared]
    prefix = common_prefix([grown(factors) for factors in lists[:2]])
    expected = next(
        (k for k, (a, b) in enumerate(zip(*lists[:2], strict=False)) if a != b),
        min(map(len, lists[:2])),
    )
    assert tuple(prefix) == lists[0][:expected]
    assert common_prefix([grown(factors) for factors in lists]) == FactorChain.of(shared)


def test_few_factors_are_multiplied_from_the_outside() -> None:
    factors = tuple(transform.rotation(k, (k, 1, 2)) for k in range(1, BLOCK + 1))
    for count in range(BLOCK + 1):
        chain = FactorChain.of(factors[:count])
        assert chain.product.tobytes() == transform.product(factors[:count]).tobytes()


def test_the_longest_chains_do_not_recurse() -> None:
    chain = FactorChain()
    for step in range(100 * BLOCK):
        chain = chain.under((KNOWN[step % 4],))
    assert len(chain.inner) == 0
    again = pickle.loads(pickle.dumps(chain))
    assert again == chain and again.outer_motion(PITCH) == chain.outer_motion(PITCH)


@given(LISTS)
def test_planes_go_through_blocks_as_through_factors(factors: tuple[Factor, ...]) -> None:
    plane = b.half_space((1, 2, 3), 4.5)
    once = plane._moved(factors)._leaf()
    twice = plane._moved(factors[5:])._moved(factors[:5])._leaf()
    one_by_one = plane._leaf()
    for factor in reversed(factors):
        one_by_one = one_by_one.placed(FactorChain.of((factor,)))
    assert once.plane == twice.plane == one_by_one.plane  # type: ignore[union-attr]


STEPS: dict[str, Callable[[b.Solid], b.Solid]] = {
    "rotate": lambda solid: solid.rotate(1),
    "about a point": lambda solid: solid.rotate((1, 2, 3), about=(1, 0, 0)),
    "translate": lambda solid: solid.translate(0.1, 0, 0),
    "scale": lambda solid: solid.scale((1.001, 1, 0.999)),
    "mirror": lambda solid: solid.mirror((1, 2, 3)),
    "complement": lambda solid: ~solid.rotate(1),
}


#: A complement that was looked at remembers its operand, so those of half-spaces grow.
CASES = [
    *[pytest.param(b.cube(2) - b.cube(1), step, id=name) for name, step in STEPS.items()],
    *[
        pytest.param(b.half_space((1, 2, 3), 0.5), step, id=f"{name}, a half-space")
        for name, step in STEPS.items()
        if name != "complement"
    ],
]


# Found: n steps such as `solid = solid.rotate(1)` cost n².
@pytest.mark.sampled(4)
@pytest.mark.parametrize(("start", "step"), CASES)
def test_every_step_costs_the_same(
    start: b.Solid, step: Callable[[b.Solid], b.Solid], monkeypatch: pytest.MonkeyPatch
) -> None:
    """Count inner products, maps of the axes and signs that n steps ask for."""
    asked = 0

    def counting(original: Callable[..., object]) -> Callable[..., object]:
        def called(*given: object) -> object:
            nonlocal asked
            asked += 1
            return original(*given)

        return called

    for name in ("_dot", "_signed_axes", "determinant_sign", "exact_dot"):
        monkeypatch.setattr(transform, name, counting(getattr(transform, name)))
    solid = start
    counts = [0]
    for _ in range(3):
        for _ in range(2 * BLOCK):
            solid = step(solid)
            assert not solid.is_empty
        counts.append(asked)
    first, *rest = (after - before for before, after in pairwise(counts))
    assert all(count < 1.5 * first for count in rest)
