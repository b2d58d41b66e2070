"""Two admins decide about one device at the same moment."""

from __future__ import annotations

import json
import threading
from collections.abc import Callable
from datetime import UTC, datetime
from pathlib import Path
from typing import Any

import pytest
from django.conf import LazySettings
from django.db import connection

from registry import services
from registry.devices.credentials import KeyChanged
from registry.models import DeviceEvent
from registry.services import NotPending
from tests.integration.wire.bus import SERVER_WORD, SITE, Bus
from tests.kit.files import MIXER_TEXT
from tests.kit.mqtt import Ear
from tests.kit.waiting import wait_for

TEXT = MIXER_TEXT.encode()


@pytest.mark.parametrize("other", [services.approve_device, services.reject_device])
def test_one_of_two_admins_decides_and_the_other_is_told(
    database: Path, settings: LazySettings, other: Callable[..., Any]
) -> None:
    services.create_site(name="Hall", slug="hall")
    settings.VIPO_DEFAULT_SITE = "hall"
    services.ingest_description(device_id="paintMixer03", payload=TEXT, at=datetime.now(UTC))
    together, came_of_it = threading.Barrier(2), []

    def decide(what: Callable[..., Any]) -> None:
        together.wait(20)
        try:
            what(site="hall", device_id="paintMixer03", by=None, at=datetime.now(UTC))
            came_of_it.append("decided")
        except NotPending:
            came_of_it.append("told")
        finally:
            connection.close()

    admins = [threading.Thread(target=decide, args=(what,)) for what in (services.approve_device, other)]
    for admin in admins:
        admin.start()
    for admin in admins:
        admin.join(40)
    assert sorted(came_of_it) == ["decided", "told"]
    assert DeviceEvent.objects.filter(kind__in=("approved", "retired")).count() == 1


@pytest.mark.parametrize("bus", ["amqtt"], indirect=True)
def test_a_key_that_is_revoked_while_the_device_is_told_another_stays_revoked(bus: Bus) -> None:
    name, who = "paintMixer03", {"site": SITE, "device_id": "paintMixer03", "by": None, "at": datetime.now(UTC)}
    services.ingest_description(device_id=name, payload=TEXT, at=datetime.now(UTC))
    key = str(services.approve_device(**who).credential)
    services.ingest_presence(device_id=name, payload=b'{"s": "online", "boot": 1}', at=datetime.now(UTC))
    device = bus.client(name, key)
    told: list[dict[str, Any]] = []
    device.subscribe(f"vipo/v1/dev/{name}/down/credential", 1, lambda _t, body, _r: told.append(json.loads(body)))
    device.start()
    assert device.wait_subscribed(20)
    came_of_it: list[BaseException] = []

    def rotate() -> None:
        try:
            services.rotate_credential(**who)
        except KeyChanged as error:
            came_of_it.append(error)
        finally:
            connection.close()

    first = threading.Thread(target=rotate)
    first.start()
    wait_for("the new key", lambda: told)
    with pytest.raises(KeyChanged, match="Somebody else is giving paintMixer03 a new key just now"):
        services.rotate_credential(**who)  # the device would keep the later key, the server perhaps the other
    services.revoke_credential(**who)
    with Ear(bus.server_port, SERVER_WORD) as ear:  # the device's own answer may be lost with its connection
        ear.say(f"vipo/v1/dev/{name}/up/ack", {"id": told[0]["id"], "st": "DONE"})
        first.join(40)
    device.stop()
    assert [str(error).split(" meanwhile")[0] for error in came_of_it] == [
        f"Somebody else has given {name} another key"
    ]
    assert not services.get_device(site=SITE, device_id=name).has_key
    assert not bus.lets_in(name, told[0]["v"]["credential"])
