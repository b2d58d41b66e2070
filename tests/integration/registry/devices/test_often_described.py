"""A device that describes itself anew all the time leaves the rest of its history where it is."""

from __future__ import annotations

from dataclasses import replace
from datetime import timedelta

from registry import services
from registry.models import DeviceEvent
from registry.services import DescriptionMessage
from tests.kit.sites import MIXER, NOW, approve, come
from vipo_device.descriptions.reader import write_description

OFTEN = "Describes itself anew all the time; not every time is written down"


def change(count: int, start: int = 0, minutes: float = 0.0) -> None:
    for number in range(start, start + count):
        payload = write_description(replace(MIXER, name=f"Mixer {number}")).encode()
        at = NOW + timedelta(minutes=minutes, milliseconds=number)
        services.ingest_descriptions(descriptions=[DescriptionMessage("mixer1", payload, at)])


def lines() -> list[str]:
    return list(DeviceEvent.objects.filter(device="mixer1").order_by("pk").values_list("text", flat=True))


def test_three_hundred_changes_within_ten_minutes_are_ten_lines(hall: str) -> None:
    approve()
    come()
    change(300)
    told = lines()
    assert told[:3] == ["Described itself for the first time: Mixer One, mixer", "Approved", "Came online"]
    assert (len(told), told[-1]) == (12, OFTEN)
    assert services.get_device(site="hall", device_id="mixer1").name == "Mixer 299"
    change(2, 300, minutes=11)
    assert lines()[-2:] == ["Calls itself Mixer 300", "Calls itself Mixer 301"]
