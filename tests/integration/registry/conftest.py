"""A site with people of every role, and devices that can be made to speak."""

from __future__ import annotations

import json
from collections.abc import Callable
from dataclasses import replace
from datetime import UTC, datetime
from typing import Any

import pytest

from registry import services
from registry.floorplan.plan import Grid
from registry.models import User
from vipo_device.descriptions.reader import write_description
from vipo_device.protocol.description import Description, MethodSpec, Pose, PropertySpec, Size

NOW = datetime(2026, 11, 21, 12, 0, tzinfo=UTC)
PASSWORD = "correct-horse-9"
ROLES = ("viewer", "operator", "author", "admin")
MIXER = Description(
    "mixer1",
    "Mixer One",
    "machine",
    "mixer",
    Pose(2.0, 2.0),
    Size(1.0, 1.0, 1.0),
    site="hall",
    simulated=True,
    properties=(PropertySpec("jobStatus", "number", "PERCENT"),),
    methods=(MethodSpec("mix", "vipo/v1/dev/mixer1/down/mix"),),
)
ROBOT = replace(MIXER, id="robot1", name="Robot One", kind="robot", device_class="turtlebot", radius_m=0.2, methods=())


@pytest.fixture
def hall(db: None) -> str:
    """A site with a map and one member of each role: viewer@…, operator@…, author@…, admin@…; stranger@… is none."""
    services.create_site(name="Hall", slug="hall")
    for name in (*ROLES, "stranger"):
        services.create_user(email=f"{name}@vipo.example", password=PASSWORD, display_name=f"{name.title()} Person")
        if name in ROLES:
            services.set_member(site="hall", email=f"{name}@vipo.example", role=name)
    services.save_map(site="hall", grid=Grid(4, 3, 1.0, 0.0, 0.0, bytes([0] * 8 + [100] * 3 + [255])))
    return "hall"


@pytest.fixture
def person(hall: str) -> Callable[[str], User]:
    return lambda name: User.objects.get(email=f"{name}@vipo.example")


def describe(description: Description = MIXER) -> Any:
    payload = write_description(description).encode()
    return services.ingest_description(device_id=description.id, payload=payload, at=NOW)


def come(device_id: str = "mixer1", *, boot: int = 1, online: bool = True, at: datetime = NOW) -> Any:
    body = json.dumps({"s": "online" if online else "offline", "boot": boot}).encode()
    return services.ingest_presence(device_id=device_id, payload=body, at=at)


def say(device_id: str = "mixer1", *, at: datetime = NOW, retained: bool = False, **fields: Any) -> Any:
    body = json.dumps({"boot": 1, "seq": 1, "done": True, **fields}).encode()
    return services.ingest_state(device_id=device_id, payload=body, at=at, retained=retained)
