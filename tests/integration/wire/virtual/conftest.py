"""A mixer that has joined and was let in."""

from __future__ import annotations

import json
from collections.abc import Iterator
from datetime import UTC, datetime

import pytest

from execution.gateway.gateway import Gateway
from registry import services
from tests.integration.wire.bus import SITE, Bus
from tests.integration.wire.virtual.mixer import KEY, MIXER, Mixer
from tests.kit.files import MIXER_TEXT
from tests.kit.waiting import wait_for


@pytest.fixture
def mixer(bus: Bus, gateway: Gateway) -> Iterator[Mixer]:
    at = datetime.now(UTC)
    services.enrol_device(site=SITE, device_id=MIXER, payload=json.dumps({"key": KEY}).encode(), at=at)
    made = Mixer(bus)
    made.client.publish(f"vipo/v1/dev/{MIXER}/up/desc", MIXER_TEXT.encode(), retain=True)
    made.client.publish(f"vipo/v1/dev/{MIXER}/up/presence", b'{"s": "online", "boot": 1}', retain=True)
    made.client.start()
    wait_for("its description", lambda: services.find_device(device_id=MIXER))
    services.approve_device(site=SITE, device_id=MIXER, by=None, at=datetime.now(UTC))
    wait_for("the approved mixer", lambda: made.client.connected)
    yield made
    made.client.stop()
