"""Files that are either complete or not there."""

import contextlib
import io
import os
from collections.abc import Callable, Iterable
from pathlib import Path
from typing import BinaryIO, TypeAlias

from ..errors import FormatError
from ..parameters import file_path

#: Takes the file that was written, and raises an error if it is not what it should be.
Proof: TypeAlias = Callable[[BinaryIO], None]


def write_file(
    path: str | os.PathLike[str], chunks: Iterable[bytes], prove: Proof | None = None
) -> None:
    """Write the chunks to a new file beside `path`, then give it that name in one step.

    Whatever goes wrong, a file that was there before stays as it was. What goes to the null device
    is made and proved, and kept nowhere.

    Parameters
    ----------
    path : str or path
    chunks : iterable of bytes
    prove : callable, optional
        Is given the new file, to be read from its beginning, before that gets its name.

    Raises
    ------
    FormatError
        If the file cannot be written; code ``"unwritable"``; and what `prove` raises.
    """
    name = file_path(path)
    if name == os.devnull:
        _drop(chunks, prove)
        return
    # A link stays a link: what it points to is replaced.
    target = Path(os.path.realpath(name))
    try:
        _check_target(target)
        part = target.with_name(f".{target.name}.{os.urandom(4).hex()}.part")
        _write_new(part, target, chunks, prove)
    except OSError as error:
        reason = error.strerror or type(error).__name__
        raise FormatError(f"{name}: cannot write this file: {reason}.", "unwritable") from error


def _drop(chunks: Iterable[bytes], prove: Proof | None) -> None:
    """Make what would be written, and prove it."""
    data = b"".join(chunks)
    if prove is not None:
        prove(io.BytesIO(data))


def _check_target(target: Path) -> None:
    if target.is_dir():
        raise IsADirectoryError(21, "it is a folder")
    if target.exists() and not target.is_file():
        raise OSError(22, "it is no ordinary file")
    if not target.parent.is_dir():
        raise FileNotFoundError(2, f"there is no folder {target.parent}")


def _write_new(part: Path, target: Path, chunks: Iterable[bytes], prove: Proof | None) -> None:
    # Opened like any new file, so that the user's mask decides about its mode.
    handle = os.open(part, os.O_WRONLY | os.O_CREAT | os.O_EXCL | getattr(os, "O_BINARY", 0), 0o666)
    try:
        with open(handle, "wb", buffering=1 << 20) as stream:
            stream.writelines(chunks)
            stream.flush()
            os.fsync(stream.fileno())
        if prove is not None:
            with part.open("rb") as written:
                prove(written)
        if target.exists():
            part.chmod(target.stat().st_mode & 0o7777)
        os.replace(part, target)
    except BaseException:
        with contextlib.suppress(OSError):
            part.unlink()
        raise
