"""`Case`: one set operation on given operands, as a value that can be sent as JSON."""

import hashlib
import json
import shlex
from collections.abc import Sequence
from dataclasses import asdict, dataclass, field
from pathlib import Path
from typing import Any

from ..._core import __version__
from ..record import Kind

#: The name of the operation that evaluates a whole script.
SCRIPT = "csg"

#: The number of hexadecimal digits of a key: with 2^64 keys, two of a million cases have equal keys
#: with probability 3e-8.
_KEY_DIGITS = 16


@dataclass(frozen=True)
class Operand:
    """One input mesh of a case.

    Parameters
    ----------
    name : str
        The letter of the operand: "a", "b", ….
    file : str or None
        The path of the file, as given.
    sha256 : str
        The SHA-256 hash of the bytes of the file, or of `mesh` as JSON.
    pose : list of list of float or None
        The three rows of the affine map that places the mesh, if it is known in advance.
    mesh : dict or None
        The mesh as ``vertices`` and ``faces``, if there is no file.
    """

    name: str
    file: str | None
    sha256: str
    pose: list[list[float]] | None = None
    mesh: dict[str, Any] | None = None


@dataclass(frozen=True)
class Case:
    """One set operation on given operands, or one script.

    Parameters
    ----------
    name : str
        The name, equal in every run of the campaign.
    kind : {"pair", "csg", "pose"}
    operation : str
    operands : tuple of Operand
    pose : str or None
        The name of the pose of the second operand relative to the first (see
        `bspcsg.campaign.cases.poses`).
    seed, number : int or None
        The seed and the number of the random draw, for poses.
    command : str
        The command line that runs only this case.
    """

    name: str
    kind: Kind
    operation: str
    operands: tuple[Operand, ...]
    pose: str | None = None
    seed: int | None = None
    number: int | None = None
    command: str = ""
    key: str = field(default="", compare=False)

    def __post_init__(self) -> None:
        """Set the key to a hash of the case if no key is given."""
        if not self.key:
            object.__setattr__(self, "key", self._hashed())

    def _hashed(self) -> str:
        """Return the hash of everything that the case's result depends on."""
        inputs = [[operand.sha256, operand.pose] for operand in self.operands]
        drawn = [self.pose, self.seed, self.number]
        text = json.dumps([__version__, self.kind, self.operation, inputs, drawn])
        return hashlib.sha256(text.encode()).hexdigest()[:_KEY_DIGITS]

    def to_dict(self) -> dict[str, Any]:
        """Return the case as JSON values."""
        return asdict(self)

    @classmethod
    def from_dict(cls, values: dict[str, Any]) -> "Case":
        """Return the case whose `to_dict` returned these values."""
        operands = tuple(Operand(**operand) for operand in values["operands"])
        return cls(**{**values, "operands": operands})


def command_for(files: Sequence[str], *options: str) -> str:
    """Return the ``bspcsg crosscheck`` command line for files and options, quoted for a shell."""
    words = ["bspcsg", "crosscheck", *files, *options]
    return " ".join(shlex.quote(word) for word in words)


def digest_of(path: Path) -> str:
    """Return the SHA-256 hash of a file's bytes, in hexadecimal."""
    with path.open("rb") as file:
        return hashlib.file_digest(file, "sha256").hexdigest()


def digest_of_mesh(mesh: dict[str, Any]) -> str:
    """Return the SHA-256 hash of a mesh given as JSON values, in hexadecimal."""
    return hashlib.sha256(json.dumps(mesh, sort_keys=True).encode()).hexdigest()
