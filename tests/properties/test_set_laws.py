"""Laws of set algebra, as exact identities of sets and of rational volumes."""

import numpy as np
from hypothesis import given

import bspcsg as b
from support.checks import assert_sound
from support.strategies import solids

ANY = solids()


@given(ANY, ANY)
def test_inclusion_exclusion(a: "b.Solid", c: "b.Solid") -> None:
    assert (a | c).volume_exact + (a & c).volume_exact == a.volume_exact + c.volume_exact


@given(ANY, ANY)
def test_difference_and_intersection_share_out_a(a: "b.Solid", c: "b.Solid") -> None:
    assert (a - c).volume_exact + (a & c).volume_exact == a.volume_exact


@given(ANY, ANY)
def test_symmetric_difference_has_the_rest(a: "b.Solid", c: "b.Solid") -> None:
    both = (a & c).volume_exact
    assert (a ^ c).volume_exact == a.volume_exact + c.volume_exact - 2 * both
    assert (a ^ c).volume_exact == (a - c).volume_exact + (c - a).volume_exact


@given(ANY, ANY)
def test_results_are_sound(a: "b.Solid", c: "b.Solid") -> None:
    for result in (a | c, a & c, a - c, c - a, a ^ c):
        assert_sound(result)


@given(ANY, ANY)
def test_commutes(a: "b.Solid", c: "b.Solid") -> None:
    assert (a | c).equals(c | a)
    assert (a & c).equals(c & a)
    assert (a ^ c).equals(c ^ a)


@given(ANY, ANY, ANY)
def test_associates_and_distributes(a: "b.Solid", c: "b.Solid", d: "b.Solid") -> None:
    assert ((a | c) | d).equals(a | (c | d))
    assert ((a & c) & d).equals(a & (c & d))
    assert ((a ^ c) ^ d).equals(a ^ (c ^ d))
    assert (a & (c | d)).equals((a & c) | (a & d))
    assert (a - c - d).equals(a - (c | d))


@given(ANY, ANY)
def test_de_morgan(a: "b.Solid", c: "b.Solid") -> None:
    assert (~(a | c)).equals(~a & ~c)
    assert (~(a & c)).equals(~a | ~c)
    assert (a - c).equals(a & ~c)
    assert (~~a).equals(a)


@given(ANY, ANY)
def test_absorption_and_idempotence(a: "b.Solid", c: "b.Solid") -> None:
    assert (a | a).equals(a)
    assert (a & a).equals(a)
    assert (a & (a | c)).equals(a)
    assert (a | (a & c)).equals(a)
    assert (a - a).is_empty
    assert (a ^ a).is_empty


@given(ANY, ANY)
def test_parts_put_together_again(a: "b.Solid", c: "b.Solid") -> None:
    assert ((a & c) | (a - c)).equals(a)
    assert ((a ^ c) ^ c).equals(a)
    assert (a ^ c).equals((a | c) - (a & c))


@given(ANY, ANY)
def test_inclusion_is_an_order(a: "b.Solid", c: "b.Solid") -> None:
    assert a & c <= a <= a | c
    assert a - c <= a
    assert (a <= c) == (a - c).is_empty
    assert (a <= c and c <= a) == a.equals(c)


@given(ANY, ANY)
def test_labels_follow_the_operation(a: "b.Solid", c: "b.Solid") -> None:
    points = np.random.default_rng(5).uniform(-3.5, 4.5, (64, 3))
    in_a, in_c = a.classify(points), c.classify(points)
    clear = (in_a != 0) & (in_c != 0)
    first, second = in_a[clear] > 0, in_c[clear] > 0
    pairs = [
        (a | c, first | second),
        (a & c, first & second),
        (a - c, first & ~second),
        (a ^ c, first ^ second),
        (~a, ~first),
    ]
    for result, expected in pairs:
        assert result.classify(points[clear]).tolist() == np.where(expected, 1, -1).tolist()


@given(ANY, ANY)
def test_a_chain_equals_one_expression(a: "b.Solid", c: "b.Solid") -> None:
    stepwise = a | c
    stepwise.to_mesh()
    stepwise = stepwise - (a & c)
    stepwise.to_mesh()
    assert stepwise.equals(a ^ c)
    assert stepwise.volume_exact == (a ^ c).volume_exact
