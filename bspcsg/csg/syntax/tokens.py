"""Division of a script into tokens."""

import json
import math
import re
from typing import Any, NamedTuple, NoReturn

from .source import Script

_SPACE = r"(?:[\s\ufeff]+ | //[^\n]* | /\*.*?\*/)*+"
_BLANKS = re.compile(_SPACE, re.VERBOSE | re.DOTALL)
_WORD = re.compile(
    _SPACE
    + r"""(?:
      (?P<number>(?:\d+\.?\d*|\.\d+)(?:[eE][+-]?\d+)?(?![\w.]))
    | (?P<name>\$?[A-Za-z_]\w*)
    | (?P<string>"(?:[^"\\]++|\\.)*+")
    | (?P<mark>[\#%!*(){}\[\],;=+\-])
    )""",
    re.VERBOSE | re.DOTALL,
)

_ESCAPE = re.compile(r"\\(x[0-7][0-9a-fA-F]|u[0-9a-fA-F]{4}|U[0-9a-fA-F]{6}|.)", re.DOTALL)
_CONTROLS = {"n": "\n", "t": "\t", "r": "\r"}

#: The largest number of characters of a token that an error quotes.
_MAX_QUOTED_CHARACTERS = 24


class Token(NamedTuple):
    """A token: its kind ("number", "name", "string", "mark" or "end"), text and offset."""

    kind: str
    text: str
    offset: int

    def __str__(self) -> str:
        """Return the token in quotation marks, shortened, for error messages."""
        if self.kind == "end":
            return "the end of the file"
        text = "".join(
            c if c.isprintable() else "\N{REPLACEMENT CHARACTER}"
            for c in self.text[:_MAX_QUOTED_CHARACTERS]
        )
        return f"“{text}{'…' if len(self.text) > _MAX_QUOTED_CHARACTERS else ''}”"


class TokenReader:
    """An iterator over the tokens of a script.

    Parameters
    ----------
    script : Script
    """

    def __init__(self, script: Script) -> None:
        self._script = script
        self._position = 0

    def next(self) -> Token:
        """Return the next token and advance past it; after the last token, return an "end" token.

        Raises
        ------
        FormatError
            If the text is not a token, such as a string without its closing quote.
        """
        text = self._script.text
        match = _WORD.match(text, self._position)
        if match is not None:
            kind = match.lastgroup or ""
            self._position = match.end()
            return Token(kind, match.group(kind), match.start(kind))
        gap = _BLANKS.match(text, self._position)
        self._position = gap.end() if gap else self._position
        if self._position < len(text):
            raise _unreadable(self._script, self._position)
        return Token("end", "", self._position)

    def numbers(self, start: int, deepest: int) -> "Numbers | None":
        """Return a whole vector of numbers, or of such vectors, and advance past it.

        It is parsed as JSON, which is ten times as fast as token by token.

        Parameters
        ----------
        start : int
            The offset of the vector's opening bracket.
        deepest : int
            The largest nesting depth of vectors.

        Returns
        -------
        tuple or None
            None, without an advance, if the vector is not JSON, contains anything but numbers and
            vectors, or is nested too deep.
        """
        try:
            found, end = _JSON.raw_decode(self._script.text, start)
            numbers = _numbers(found, deepest)
        except (ValueError, RecursionError):
            return None
        self._position = end
        return numbers


#: A vector of numbers, or of such vectors.
Numbers = tuple["float | Numbers", ...]


def _no_number(text: str) -> NoReturn:
    raise ValueError(text)


_JSON = json.JSONDecoder(parse_int=float, parse_constant=_no_number)


def _numbers(found: list[Any], deepest: int) -> Numbers:
    """Return nested lists as tuples; raise `ValueError` for entries that are not finite numbers."""
    if deepest < 1:
        raise ValueError("too deep")
    kinds = set(map(type, found))
    if kinds <= {float}:
        if math.inf in found or -math.inf in found:
            raise ValueError("too large")
        return tuple(found)
    if kinds != {list}:
        raise ValueError("not a vector of numbers or vectors")
    return tuple([_numbers(one, deepest - 1) for one in found])


def _unreadable(script: Script, position: int) -> Exception:
    place = script.places().at(position)
    rest = script.text[position : position + 2]
    if rest.startswith('"'):
        return script.error(place, "this string has no closing quotation mark.")
    if rest == "/*":
        return script.error(place, "this comment has no closing */.")
    word = re.match(r"[\w.]+|.", script.text[position:], re.DOTALL)
    return script.error(
        place, f"unexpected characters {Token('mark', word.group() if word else rest, 0)}."
    )


def unquoted(text: str) -> str:
    r"""Return a quoted text without quotes, with ``\n``, ``\t``, ``\x41``, ``\u0041`` replaced."""
    return _ESCAPE.sub(_character, text[1:-1])


def _character(match: re.Match[str]) -> str:
    code = match.group(1)
    if len(code) == 1:
        return _CONTROLS.get(code, code)
    number = int(code[1:], 16)
    return chr(number) if 0 < number < 0x110000 and not 0xD800 <= number < 0xE000 else "?"


def quoted(text: str) -> str:
    """Return a text in quotes, with escapes so that parsing it gives the same text."""
    for plain, escaped in (("\\", "\\\\"), ('"', '\\"'), ("\n", "\\n"), ("\t", "\\t")):
        text = text.replace(plain, escaped)
    return '"' + text.replace("\r", "\\r") + '"'
