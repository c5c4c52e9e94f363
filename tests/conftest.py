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
hypothesis.settings.load_profile(os.environ.get("BSPCSG_HYPOTHESIS", "ci"))


def pytest_collection_modifyitems(items: list[pytest.Item]) -> None:
    """Leave out what takes minutes, with a reason that the summary counts."""
    if DEEP:
        return
    for item in items:
        if item.get_closest_marker("slow"):
            item.add_marker(pytest.mark.skip(reason="slow; set BSPCSG_DEEP=1 to run it"))


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
