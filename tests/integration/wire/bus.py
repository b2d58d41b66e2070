"""A broker with the registry's accounts, and how tests come in to it."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

from tests.kit.servers import Mosquitto
from tests.kit.waiting import wait_for
from vipo_device.protocol.mqtt_client import MqttClient

SITE, SERVER_WORD, JOIN = "hall", "the server's word", "j" * 32


@dataclass
class Bus:
    """A broker that runs with the registry's accounts."""

    kind: str
    server_port: int
    device_port: int
    mosquitto: Mosquitto | None = None

    def client(self, name: str, key: str, **more: Any) -> MqttClient:
        return MqttClient(host="127.0.0.1", port=self.device_port, username=name, password=key, client_id=name, **more)

    def lets_in(self, name: str, key: str) -> bool:
        client = self.client(name, key)
        client.start()
        try:
            wait_for("an answer", lambda: client.connected or client.refusal)
            return client.connected
        finally:
            client.stop()
