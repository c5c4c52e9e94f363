"""A small renderer for the examples: meshes to a PNG, with numpy and the standard library."""

import struct
import zlib
from collections.abc import Sequence
from pathlib import Path

import numpy as np
import numpy.typing as npt

Array = npt.NDArray[np.float64]
COLOURS = np.array([(222, 196, 160), (96, 150, 196), (150, 190, 120), (206, 130, 110)]) / 255
_LIGHT = np.array([-0.55, 0.65, 0.53])


def view(turn: float = 30, tilt: float = 20) -> Array:
    """Return a rotation that looks from the front, turned about y and tilted about x (degrees)."""
    a, c = np.radians([turn, tilt])
    about_y = np.array([(np.cos(a), 0, np.sin(a)), (0, 1, 0), (-np.sin(a), 0, np.cos(a))])
    about_x = np.array([(1, 0, 0), (0, np.cos(c), -np.sin(c)), (0, np.sin(c), np.cos(c))])
    return about_x @ about_y


def shade(
    vertices: Array, faces: Array, source: Array, pose: Array, size: int, window: Array
) -> Array:
    """Return a (size, size, 4) picture: flat shading, one colour for each source mesh.

    `window` is the lowest corner and the width of what is seen, in turned coordinates.
    """
    points = (vertices @ pose.T - [*window[:2], 0]) / window[2] * size
    corners = points[faces]
    normals = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    lengths = np.linalg.norm(normals, axis=1)
    light = 0.4 + 0.6 * np.clip(normals @ _LIGHT / np.where(lengths > 0, lengths, 1), 0, 1)
    colours = COLOURS[source % len(COLOURS)] * light[:, None]
    picture, depth = np.zeros((size, size, 4)), np.full((size, size), -np.inf)
    for k in np.flatnonzero(normals[:, 2] > 0):
        _fill(picture, depth, corners[k], colours[k])
    return picture[::-1]


def _fill(picture: Array, depth: Array, corners: Array, colour: Array) -> None:
    size = len(depth)
    low = np.clip(np.floor(corners[:, :2].min(axis=0)).astype(int), 0, size)
    high = np.clip(np.ceil(corners[:, :2].max(axis=0)).astype(int) + 1, 0, size)
    x, y = np.meshgrid(np.arange(low[0], high[0]) + 0.5, np.arange(low[1], high[1]) + 0.5)
    (ax, ay, az), (bx, by, bz), (cx, cy, cz) = corners
    area = (bx - ax) * (cy - ay) - (by - ay) * (cx - ax)
    u = ((x - ax) * (cy - ay) - (y - ay) * (cx - ax)) / area
    v = ((bx - ax) * (y - ay) - (by - ay) * (x - ax)) / area
    z = az + u * (bz - az) + v * (cz - az)
    tile = depth[low[1] : high[1], low[0] : high[0]]
    seen = (u >= 0) & (v >= 0) & (u + v <= 1) & (z > tile)
    tile[seen] = z[seen]
    picture[low[1] : high[1], low[0] : high[0]][seen] = [*colour, 1]


def row(meshes: Sequence[tuple[Array, Array, Array]], pose: Array, size: int = 420) -> Array:
    """Return several meshes (vertices, faces, colour of each face) side by side, at one scale."""
    seen = np.concatenate([vertices for vertices, _, _ in meshes]) @ pose.T
    low, high = seen.min(axis=0)[:2], seen.max(axis=0)[:2]
    width = float((high - low).max()) * 1.06
    corner = (low + high) / 2 - width / 2
    window = np.array([*corner, width])
    # Four rays a pixel, averaged.
    tiles = [shade(v, f, source, pose, 2 * size, window) for v, f, source in meshes]
    fine = np.concatenate(tiles, axis=1)
    return fine.reshape(size, 2, -1, 2, 4).mean(axis=(1, 3))


def save_png(picture: Array, path: Path) -> None:
    """Write a (height, width, 4) picture with values from 0 to 1."""
    height, width = picture.shape[:2]
    cover = picture[:, :, 3:]
    colours = np.where(cover > 0, picture[:, :, :3] / np.maximum(cover, 1e-9), 0)
    pixels = np.concatenate([colours, cover], axis=2)
    rows = np.zeros((height, 1 + 4 * width), dtype=np.uint8)
    rows[:, 1:] = np.round(pixels * 255).astype(np.uint8).reshape(height, -1)
    header = struct.pack(">IIBBBBB", width, height, 8, 6, 0, 0, 0)
    chunks = [(b"IHDR", header), (b"IDAT", zlib.compress(rows.tobytes(), 9)), (b"IEND", b"")]
    packed = [
        struct.pack(">I", len(data)) + name + data + struct.pack(">I", zlib.crc32(name + data))
        for name, data in chunks
    ]
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_bytes(b"\x89PNG\r\n\x1a\n" + b"".join(packed))
