"""Two gateways: one of them tells dashboards, the other takes over, and what does not hold any more is taken away."""

from __future__ import annotations

import threading
from collections.abc import Iterator
from contextlib import contextmanager
from datetime import UTC, datetime

import pytest
from django.conf import LazySettings

from execution.gateway.gateway import Gateway
from registry import services
from tests.integration.wire.bus import SITE, Bus
from tests.integration.wire.dashboards.program import (
    EVERYTHING,
    dashboard,
    make_device,
    make_person,
    make_token,
    say,
    topic,
)
from tests.kit.waiting import wait_for

pytestmark = pytest.mark.servers


@contextmanager
def running(settings: LazySettings, name: str) -> Iterator[None]:
    settings.VIPO_GATEWAY = name
    made, stopping = Gateway(settings), threading.Event()
    thread = threading.Thread(target=made.run_forever, args=(stopping,))
    thread.start()
    try:
        yield
    finally:
        stopping.set()
        thread.join(20)


def test_each_change_is_told_once_and_by_the_other_one_when_the_first_has_gone(
    bus: Bus, settings: LazySettings
) -> None:
    make_device("mixer01")
    make_device("mixer02")
    name, key = make_token(make_person("ada@vipo.example"))
    with dashboard(bus, name, key, EVERYTHING) as seen:
        with running(settings, "second"):
            with running(settings, "first"):
                wait_for("the values", lambda: topic("mixer01") in seen.heard and topic("mixer02") in seen.heard)
                before = seen.count
                say("mixer01", jobStatus=33)
                wait_for("the value", lambda: seen.heard[topic("mixer01")] == 33)
                threading.Event().wait(2)
                assert seen.count - before == 1
            say("mixer01", jobStatus=44)
            wait_for("the value", lambda: seen.heard[topic("mixer01")] == 44)
        services.retire_device(site=SITE, device_id="mixer02", by=None, at=datetime.now(UTC))
        say("mixer01", jobStatus=55)
        with running(settings, "third"):
            wait_for("what changed while nobody told", lambda: seen.heard[topic("mixer01")] == 55)
            wait_for("the end of the other", lambda: seen.heard[topic("mixer02")] is None)


def test_dozens_of_devices_are_told_whole_to_who_comes_later(bus: Bus, settings: LazySettings) -> None:
    names = [f"mixer{number:03}" for number in range(60)]
    for device in names:
        make_device(device)
    ada = make_person("ada@vipo.example")
    with running(settings, "only"), dashboard(bus, *make_token(ada), EVERYTHING) as early:
        wait_for("all values", lambda: {topic(device) for device in names} <= early.heard.keys())
        with dashboard(bus, *make_token(ada), EVERYTHING) as late:
            wait_for("all values", lambda: late.heard == early.heard)
        services.revoke_token(token_id=services.list_tokens(site=SITE)[-1].id)
        services.revoke_token(token_id=services.list_tokens(site=SITE)[0].id)
        wait_for("the end", lambda: early.refused)
