"""How the connectors' devices come to VIPO's broker: by the settings, the environment and the site's files of keys."""

from __future__ import annotations

import os
from pathlib import Path
from typing import Any

from django.conf import settings

from vipo_device.kit.connection import ConnectionMaker
from vipo_device.kit.enrolment import device_connections
from vipo_device.kit.keyring import KeyRing


def connections(site: str, secrets: Path, world: str) -> ConnectionMaker:
    """Return what connects the devices of another world to VIPO's listener for devices."""
    ring = KeyRing(secrets / "devices.json", secrets / f"{world}-{site}.json")
    broker: dict[str, Any] = settings.VIPO_MQTT
    port = int(os.environ.get("VIPO_MQTT_DEVICE_PORT", broker["port"]))
    return device_connections(site, {**broker, "port": port}, ring, read_enrolment_key(secrets))


def read_enrolment_key(secrets: Path) -> str:
    """Return the key by which the site's devices enrol, empty where there is none."""
    path = secrets / "join"
    return os.environ.get("VIPO_JOIN_KEY", "") or (path.read_text().strip() if path.exists() else "")
