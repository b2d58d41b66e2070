"""What all tests share: how hypothesis searches.

`make test` judges a change, so it takes the same examples each time; every other run, `make check` too, looks for
new ones, fewer of them.
"""

import os
import sys

import pytest
from hypothesis import settings

settings.register_profile("searching", deadline=None, max_examples=30)
settings.register_profile("steady", deadline=None, derandomize=True, max_examples=40)
settings.load_profile("steady" if os.environ.get("VIPO_STEADY") == "1" else "searching")

pytest.register_assert_rewrite("tests.kit")
pytest_plugins = ["tests.kit.scheduling", "tests.kit.databases"]


@pytest.fixture(autouse=True)
def _nothing_remembered():
    """Let no test carry on with what a process keeps of another test's database: owners' sites, readings to write."""
    yield
    if drive := sys.modules.get("execution.engine.drive"):
        drive.forget_all()
    if samples := sys.modules.get("registry.devices.samples"):
        samples._buffer = samples.SampleBuffer()
