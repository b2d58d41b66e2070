"""A site with people of each role."""

from __future__ import annotations

import pytest

from tests.kit.sites import make_hall


@pytest.fixture
def hall(db: None) -> str:
    return make_hall()
