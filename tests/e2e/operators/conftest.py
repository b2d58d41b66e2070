"""Whoever watches runs here prefers no motion: a frame of a moving place takes long without a graphics card.

Robots are shown where they are once a second then. Motion itself is tried where programs are drawn and rehearsed.
"""

from __future__ import annotations

from functools import partial

import pytest

from tests.e2e.conftest import SignIn


@pytest.fixture
def sign_in(sign_in: SignIn) -> SignIn:
    return partial(sign_in, motion=False)
