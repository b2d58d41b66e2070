"""What people decide about a virtual device's key, and how the device goes on by itself: on the embedded broker."""

from __future__ import annotations

import json
import threading
from collections.abc import Callable, Iterator
from dataclasses import replace
from datetime import UTC, datetime
from pathlib import Path
from typing import Any

import pytest

from execution.gateway.gateway import Gateway
from registry import services
from registry.models import DeviceEvent
from simulation.management.commands.twin import connections
from simulation.site_facts import demo_facts
from simulation.twin import Twin, TwinPlan
from tests.integration.wire.bus import JOIN, SITE, Bus
from tests.integration.wire.conftest import bus, database, gateway
from tests.kit.waiting import wait_for

__all__ = ["bus", "database", "gateway"]
pytestmark = [pytest.mark.servers, pytest.mark.parametrize("bus", ["amqtt"], indirect=True)]
OVEN, KEY = "curingOven01", "the-first-key-of-the-oven-01"


@pytest.fixture
def keys(bus: Bus, gateway: Gateway, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Iterator[Path]:
    """The file of keys of a running twin whose oven takes part."""
    monkeypatch.setattr("vipo_device.kit.enrolment.PAUSE_S", (0.1, 0.2))
    services.expect_device(site=SITE, device_id=OVEN, credential=KEY)
    file = tmp_path / "devices.json"
    file.write_text(json.dumps({OVEN: KEY, "another": "its key"}))
    plan = TwinPlan(
        replace(demo_facts(), slug=SITE), frozenset({OVEN}), tmp_path / "memory.json", driver="kinematic", speed=20
    )
    twin, stopping = Twin(plan, connections(SITE, JOIN, tmp_path)), threading.Event()
    thread = threading.Thread(target=twin.run, args=(stopping,))
    thread.start()
    try:
        wait_for("the oven", is_here)
        yield file
    finally:
        stopping.set()
        thread.join(20)
    assert not thread.is_alive()
    assert json.loads(file.read_text())["another"] == "its key"


def decide(what: Callable[..., Any]) -> Any:
    return what(site=SITE, device_id=OVEN, by=None, at=datetime.now(UTC))


def is_here() -> bool:
    device = services.find_device(device_id=OVEN)
    return device is not None and device.online and "temperature" in device.readings


def has_left() -> bool:
    return not services.find_device(device_id=OVEN).online  # type: ignore[union-attr]


def kept(file: Path) -> str:
    return str(json.loads(file.read_text())[OVEN])


def test_a_device_that_may_come_back_knocks_with_a_fresh_key_and_goes_on(keys: Path) -> None:
    decide(services.retire_device)
    wait_for("an enrolment while it is out", lambda: (keys.parent / "devices-spare.json").exists())
    assert kept(keys) == KEY
    decide(services.readmit_device)
    wait_for("the device", is_here, 40)
    assert services.find_device(device_id=OVEN).lifecycle == "pending"  # type: ignore[union-attr]
    wait_for("its key", lambda: kept(keys) != KEY)
    assert services.check_device_password(username=OVEN, password=KEY) is None
    decided = decide(services.approve_device)
    assert (decided.taken, kept(keys)) == (True, decided.credential)
    assert not DeviceEvent.objects.filter(device=OVEN, kind="problem").exists()


def test_a_new_key_is_taken_and_a_revoked_one_waits_for_one_written_by_hand(keys: Path) -> None:
    new = decide(services.rotate_credential)
    assert (new.taken, kept(keys)) == (True, new.credential)
    wait_for("the device with its new key", is_here, 40)
    decide(services.revoke_credential)
    wait_for("the end", has_left)
    told = decide(services.rotate_credential)
    assert not told.taken
    keys.write_text(json.dumps({**json.loads(keys.read_text()), OVEN: told.credential}))
    wait_for("the device with the key from the file", is_here, 40)
