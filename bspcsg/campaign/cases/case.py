"""One question for two engines, as a value that is sent to another process as JSON."""

import hashlib
import json
import shlex
from collections.abc import Sequence
from dataclasses import asdict, dataclass, field
from pathlib import Path
from typing import Any

from ..._core import __version__
from ..record import Kind

#: The name of the operation that runs a whole script.
SCRIPT = "csg"

#: Digits of a key: of 2^64 keys, a million cases share two with a chance of 3e-8.
_KEY_DIGITS = 16


@dataclass(frozen=True)
class Operand:
    """One input mesh.

    Parameters
    ----------
    name : str
        A letter.
    file : str or None
        The name as given.
    sha256 : str
        Of the bytes of the file, or of `mesh` as JSON.
    pose : list of list of float or None
        Three rows of an affine map, if it is known in advance.
    mesh : dict or None
        ``vertices`` and ``faces``, if there is no file.
    """

    name: str
    file: str | None
    sha256: str
    pose: list[list[float]] | None = None
    mesh: dict[str, Any] | None = None


@dataclass(frozen=True)
class Case:
    """One operation on some operands.

    Parameters
    ----------
    name : str
        The same in every run of the campaign.
    kind : {"pair", "csg", "pose"}
    operation : str
    operands : tuple of Operand
    pose : str or None
        How the second operand is placed on the first (see `bspcsg.campaign.poses`).
    seed, number : int or None
        Of the random draw, for poses.
    command : str
        The command that runs this case alone.
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
        """Compute the key if it is not given."""
        if not self.key:
            object.__setattr__(self, "key", self._hashed())

    def _hashed(self) -> str:
        """Return the hash of everything that the answer depends on."""
        inputs = [[operand.sha256, operand.pose] for operand in self.operands]
        drawn = [self.pose, self.seed, self.number]
        text = json.dumps([__version__, self.kind, self.operation, inputs, drawn])
        return hashlib.sha256(text.encode()).hexdigest()[:_KEY_DIGITS]

    def to_dict(self) -> dict[str, Any]:
        """Return the case as JSON values."""
        return asdict(self)

    @classmethod
    def from_dict(cls, values: dict[str, Any]) -> "Case":
        """Return the case from the values of `to_dict`."""
        operands = tuple(Operand(**operand) for operand in values["operands"])
        return cls(**{**values, "operands": operands})


def command_for(files: Sequence[str], *options: str) -> str:
    """Return a command line, quoted for a shell."""
    words = ["bspcsg", "crosscheck", *files, *options]
    return " ".join(shlex.quote(word) for word in words)


def digest_of(path: Path) -> str:
    """Return the hash of a file's bytes."""
    with path.open("rb") as file:
        return hashlib.file_digest(file, "sha256").hexdigest()


def digest_of_mesh(mesh: dict[str, Any]) -> str:
    """Return the hash of a mesh given as JSON values."""
    return hashlib.sha256(json.dumps(mesh, sort_keys=True).encode()).hexdigest()
