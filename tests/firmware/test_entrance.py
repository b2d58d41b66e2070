"""Keys on the real MicroPython: a new device enrols, a new key is kept and believed only once the broker takes it."""

from __future__ import annotations

import json
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import pytest

from tests.firmware.rig import (
    ACCOUNTS,
    DEVICE,
    LIMIT_S,
    EmbeddedBus,
    Running,
    configuration,
    interpreter_command,
    running_chip,
    start_firmware,
)
from tests.kit.mqtt import Ear
from tests.kit.servers import run_mosquitto, write_mosquitto_files
from tests.kit.waiting import wait_for
from vipo_device.protocol.sockets import tls_context

JOIN_KEY, NEXT_KEY, STRAY_KEY = "j" * 32, "n" * 40, "s" * 40
ACCOUNTS_FOR_ENROLMENT = {"server": ACCOUNTS["server"], "join:hall": JOIN_KEY}


@contextmanager
def open_bus(kind: str, folder: Path) -> Iterator[Any]:
    """A broker that knows nobody but the server and the site's account for enrolment."""
    if kind == "amqtt":
        embedded = EmbeddedBus()
        embedded.accounts = dict(ACCOUNTS_FOR_ENROLMENT)
        embedded.start()
        yield embedded
        embedded.stop()
    else:
        with run_mosquitto(folder, ACCOUNTS_FOR_ENROLMENT) as mosquitto:
            yield mosquitto


def restart_with(bus: Any, key: str) -> None:
    """Let the device in with a key, and nobody with another; every connection ends."""
    bus.kill()
    bus.accounts[DEVICE] = key
    if not isinstance(bus, EmbeddedBus):
        write_mosquitto_files(bus)
    bus.start()


@pytest.fixture(params=["amqtt", "mosquitto"])
def new_device(request: pytest.FixtureRequest, micropython: str, tmp_path: Path) -> Iterator[Running]:
    with open_bus(request.param, tmp_path) as bus, Ear(bus.port, ACCOUNTS["server"], "vipo/v1/#") as ear:
        command = interpreter_command(micropython)
        process = start_firmware(command, tmp_path, bus, password="", join_key=JOIN_KEY)
        running = Running(ear, bus, process, tmp_path / "panel.log")
        try:
            yield running
        finally:
            running.end()


def test_a_new_device_enrols_with_a_key_of_its_own_and_takes_new_ones(new_device: Running, tmp_path: Path) -> None:
    kept = tmp_path / "key"
    enrolled = new_device.ear.wait(lambda h: h.topic == f"vipo/v1/join/hall/{DEVICE}", LIMIT_S)
    own = enrolled.json["key"]
    assert (list(enrolled.json), len(own), kept.read_text()) == (["key"], 48, own)
    assert JOIN_KEY not in own
    restart_with(new_device.bus, own)
    new_device.state(lambda _state: True)

    new_device.tell("credential", "k1", credential="short")
    assert "20 to 128" in new_device.answer("k1", "REJECTED").json["why"]
    new_device.tell("credential", "k2", credential=NEXT_KEY)
    new_device.answer("k2", "DONE")
    assert kept.read_text() == f"{NEXT_KEY}\n{own}"
    come_back(new_device, NEXT_KEY)
    wait_for("the new key in its file", lambda: kept.read_text() == NEXT_KEY)

    new_device.tell("credential", "k3", credential=STRAY_KEY)
    new_device.answer("k3", "DONE")
    come_back(new_device, NEXT_KEY)
    wait_for("the new key in its file", lambda: kept.read_text() == NEXT_KEY)


def come_back(new_device: Running, key: str) -> None:
    """Let the device in with that key alone; it tells its state anew, whether this is heard at once or kept."""
    told = max(h.json["seq"] for h in new_device.ear.all("/up/state"))
    restart_with(new_device.bus, key)
    new_device.state(lambda state: state["seq"] > told)


def test_a_board_enrols_over_tls(micropython: str, tmp_path: Path) -> None:
    with run_mosquitto(tmp_path, ACCOUNTS_FOR_ENROLMENT, tls=True) as bus:
        authority = tls_context(bus.authority)
        settings = configuration(bus, tmp_path, password="", join_key=JOIN_KEY, wifi_name="hall")
        (tmp_path / "config.json").write_text(json.dumps(settings))
        with (
            Ear(bus.port, ACCOUNTS["server"], "vipo/v1/#", tls=authority) as ear,
            running_chip(micropython, tmp_path, {}) as chip,
        ):
            board = Running(ear, bus, chip.process, tmp_path / "console")
            enrolled = ear.wait(lambda h: h.topic == f"vipo/v1/join/hall/{DEVICE}", LIMIT_S)
            restart_with(bus, enrolled.json["key"])
            board.state(lambda _state: True)
            assert chip.process.poll() is None
