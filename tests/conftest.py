"""Settings for all tests: which cases run, the seed of random examples, shared data."""

import os
from collections import Counter
from pathlib import Path

import hypothesis
import pytest

from support import COMMIT, DEEP, draw

REPOSITORY = Path(__file__).resolve().parent.parent

_QUIET = [hypothesis.HealthCheck.too_slow, hypothesis.HealthCheck.data_too_large]
for _name, _count in (("fast", 15), ("ci", 40), ("deep", 2000)):
    hypothesis.settings.register_profile(
        _name,
        max_examples=_count,
        deadline=None,
        database=None,
        suppress_health_check=_QUIET,
        print_blob=True,
    )
hypothesis.settings.load_profile(os.environ.get("BSPCSG_HYPOTHESIS", "ci"))


@pytest.hookimpl(tryfirst=True)
def pytest_configure(config: pytest.Config) -> None:
    """Seed hypothesis with the commit, unless a seed is given."""
    if config.option.hypothesis_seed is None:
        config.option.hypothesis_seed = str(draw("hypothesis", 2**32))


def pytest_report_header() -> str:
    """Return the line that says how to repeat this choice of cases."""
    return "all cases" if DEEP else f"cases drawn by BSPCSG_COMMIT={COMMIT}"


def pytest_collection_modifyitems(config: pytest.Config, items: list[pytest.Item]) -> None:
    """Deselect the cases that only a deep run includes."""
    if DEEP:
        return
    cases = Counter(map(_function, items))
    seen: Counter[str] = Counter()
    kept: list[pytest.Item] = []
    left: list[pytest.Item] = []
    for item in items:
        name = _function(item)
        seen[name] += 1
        (kept if _is_drawn(item, seen[name] - 1, cases[name]) else left).append(item)
    config.hook.pytest_deselected(items=left)
    items[:] = kept


def _function(item: pytest.Item) -> str:
    return item.nodeid.partition("[")[0]


def _is_drawn(item: pytest.Item, number: int, cases: int) -> bool:
    """Return true if this run includes case `number` of a test's `cases`."""
    if item.get_closest_marker("deep"):
        return False
    sampled = item.get_closest_marker("sampled")
    if sampled is None:
        return True
    step: int = min(*sampled.args, cases)
    return number % step == draw(_function(item), step)


@pytest.fixture(scope="session")
def repository() -> Path:
    """Return the root folder of the working tree."""
    return REPOSITORY


@pytest.fixture(scope="session")
def shared_meshes() -> Path:
    """Return the folder of real meshes beside the checkout; skip the test if it is missing."""
    folder = REPOSITORY.parent / "shared" / "meshes"
    if not folder.is_dir():
        pytest.skip("the shared meshes do not lie beside this checkout")
    return folder


@pytest.fixture(scope="session")
def shared_scripts() -> Path:
    """Return the folder of OpenSCAD scripts beside the checkout; skip the test if it is missing."""
    folder = REPOSITORY.parent / "shared" / "csg"
    if not folder.is_dir():
        pytest.skip("the shared scripts do not lie beside this checkout")
    return folder
