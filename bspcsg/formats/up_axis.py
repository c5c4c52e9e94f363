"""Rotation of meshes about the x axis by quarter turns, for formats whose upward axis is y."""

from dataclasses import replace

import numpy as np

from .raw import RawMesh


def rotated_about_x(raw: RawMesh, quarters: int) -> RawMesh:
    """Return a mesh rotated about x by quarter turns, exactly; one quarter takes y to z.

    Parameters
    ----------
    raw : RawMesh
    quarters : int
        The number of quarter turns, of any sign.
    """
    count = quarters % 4
    if count == 0:
        return raw
    x, y, z = raw.vertices.T
    moved = {1: (x, -z, y), 2: (x, -y, -z), 3: (x, z, -y)}[count]
    # Adding zero turns -0.0 into 0.0.
    vertices = np.ascontiguousarray(np.array(moved).T) + 0.0
    if raw.attributes is None:
        return replace(raw, vertices=vertices)
    quarter = np.array([[1.0, 0, 0], [0, 0, -1], [0, 1, 0]])
    said = raw.attributes.turned(np.linalg.matrix_power(quarter, count))
    return replace(raw, vertices=vertices, attributes=said)
