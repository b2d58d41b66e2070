"""Whoever speaks MQTT sends each message at once: Nagle's algorithm is off on both ends, also under TLS."""

from __future__ import annotations

import os
from pathlib import Path
from typing import Any

import pytest

from tests.kit.mqtt import Ear, sends_at_once
from tests.kit.servers import run_mosquitto
from tests.kit.waiting import wait_for
from tests.unit.robot_agent.agent import Link, make_config
from vipo_device.protocol.sockets import tls_context
from vipo_site.embedded_broker.server import start_broker

WORD = "secret"
ROBOT = {"id": "tb1", "site": "hall", "radius_m": 0.2, "speed_m_s": 0.5, "ros": 2, "password": "a word"}


@pytest.mark.servers
@pytest.mark.parametrize("tls", [False, True], ids=["plain", "TLS"])
def test_clients_and_mosquitto_send_at_once(tmp_path: Path, tls: bool) -> None:
    with run_mosquitto(tmp_path, {"server": WORD, "tb1": "a word"}, tls=tls) as mosquitto:
        trusted = tls_context(mosquitto.authority) if tls else None
        with Ear(mosquitto.port, WORD, tls=trusted):
            assert sends_at_once(os.getpid(), mosquitto.port) == [True]
        where: dict[str, Any] = {"host": "localhost", "port": mosquitto.device_port, "ca": mosquitto.authority}
        link = Link(make_config({**ROBOT, **where}), 1)
        link.start()
        try:
            wait_for("the robot", lambda: link.is_connected)
            assert sends_at_once(os.getpid(), mosquitto.device_port) == [True]
            assert mosquitto.process is not None
            assert sends_at_once(mosquitto.process.pid, mosquitto.device_port) == [True]
        finally:
            link.stop()


def test_the_embedded_broker_and_its_clients_send_at_once() -> None:
    broker = start_broker(port=0, server_password=WORD)
    try:
        with Ear(broker.port, WORD):
            assert sends_at_once(os.getpid(), broker.port) == [True, True]
    finally:
        broker.stop()
