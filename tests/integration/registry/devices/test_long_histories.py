"""A history keeps what people decided, however often its device comes, leaves, reports and describes itself."""

from __future__ import annotations

from collections import Counter
from dataclasses import replace
from datetime import timedelta

import pytest

from registry import services
from registry.devices import history
from registry.devices.history import MOST_EVENTS, MOST_OF_NOISY
from registry.models import DeviceEvent
from tests.kit.sites import MIXER, NOW, approve, come, describe_later, say


@pytest.fixture
def mixer(hall: str) -> str:
    approve()
    services.update_device(site="hall", device_id="mixer1", name="Oven by the door", by=None, at=NOW)
    return "mixer1"


def kinds() -> Counter[str]:
    return Counter(DeviceEvent.objects.values_list("kind", flat=True))


def test_a_device_on_a_bad_line_pushes_nothing_out_of_its_history(mixer: str) -> None:
    for number in range(6 * 40):
        come(boot=1, online=number % 2 == 0, at=NOW + timedelta(seconds=10 * (number + 1)))
    kept = kinds()
    assert (kept["approved"], kept["described"], kept["edited"]) == (1, 1, 1)
    assert kept["online"] + kept["offline"] + kept["flapping"] == MOST_OF_NOISY


def test_a_device_that_reports_errors_and_refused_messages_pushes_nothing_out_of_its_history(mixer: str) -> None:
    come(at=NOW)
    for number in range(150):
        at = NOW + timedelta(seconds=20 * number)
        say(at=at, seq=number + 1, props={"error": "Lid open" if number % 2 == 0 else ""})
        services.record_problem(device_id=mixer, text=f"state: {number}", at=at)
    kept = kinds()
    assert (kept["approved"], kept["described"], kept["edited"], kept["online"]) == (1, 1, 1, 1)
    assert kept["error"] + kept["recovered"] + kept["problem"] == MOST_OF_NOISY


def test_descriptions_push_out_older_descriptions_alone(mixer: str, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(history, "DAMPED_FOR", timedelta(0))
    for number in range(MOST_OF_NOISY + history.EVENTS_TO_SPARE + 2):
        said = describe_later(replace(MIXER, name=f"Mixer {number}"))
        services.ingest_descriptions(descriptions=[said])
    kept = kinds()
    assert (kept["approved"], kept["edited"]) == (1, 1)
    assert MOST_OF_NOISY <= kept["described"] <= MOST_OF_NOISY + history.EVENTS_TO_SPARE


def test_of_what_people_decide_the_newest_two_hundred_are_kept(mixer: str) -> None:
    for number in range(MOST_EVENTS + 5):
        services.update_device(site="hall", device_id=mixer, name=f"Oven {number}", by=None, at=NOW)
    kept = kinds()
    assert (kept["edited"], kept["approved"], kept["described"]) == (MOST_EVENTS, 0, 1)
