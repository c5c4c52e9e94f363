"""The content of pickles: bytes with a checksum, checked completely before use."""

import base64
import pickle
import random
import zlib

import pytest

import bspcsg as b
from bspcsg import _core, bsp
from bspcsg.errors import core_errors

HEAD, CHECKSUM = 8, 4


def solid() -> b.Solid:
    ball = b.sphere(2, segments=12)
    return (ball - b.box((1, 2, 3)).rotate(30)) & b.half_space((1, 2, 3), 1)


def forged(data: bytes, rng: random.Random) -> bytes:
    """Return a snapshot with some bytes of the payload changed, and a matching checksum."""
    payload = bytearray(data[:-CHECKSUM])
    for _ in range(rng.choice([1, 1, 2, 3])):
        place = rng.randrange(HEAD, len(payload))
        payload[place] = (payload[place] + rng.choice([1, 2, 64, 128, 255])) % 256
    return bytes(payload) + zlib.crc32(payload).to_bytes(CHECKSUM, "little")


def loaded(data: bytes) -> b.Solid:
    from bspcsg.solid.leaf import TreeLeaf
    from bspcsg.solid.solid import from_leaf

    with core_errors():
        return from_leaf(TreeLeaf(_core.Tree.load(data)))


#: Two cubes that touch in a corner, as version 2 of the bytes has them, compressed, in base 85.
TOUCHING_CUBES = (
    "c-l)UE=Vp;FJ=;CU}R$8U;u%J71wsMLrDmQAW&qHgwgmAgNOzn?D6x_#nEYE&BLV+Q=W%`k(q&+iG_`wg`Jgwg_VJok"
    "%^g|iJgssiH(7cg^`t=k)4@=fdkFoNW_ITpZU;P2rh!asRK<3su%};k70P!0Y4vI9GxcCJY4!P<%tVmCI$weLMCPwRyK"
    "AHPA+anR4&8BOpiJMT4#&1"
)


def test_bytes_of_the_version_before_are_read() -> None:
    old = zlib.decompress(base64.b85decode(TOUCHING_CUBES))
    cubes = b.cube(1) | b.cube(1).translate(1, 1, 1)
    again = loaded(old)
    assert again.equals(cubes)
    assert old[HEAD - 1] == 2
    assert again.tree.dump()[HEAD - 1] == 3
    newer = bytearray(old[:-CHECKSUM])
    newer[HEAD - 1] = 4
    with pytest.raises(b.FormatError, match="newer"):
        loaded(bytes(newer) + zlib.crc32(newer).to_bytes(CHECKSUM, "little"))


# Found: pickles contained meshes and attributes of inputs that contribute no face to the solid (a
# unit cube within a sphere: 2.4 MB), and such meshes prevented the solid from being refined.
def test_what_bounds_nothing_is_not_in_the_bytes() -> None:
    inside = b.cube(1).tagged(part=1) & b.sphere(5, segments=100).tagged(part=2)
    data = pickle.dumps(inside)
    assert len(data) < 2 * len(pickle.dumps(b.cube(1).tagged(part=1)))
    copy = pickle.loads(data)
    assert copy.equals(b.cube(1)) and copy.tagged(part=3).volume == 1
    assert set(copy.to_mesh().face_attributes["part"].tolist()) == {1}


def test_what_bounds_nothing_does_not_keep_a_solid_in_its_place() -> None:
    inside = (b.cube(1) & b.cube(9e6)).tree
    refined = inside.refined(inside.pitch - 3)
    assert refined.volume6_exact(100) == inside.volume6_exact(100)


# Found: damaged snapshots were loaded, and panicked later.
def test_any_damaged_byte_shows() -> None:
    data = solid().tree.dump()
    assert loaded(data).equals(solid())
    rng = random.Random(1)
    for place in [*range(HEAD), *rng.sample(range(len(data)), 200)]:
        bad = bytearray(data)
        bad[place] ^= 1 << rng.randrange(8)
        with pytest.raises(b.FormatError) as caught:
            loaded(bytes(bad))
        assert caught.value.code == "bad_snapshot"
    for length in [0, 1, 7, 8, 11, 12, len(data) - 1]:
        with pytest.raises(b.FormatError):
            loaded(data[:length])
    with pytest.raises(b.FormatError):
        loaded(data + b"\0")


def test_forged_bytes_are_refused_or_make_a_solid() -> None:
    data, tool, rng = solid().tree.dump(), b.box((1, 1, 4)), random.Random(2)
    taken = 0
    for _ in range(400):
        try:
            body = loaded(forged(data, rng))
            taken += 1
            assert isinstance(body.volume, float)
            body.to_mesh()
            (body | tool).to_mesh()
        except b.FormatError as error:
            assert error.code == "bad_snapshot"
        except b.UnboundedError:
            pass
    assert taken > 0


def test_snapshots_of_the_first_version_are_read() -> None:
    data = solid().tree.dump()
    first = b"\1" + data[HEAD:-CHECKSUM]
    assert loaded(first).equals(solid())
    with pytest.raises(b.FormatError):
        loaded(first[:-1])


def test_a_later_version_is_named() -> None:
    data = bytearray(solid().tree.dump())
    data[HEAD - 1] = 9
    with pytest.raises(b.FormatError, match="version 9 is not known"):
        loaded(bytes(data))


def test_a_snapshot_of_another_kind_is_refused() -> None:
    region = bsp.Region.circle(2) - bsp.Region.rectangle(1)
    with core_errors(), pytest.raises(_core.CoreError, match="do not start with its header"):
        _core.Tree.load(region._tree.dump())
    with core_errors(), pytest.raises(_core.CoreError, match="do not start with its header"):
        _core.ObjectTree.load(solid().tree.dump())


@pytest.mark.parametrize("dimension", [1, 2, 3])
def test_sets_are_refused_or_make_a_set(dimension: int) -> None:
    sets: dict[int, bsp.Intervals | bsp.Region | bsp.ObjectTree] = {
        1: bsp.Intervals([(0, 2), (3, 5.5)]),
        2: bsp.Region.circle(2, 9) - bsp.Region.rectangle(1),
        3: bsp.ObjectTree.from_mesh(b.box((1, 2, 3)) - b.box((1, 1, 1)).rotate(30)),
    }
    made = sets[dimension]
    data, rng = made._tree.dump(), random.Random(3)
    again = _core.ObjectTree.load(data)
    assert again.equals(made._tree)
    assert _core.ObjectTree.load(b"\1" + data[HEAD:-CHECKSUM]).equals(made._tree)
    damaged = bytearray(data)
    damaged[HEAD + 3] ^= 4
    with pytest.raises(_core.CoreError, match="checksum"):
        _core.ObjectTree.load(bytes(damaged))
    for _ in range(400):
        try:
            other = _core.ObjectTree.load(forged(data, rng))
            other.stats()
            other.boundary()
            if other.pitch == made._tree.pitch and other.dimension == dimension:
                other.merge(made._tree, "union").measure()
        except _core.CoreError as error:
            assert error.code in ("bad_snapshot", "unbounded"), error.message
