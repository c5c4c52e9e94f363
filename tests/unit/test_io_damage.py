"""Files with a few wrong bytes are read as sound solids, or refused in one line."""

import random
from collections.abc import Iterator

import numpy as np
import pytest

from bspcsg.errors import FormatError
from bspcsg.io import FORMATS, RawMesh, decoded, encoded
from support import DEEP
from support.shapes import icosphere, joined, moved

ROUNDS = 3000 if DEEP else 60
INSERTED = (b"999999999999", b"-1", b"nan", b"1e999", b"\xff" * 4, b"\0" * 4, b" ", b"<", b'"')


def damaged(data: bytes, seed: int) -> Iterator[bytes]:
    rng = random.Random(seed)
    for _ in range(ROUNDS):
        changed = bytearray(data)
        for _ in range(rng.choice([1, 1, 2, 5, 20])):
            at = rng.randrange(len(changed) - 40)
            kind = rng.randrange(4)
            if kind == 0:
                changed[at] = rng.randrange(256)
            elif kind == 1:
                del changed[at : at + rng.randrange(1, 20)]
            elif kind == 2:
                changed[at:at] = rng.choice(INSERTED)
            else:
                changed[at : at + 4] = rng.choice([b"\xff\xff\xff\x7f", b"\xff" * 4, b"9999"])
        yield bytes(changed)


FORMS = [(name, False) for name in FORMATS] + [(name, True) for name in (".stl", ".ply")]


@pytest.mark.parametrize(("suffix", "text"), FORMS)
def test_damage(suffix: str, text: bool) -> None:
    objects = (("lid", 20), ("body", 20))
    mesh = RawMesh(*joined(icosphere(0), moved(icosphere(0), (3, 0, 0))), objects=objects)
    data = b"".join(encoded(mesh, "x", suffix, text).chunks)
    refused = 0
    for changed in damaged(data, seed=1):
        try:
            raw = decoded("x", changed, suffix)
        except FormatError as error:
            assert "\n" not in error.message and error.message.startswith("x")
            refused += 1
            continue
        assert np.isfinite(raw.vertices).all()
        assert len(raw.faces) == 0 or 0 <= raw.faces.min() <= raw.faces.max() < len(raw.vertices)
    assert refused > ROUNDS // 10
