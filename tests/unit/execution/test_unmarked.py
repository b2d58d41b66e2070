"""What a gateway still has to tell the database of what it has sent."""

from __future__ import annotations

from datetime import UTC, datetime, timedelta

import pytest

from execution.gateway import unmarked
from execution.gateway.unmarked import Unmarked

NOON = datetime(2026, 11, 25, 12, tzinfo=UTC)


@pytest.fixture
def clock(monkeypatch: pytest.MonkeyPatch) -> list[float]:
    """A clock by which the test says what time it is."""
    now = [0.0]
    monkeypatch.setattr(unmarked, "steady_s", lambda: now[0])
    return now


def test_what_went_out_in_a_moment_is_due_together_when_the_first_has_waited(clock: list[float]) -> None:
    sent = Unmarked()
    sent.add(["a"], NOON)
    clock[0] = 0.09
    sent.add(["b"], NOON + timedelta(seconds=1))
    assert sent.list_due() == {}
    clock[0] = 0.1
    assert sent.list_due() == {"a": NOON, "b": NOON + timedelta(seconds=1)}
    assert sent.list_due() == {"a": NOON, "b": NOON + timedelta(seconds=1)}, "until the database has taken it"
    sent.forget(["a", "b"])
    assert sent.list_due(all_of_it=True) == {}


def test_what_is_answered_first_is_never_due_and_the_next_one_waits_anew(clock: list[float]) -> None:
    sent = Unmarked()
    sent.add(["a"], NOON)
    sent.forget(["a", "unknown"])
    clock[0] = 5.0
    sent.add(["b"], NOON)
    assert sent.list_due() == {}
    assert sent.list_due(all_of_it=True) == {"b": NOON}
