"""`FactorChain`: a transform as a list of factors, to which adding factors is cheap."""

from collections.abc import Callable, Iterator, MutableMapping, Sequence
from functools import reduce
from typing import TypeVar

from .._types import FloatArray
from .transform import Factor, Factors, LatticeMotion, lattice_motion, multiplied, permuting_run

Value = TypeVar("Value")

#: The largest number of factors in a block.
BLOCK = 32


class FactorChain:
    """A transform as a list of affine factors, the outermost first; immutable.

    The innermost factors are grouped in blocks that store their products. Longer chains share these
    blocks, so that n transforms one after another take a multiple of n matrix products, not of n².

    Parameters
    ----------
    head : tuple of Factor
        The outermost factors, at most `BLOCK`.
    rest : FactorBlock, optional
        The factors that are applied before those of `head`.
    """

    __slots__ = ("__weakref__", "_head", "_rest", "_shorter")

    def __init__(self, head: Factors = (), rest: "FactorBlock | None" = None) -> None:
        self._head = head
        self._rest = rest
        self._shorter: tuple[int, FactorChain] | None = None

    @classmethod
    def of(cls, factors: Sequence[Factor]) -> "FactorChain":
        """Return the chain of the given factors, the outermost first."""
        return cls().under(factors)

    def under(self, factors: Sequence[Factor]) -> "FactorChain":
        """Return the chain with more factors applied after it, given outermost first."""
        head, rest = self._head, self._rest
        for factor in reversed(factors):
            if len(head) == BLOCK:
                head, rest = (), FactorBlock(head, rest)
            head = (factor, *head)
        return FactorChain(head, rest)

    def around(self, inner: "FactorChain") -> "FactorChain":
        """Return the chain that applies `inner` first and then this chain."""
        return inner.under(tuple(self)) if inner else self

    def fold(
        self,
        start: Value,
        step: Callable[[Value, Factor], Value],
        known: MutableMapping["FactorBlock", Value],
    ) -> Value:
        """Return the value after one call of `step` for each factor, the innermost first.

        Parameters
        ----------
        start : object
        step : callable
            A function of a value and a factor that returns the next value.
        known : mutable mapping
            The values after whole blocks for this start; they are looked up here, and new ones
            added.
        """
        waiting, block = [], self._rest
        while block is not None and block not in known:
            waiting.append(block)
            block = block.rest
        value = start if block is None else known[block]
        for block in reversed(waiting):
            value = known[block] = reduce(step, reversed(block.factors), value)
        return reduce(step, reversed(self._head), value)

    def without(self, count: int) -> "FactorChain":
        """Return the chain without its `count` outermost factors; equal calls return one object."""
        if count == 0:
            return self
        # Read once, because another thread may replace it.
        shorter = self._shorter
        if shorter is None or shorter[0] != count:
            shorter = self._shorter = (count, self._without(count))
        return shorter[1]

    def _without(self, count: int) -> "FactorChain":
        head, rest = self._head, self._rest
        while count >= len(head) and rest is not None:
            count -= len(head)
            head, rest = rest.factors, rest.rest
        return FactorChain(head[count:], rest)

    def __len__(self) -> int:
        """Return the number of factors."""
        return len(self._head) + _length(self._rest)

    def __iter__(self) -> Iterator[Factor]:
        """Yield the factors, outermost first."""
        yield from self._head
        block = self._rest
        while block is not None:
            yield from block.factors
            block = block.rest

    def __eq__(self, other: object) -> bool:
        """Return true if both chains have the same factors, bit by bit."""
        return isinstance(other, FactorChain) and len(self) == len(other) == _common_length(
            self, other
        )

    def __hash__(self) -> int:
        """Return a hash value of all factors."""
        return _hashed(self._head, self._rest)

    def __reduce__(self) -> tuple[Callable[[Factors], "FactorChain"], tuple[Factors]]:
        """Return the factors for pickling, without blocks, whose nesting may be too deep."""
        return FactorChain.of, (tuple(self),)

    @property
    def product(self) -> FloatArray:
        """The product of all factors, (4, 4) float64, each entry of each product rounded once."""
        return _product(self._head, self._rest)

    @property
    def mirrors(self) -> bool:
        """True if the transform is orientation-reversing."""
        return _mirrors(self._head, self._rest)

    @property
    def inner(self) -> "FactorChain":
        """The chain without its outermost factors that only permute, mirror and shift axes."""
        return _inner(self._head, self._rest)

    def outer_motion(self, pitch: int) -> LatticeMotion | None:
        """Return the outermost factors that only permute, mirror and shift axes, as one motion.

        Return None if this motion does not map the lattice onto itself.
        """
        run = permuting_run(self._head)
        if self._rest is None or len(run) < len(self._head):
            return lattice_motion(run, pitch)
        return lattice_motion(run, pitch, self._rest.outer_motion(pitch))


#: The chain without factors, the identity.
IDENTITY_CHAIN = FactorChain()


class FactorBlock:
    """A group of consecutive factors of a chain, and the block of all factors applied before them.

    It stores the product of all these factors.

    Parameters
    ----------
    factors : tuple of Factor
        The outermost factors of the block, `BLOCK` in number.
    rest : FactorBlock, optional
        The factors that are applied before `factors`.
    """

    __slots__ = (
        "__weakref__",
        "_motions",
        "factors",
        "hashed",
        "inner",
        "length",
        "mirrors",
        "product",
        "rest",
    )

    def __init__(self, factors: Factors, rest: "FactorBlock | None") -> None:
        # Computed now from `rest`; on demand, the recursion would be as deep as the number of
        # blocks.
        self.factors = factors
        self.rest = rest
        self.length = len(factors) + _length(rest)
        self.hashed = _hashed(factors, rest)
        self.product = _product(factors, rest)
        self.mirrors = _mirrors(factors, rest)
        self.inner = _inner(factors, rest)
        self._motions: dict[int, LatticeMotion | None] = {}

    def outer_motion(self, pitch: int) -> LatticeMotion | None:
        """Return the outermost factors that only permute, mirror and shift axes, as one motion.

        Return None if this motion does not map the lattice onto itself.
        """
        waiting: list[FactorBlock] = []
        block: FactorBlock | None = self
        while block is not None and pitch not in block._motions:
            waiting.append(block)
            block = block.rest if len(permuting_run(block.factors)) == BLOCK else None
        motion = LatticeMotion() if block is None else block._motions[pitch]
        for block in reversed(waiting):
            motion = lattice_motion(permuting_run(block.factors), pitch, motion)
            block._motions[pitch] = motion
        return motion


def common_prefix(chains: Sequence[FactorChain]) -> FactorChain:
    """Return the longest chain of outermost factors with which all given chains begin."""
    first = chains[0]
    length = min(_common_length(first, chain) for chain in chains)
    if length == len(first):
        return first
    return FactorChain.of([factor for _, factor in zip(range(length), first, strict=False)])


def _common_length(one: FactorChain, other: FactorChain) -> int:
    """Return the number of equal outermost factors of two chains."""
    if one is other:
        return len(one)
    count = 0
    for count, (a, b) in enumerate(zip(one, other, strict=False), start=1):
        if a != b:
            return count - 1
    return count


def _length(block: FactorBlock | None) -> int:
    return 0 if block is None else block.length


def _hashed(factors: Factors, rest: FactorBlock | None) -> int:
    return hash((factors, 0 if rest is None else rest.hashed))


def _product(factors: Factors, rest: FactorBlock | None) -> FloatArray:
    inner = [] if rest is None else [rest.product]
    return multiplied([factor.matrix for factor in factors] + inner)


def _mirrors(factors: Factors, rest: FactorBlock | None) -> bool:
    inner = rest is not None and rest.mirrors
    return (sum(factor.mirrors for factor in factors) + inner) % 2 == 1


def _inner(factors: Factors, rest: FactorBlock | None) -> FactorChain:
    run = len(permuting_run(factors))
    if run < len(factors):
        return FactorChain(factors[run:], rest)
    return IDENTITY_CHAIN if rest is None else rest.inner
