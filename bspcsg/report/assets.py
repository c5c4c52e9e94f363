"""The scripts, styles and templates of which HTML pages are made."""

from functools import cache
from importlib.resources import files
from typing import TYPE_CHECKING, Any

from ..errors import missing_part
from .viewer.packing import compressed

if TYPE_CHECKING:
    import jinja2


@cache
def asset(name: str) -> str:
    """Return the text of a file in the folder ``assets``."""
    return (files(__package__) / "assets" / name).read_text(encoding="utf-8")


@cache
def bundle() -> str:
    """Return the 3D viewer with three.js as compressed text; `assets/loader.js` unpacks it."""
    return compressed(asset("viewer.js").encode())


def rendered(template: str, **values: Any) -> str:
    """Return the page that a template, a file in the folder ``templates``, makes of values.

    Raises
    ------
    MissingPartError
        If Jinja2 is not installed.
    """
    return _environment().get_template(template).render(values)


@cache
def _environment() -> "jinja2.Environment":
    try:
        import jinja2
    except ImportError as error:
        raise missing_part("Jinja2", "to make pages", "pip install 'jinja2>=3.1'") from error
    environment = jinja2.Environment(
        autoescape=True,
        trim_blocks=True,
        lstrip_blocks=True,
        undefined=jinja2.StrictUndefined,
        loader=jinja2.PackageLoader(__package__, "templates"),
    )
    environment.globals.update(asset=asset, bundle=bundle)
    return environment
