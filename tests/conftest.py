"""Fixtures and settings that all tests share."""

from __future__ import annotations

import os
from pathlib import Path

import pytest
from hypothesis import HealthCheck, settings

from tests.tools import real_data_folder

_QUIET = (HealthCheck.too_slow, HealthCheck.data_too_large)
# Times say nothing on a shared machine, so no deadline; CI draws the same examples every time.
settings.register_profile("default", deadline=None, suppress_health_check=_QUIET)
settings.register_profile(
    "ci", deadline=None, suppress_health_check=_QUIET, derandomize=True, database=None
)
settings.register_profile("thorough", deadline=None, suppress_health_check=_QUIET, max_examples=500)
settings.load_profile(
    os.environ.get("HYPOTHESIS_PROFILE", "ci" if "CI" in os.environ else "default")
)


@pytest.fixture(scope="session")
def real_data() -> Path:
    """Folder of the real heads; the test is skipped (or fails, see `tests.tools`) without them."""
    return real_data_folder()
