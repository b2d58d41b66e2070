"""Two admins decide about one device at the same moment."""

from __future__ import annotations

import threading
from collections.abc import Callable
from datetime import UTC, datetime
from pathlib import Path
from typing import Any

import pytest
from django.conf import LazySettings
from django.db import connection

from registry import services
from registry.models import DeviceEvent
from registry.services import NotPending

TEXT = Path("registry/demo/devices/paintMixer03.ttl").read_bytes()


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
