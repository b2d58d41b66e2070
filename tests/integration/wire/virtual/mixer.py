"""A mixer that somebody else might have written, and commands for it."""

from __future__ import annotations

import json
import threading
import time
from datetime import UTC, datetime
from uuid import UUID, uuid4

from execution.models import Command
from registry import services
from tests.integration.wire.bus import SITE, Bus
from vipo_device.kit.enrolment import take_new_keys
from vipo_device.protocol.mqtt_client import MqttClient

KEY = "the-key-of-the-mixer-0001"
MIXER = "paintMixer03"
A_MINUTE_S = 1.0


class Mixer:
    """Takes `pace` times as long as it should; answers as docs/protocol.md says, and does once what is said twice."""

    def __init__(self, bus: Bus) -> None:
        self.client: MqttClient = bus.client(MIXER, KEY)
        self.pace, self.heard = 1.0, 0
        self._known: set[str] = set()
        take_new_keys(MIXER, self.client, lambda key: None)
        self.client.subscribe(f"vipo/v1/dev/{MIXER}/down/mixPaint", 1, self._told)

    def _say(self, kind: str, body: object) -> None:
        self.client.publish(f"vipo/v1/dev/{MIXER}/up/{kind}", json.dumps(body).encode())

    def _told(self, _topic: str, payload: bytes, _retained: bool) -> None:
        told = json.loads(payload)
        if told["id"] in self._known:
            return  # its answer is on its way
        self._known.add(told["id"])
        self.heard += 1
        threading.Thread(target=self._mix, args=(told["id"], told["v"]["time"])).start()

    def _mix(self, command: str, minutes: float) -> None:
        for status in ("ACCEPTED", "RUNNING"):
            self._say("ack", {"id": command, "st": status})
        time.sleep(self.pace * minutes * A_MINUTE_S)
        self._say("ack", {"id": command, "st": "DONE"})


def tell(method: str = "mixPaint", *, to: str = MIXER, stand_in: bool = False, **arguments: object) -> UUID:
    """Put a command into the outbox; the gateway sends it."""
    at = datetime.now(UTC)
    command = Command.objects.create(
        id=uuid4(), site_id=services.get_site_id(site=SITE), position=Command.objects.count() + 1, device=to,
        method=method, arguments=arguments, run=uuid4(), step="mix", send_after=at, created_at=at, stand_in=stand_in,
    )  # fmt: skip
    services.wake("gateway")
    return command.pk


def is_over(command: UUID) -> bool:
    return Command.objects.get(pk=command).status == "done"
