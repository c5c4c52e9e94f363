"""Panoramas: the view of a viewer in the plane, and refusals."""

import io
from typing import Any

import numpy as np
import numpy.typing as npt
import pytest
from PIL import Image

from bspcsg import InvalidMeshError, bsp

SEGMENTS = [[[-2, 3], [2, 3]], [[-1, 1], [1, 1]], [[-1, -2], [1, -2]]]


def strip(picture: bsp.Picture) -> npt.NDArray[np.uint8]:
    row: npt.NDArray[np.uint8] = np.asarray(Image.open(io.BytesIO(picture.png)))[-30]
    return row


def test_panorama_around_an_eye() -> None:
    colors = ["#ff0000", "#00ff00", "#0000ff"]
    seen = strip(bsp.panorama(SEGMENTS, eye=(0, 0), size=(384, 300), colors=colors))
    # 360 pixels all around, a degree each, with +y in the middle and an empty border of 12.
    assert seen[192].tolist() == [0, 255, 0]
    assert [seen[192 + k].tolist() for k in (-42, 42)] == [[0, 255, 0]] * 2
    # The red segment reaches to 33.7 degrees: all of it is behind the green one.
    assert [255, 0, 0] not in seen.tolist()
    assert [seen[k].tolist() for k in (20, 364)] == [[0, 0, 255]] * 2
    assert seen[100].tolist() == [255, 255, 255]


def test_panorama_along_a_direction() -> None:
    colors = ["#ff0000", "#00ff00", "#0000ff"]
    seen = strip(bsp.panorama(SEGMENTS, direction=(0, 1), size=(384, 300), colors=colors))
    assert seen[20].tolist() == [255, 0, 0] == seen[360].tolist()
    assert seen[192].tolist() == [0, 0, 255]
    back = strip(bsp.panorama(SEGMENTS, direction=(0, -1), size=(384, 300), colors=colors))
    assert back[192].tolist() == [255, 0, 0]


def test_a_segment_in_line_with_the_eye_is_not_seen() -> None:
    seen = strip(bsp.panorama([[[1, 0], [2, 0]]], eye=(0, 0), size=(384, 300)))
    assert (seen[14:370] == 255).all()


def test_an_empty_panorama() -> None:
    viewpoints: list[dict[str, Any]] = [{"eye": (1, 2)}, {"direction": (1, 2)}]
    for viewpoint in viewpoints:
        picture = bsp.panorama(np.zeros((0, 2, 2)), **viewpoint)
        assert picture.painting.source.tolist() == [-1]


@pytest.mark.parametrize(
    ("change", "text"),
    [
        ({"eye": (0, 0), "direction": (0, 1)}, "exactly one"),
        ({}, "exactly one"),
        ({"direction": (0, 0)}, "direction"),
        ({"eye": (0, 0, 0)}, "eye"),
        ({"eye": (0, 0), "size": (63, 100)}, "64"),
        ({"eye": (0, 0), "samples": 0.5}, "samples"),
    ],
)
def test_refused_panoramas(change: dict[str, Any], text: str) -> None:
    with pytest.raises(InvalidMeshError, match=text):
        bsp.panorama(SEGMENTS, **change)
    with pytest.raises(InvalidMeshError, match="picture"):
        bsp.panorama(bsp.PartitionTree([[[0, 0, 0], [2, 0, 0], [0, 2, 0]]]), eye=(0, 0))
