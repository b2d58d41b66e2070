"""What properties were: gathered, written by the minute, read back, forgotten after seven days."""

from __future__ import annotations

import json
from dataclasses import replace
from datetime import timedelta
from typing import Any

import pytest

from registry import services
from registry.devices import samples
from registry.devices.samples import Bucket, SampleBuffer
from registry.models import Device, Sample
from tests.kit.sign_in import ROLES, signed_in
from tests.kit.sites import MIXER, NOW, come, describe, say
from vipo_device.protocol.description import PropertySpec

OVEN = replace(MIXER, properties=(PropertySpec("heat", "number", "DEG_C"), PropertySpec("lid", "text")))
HISTORY = "/api/sites/hall/devices/mixer1/history"


@pytest.fixture
def oven(hall: str, monkeypatch: pytest.MonkeyPatch) -> str:
    describe(OVEN)
    Device.objects.update(lifecycle="approved")
    come(at=NOW - timedelta(days=30))
    monkeypatch.setattr(samples, "_buffer", SampleBuffer())
    return "mixer1"


class Talk:
    def __init__(self) -> None:
        self.seq = 0

    def __call__(self, minutes: float, **readings: Any) -> None:
        self.seq += 1
        say(at=NOW + timedelta(minutes=minutes), seq=self.seq, props=readings)


def history(name: str = "heat", *, minutes: float = -60, until: float = 60, most: int = 500) -> Any:
    return services.read_history(
        site="hall", device_id="mixer1", name=name, since=NOW + timedelta(minutes=minutes),
        now=NOW + timedelta(minutes=until), most=most,
    )  # fmt: skip


def points(series: Any) -> list[tuple[float, Any, Any, Any]]:
    return [((p.at - NOW).total_seconds() / 60, p.minimum, p.maximum, p.value) for p in series.points]


def test_a_minute_is_one_row_with_the_least_the_greatest_and_the_last_value(oven: str) -> None:
    talk = Talk()
    for seconds, heat in enumerate((20, 35, 18, 30)):
        talk(seconds / 60, heat=heat)
    talk(1.5, heat=31)
    assert services.flush_samples() == 0
    assert services.flush_samples(all_of_it=True) == 4
    assert points(history()) == [(0.05, 18.0, 35.0, 30), (1.5, 31.0, 31.0, 31)]
    assert (history().unit, history().bucket_s) == ("DEG_C", 60)


def test_what_is_written_later_in_the_same_minute_joins_what_is_there(oven: str) -> None:
    talk = Talk()
    for heat in (20, 40, 10, 25):
        talk(0, heat=heat)
        services.flush_samples(all_of_it=True)
    assert points(history()) == [(0.0, 10.0, 40.0, 25)]


def test_only_what_changes_is_kept_and_what_held_before_comes_first(oven: str) -> None:
    talk = Talk()
    for minutes in (-120, -90, 0, 5):
        talk(minutes, heat=20, lid="open")
    talk(7, heat=21, lid="open")
    services.flush_samples(all_of_it=True)
    assert points(history()) == [(-120.0, 20.0, 20.0, 20), (7.0, 21.0, 21.0, 21)]
    assert points(history("lid")) == [(-120.0, None, None, "open")]
    assert set(Sample.objects.values_list("property", flat=True)) == {"heat", "lid", "$done", "$online"}


def test_many_minutes_are_joined_into_as_many_points_as_are_wanted(oven: str) -> None:
    talk = Talk()
    for minutes in range(60):
        talk(minutes, heat=minutes)
    services.flush_samples(all_of_it=True)
    found = history(minutes=0, until=59, most=6)
    assert found.bucket_s == 600
    assert points(found) == [(9.0 + 10 * i, 10.0 * i, 10.0 * i + 9, 10 * i + 9) for i in range(6)]


def test_a_new_process_goes_on_where_the_last_one_ended(oven: str, monkeypatch: pytest.MonkeyPatch) -> None:
    talk = Talk()
    talk(0, heat=30)
    services.flush_samples(all_of_it=True)
    monkeypatch.setattr(samples, "_buffer", SampleBuffer())
    talk(0.5, heat=20)
    services.flush_samples(all_of_it=True)
    assert points(history()) == [(0.5, 20.0, 30.0, 20)]


def test_what_is_older_than_seven_days_is_forgotten(oven: str) -> None:
    talk = Talk()
    for days in (-8, -7.6, -7.5, -6.9, 0):
        talk(days * 24 * 60, heat=days)
    services.flush_samples(all_of_it=True)
    assert services.prune_samples(now=NOW)
    assert list(Sample.objects.filter(property="heat").order_by("minute").values_list("value", flat=True)) == [
        "-7.5",
        "-6.9",
        "0",
    ]


def test_a_value_that_has_not_changed_for_eight_days_is_still_there(oven: str) -> None:
    talk = Talk()
    for days in (-8, -6, -3, -0.1):
        talk(days * 24 * 60, heat=60)
        services.flush_samples(all_of_it=True)
        services.prune_samples(now=NOW + timedelta(days=days))
    services.prune_samples(now=NOW)
    assert [p[3] for p in points(history())] == [60]
    assert set(Sample.objects.values_list("property", flat=True)) == {"heat", "$done", "$online"}


def test_of_a_device_that_was_named_anew_each_day_only_what_it_describes_outlives_the_seven_days(oven: str) -> None:
    first = int((NOW - timedelta(days=7)).timestamp() // 60)
    names = [*(f"p{number}" for number in range(100)), "heat", "$online"]
    Sample.objects.bulk_create(
        Sample(device_id="mixer1", property=name, minute=first - 1, value="1", at_ms=(first - 1) * 60_000, seq=seq)
        for seq, name in enumerate(names)
    )
    assert services.prune_samples(now=NOW)
    assert set(Sample.objects.values_list("property", flat=True)) == {"heat", "$online"}


def test_it_is_forgotten_as_fast_as_it_is_written_a_part_at_a_time(oven: str, monkeypatch: pytest.MonkeyPatch) -> None:
    first = int((NOW - timedelta(days=7)).timestamp() // 60)
    Sample.objects.bulk_create(
        Sample(device_id="mixer1", property="heat", minute=first - n, value="1", at_ms=(first - n) * 60_000, seq=n)
        for n in range(1, 52)
    )
    monkeypatch.setattr(samples, "PRUNE_AT_ONCE", 10)
    monkeypatch.setattr(samples, "PRUNE_S", 0.0)
    assert not services.prune_samples(now=NOW)
    assert Sample.objects.count() == 41
    monkeypatch.setattr(samples, "PRUNE_S", 60.0)
    assert services.prune_samples(now=NOW)
    assert Sample.objects.count() == 1


def test_numbers_rise_with_each_writing_so_that_readers_can_go_on_from_one(oven: str) -> None:
    talk = Talk()
    talk(0, heat=1)
    services.flush_samples(all_of_it=True)
    first = max(Sample.objects.values_list("seq", flat=True))
    talk(0.2, heat=2)
    services.flush_samples(all_of_it=True)
    assert list(Sample.objects.filter(seq__gt=first).values_list("property", "value")) == [("heat", "2")]


def test_strangers_and_what_is_not_described_leave_no_rows(oven: str) -> None:
    talk = Talk()
    talk(0, smell=3)
    Device.objects.update(lifecycle="pending")
    talk(1, heat=3)
    services.flush_samples(all_of_it=True)
    assert set(Sample.objects.values_list("property", flat=True)) == {"$done", "$online"}


def test_what_cannot_be_written_is_kept_for_the_next_time() -> None:
    buffer = SampleBuffer()
    key = ("mixer1", "heat", 1)
    buffer._add("mixer1", "heat", 5, 60_000)
    buffer.give_back({key: Bucket(9, 1.0, 9.0, 59_000)}, 0.0)
    assert buffer.take(0.0, all_of_it=True) == {key: Bucket(5, 1.0, 9.0, 60_000)}


def test_a_device_that_changes_its_names_all_the_time_fills_no_disk() -> None:
    buffer = SampleBuffer()
    for number in range(5_000):
        buffer._add("mixer1", f"p{number}", 1, 60_000)
    buffer._add("mixer2", "heat", 1, 60_000)
    assert len(buffer.take(0.0, all_of_it=True) or buffer._waiting) == 1_001


def test_a_device_has_a_history_again_as_soon_as_a_clock_that_was_ahead_is_put_right() -> None:
    buffer, ahead, right = SampleBuffer(), 1_000, 10
    for number in range(2_000):
        buffer._add("mixer1", f"p{number}", 1, ahead * 60_000)
    assert len(buffer._waiting) == 1_000
    buffer._add("mixer1", "heat", 1, (ahead - 1) * 60_000)  # what another process took in a moment ago
    assert len(buffer._waiting) == 1_000
    for number in range(2_000):
        buffer._add("mixer1", f"p{number}", 1, right * 60_000)
    assert len(buffer._waiting) == 2_000
    buffer._add("mixer1", "heat", 1, (right + 1) * 60_000)
    assert len(buffer._waiting) == 2_001


@pytest.mark.parametrize("role", [*ROLES, "stranger", "nobody"])
def test_every_member_may_read_what_was(oven: str, role: str) -> None:
    talk = Talk()
    talk(0, heat=20.5)
    services.flush_samples(all_of_it=True)
    client = signed_in(role)
    answer = client.get(HISTORY, {"property": "heat", "since": NOW.isoformat()})
    assert answer.status_code == {"stranger": 404, "nobody": 401}.get(role, 200)
    if role in ROLES:
        assert (answer.json()["unit"], answer.json()["property"]) == ("DEG_C", "heat")


def test_a_property_that_is_not_there_is_refused_by_name(oven: str) -> None:
    client = signed_in("viewer")
    answer = client.get(HISTORY, {"property": "smell"})
    told = "Mixer One has no property 'smell'. It has: heat, lid."
    assert (answer.status_code, answer.json()["detail"]) == (422, told)
    assert client.get(HISTORY, {"property": "heat", "since": "yesterday"}).status_code == 422


def test_a_thousand_devices_are_written_at_once(oven: str) -> None:
    site = Device.objects.get().site
    described = json.loads(json.dumps(Device.objects.get().description))
    Device.objects.bulk_create(
        Device(id=f"m{n}", site=site, lifecycle="approved", description=described) for n in range(1000)
    )
    for n in range(1000):
        for name in ("heat", "lid", "$done"):
            samples._buffer._add(f"m{n}", name, n, 60_000)
    samples._buffer._since = 0.0
    assert services.flush_samples(all_of_it=True) == 3000
    assert Sample.objects.count() == 3000
