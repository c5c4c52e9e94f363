"""Words of a script."""

import re
from collections.abc import Iterator
from typing import NamedTuple

from .source import Script

WORD = re.compile(
    r"""
      (?P<space>[\s\ufeff]+ | //[^\n]* | /\*.*?\*/)
    | (?P<number>(?:\d+\.?\d*|\.\d+)(?:[eE][+-]?\d+)?(?![\w.]))
    | (?P<name>\$?[A-Za-z_]\w*)
    | (?P<string>"(?:[^"\\]++|\\.)*+")
    | (?P<mark>[\#%!*(){}\[\],;=+\-])
    """,
    re.VERBOSE | re.DOTALL,
)

_ESCAPE = re.compile(r"\\(x[0-7][0-9a-fA-F]|u[0-9a-fA-F]{4}|U[0-9a-fA-F]{6}|.)", re.DOTALL)
_CONTROLS = {"n": "\n", "t": "\t", "r": "\r"}

#: Most characters of an offending word that an error quotes.
_QUOTED = 24


class Token(NamedTuple):
    """A word: its kind ("number", "name", "string", "mark" or "end"), text and offset."""

    kind: str
    text: str
    offset: int

    def __str__(self) -> str:
        """Return the word as an error quotes it."""
        if self.kind == "end":
            return "the end of the file"
        text = "".join(
            c if c.isprintable() else "\N{REPLACEMENT CHARACTER}" for c in self.text[:_QUOTED]
        )
        return f"“{text}{'…' if len(self.text) > _QUOTED else ''}”"


def tokens(script: Script) -> Iterator[Token]:
    """Yield the words of a script, and an "end" after the last.

    Raises
    ------
    FormatError
        If something is no word, such as a text without its closing quote.
    """
    text, position = script.text, 0
    while position < len(text):
        match = WORD.match(text, position)
        if match is None:
            raise _unreadable(script, position)
        kind = str(match.lastgroup)
        if kind != "space":
            yield Token(kind, match.group(), position)
        position = match.end()
    yield Token("end", "", len(text))


def _unreadable(script: Script, position: int) -> Exception:
    place = script.places().at(position)
    rest = script.text[position : position + 2]
    if rest.startswith('"'):
        return script.error(place, "this text has no closing quote.")
    if rest == "/*":
        return script.error(place, "this comment has no end.")
    word = re.match(r"[\w.]+|.", script.text[position:], re.DOTALL)
    return script.error(place, f"cannot read {Token('mark', word.group() if word else rest, 0)}.")


def unquoted(text: str) -> str:
    r"""Return what a quoted text stands for: ``\n``, ``\t``, ``\x41``, ``\u0041`` and so on."""
    return _ESCAPE.sub(_character, text[1:-1])


def _character(match: re.Match[str]) -> str:
    code = match.group(1)
    if len(code) == 1:
        return _CONTROLS.get(code, code)
    number = int(code[1:], 16)
    return chr(number) if 0 < number < 0x110000 and not 0xD800 <= number < 0xE000 else "?"


def quoted(text: str) -> str:
    """Return a text in quotes, so that reading it gives the same again."""
    for plain, escaped in (("\\", "\\\\"), ('"', '\\"'), ("\n", "\\n"), ("\t", "\\t")):
        text = text.replace(plain, escaped)
    return '"' + text.replace("\r", "\\r") + '"'
