"""Open programs are looked at again after what they depend on in devices has changed, and after nothing else."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from typing import Any

import pytest
from django.test import Client

from editor.programs.checking import build_surroundings, changes_programs, fingerprint_of
from registry import services
from registry.models import Device
from tests.kit.sign_in import signed_in
from tests.kit.sites import MIXER, NOW, ROBOT, come, describe, hear_news, make_hall, say
from tests.kit.work import count_work
from vipo_device.protocol.description import PropertySpec, Size

pytestmark = pytest.mark.django_db(transaction=True)
NUMBER = MIXER.properties[0]


@pytest.fixture(autouse=True)
def hall() -> None:
    """A site with a mixer and a robot, which are there and have said their readings."""
    make_hall()
    for description in (MIXER, ROBOT):
        describe(description)
        come(description.id)
    Device.objects.update(lifecycle="approved")
    say(props={"jobStatus": 1})
    say("robot1", loc=[1, 1, 0, 0], props={"jobStatus": 1})


def is_woken(change: Callable[[], Any]) -> bool:
    """Tell whether open programs are woken by what is told of a change, and that they are if they depend on it."""
    before = fingerprint_of(build_surroundings(site="hall"))
    with hear_news() as heard:
        change()
    assert heard
    woken = [changes_programs(message) for _, message in heard]
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
def test_a_device_that_describes_itself_otherwise_wakes_open_programs(change: Any) -> None:
    assert is_woken(lambda: describe(replace(MIXER, **change)))


def test_a_machine_that_is_moved_wakes_open_programs() -> None:
    client = signed_in("admin")
    assert is_woken(lambda: move(client, 3.0))
    assert is_woken(lambda: move(client, 2.5))


def test_a_machine_that_says_another_place_of_itself_wakes_open_programs() -> None:
    assert is_woken(lambda: say(seq=2, loc=[3, 1, 0, 0]))


def test_a_device_that_goes_comes_back_is_new_or_is_taken_out_wakes_open_programs() -> None:
    assert is_woken(lambda: come(online=False))
    assert is_woken(lambda: say(seq=2))
    assert is_woken(lambda: describe(replace(MIXER, id="mixer2", methods=())))
    assert is_woken(lambda: services.retire_device(site="hall", device_id="robot1", by=None, at=NOW))


def test_readings_and_a_robot_that_drives_wake_nobody() -> None:
    assert not is_woken(lambda: say(seq=2, done=False, props={"jobStatus": 50}))
    assert not is_woken(lambda: say("robot1", seq=2, loc=[2, 1, 0, 1], props={"jobStatus": 7}))
    assert not is_woken(lambda: say("robot1", seq=3, done=False, loc=[3, 1, 0, 1]))


def test_news_of_a_device_with_many_readings_are_judged_without_looking_at_them() -> None:
    describe(replace(MIXER, properties=tuple(PropertySpec(f"p{number}", "number") for number in range(60))))
    with hear_news() as heard:
        say(seq=2, props={f"p{number}": number for number in range(60)})
    ((_, message),) = heard
    assert len(message["device"]["properties"]) == 60
    with count_work() as work:
        assert not changes_programs(message)
    assert work.lines <= 10
