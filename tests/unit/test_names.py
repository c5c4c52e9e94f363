"""The names of the package are those of `__all__`, and each is one object."""

import inspect
import pickle
from collections.abc import Callable
from pathlib import Path
from typing import Any, cast

import pytest

import bspcsg as b


def test_public_functions_are_the_ones_of_their_modules() -> None:
    public = b.union
    from bspcsg.operations.setops import union

    assert union is public and pickle.loads(pickle.dumps(b.union)) is b.union
    assert b.union.__name__ == "union" and (b.Solid.__or__.__doc__ or "").startswith("Union")


# Found: `dir` listed names that are not public.
def test_dir_shows_public_names_only() -> None:
    names = dir(b)
    assert set(b.__all__) <= set(names)
    leaked = {"Any", "import_module", "TYPE_CHECKING", "suggestions"}
    assert not leaked & set(names)
    assert dir(b.io) == sorted(b.io.__all__)


def test_no_module_hides_a_public_name() -> None:
    # An import of `bspcsg.name` would put the module where the name was.
    beside = {path.stem for path in Path(b.__file__).parent.iterdir()}
    assert beside & set(b.__all__) <= set(b._PARTS)


PUBLIC = [getattr(home, name) for home in (b, b.bsp) for name in home.__all__]
CLASSES = [kind for kind in PUBLIC if inspect.isclass(kind) and kind.__module__[:6] == "bspcsg"]


# Found: TypeErrors named classes that users do not know, as `Movable.translate`.
def test_methods_are_named_after_public_classes() -> None:
    known = {kind.__qualname__ for kind in CLASSES}
    for kind in CLASSES:
        for name, method in inspect.getmembers(kind, inspect.isfunction):
            if not name.startswith("_") and method.__module__.startswith("bspcsg"):
                called = inspect.unwrap(method).__qualname__
                assert called.partition(".")[0] in known, called
                assert pickle.loads(pickle.dumps(method)) is method


@pytest.mark.parametrize(
    ("call", "words"),
    [
        (lambda s: s.translate(w=1), r"^Solid\.translate\(\) got an unexpected keyword"),
        (lambda s: s.fillet(), r"^Solid\.fillet\(\) missing 2 required"),
        (lambda s: s.project(3), r"^Solid\.project\(\) takes 1 positional"),
        (lambda s: s.equals(), r"^Solid\.equals\(\) missing"),
        (lambda s: s.load(), r"^Solid\.load\(\) missing"),
        (lambda s: s.slice(0).cast(), r"^Region\.cast\(\) missing"),
        (lambda s: cast(Any, b.Assembly("a", s)).rotate(w=1), r"^Assembly\.rotate\(\) got"),
    ],
)
def test_type_errors_name_the_class_that_was_used(call: Callable[[Any], Any], words: str) -> None:
    with pytest.raises(TypeError, match=words):
        call(b.cube(1))


def test_own_copies_of_methods_are_the_same_methods() -> None:
    from bspcsg.solid.movable import Movable

    assert b.Solid.rotate is not Movable.rotate and b.Solid.rotate.__doc__ == Movable.rotate.__doc__
    assert inspect.signature(b.Solid.rotate) == inspect.signature(Movable.rotate)
    with b.union() as block:
        part = b.box(4, 3, 2)
        part.chamfer(part.edges().parallel("z"), 1)
    assert block.solid.volume == 20


@pytest.mark.parametrize(
    ("owner", "word", "name"),
    [
        (b.cube(1), "diff", "difference"),
        (b.cube(1), "subtract", "difference"),
        (b.cube(1), "add", "union"),
        (b.Region.circle(1), "intersect", "intersection"),
        (b.Region.circle(1), "xor", "symmetric_difference"),
        (b.cube(1), "bounding_box", "bounds"),
        (b.cube(1), "fillett", "fillet"),
        (b.cube(1), "is_watertight", "findings"),
        (b.cube(1), "hull", "the function bspcsg.hull"),
        (b.bsp.Intervals(), "add", "union"),
        (b, "diff", "difference"),
        (b, "symmetric_difference", "xor"),
        (b, "cuboid", "cube"),
    ],
)
def test_names_of_other_libraries_lead_to_the_one_here(owner: Any, word: str, name: str) -> None:
    with pytest.raises(AttributeError, match=rf"no attribute '{word}'\. Is {name} meant\?$"):
        getattr(owner, word)


def test_names_that_nobody_can_mean_are_only_refused() -> None:
    for owner, name in ((b.cube(1), "zzzzzz"), (b.cube(1), "_reps"), (b, "zzzzzz")):
        with pytest.raises(AttributeError, match=rf"has no attribute '{name}'$"):
            getattr(owner, name)
    assert not hasattr(b.cube(1), "__array__") and not hasattr(b.cube(1), "diff")


def test_operations_by_other_names_are_asked_about() -> None:
    (v, f), op = (b.cube(1).vertices, b.cube(1).faces), "subtract"
    with pytest.raises(b.InvalidParameterError, match=r"Is difference meant\?$"):
        b.boolean(v, f, v, f, op)  # type: ignore[arg-type]
    with pytest.raises(b.InvalidParameterError, match=r"Is difference meant\?$"):
        b.bsp.merge(b.Region.circle(1), b.Region.circle(1), op)  # type: ignore[arg-type]
