"""Open programs are looked at again after what they depend on in devices has changed, and after nothing else."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from typing import Any

import pytest
from django.test import Client

from editor.programs.checking import DeviceWatch, build_surroundings, fingerprint_of
from registry.models import Device
from tests.kit.sign_in import signed_in
from tests.kit.sites import MIXER, ROBOT, come, describe, hear_news, make_hall, say
from vipo_device.protocol.description import PropertySpec, Size

pytestmark = pytest.mark.django_db(transaction=True)
NUMBER = MIXER.properties[0]


@pytest.fixture
def watch() -> DeviceWatch:
    """A watch of a site with a mixer and a robot, which has heard them come, say their readings and move."""
    make_hall()
    watch = DeviceWatch()
    with hear_news() as heard:
        for description in (MIXER, ROBOT):
            describe(description)
            come(description.id)
        Device.objects.update(lifecycle="approved")
        say(props={"jobStatus": 1})
        say("robot1", loc=[1, 1, 0, 0], props={"jobStatus": 1})
    for _, message in heard:
        watch.changes_programs(message)
    return watch


def is_woken(watch: DeviceWatch, change: Callable[[], Any]) -> bool:
    """Tell whether the watch is woken by what is told of a change, and that it is if programs depend on it."""
    before = fingerprint_of(build_surroundings(site="hall"))
    with hear_news() as heard:
        change()
    assert heard
    woken = [watch.changes_programs(message) for _, message in heard]
    assert any(woken) == (fingerprint_of(build_surroundings(site="hall")) != before)
    return any(woken)


def move(client: Client, x_m: float) -> None:
    body = {"location": {"x": x_m, "y": 1}}
    answer = client.patch(f"/api/sites/hall/devices/{MIXER.id}", body, content_type="application/json")
    assert answer.status_code == 200, answer.content


@pytest.mark.parametrize(
    "change",
    [
        {"properties": ()},
        {"properties": (replace(NUMBER, unit="DEG_C"),)},
        {"properties": (replace(NUMBER, minimum=0.0),)},
        {"properties": (NUMBER, PropertySpec("phase", "text", options=("hot", "cold")))},
        {"size": Size(2.0, 1.0, 1.0)},
        {"radius_m": 0.5},
    ],
)
def test_a_device_that_describes_itself_otherwise_wakes_open_programs(watch: DeviceWatch, change: Any) -> None:
    assert is_woken(watch, lambda: describe(replace(MIXER, **change)))


def test_a_machine_that_is_moved_wakes_open_programs(watch: DeviceWatch) -> None:
    client = signed_in("admin")
    assert is_woken(watch, lambda: move(client, 3.0))
    assert is_woken(watch, lambda: move(client, 2.5))


def test_readings_and_a_robot_that_drives_wake_nobody(watch: DeviceWatch) -> None:
    assert not is_woken(watch, lambda: say(seq=2, props={"jobStatus": 50}))
    assert not is_woken(watch, lambda: say("robot1", seq=2, loc=[2, 1, 0, 1], props={"jobStatus": 7}))


def test_a_robot_that_a_process_has_not_heard_of_wakes_it_once_at_most_while_it_drives(watch: DeviceWatch) -> None:
    with hear_news() as heard:
        for seq in range(2, 6):
            say("robot1", seq=seq, loc=[seq / 2, 1, 0, 1], props={"jobStatus": seq})
    fresh = DeviceWatch()
    assert [fresh.changes_programs(message) for _, message in heard][1:] == [False, False, False]
