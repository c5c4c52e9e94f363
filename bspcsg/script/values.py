"""Replacement of values that a Python script assigns to variables at its top level."""

import ast
from collections import deque
from collections.abc import Iterable, Iterator
from types import CodeType

from ..errors import FormatError
from ..suggestions import suggestion_text

#: The global variable of a script whose value is the dictionary of the caller's values.
VALUES = "__defines__"

#: Statements whose blocks have their own scope, and so are not part of the top level.
_OTHER_SCOPES = (ast.FunctionDef, ast.AsyncFunctionDef, ast.ClassDef)


def compiled(source: bytes, name: str, given: Iterable[str] = ()) -> CodeType:
    """Compile a script so that the given variables get their values from the dictionary `VALUES`.

    Every assignment to such a variable at the top level assigns the given value instead, also in an
    ``if`` or a loop; in ``a, b = 1, 2``, only the given variables change. Line numbers stay the
    same.

    Parameters
    ----------
    source : bytes
        The source code of the script.
    name : str
        The script's name in errors and tracebacks.
    given : iterable of str
        The names of the variables.

    Raises
    ------
    FormatError
        If the top level does not assign one of the variables (code "unknown_name"); the message
        lists the variables that it assigns.
    SyntaxError, ValueError
        If the source is not Python.
    """
    tree, wanted = ast.parse(source, name), tuple(given)
    if wanted:
        blocks = list(_top_level(tree))
        assigned = {bound: None for block in blocks for one in block for bound in _bound(one)}
        for unknown in (one for one in wanted if one not in assigned):
            raise FormatError(_advice(unknown, list(assigned)), "unknown_name")
        for block in blocks:
            block[:] = [new for old in block for new in _replaced(old, wanted)]
    return compile(ast.fix_missing_locations(tree), name, "exec", dont_inherit=True)


def _advice(unknown: str, known: list[str]) -> str:
    message = f"the script does not assign the variable {unknown} at its top level"
    if not known:
        return f"{message}; it assigns no variable there."
    return f"{message}.{suggestion_text(unknown, known)} It assigns {', '.join(known)}."


def _top_level(tree: ast.Module) -> Iterator[list[ast.stmt]]:
    """Yield the lists of statements in a script's global scope, outermost first."""
    waiting: deque[ast.AST] = deque([tree])
    while waiting:
        owner = waiting.popleft()
        for part in ("body", "orelse", "finalbody", "handlers", "cases"):
            block = getattr(owner, part, ())
            if part not in ("handlers", "cases") and block:
                yield block
            waiting.extend(one for one in block if not isinstance(one, _OTHER_SCOPES))


def _bound(statement: ast.stmt) -> list[str]:
    """Return the names that a statement assigns; empty if it is not an assignment."""
    if isinstance(statement, ast.Assign):
        targets = statement.targets
    elif isinstance(statement, ast.AnnAssign):
        targets = [statement.target]
    else:
        return []
    nodes = (node for target in targets for node in ast.walk(target))
    stored = (node for node in nodes if isinstance(node, ast.Name))
    return [node.id for node in stored if isinstance(node.ctx, ast.Store)]


def _replaced(statement: ast.stmt, wanted: tuple[str, ...]) -> list[ast.stmt]:
    """Return the statements that replace a statement, so that wanted names get other values."""
    names = [name for name in _bound(statement) if name in wanted]
    if not names:
        return [statement]
    if isinstance(statement, ast.AnnAssign):
        statement.value = _value(names[0], statement)
        return [statement]
    kept: list[ast.stmt] = []
    if isinstance(statement, ast.Assign):
        rest = [one for one in statement.targets if not _is_name(one, names)]
        kept = [ast.copy_location(ast.Assign(rest, statement.value), statement)] if rest else []
    return [*kept, *(_assignment(name, statement) for name in names)]


def _is_name(target: ast.expr, names: list[str]) -> bool:
    return isinstance(target, ast.Name) and target.id in names


def _assignment(name: str, old: ast.stmt) -> ast.stmt:
    target = ast.Name(name, ast.Store())
    return ast.copy_location(ast.Assign([target], _value(name, old)), old)


def _value(name: str, old: ast.stmt) -> ast.expr:
    """Return the expression ``VALUES[name]``, with the line numbers of an old statement."""
    values = ast.Name(VALUES, ast.Load())
    return ast.copy_location(ast.Subscript(values, ast.Constant(name), ast.Load()), old)
