"""Build GLB files as other programs write them."""

import json
from typing import Any

import numpy as np
import numpy.typing as npt

from corpus.broken import glb_of

Numbers = npt.NDArray[Any]

#: Components of glTF by the types of arrays.
COMPONENTS = {"i1": 5120, "u1": 5121, "i2": 5122, "u2": 5123, "u4": 5125, "f4": 5126}
TYPES = {1: "SCALAR", 2: "VEC2", 3: "VEC3", 4: "VEC4"}


class Scene:
    """A GLB file under construction, with one mesh at one node.

    Parameters
    ----------
    positions : (n, 3) array
        Positions of vertices, in the type in which they are stored.
    faces : (m, 3) int array
        Triangles over at most 65 536 vertices.
    stride : int
        The number of bytes from one position to the next; 0 for no gaps.
    accessor
        Further properties of the accessor of positions.
    """

    def __init__(
        self, positions: Numbers, faces: Numbers, stride: int = 0, **accessor: Any
    ) -> None:
        self.data = b""
        self.tree: dict[str, Any] = {"asset": {"version": "2.0"}, "bufferViews": []}
        self.tree["accessors"] = []
        attributes = {"POSITION": self.add(positions, stride, **accessor)}
        self.primitive: dict[str, Any] = {
            "attributes": attributes,
            "indices": self.add(np.asarray(faces, "u2").reshape(-1, 1)),
        }
        self.node: dict[str, Any] = {"mesh": 0, "name": "part"}
        self.tree |= {"meshes": [{"primitives": [self.primitive]}], "nodes": [self.node]}

    def view(self, values: Numbers, stride: int = 0) -> int:
        """Add a buffer view with rows of numbers, and return its index."""
        self.data += bytes(-len(self.data) % 4)
        told: dict[str, Any] = {"buffer": 0, "byteOffset": len(self.data)}
        data = values.tobytes()
        if stride:
            rows = np.zeros((len(values), stride), np.uint8)
            rows[:, : values.itemsize * values.shape[1]] = values.view(np.uint8)
            told["byteStride"], data = stride, rows.tobytes()
        self.data += data
        self.tree["bufferViews"].append(told | {"byteLength": len(data)})
        return len(self.tree["bufferViews"]) - 1

    def add(self, values: Numbers, stride: int = 0, **further: Any) -> int:
        """Add an accessor with rows of numbers, and return its index."""
        values = np.ascontiguousarray(values)
        self.tree["accessors"].append(
            {
                "bufferView": self.view(values, stride),
                "componentType": COMPONENTS[values.dtype.str[1:]],
                "count": len(values),
                "type": TYPES[values.shape[1]],
                **further,
            }
        )
        return len(self.tree["accessors"]) - 1

    def replace(self, accessor: int, places: list[int], values: Numbers) -> dict[str, Any]:
        """Make an accessor sparse, with values at these indices; return its sparse entry."""
        indices = np.array(places, "u1").reshape(-1, 1)
        sparse = {
            "count": len(places),
            "indices": {"bufferView": self.view(indices), "componentType": 5121},
            "values": {"bufferView": self.view(np.ascontiguousarray(values))},
        }
        self.tree["accessors"][accessor]["sparse"] = sparse
        return sparse

    def blur(self, accessor: int, places: list[int]) -> None:
        """Overwrite the elements at these indices in the buffer view of an accessor."""
        view = self.tree["bufferViews"][self.tree["accessors"][accessor]["bufferView"]]
        size = view.get("byteStride", 12)
        for place in places:
            at = view["byteOffset"] + size * place
            self.data = self.data[:at] + b"\x7f" * size + self.data[at + size :]

    def place(self, **given: Numbers) -> None:
        """Add instances of the mesh, with the extension EXT_mesh_gpu_instancing."""
        told = {key: self.add(values, normalized=True) for key, values in given.items()}
        self.node["extensions"] = {"EXT_mesh_gpu_instancing": {"attributes": told}}
        self.tree["extensionsRequired"] = ["EXT_mesh_gpu_instancing"]

    def bytes(self) -> bytes:
        """Return the bytes of the GLB file."""
        self.tree["buffers"] = [{"byteLength": len(self.data)}]
        return glb_of(json.dumps(self.tree).encode(), self.data + bytes(-len(self.data) % 4))
