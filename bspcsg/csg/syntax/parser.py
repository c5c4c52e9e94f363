"""Parser of scripts to trees.

The grammar is that of `.csg` files, which OpenSCAD writes for an evaluated model::

    file  = { node | ";" } ;
    node  = { "#" | "%" | "!" | "*" } , name , "(" , [ arg , { "," , arg } ] , ")" , body ;
    body  = ";" | "{" , { node | ";" } , "}" | node ;
    arg   = [ name , "=" ] , value ;
    value = number | text | "true" | "false" | "undef" | "inf" | "nan" | ( "-" | "+" ) , value
          | "[" , [ value , { "," , value } ] , "]" ;

Nodes may be nested to any depth, since the parser has its own stack.
"""

import math
from dataclasses import dataclass, field
from pathlib import Path

from ...errors import FormatError
from ...parameters import file_path, text_value
from .source import Script
from .tokens import Token, TokenReader, unquoted
from .tree import KEYWORDS, MAX_VECTOR_DEPTH, Argument, CsgTree, Node, Place, Value


def parse(text: str, name: str = "<csg>", folder: str | Path | None = None) -> CsgTree:
    """Parse the text of a script, and return its tree.

    Parameters
    ----------
    text : str
        The script, in OpenSCAD's `.csg` language.
    name : str
        The script's name in errors.
    folder : path, optional
        The folder of the files that the script imports; by default the current folder.

    Raises
    ------
    FormatError
        If the text is not a `.csg` script. The message begins with name, line and column; `where`
        contains line and column.

    Examples
    --------
    >>> from bspcsg import csg as scripts
    >>> scripts.parse("sphere(r = 2);").nodes[0].name
    'sphere'
    """
    place = Path() if folder is None else Path(file_path(folder, "folder"))
    script = Script(text_value(text, "text"), text_value(name, "name"), place)
    return CsgTree(_Parser(script).nodes(), name, script.folder)


def value_of(text: str) -> Value:
    """Parse a value of the script language, such as ``1.5``, ``"text"`` or ``[1, 2]``.

    Raises
    ------
    FormatError
        If the text is not a value.
    """
    return _Parser(Script(text_value(text, "text"), "<value>")).value()


@dataclass
class _Frame:
    """A node whose children are still being parsed."""

    name: str
    arguments: tuple[Argument, ...]
    modifiers: str
    place: Place
    braced: bool
    children: list[Node] = field(default_factory=list)

    def node(self) -> Node:
        return Node(self.name, self.arguments, tuple(self.children), self.modifiers, self.place)


class _Parser:
    def __init__(self, script: Script) -> None:
        self._script = script
        self._places = script.places()
        self._words = TokenReader(script)
        self._next = self._words.next()

    def value(self) -> Value:
        found = self._value()
        if self._next.kind != "end":
            raise self._error(f"expected the end after the value, found {self._next}.")
        return found

    def nodes(self) -> tuple[Node, ...]:
        top: list[Node] = []
        open_frames: list[_Frame] = []
        while self._next.kind != "end" or open_frames:
            if self._next.text == "}" and open_frames and open_frames[-1].braced:
                self._take()
                self._close(open_frames, top)
            elif self._next.text == ";" and not (open_frames and not open_frames[-1].braced):
                self._take()
            else:
                self._open(open_frames, top)
        return tuple(top)

    def _open(self, open_frames: list[_Frame], top: list[Node]) -> None:
        """Read a node up to its body, and close it if it has no children."""
        if self._next.kind == "end":
            frame = open_frames[-1]
            missing = "“}”" if frame.braced else "“;”"
            message = f"{frame.name}() is not closed: {missing} is missing at the end of the file."
            raise self._script.error(frame.place, message)
        frame = self._head()
        open_frames.append(frame)
        if self._next.text == ";" and self._next.kind == "mark":
            self._take()
            self._close(open_frames, top)
        elif self._next.text == "{":
            self._take()
            frame.braced = True

    def _close(self, open_frames: list[_Frame], top: list[Node]) -> None:
        """Add the innermost open node to its parent; also close parents without braces."""
        while True:
            node = open_frames.pop().node()
            (open_frames[-1].children if open_frames else top).append(node)
            if not open_frames or open_frames[-1].braced:
                return

    def _head(self) -> _Frame:
        modifiers = ""
        while self._next.text in ("#", "%", "!", "*"):
            modifiers += self._take().text
        word = self._next
        if word.kind != "name":
            raise self._error(f"expected a node, found {word}.")
        self._take()
        if self._next.text == "=" and self._next.kind == "mark":
            message = (
                "a .csg file has no variables; this looks like OpenSCAD's own language."
                " Convert it: openscad -o model.csg model.scad"
            )
            raise self._error(message, word)
        arguments = self._arguments(word)
        place = self._places.at(word.offset)
        return _Frame(word.text, arguments, modifiers, place, braced=False)

    def _arguments(self, node: Token) -> tuple[Argument, ...]:
        self._expect("(", f"after {node.text}")
        found: list[Argument] = []
        while self._next.text != ")" or self._next.kind != "mark":
            found.append(self._argument())
            if self._next.text == ",":
                self._take()
            elif self._next.text != ")":
                raise self._error(f"expected “,” or “)”, found {self._next}.")
        self._take()
        return tuple(found)

    def _argument(self) -> Argument:
        if self._next.kind != "name" or self._next.text in KEYWORDS:
            return Argument(None, self._value())
        name = self._take().text
        self._expect("=", f"after {name}")
        return Argument(name, self._value())

    def _value(self) -> Value:
        """Read a value, which may be a vector of vectors up to `MAX_VECTOR_DEPTH` deep."""
        vectors: list[list[Value]] = []
        while True:
            value: Value
            if self._next.text != "[" or self._next.kind != "mark":
                value = self._scalar()
            elif (numbers := self._numbers(MAX_VECTOR_DEPTH - len(vectors))) is not None:
                value = numbers
            else:
                self._take()
                vectors.append([])
                if len(vectors) > MAX_VECTOR_DEPTH:
                    raise self._error(f"vectors are nested deeper than {MAX_VECTOR_DEPTH} levels.")
                if self._next.text != "]":
                    continue
                value = self._end_of(vectors)
            while vectors:
                vectors[-1].append(value)
                if self._comma_before_value():
                    break
                value = self._end_of(vectors)
            if not vectors:
                return value

    def _numbers(self, deepest: int) -> Value:
        """Read a whole vector of numbers; return None if it must be read token by token."""
        found = self._words.numbers(self._next.offset, deepest)
        if found is not None:
            self._next = self._words.next()
        return found

    def _comma_before_value(self) -> bool:
        """Skip a comma; return True if there was one and another value follows it."""
        if self._next.text == ",":
            self._take()
            return self._next.text != "]"
        return False

    def _end_of(self, vectors: list[list[Value]]) -> Value:
        self._expect("]", "to close a vector")
        return tuple(vectors.pop())

    def _scalar(self) -> Value:
        sign = 1.0
        signed = self._next
        while self._next.text in ("-", "+"):
            sign = -sign if self._take().text == "-" else sign
        word = self._take()
        if word.kind == "number":
            return sign * self._number(word)
        if word.kind == "name" and word.text in ("inf", "nan"):
            return sign * (math.inf if word.text == "inf" else math.nan)
        if signed is word and word.kind == "string":
            return unquoted(word.text)
        if signed is word and word.text in KEYWORDS:
            return KEYWORDS[word.text]
        raise self._error(f"expected a value, found {word}.", word)

    def _number(self, word: Token) -> float:
        value = float(word.text)
        if math.isinf(value):
            raise self._error(f"the number {word} is too large for a double.", word)
        return value

    def _expect(self, mark: str, where: str) -> None:
        if self._next.text != mark or self._next.kind != "mark":
            raise self._error(f"expected “{mark}” {where}, found {self._next}.")
        self._take()

    def _take(self) -> Token:
        taken = self._next
        if taken.kind != "end":
            self._next = self._words.next()
        return taken

    def _error(self, message: str, at: Token | None = None) -> FormatError:
        return self._script.error(self._places.at((at or self._next).offset), message)
