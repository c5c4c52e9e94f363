"""The names of the package are those of `__all__`, one object each, whoever asks for them."""

import pickle
from pathlib import Path

import bspcsg as b


def test_public_functions_are_the_ones_of_their_modules() -> None:
    public = b.union
    from bspcsg.operations.setops import union

    assert union is public and pickle.loads(pickle.dumps(b.union)) is b.union
    assert b.union.__name__ == "union" and (b.Solid.__or__.__doc__ or "").startswith("Union")


# Found: `dir` leaked what is not public.
def test_dir_shows_public_names_only() -> None:
    names = dir(b)
    assert set(b.__all__) <= set(names)
    leaked = {"Any", "import_module", "TYPE_CHECKING", "above", "conveniences"}
    assert not leaked & set(names)
    assert dir(b.io) == sorted(b.io.__all__)


def test_no_module_hides_a_public_name() -> None:
    # An import of `bspcsg.name` would put the module where the name was.
    beside = {path.stem for path in Path(b.__file__).parent.iterdir()}
    assert beside & set(b.__all__) <= set(b._PARTS)
