"""Tokens at both brokers: a dashboard hears how the Things of its one site are, and says nothing."""

from __future__ import annotations

import itertools
import threading
import time
from datetime import UTC, datetime

import pytest

from execution.gateway.gateway import Gateway
from registry import services
from tests.integration.wire.bus import SERVER_WORD, SITE, Bus
from tests.integration.wire.dashboards.program import (
    EVERYTHING,
    dashboard,
    make_device,
    make_person,
    make_token,
    say,
    topic,
)
from tests.kit.mqtt import Ear
from tests.kit.waiting import wait_for
from vipo_site.embedded_broker import connection

pytestmark = pytest.mark.servers


def test_a_dashboard_hears_the_values_of_its_one_site_as_they_are(bus: Bus, gateway: Gateway) -> None:
    services.create_site(name="Yard", slug="yard")
    ada, eve = make_person("ada@vipo.example"), make_person("eve@vipo.example", "yard")
    make_device("mixer01")
    make_device("yard.mixer", "yard")
    name, key = make_token(ada)
    make_token(eve, "yard")
    with dashboard(bus, name, key, EVERYTHING, f"vipo/v1/site/{SITE}/stop") as seen:
        wait_for("the value", lambda: seen.heard.get(topic("mixer01")) == 10)
        say("mixer01", jobStatus=55)
        wait_for("the next value", lambda: seen.heard.get(topic("mixer01")) == 55)
        with Ear(bus.server_port, SERVER_WORD, "vipo/v1/none") as server:
            server.say(f"vipo/v1/site/{SITE}/stop", {"active": True})
        wait_for("the stop", lambda: seen.heard.get(f"vipo/v1/site/{SITE}/stop"))
        services.retire_device(site=SITE, device_id="mixer01", by=None, at=datetime.now(UTC))
        wait_for("its end", lambda: seen.heard[topic("mixer01")] is None)
        assert {name.split("/")[3] for name in seen.heard} == {SITE}
    with Ear(bus.server_port, SERVER_WORD, "vipo/v1/site/+/things/#") as ear:
        ear.wait(lambda heard: heard.topic == topic("yard.mixer", "yard") and heard.payload == b"10")
        assert not [heard for heard in ear.heard if "mixer01" in heard.topic]


FOREIGN = (
    *("#", "+/#", "vipo/#", "vipo/v1/#", "vipo/v1/site/#", "vipo/v1/site/+/things/#", "vipo/v1/site/yard/things/#"),
    *("vipo/v1/site/hall/#", "vipo/v1/site/yard/stop", "vipo/v1/site/+/stop", "vipo/v1/site/hallo/things/#"),
    *("vipo/v1/dev/+/up/#", "vipo/v1/dev/mixer01/up/state", "vipo/v1/dev/mixer01/down/#", "vipo/v1/join/hall/+"),
    *("$SYS/#", "$share/g/vipo/v1/dev/+/up/#", "$share/gateway/vipo/v1/join/+/+", "vipo/v1/srv/status"),
    "$CONTROL/dynamic-security/v1/response",
)


def test_a_dashboard_is_refused_everything_else_and_says_nothing(bus: Bus, gateway: Gateway) -> None:
    make_device("mixer01")
    name, key = make_token(make_person("ada@vipo.example"))
    with Ear(bus.server_port, SERVER_WORD, "vipo/#") as ear, dashboard(bus, name, key, *FOREIGN, EVERYTHING) as seen:
        assert seen.granted == [False] * len(FOREIGN) + [True]
        wait_for("the value", lambda: topic("mixer01") in seen.heard)
        for to in (topic("mixer01"), "vipo/v1/dev/mixer01/down/mixPaint", f"vipo/v1/dev/{name}/up/state", "anything"):
            seen.client.publish(to, b"boo", 1, retain=True)
        wait_for("their end", lambda: not seen.client.is_connected() or not seen.client._out_messages)
        ear.say("vipo/v1/dev/mixer01/down/probe", {"over": True})
        ear.wait(lambda heard: heard.topic.endswith("/probe"))
        assert not [heard for heard in ear.heard if heard.payload == b"boo"]
        assert set(seen.heard) <= {heard.topic for heard in ear.heard}


def test_the_will_of_a_dashboard_is_not_sent(bus: Bus, gateway: Gateway) -> None:
    name, key = make_token(make_person("ada@vipo.example"))
    with Ear(bus.server_port, SERVER_WORD, "vipo/#") as ear:
        with dashboard(bus, name, key, will=f"vipo/v1/site/{SITE}/stop") as seen:
            if bus.kind == "amqtt":
                assert seen.refused
            else:
                seen.client.socket().close()  # no goodbye: the will is due
                time.sleep(1)
        ear.say("vipo/v1/over", {})
        ear.wait(lambda heard: heard.topic == "vipo/v1/over")
        assert not [heard for heard in ear.heard if heard.payload == b"boo"]


@pytest.mark.parametrize("scopes", [["read"], ["operate"]])
def test_a_token_that_was_not_made_for_the_broker_opens_nothing_there(
    bus: Bus, gateway: Gateway, scopes: list[str]
) -> None:
    asked = {"name": "Program", "scopes": scopes, "days": 1, "now": datetime.now(UTC)}
    view, text = services.create_token(user=make_person("ada@vipo.example"), site=SITE, **asked)
    assert services.broker_of(view=view) is None
    with dashboard(bus, f"token:{view.id}", text) as seen:
        assert seen.refused


def test_a_second_connection_by_one_token_takes_the_place_of_the_first(bus: Bus, gateway: Gateway) -> None:
    name, key = make_token(make_person("ada@vipo.example"))
    with dashboard(bus, name, key) as first:
        first.client.reconnect_delay_set(60, 60)
        with dashboard(bus, name, key) as second:
            wait_for("the end of the first", lambda: first.ended_at)
            assert second.is_in


def test_a_dashboard_that_reads_nothing_delays_nobody(
    bus: Bus, gateway: Gateway, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(connection, "STUCK_S", 3600.0)  # when the embedded broker would end it
    make_device("mixer01")
    ada = make_person("ada@vipo.example")
    slow, quick = make_token(ada), make_token(ada)
    values = itertools.cycle(range(11, 100))
    with dashboard(bus, *slow, EVERYTHING, keep_alive_s=3600) as deaf, dashboard(bus, *quick, EVERYTHING) as seen:
        deaf.client.loop_stop()  # its socket is open, and nobody reads it
        with Ear(bus.server_port, SERVER_WORD, "vipo/v1/none") as ear:
            for number in range(20_000):
                ear.say(f"{EVERYTHING[:-1]}big/{number % 50}", b"%d" % number + b" " * 500, qos=0)

            def is_told() -> bool:
                """Whether a value has come; one for which the flood leaves no room is left out."""
                say("mixer01", jobStatus=next(values))
                return seen.heard.get(topic("mixer01"), 10) != 10

            wait_for("a value", is_told)


def test_many_who_make_tokens_at_once_all_come_in(bus: Bus, gateway: Gateway) -> None:
    ada = make_person("ada@vipo.example")
    made: list[tuple[str, str]] = []

    def make() -> None:
        made.append(make_token(ada))

    threads = [threading.Thread(target=make) for _ in range(6)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join(30)
    assert len(set(made)) == 6
    for name, key in made:
        with dashboard(bus, name, key, EVERYTHING) as seen:
            assert seen.granted == [True]
