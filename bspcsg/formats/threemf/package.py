"""The parts of a 3MF package, a ZIP archive of XML files.

The bytes to unpack are limited, and XML document types are refused, so that a small file cannot
grow without bound.
"""

import io
import posixpath
import re
import zipfile
import zlib
from collections.abc import Iterator
from contextlib import contextmanager

from ...errors import BspcsgError, FormatError
from ..source import Source
from .part import ModelPart, PartReader, Start, parse_xml
from .write import NOTHING

#: The largest number of parts in an archive; its directory then takes some 16 MB of memory. The
#: largest projects of slicers have hundreds of parts.
_MAX_PARTS = 1 << 14

#: All parts together may unpack to this many times the bytes of the archive. The XML of meshes is
#: compressed to a fifth, XML that repeats one small mesh to a 13th, and a single repeated letter to
#: a thousandth.
_MAX_UNPACKING_RATIO = 64

#: All parts together may always unpack to this number of bytes, even in a small archive.
_MIN_BYTE_LIMIT = 1 << 26

#: All parts together may never unpack to more bytes than this: 2 GiB, some 20 million triangles.
_MAX_BYTE_LIMIT = 1 << 31

#: The number of bytes that are unpacked at a time.
_CHUNK_BYTES = 1 << 20

#: The bytes that begin the entry of a part in an archive's directory.
_ENTRY = b"PK\x01\x02"

#: The errors that the standard library raises on damaged archives.
_DAMAGES = (
    zipfile.BadZipFile,
    NotImplementedError,
    RuntimeError,
    EOFError,
    zlib.error,
    OSError,
    ValueError,
)

_MODEL = "http://schemas.microsoft.com/3dmanufacturing/2013/01/3dmodel"


class Package:
    """The parts of one 3MF archive, each parsed at most once.

    Parameters
    ----------
    source : Source
    archive : ZipFile
        The open archive with the bytes of `source`.
    """

    def __init__(self, source: Source, archive: zipfile.ZipFile) -> None:
        self.source = source
        self.parts: dict[str, ModelPart] = {}
        self._archive = archive
        self._pictures: dict[str, bytes] = {}
        self._entries = {entry.filename.lower(): entry for entry in archive.infolist()}
        self._left = min(
            max(_MAX_UNPACKING_RATIO * len(source.data), _MIN_BYTE_LIMIT), _MAX_BYTE_LIMIT
        )

    def root(self) -> str:
        """Return the name of the main model part, which the package's relationships name."""
        targets: list[str] = []

        def start(tag: str, attributes: dict[str, str]) -> None:
            if tag.endswith("Relationship") and attributes.get("Type") == _MODEL:
                targets.append(_part_name(attributes.get("Target", "")))

        if "_rels/.rels" in self._archive.namelist():
            self.parse("_rels/.rels", start)
        return targets[0] if targets else "3D/3dmodel.model"

    def is_empty_set(self, root: str) -> bool:
        """Say whether the part `root` equals what this package writes for the empty set."""
        entry = self._entries.get(root.lower())
        if entry is None or entry.file_size != len(NOTHING):
            return False
        with _damage_as_error(self.source), self._archive.open(entry) as stream:
            return stream.read(len(NOTHING) + 1) == NOTHING

    def named(self, pattern: re.Pattern[str]) -> list[str]:
        """Return the lower-case names of the parts whose whole name matches a pattern."""
        return [name for name in self._entries if pattern.fullmatch(name)]

    def parse(self, name: str, start: Start) -> None:
        """Call `start` with tag and attributes of each XML element of a part."""
        parse_xml(*self._opened(name), start)

    def part(self, name: str) -> ModelPart:
        """Return a model part; it is parsed on the first call."""
        if name not in self.parts:
            reader = PartReader(*self._opened(name), _part_name)
            self.parts[name] = reader.read()
        return self.parts[name]

    def picture(self, name: str) -> bytes:
        """Return the bytes of a picture's part, unpacked on the first call.

        Return no bytes if there is no such part.
        """
        if name.lower() not in self._entries:
            return b""
        if name not in self._pictures:
            self._pictures[name] = b"".join(self._opened(name)[1])
        return self._pictures[name]

    def _opened(self, name: str) -> tuple[Source, Iterator[bytes]]:
        """Return a source without data, for errors that name a part, and the part's chunks."""
        entry = self._entries.get(name.lower())
        if entry is None:
            raise self.source.error(
                f"the archive is incomplete: it has no part {name}.", "truncated"
            )
        if entry.file_size > self._left:
            raise self._too_large(name)
        return Source(f"{self.source.name}/{name}", b""), self._unpacked(entry)

    def _unpacked(self, entry: zipfile.ZipInfo) -> Iterator[bytes]:
        """Yield the bytes of a part in chunks; too many bytes raise a `FormatError`."""
        with _damage_as_error(self.source), self._archive.open(entry) as stream:
            while chunk := stream.read(_CHUNK_BYTES):
                self._left -= len(chunk)
                if self._left < 0:
                    raise self._too_large(entry.filename)
                yield chunk

    def _too_large(self, name: str) -> FormatError:
        message = (
            f"the part {name} unpacks to too much data: all parts together may have at most"
            f" {_MAX_UNPACKING_RATIO} times the bytes of the archive, and"
            f" {_MAX_BYTE_LIMIT >> 30} GiB."
        )
        return self.source.error(message, "too_large")


@contextmanager
def opened(source: Source) -> Iterator[Package]:
    """Open a 3MF package in a `with` statement; a damaged part raises an error when it is read.

    Raises
    ------
    FormatError
        If the archive is damaged or has too many parts.
    """
    if source.data.count(_ENTRY) > _MAX_PARTS:
        message = (
            f"the archive has more than {_MAX_PARTS:,} parts, the largest number that is read."
        )
        raise source.error(message, "too_large")
    with _damage_as_error(source):
        archive = zipfile.ZipFile(io.BytesIO(source.data))
    with archive:
        yield Package(source, archive)


@contextmanager
def _damage_as_error(source: Source) -> Iterator[None]:
    """Turn exceptions of the `zipfile` module into a `FormatError`: the archive is damaged."""
    try:
        yield
    except BspcsgError:
        raise
    except _DAMAGES as error:
        message = f"the ZIP archive is damaged or incomplete: {error}."
        raise source.error(message, "truncated") from error


def _part_name(target: str) -> str:
    return posixpath.normpath(target).lstrip("/")
