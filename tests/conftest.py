"""Settings for all tests: how many random examples, where shared data lies, what is slow."""

import os
from pathlib import Path

import hypothesis
import pytest

from support import DEEP

REPOSITORY = Path(__file__).resolve().parent.parent

_QUIET = [hypothesis.HealthCheck.too_slow, hypothesis.HealthCheck.data_too_large]
for _name, _count in (("fast", 15), ("ci", 40), ("deep", 2000)):
    hypothesis.settings.register_profile(
        _name,
        max_examples=_count,
        deadline=None,
        derandomize=_name != "deep",
        suppress_health_check=_QUIET,
        print_blob=True,
    )
# Whoever reads why a test failed wants to see the frames inside the package.
os.environ.setdefault("BSPCSG_TRACEBACKS", "full")
hypothesis.settings.load_profile(os.environ.get("BSPCSG_HYPOTHESIS", "ci"))


def pytest_collection_modifyitems(config: pytest.Config, items: list[pytest.Item]) -> None:
    """Deselect what takes minutes; the summary counts it, and BSPCSG_DEEP=1 runs it."""
    slow = [] if DEEP else [item for item in items if item.get_closest_marker("slow")]
    if slow:
        config.hook.pytest_deselected(items=slow)
        items[:] = [item for item in items if not item.get_closest_marker("slow")]


@pytest.fixture(scope="session")
def repository() -> Path:
    """Return the root of the working tree."""
    return REPOSITORY


@pytest.fixture(scope="session")
def shared_meshes() -> Path:
    """Return the folder of real meshes that lies beside a full checkout."""
    folder = REPOSITORY.parent / "shared" / "meshes"
    if not folder.is_dir():
        pytest.skip("the shared meshes do not lie beside this checkout")
    return folder


@pytest.fixture(scope="session")
def shared_scripts() -> Path:
    """Return the folder of OpenSCAD's scripts that lies beside a full checkout."""
    folder = REPOSITORY.parent / "shared" / "csg"
    if not folder.is_dir():
        pytest.skip("the shared scripts do not lie beside this checkout")
    return folder
