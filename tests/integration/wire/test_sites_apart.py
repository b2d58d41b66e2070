"""Two sites on one broker, on both brokers: whose key opens what, and who hears whose stop."""

from __future__ import annotations

import json
import time

import pytest

from execution.floor.stops import press_stop
from execution.gateway.gateway import Gateway
from registry import services
from registry.broker.accounts import Account, accounts
from tests.integration.wire.bus import JOIN, SITE, Bus
from tests.kit.mqtt import Ear
from tests.kit.waiting import wait_for

pytestmark = pytest.mark.servers
YARD = "y" * 32
KEYS = {"mixer01": "k" * 32, "yard.mixer01": "q" * 32}


@pytest.fixture
def yard(bus: Bus) -> str:
    services.create_site(name="Yard", slug="yard")
    services.set_enrolment_key(site="yard", key=YARD)
    accounts().put(Account("join:yard", YARD))
    return "yard"


def enrol(bus: Bus, site: str, join_key: str, device: str) -> None:
    door = bus.client(f"join:{site}", join_key)
    door.publish(f"vipo/v1/join/{site}/{device}", json.dumps({"key": KEYS[device]}).encode())
    door.start()
    wait_for("the account", lambda: bus.lets_in(device, KEYS[device]))
    door.stop()


def heard_stops(bus: Bus, device: str) -> list[tuple[str, bytes]]:
    """Let a device ask for the stops of all sites and say what it hears within a second of a message of its own."""
    heard: list[tuple[str, bytes]] = []
    client = bus.client(device, KEYS[device])
    for topic in ("vipo/v1/site/hall/stop", "vipo/v1/site/yard/stop", "vipo/v1/site/+/stop", "vipo/v1/srv/status"):
        client.subscribe(topic, 1, lambda name, payload, _retained: heard.append((name, payload)))
    client.start()
    wait_for("the server's status", lambda: any(name == "vipo/v1/srv/status" for name, _ in heard))
    time.sleep(1.0)  # what must not come has no sign of its own
    client.stop()
    return [(name, payload) for name, payload in heard if name.endswith("/stop")]


def test_a_device_hears_its_own_sites_stop_and_nobodys_name(bus: Bus, gateway: Gateway, yard: str) -> None:
    enrol(bus, SITE, JOIN, "mixer01")
    enrol(bus, "yard", YARD, "yard.mixer01")
    for site in (SITE, "yard"):
        press_stop(site=site, by="Ada Meyer")
    with Ear(bus.server_port, "the server's word", "vipo/v1/site/+/stop") as ear:
        for site in (SITE, "yard"):
            ear.wait(lambda heard, site=site: heard.topic == f"vipo/v1/site/{site}/stop", 20)
    for device, site in (("mixer01", SITE), ("yard.mixer01", "yard")):
        ((topic, payload),) = set(heard_stops(bus, device))
        body = json.loads(payload)
        assert (topic, body["active"], sorted(body)) == (f"vipo/v1/site/{site}/stop", True, ["active", "at", "fence"])


def test_a_join_key_enrols_at_its_own_site_only(bus: Bus, gateway: Gateway, yard: str) -> None:
    assert not bus.lets_in("join:hall", YARD)
    assert not bus.lets_in("join:yard", JOIN)
    door = bus.client("join:yard", YARD)
    for topic in ("vipo/v1/join/hall/mixer01", "vipo/v1/join/yard/mixer01", "vipo/v1/join/yard/yard.mixer01"):
        door.publish(topic, json.dumps({"key": KEYS[topic.rsplit("/", 1)[1]]}).encode())
    door.start()
    wait_for("the last of them", lambda: bus.lets_in("yard.mixer01", KEYS["yard.mixer01"]))
    door.stop()
    assert not bus.lets_in("mixer01", KEYS["mixer01"])
    assert services.list_account_sites() == {"yard.mixer01": "yard"}


@pytest.mark.parametrize("bus", ["mosquitto"], indirect=True)
def test_an_account_of_an_earlier_version_hears_no_other_site_once_a_gateway_has_come(bus: Bus, yard: str) -> None:
    services.expect_device(site=SITE, device_id="mixer01", credential=KEYS["mixer01"])
    accounts().put(Account("mixer01", KEYS["mixer01"], site="+"))
    assert accounts().find_outdated() == {"mixer01"}
    services.reconcile_accounts()
    assert accounts().find_outdated() == frozenset()
    assert bus.lets_in("mixer01", KEYS["mixer01"])
