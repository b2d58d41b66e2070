"""What dashboards can cost the embedded broker: so many of them, each with so many filters, asked for so often."""

from __future__ import annotations

import pytest

from registry import services
from tests.integration.wire.bus import SITE, Bus
from tests.integration.wire.dashboards.program import EVERYTHING, dashboard, make_person, make_token
from tests.kit.waiting import wait_for
from vipo_site.embedded_broker import broker
from vipo_site.embedded_broker.subscriptions import ASKS_AT_ONCE, MOST_FILTERS_OF_READER

pytestmark = [pytest.mark.servers, pytest.mark.parametrize("bus", ["amqtt"], indirect=True)]


def test_dashboards_leave_room_to_devices(bus: Bus, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(broker, "MOST_READERS", 2)
    ada = make_person("ada@vipo.example")
    first, second, third = (make_token(ada) for _ in range(3))
    with dashboard(bus, *first) as one, dashboard(bus, *second):
        with dashboard(bus, *third) as refused:
            assert "unavailable" in refused.refused.lower()
        services.expect_device(site=SITE, device_id="mixer01", credential="k" * 32)
        wait_for("mixer01", lambda: bus.lets_in("mixer01", "k" * 32))
        one.client.disconnect()
        wait_for("its leave", lambda: not one.is_in)
        with dashboard(bus, *third) as there:
            assert there.is_in


def test_a_dashboard_holds_so_many_filters_and_asks_so_often(bus: Bus) -> None:
    named = [f"{EVERYTHING[:-1]}mixer{number}/status" for number in range(MOST_FILTERS_OF_READER + 1)]
    with dashboard(bus, *make_token(make_person("ada@vipo.example")), *named) as seen:
        assert seen.granted == [True] * MOST_FILTERS_OF_READER + [False]
        begun = len(seen.granted)
        for _ in range(int(ASKS_AT_ONCE)):
            seen.client.subscribe(named[0])
        wait_for("the answers", lambda: len(seen.granted) == begun + ASKS_AT_ONCE)
        assert seen.granted[-1] is False
        assert seen.is_in
