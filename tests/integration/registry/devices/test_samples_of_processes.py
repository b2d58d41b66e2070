"""What properties were, where several processes hear the same device: gateways, the ticker, the web processes."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from datetime import datetime, timedelta
from typing import Any

import pytest
from django.utils import timezone
from lxml import etree

from registry import services
from registry.devices import samples
from registry.devices.samples import SampleBuffer
from registry.models import Device, Sample
from tests.kit.sign_in import signed_in
from tests.kit.sites import MIXER, NOW, come, describe, say
from vipo_device.protocol.description import PropertySpec

OVEN = replace(MIXER, properties=(PropertySpec("heat", "number", "DEG_C"),))
Within = Callable[[SampleBuffer], None]


@pytest.fixture
def oven(hall: str) -> str:
    describe(OVEN)
    Device.objects.update(lifecycle="approved")
    come(at=NOW - timedelta(hours=1))
    return "mixer1"


@pytest.fixture
def within(oven: str, monkeypatch: pytest.MonkeyPatch) -> Within:
    """Let what follows happen in the process that has this memory."""
    return lambda memory: monkeypatch.setattr(samples, "_buffer", memory)


def heard(minutes: float, seq: int, heat: float) -> None:
    say(at=NOW + timedelta(minutes=minutes), seq=seq, props={"heat": heat})


def heats() -> list[Any]:
    until = NOW + timedelta(minutes=30)
    found = services.read_history(site="hall", device_id="mixer1", name="heat", since=NOW, now=until)
    return [point.value for point in found.points]


def kept(name: str) -> list[str]:
    return list(Sample.objects.filter(property=name).order_by("seq").values_list("value", flat=True))


def test_two_gateways_that_hear_a_device_in_turn_keep_each_value(within: Within) -> None:
    gateways = (SampleBuffer(), SampleBuffer())
    for number, heat in enumerate((20, 90, 20, 90, 20)):
        within(gateways[number % 2])
        heard(number, number + 1, heat)
        services.flush_samples(all_of_it=True)
    assert heats() == [20, 90, 20, 90, 20]


def test_what_was_said_last_holds_whichever_gateway_writes_last(within: Within) -> None:
    early, late = SampleBuffer(), SampleBuffer()
    within(early)
    heard(1 / 60, 1, 20)
    within(late)
    heard(30 / 60, 2, 90)
    services.flush_samples(all_of_it=True)
    within(early)
    services.flush_samples(all_of_it=True)
    assert heats() == [90]
    row = Sample.objects.get(property="heat")
    assert (row.minimum, row.maximum) == (20.0, 90.0)


def test_what_a_gateway_took_in_first_is_earlier_though_its_clock_was_later(within: Within) -> None:
    first, second = SampleBuffer(), SampleBuffer()
    within(first)
    heard(0.0002, 1, 20)
    within(second)
    heard(0.0001, 2, 90)
    services.flush_samples(all_of_it=True)
    within(first)
    services.flush_samples(all_of_it=True)
    assert heats() == [90]


def test_a_device_that_fell_silent_for_the_ticker_is_there_again_for_the_gateway(within: Within) -> None:
    gateway, ticker = SampleBuffer(), SampleBuffer()
    start = timezone.now() - timedelta(minutes=30)
    within(gateway)
    come(at=start)
    services.flush_samples(all_of_it=True)
    for outage in range(2):
        away = start + timedelta(minutes=2 + 10 * outage)
        within(ticker)
        services.mark_stale(now=away)
        within(gateway)
        say(at=away + timedelta(minutes=3), seq=outage + 1)
        services.flush_samples(all_of_it=True)
    assert kept("$online") == ["true", "false", "true", "false", "true"]
    client, address = signed_in("viewer"), "/api/sites/hall/mtconnect/current"
    last = _header(client.get(address).content).get("lastSequence")
    then = etree.fromstring(client.get(address, {"at": last}).content)
    assert [e.text for e in then.iter() if etree.QName(e).localname == "Availability"] == ["AVAILABLE"]


def _header(document: bytes) -> Any:
    return etree.fromstring(document).find("{*}Header")


def test_what_the_ticker_notes_is_written_before_a_gateway_hears_the_next(within: Within) -> None:
    within(SampleBuffer())
    services.mark_stale(now=NOW)
    assert kept("$online") == ["false"]


def test_a_process_that_hears_a_device_for_the_first_time_writes_all_of_it(within: Within) -> None:
    within(SampleBuffer())
    heard(0, 1, 20)  # that process is killed before it writes
    within(SampleBuffer())
    heard(1, 2, 20)
    services.flush_samples(all_of_it=True)
    assert (heats(), kept("$online")) == ([20], ["true"])


def _revoke(at: datetime) -> None:
    services.revoke_credential(site="hall", device_id="mixer1", by=None, at=at)


def _retire(at: datetime) -> None:
    services.retire_device(site="hall", device_id="mixer1", by=None, at=at)


def _simulate(at: datetime) -> None:
    services.switch_stand_in(site="hall", device_id="mixer1", simulated=True, by=None, at=at)


@pytest.mark.parametrize("decide", [_revoke, _retire, _simulate])
def test_what_people_decide_stands_in_the_history_at_once(
    within: Within, decide: Callable[[datetime], None], django_capture_on_commit_callbacks: Any
) -> None:
    within(SampleBuffer())
    heard(0, 1, 20)
    services.flush_samples(all_of_it=True)
    within(SampleBuffer())
    with django_capture_on_commit_callbacks(execute=True):
        decide(NOW + timedelta(minutes=1))
    assert kept("$online") == ["true", "false"]


def test_a_device_that_was_approved_has_a_history_from_then_on(
    within: Within, django_capture_on_commit_callbacks: Any
) -> None:
    memory = SampleBuffer()
    Device.objects.update(lifecycle="pending")
    within(memory)
    heard(0, 1, 20)
    with django_capture_on_commit_callbacks(execute=True):
        services.approve_device(site="hall", device_id="mixer1", by=None, at=NOW + timedelta(minutes=2))
    assert (heats(), kept("$online")) == ([20], ["true"])
    heard(3, 2, 20)
    services.flush_samples(all_of_it=True)
    assert heats() == [20]
