"""How the devices of other worlds come in to VIPO's broker, as its settings say."""

from __future__ import annotations

import os
from pathlib import Path
from typing import Any

from django.conf import settings

from connectors.keys import Doorstep, KeyRing
from vipo_device.kit.connection import ConnectionMaker
from vipo_device.protocol.mqtt_client import MqttClient, Will, tls_context


def device_connections(site: str, secrets: Path, world: str) -> ConnectionMaker:
    """Return what connects a device to VIPO, by its own key; a newcomer of that world knocks with the join key."""
    ring = KeyRing(secrets / "devices.json", secrets / f"{world}-{site}.json")
    join_key = read_join_key(secrets)
    doorstep = Doorstep(site, ring, (lambda: vipo_client(f"join:{site}", join_key)) if join_key else None)

    def connect(device: str, will: Will) -> MqttClient:
        key = ring.key(device)
        client = vipo_client(device, key, will)
        doorstep.watch(device, key, client)
        return client

    return connect


def read_join_key(secrets: Path) -> str:
    """Return the site's join key, empty where there is none."""
    path = secrets / "join"
    return os.environ.get("VIPO_JOIN_KEY", "") or (path.read_text().strip() if path.exists() else "")


def vipo_client(name: str, key: str, will: Will | None = None) -> MqttClient:
    """Return a connection to the devices' listener of VIPO's broker."""
    broker: dict[str, Any] = settings.VIPO_MQTT
    return MqttClient(
        host=broker["host"],
        port=int(os.environ.get("VIPO_MQTT_DEVICE_PORT", broker["port"])),
        username=name,
        password=key,
        client_id=name,
        tls=tls_context(broker["ca"]) if broker["tls"] else None,
        will=will,
    )
