"""Reading of scripts as solids, and writing of solids as scripts."""

import os
from collections.abc import Callable, Iterable
from pathlib import Path
from typing import Any, Literal

from ..bsp import Region
from ..errors import BspcsgError, FormatError
from ..formats.atomic import write_file
from ..formats.source import limited_content
from ..parameters import file_path, one_of
from ..solid.ledger import counted
from ..solid.solid import Solid
from .evaluator import evaluate
from .from_solid import tree_of
from .making.polish import Polish
from .nodes.registry import Geometry, OnInvalid
from .openscad import read_scad
from .syntax.json_form import from_json, to_json
from .syntax.parser import parse
from .syntax.tree import CsgTree
from .syntax.writer import written


@counted
def load(
    path: str | os.PathLike[str],
    *,
    polish: bool = False,
    on_polish: Callable[[Polish], object] | None = None,
    on_invalid: OnInvalid = "error",
    allow_paths: Iterable[str | os.PathLike[str]] = (),
    lenient: bool = False,
    **options: Any,
) -> Solid:
    """Read a script file and evaluate it to a solid.

    Parameters
    ----------
    path : path
        A `.csg` file, a `.json` file of such a tree, or a `.scad` file, which the program openscad
        converts first (see `bspcsg.csg.read_tree`).
    polish : bool
        True to undo OpenSCAD's rounding to six digits (see `bspcsg.csg.evaluate`).
    on_polish : callable, optional
        Called with a `Polish`, which contains the largest distance that a corner moved.
    on_invalid : {"error", "warn", "repair"}
        The treatment of meshes that are not closed (see `bspcsg.csg.evaluate`).
    allow_paths : iterable of path
        Folders whose files the script may read, in addition to its own folder.
    lenient : bool
        True to omit nodes that cannot be evaluated, with a warning that names line and column.
    **options
        For `.scad`: ``defines``, a dict of variables.

    Raises
    ------
    FormatError
        If the file cannot be read or evaluated; the message names file, line and column. A model
        of the plane is refused with the code "not_3d"; `evaluate` returns it as a region.
    InvalidMeshError, LimitError
        If no solid can be made for a node.

    Warns
    -----
    CsgWarning
        For everything that is omitted, as by OpenSCAD.
    """
    tree = read_tree(path, **options)
    body = evaluate(
        tree,
        polish=polish,
        on_polish=on_polish,
        on_invalid=on_invalid,
        allow_paths=allow_paths,
        lenient=lenient,
    )
    return _solid(body, tree.name)


@counted
def loads(
    text: str,
    *,
    polish: bool = False,
    on_polish: Callable[[Polish], object] | None = None,
    on_invalid: OnInvalid = "error",
    allow_paths: Iterable[str | os.PathLike[str]] = (),
    lenient: bool = False,
    folder: str | Path | None = None,
    name: str = "<csg>",
    form: Literal["csg", "json"] = "csg",
) -> Solid:
    """Evaluate the text of a script, in its own language or as JSON, to a solid (see `load`).

    Examples
    --------
    >>> from bspcsg import csg as scripts
    >>> scripts.loads("difference() { cube(size = 2); cube(size = 1); }").volume
    7.0
    """
    read = {"csg": parse, "json": from_json}[one_of(("csg", "json"), form, "form")]
    tree = read(text, name, folder)
    body = evaluate(
        tree,
        polish=polish,
        on_polish=on_polish,
        on_invalid=on_invalid,
        allow_paths=allow_paths,
        lenient=lenient,
    )
    return _solid(body, name)


def read_tree(path: str | os.PathLike[str], **options: Any) -> CsgTree:
    """Read the tree of a script: `.csg`, `.json`, or `.scad` by means of the program openscad.

    Raises
    ------
    FormatError
        If the file cannot be read or is not a script. An empty file is an empty model.
    """
    name = file_path(path)
    file = Path(name)
    suffix = file.suffix.lower()
    if suffix == ".scad":
        return read_scad(file, **options)
    if options:
        raise FormatError(
            f"{name}: {', '.join(options)} can be given for .scad files only; leave it out.",
            "bad_argument",
        )
    text = _text(file, name)
    if suffix == ".json":
        return from_json(text, name, file.parent)
    return parse(text, name, file.parent)


def _text(file: Path, name: str) -> str:
    try:
        return limited_content(file).decode("utf-8")
    except UnicodeDecodeError as error:
        message = f"{name}: the file is not UTF-8 text: byte {error.start} cannot be decoded."
        raise FormatError(message, "syntax", [error.start]) from error


def _solid(body: Geometry, name: str) -> Solid:
    if isinstance(body, Region):
        message = (
            f"{name}: the model is two-dimensional, and a solid is needed; put"
            " linear_extrude(height = 1) around it."
        )
        raise FormatError(message, "not_3d")
    if body is None:
        return Solid.empty()
    try:
        # Build the tree here, so that this call raises its errors, not the first query.
        body.tree  # noqa: B018  builds it
    except BspcsgError as error:
        raise type(error)(f"{name}: {error.message}", error.code, error.where) from error
    return body


def dumps(model: Solid | CsgTree, *, flat: bool = False) -> str:
    """Return a solid or a tree as the text of a `.csg` script.

    A solid becomes the expression that made it, as far as the solid stores it (see `tree_of`), with
    polyhedra as leaves. Their corners are doubles, which are snapped to the lattice when the script
    is read. Reading a written tree gives an equal tree.

    Parameters
    ----------
    model : Solid or CsgTree
    flat : bool
        True to write a solid as one polyhedron, its reduced boundary.

    Raises
    ------
    UnboundedError
        If the solid reaches to infinity.

    Examples
    --------
    >>> import bspcsg as csg
    >>> from bspcsg import csg as scripts
    >>> part = csg.cube(3) - csg.cube(1)
    >>> scripts.parse(scripts.dumps(part)).nodes[0].name
    'difference'
    >>> scripts.loads(scripts.dumps(part)).equals(part)
    True
    """
    return written(_tree(model, flat))


def _tree(model: Solid | CsgTree, flat: bool) -> CsgTree:
    return model if isinstance(model, CsgTree) else tree_of(model, flat=flat)


def dump(model: Solid | CsgTree, path: str | os.PathLike[str], *, flat: bool = False) -> None:
    """Write a solid or a tree as a `.csg` file (see `dumps`), or as JSON if the suffix is `.json`.

    The file is written completely or not at all.

    Raises
    ------
    FormatError
        If the file cannot be written, or the tree has text that cannot be encoded (code
        ``"bad_argument"``).
    UnboundedError
        If the solid reaches to infinity.
    """
    name, tree = file_path(path), _tree(model, flat)
    is_json = Path(name).suffix.lower() == ".json"
    text = to_json(tree, indent=1) + "\n" if is_json else written(tree)
    try:
        data = text.encode()
    except UnicodeEncodeError as error:
        message = (
            f"{name}: a string in the tree contains half of a character (a lone surrogate), which"
            " cannot be written; remove it."
        )
        raise FormatError(message, "bad_argument") from error
    write_file(name, [data])
