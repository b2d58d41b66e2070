"""A site with people of every role, and what its browsers are told."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from typing import Any

import pytest

from registry.models import User
from registry.thing_directory import property_values
from tests.kit.sign_in import find_person
from tests.kit.sites import hear_news, make_hall


@pytest.fixture
def hall(db: None) -> str:
    return make_hall()


@pytest.fixture
def person(hall: str) -> Callable[[str], User]:
    return find_person


@pytest.fixture
def heard(hall: str) -> Iterator[list[tuple[str, Any]]]:
    with hear_news() as news:
        yield news


@pytest.fixture
def impatient(monkeypatch: pytest.MonkeyPatch) -> None:
    """Let nobody wait for the next value of a property."""
    monkeypatch.setattr(property_values, "MOST_POLL_S", 0.0)
