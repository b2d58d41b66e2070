"""A stop's second way to the devices: the web process's own connection to the broker, beside the gateways'.

Both say the same, retained, so who comes second changes nothing; a gateway that is dead or frozen delays nothing.
"""

from __future__ import annotations

import os
import socket
from collections.abc import Mapping
from typing import Any

from vipo_device.protocol.clock import steady_s
from vipo_device.protocol.mqtt_client import MqttClient

FRESH_S = 1.0
"""Later than this after it was pressed, a stop is left to the gateways: it may have been reset meanwhile."""
_client: MqttClient | None = None


def stop_topic(site: str) -> str:
    """Return the topic of a site's stop."""
    return f"vipo/v1/site/{site}/stop"


def open_publisher(*, mqtt: Mapping[str, Any]) -> None:
    """Begin to connect, so that a stop finds the connection there; `mqtt` is the setting VIPO_MQTT."""
    global _client
    if _client is None:
        _client = MqttClient.from_settings(mqtt, client_id=f"stop-{socket.gethostname()}-{os.getpid()}")
        _client.start()


def close_publisher() -> None:
    """End the connection."""
    global _client
    if _client is not None:
        _client.stop()
        _client = None


def publish_stop(site: str, payload: bytes, began_s: float) -> bool:
    """Tell the devices of a site; False where there is no connection now, or it is too late: nothing may wait here."""
    if _client is None or not _client.connected or steady_s() - began_s > FRESH_S:
        return False
    _client.publish(stop_topic(site), payload, retain=True, wait_s=FRESH_S)
    return True
