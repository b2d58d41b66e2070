"""A site with people of every role in the database, and devices of it that are made to speak, without a broker."""

from __future__ import annotations

import json
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import replace
from datetime import UTC, datetime, timedelta
from typing import Any

from registry import services
from registry.devices.descriptions import DescriptionMessage
from registry.floorplan.plan import Grid
from registry.live import fanout
from registry.models import Device
from tests.kit.sign_in import ROLES, add_person
from vipo_device.descriptions.reader import write_description
from vipo_device.protocol.description import Description, MethodSpec, Pose, PropertySpec, Size

NOW = datetime(2026, 11, 21, 12, 0, tzinfo=UTC)
LATER = NOW + timedelta(minutes=1)
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


def make_hall() -> str:
    """Make a site with a map, a member of each role (viewer@… to admin@…) and a stranger@…."""
    services.create_site(name="Hall", slug="hall")
    for name in ROLES:
        add_person(name, "hall")
    add_person("stranger")
    services.save_map(site="hall", grid=Grid(4, 3, 1.0, 0.0, 0.0, bytes([0] * 8 + [100] * 3 + [255])))
    return "hall"


def make_mixers(*names: str) -> None:
    """Make approved mixers of these names, and a robot `new_robot` that is not approved."""
    for name in names:
        method = replace(MIXER.methods[0], topic=f"vipo/v1/dev/{name}/down/mix")
        describe(replace(MIXER, id=name, name=f"Mixer {name}", methods=(method,)))
    Device.objects.update(lifecycle="approved")
    describe(replace(ROBOT, id="new_robot"))


def describe(description: Description = MIXER) -> Any:
    """Let a device describe itself."""
    payload = write_description(description).encode()
    return services.ingest_description(device_id=description.id, payload=payload, at=NOW)


def approve(description: Description = MIXER) -> str:
    """Let a device describe itself and an admin approve it; return its new key."""
    describe(description)
    decided = services.approve_device(site="hall", device_id=description.id, by=None, at=NOW)
    return str(decided.credential)


def come(device_id: str = "mixer1", *, boot: int = 1, online: bool = True, at: datetime = NOW) -> Any:
    """Let a device say that it is there, or gone."""
    body = json.dumps({"s": "online" if online else "offline", "boot": boot}).encode()
    return services.ingest_presence(device_id=device_id, payload=body, at=at)


def say(device_id: str = "mixer1", *, at: datetime = NOW, retained: bool = False, **fields: Any) -> Any:
    """Let a device say its state."""
    body = json.dumps({"boot": 1, "seq": 1, "done": True, **fields}).encode()
    return services.ingest_state(device_id=device_id, payload=body, at=at, retained=retained)


def may_come_in(key: str, device_id: str = "mixer1") -> bool:
    """Tell whether the broker lets a device in with this key."""
    return services.check_device_password(username=device_id, password=key) is not None


@contextmanager
def hear_news() -> Iterator[list[tuple[str, Any]]]:
    """Give what the browsers of each site are told from now on: site and message."""
    heard: list[tuple[str, Any]] = []
    stop = fanout.listen(lambda slug, message: heard.append((slug, message)))
    try:
        yield heard
    finally:
        stop()


def describe_later(description: Description, device_id: str = "", form: str = "turtle") -> DescriptionMessage:
    """Return what a device says of itself a minute later, for those that take in many at once."""
    return DescriptionMessage(device_id or description.id, write_description(description, form).encode(), LATER)
