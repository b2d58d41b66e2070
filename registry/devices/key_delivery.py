"""A new key on its way to the device that it is for, over that device's own connection.

The key is said once on the device's own `down/credential`, never retained, and kept nowhere on the way; only the
connection that came in as this device may hear that topic.
"""

from __future__ import annotations

import json
import logging
import secrets
import threading
import uuid

from django.conf import settings

from vipo_device.protocol.messages import BadMessage, down_topic, parse_ack, up_topic
from vipo_device.protocol.mqtt_client import MqttClient, MqttError

log = logging.getLogger(__name__)
CONNECT_LIMIT_S = 10.0
ANSWER_LIMIT_S = 10.0
FINAL = frozenset({"DONE", "FAILED", "REJECTED", "CANCELED"})


def hand_over(*, device_id: str, credential: str) -> bool:
    """Say a device its new key, and tell whether it answered within 10 s that it has taken it."""
    command = str(uuid.uuid4())
    answered = threading.Event()
    answers: list[str] = []

    def hear(_topic: str, payload: bytes, _retained: bool) -> None:
        try:
            ack = parse_ack(payload)
        except BadMessage:
            return
        if ack.command == command and ack.status in FINAL:
            answers.append(ack.status)
            answered.set()

    try:
        client = MqttClient.from_settings(settings.VIPO_MQTT, client_id=f"keys-{secrets.token_hex(6)}")
    except MqttError as error:
        log.warning("%s was not told its new key: %s", device_id, error.detail)
        return False
    client.subscribe(up_topic(device_id, "ack"), 1, hear)
    client.start()
    try:
        if client.wait_subscribed(CONNECT_LIMIT_S):
            body = {"id": command, "v": {"credential": credential}, "ttl_s": ANSWER_LIMIT_S}
            client.publish(down_topic(device_id, "credential"), json.dumps(body).encode(), expiry_s=ANSWER_LIMIT_S)
            answered.wait(ANSWER_LIMIT_S)
    finally:
        client.stop()
    return answers[:1] == ["DONE"]
