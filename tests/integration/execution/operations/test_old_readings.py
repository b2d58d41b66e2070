"""The ticker forgets old readings, and goes on with it each second while there are more than it can forget at once."""

from __future__ import annotations

from datetime import UTC, datetime, timedelta

import pytest

from execution.ticker.ticker import Ticker
from registry.devices import samples
from registry.models import Device, Sample
from tests.kit.sites import describe, make_hall


def test_old_readings_are_forgotten_without_a_pause_until_none_is_left(
    db: None, monkeypatch: pytest.MonkeyPatch
) -> None:
    make_hall()
    describe()
    Device.objects.update(lifecycle="approved")
    monkeypatch.setattr(samples, "PRUNE_AT_ONCE", 10)
    monkeypatch.setattr(samples, "PRUNE_S", 0.0)
    now = datetime.now(UTC)
    first = int((now - timedelta(days=8)).timestamp() // 60)
    Sample.objects.bulk_create(
        Sample(device_id="mixer1", property="heat", minute=first - n, value="1", at_ms=(first - n) * 60_000, seq=n)
        for n in range(36)
    )
    ticker, left = Ticker("a"), []
    for second in range(5):
        ticker.tick(now + timedelta(seconds=1.1 * second))
        left.append(Sample.objects.filter(property="heat").count())
    assert left == [26, 16, 6, 1, 1]
