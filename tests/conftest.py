"""What all tests share: how hypothesis searches.

`make test` judges a change, so it takes the same examples each time; every other run looks for new ones.
"""

import os

import pytest
from hypothesis import settings

settings.register_profile("searching", deadline=None)
settings.register_profile("steady", deadline=None, derandomize=True)
settings.load_profile("steady" if os.environ.get("VIPO_STEADY") == "1" else "searching")

pytest.register_assert_rewrite("tests.kit")
pytest_plugins = ["tests.kit.scheduling", "tests.kit.databases"]
