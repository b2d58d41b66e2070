"""Alerts: raised and ended by what devices say, one for each cause, seen by people, forgotten in time."""

from __future__ import annotations

import json
from collections.abc import Callable
from dataclasses import replace
from datetime import datetime, timedelta
from typing import Any

import pytest
from django.db import connection
from django.test import Client
from django.test.utils import CaptureQueriesContext

from registry import services
from registry.alerts import buffer as alert_notes
from registry.alerts import inbox
from registry.alerts.alerts import Raised
from registry.alerts.buffer import AGAIN_S, NoteBuffer
from registry.alerts.causes import sentence_of
from registry.models import Device, DeviceAlert, User
from registry.services import BadDevice
from tests.kit.sign_in import below_role, from_role, signed_in
from tests.kit.sites import MIXER, NOW, ROBOT, come, describe, say
from vipo_device.descriptions.reader import write_description
from vipo_device.protocol.description import PropertySpec
from vipo_site.cli.main import main

LONG_AGO = NOW - timedelta(days=1)
ALERTS = "/api/sites/hall/alerts"


@pytest.fixture
def mixer(hall: str, monkeypatch: pytest.MonkeyPatch) -> str:
    """A mixer that takes part and is online."""
    monkeypatch.setattr(alert_notes, "_buffer", NoteBuffer())
    describe()
    services.approve_device(site="hall", device_id="mixer1", by=None, at=NOW)
    come()
    return "mixer1"


def watch(seconds: float = 0, *, at_work: tuple[str, ...] = (), since: datetime = LONG_AGO) -> None:
    services.watch_devices(now=NOW + timedelta(seconds=seconds), since=since, at_work=at_work)


def alerts(state: Any = None) -> list[tuple[str, str, int]]:
    found = services.list_alerts(site="hall", state=state)
    return [(alert.code, str(alert.args.get("why", "")), alert.count) for alert in found]


def test_a_device_that_leaves_during_work_is_an_error_until_it_is_back(mixer: str) -> None:
    come(online=False)
    watch(2, at_work=(mixer,))
    assert alerts() == []
    watch(6, at_work=(mixer,))
    assert alerts() == [("offline_at_work", "", 1)]
    watch(4000)
    assert alerts() == [("offline_at_work", "", 1)]
    come(at=NOW + timedelta(seconds=4001))
    watch(4002)
    assert (alerts(), alerts("over")) == ([], [("offline_at_work", "", 1)])


def test_a_long_absence_is_a_warning_and_not_what_the_server_itself_has_lost(mixer: str, settings: Any) -> None:
    settings.VIPO_OFFLINE_ALERT_S = 120
    come(online=False)
    watch(119)
    watch(500, since=NOW + timedelta(seconds=450), at_work=(mixer,))
    assert alerts() == []
    watch(121)
    assert alerts() == [("offline", "", 1)]
    services.retire_device(site="hall", device_id=mixer, by=None, at=NOW)
    watch(122)
    assert alerts() == []


def test_a_start_of_the_watch_does_not_begin_an_absence_anew(mixer: str, settings: Any) -> None:
    settings.VIPO_OFFLINE_ALERT_S = 3600
    come(online=False)
    watch(3599, since=NOW + timedelta(seconds=1800))
    assert alerts() == []
    watch(3600, since=NOW + timedelta(seconds=1800))
    assert alerts() == [("offline", "", 1)]


def test_right_after_a_start_no_absence_is_told_however_long_it_was(mixer: str, settings: Any) -> None:
    settings.VIPO_OFFLINE_ALERT_S = 600
    come(online=False)
    watch(7259, since=NOW + timedelta(seconds=7200))
    assert alerts() == []
    come(boot=2, at=NOW + timedelta(seconds=7259))
    watch(7260, since=NOW + timedelta(seconds=7200))
    assert alerts() == []
    come(boot=2, online=False, at=NOW + timedelta(seconds=7261))
    watch(7262, since=NOW + timedelta(seconds=7200))
    assert alerts() == []
    watch(7861, since=NOW + timedelta(seconds=7200))
    assert alerts() == [("offline", "", 1)]


def test_what_a_device_says_is_an_alert_with_its_words(mixer: str, heard: list[Any]) -> None:
    say(props={"error": "Belt torn", "battery": 12})
    watch(1)
    assert alerts() == [("battery_low", "", 1), ("error", "Belt torn", 1)]
    say(seq=2, props={"error": "Belt and motor torn", "battery": 80})
    watch(2)
    assert alerts() == [("battery_low", "", 1), ("error", "Belt torn", 1)]
    watch(12)
    assert alerts() == [("error", "Belt and motor torn", 1)]
    come(online=False, at=NOW + timedelta(seconds=13))
    watch(30)
    assert alerts() == [("error", "Belt and motor torn", 1)]
    come(at=NOW + timedelta(seconds=31))
    say(seq=3, props={"error": "", "warning": True, "battery": "full"}, at=NOW + timedelta(seconds=31))
    watch(32)
    assert alerts() == [("warning", "", 1)]


@pytest.mark.parametrize(("unit", "told"), [("PERCENT", ["battery_low"]), ("V", [])])
def test_a_battery_that_is_said_in_volts_is_not_taken_for_a_share(unit: str, told: list[str], mixer: str) -> None:
    battery = PropertySpec("battery", "number", unit)
    describe(replace(MIXER, properties=(*MIXER.properties, battery)))
    say(props={"battery": 12.6})
    watch(1)
    assert [code for code, _, _ in alerts()] == told
    assert services.get_device(site="hall", device_id=mixer).status == ("warning" if told else "idle")


def test_who_changes_its_mind_all_the_time_has_one_alert(mixer: str) -> None:
    for second in range(60):
        said = {"error": "Jam" if second % 2 else ""}
        say(seq=second + 1, props=said, at=NOW + timedelta(seconds=second))
        watch(second)
    rows = DeviceAlert.objects.all()
    assert [(row.code, row.over_at) for row in rows] == [("error", None)]
    assert rows[0].count <= 6


def test_a_new_device_that_waits_long_is_told_to_admins(mixer: str) -> None:
    describe(ROBOT)
    come("robot1")
    watch(3500)
    assert alerts() == []
    watch(3700)
    assert alerts() == [("newcomer_waits", "", 1)]
    assert services.list_alerts(site="hall", role="author") == ()
    come("robot1", online=False)  # who is there would be told its key over MQTT
    services.approve_device(site="hall", device_id="robot1", by=None, at=NOW)
    come("robot1", boot=2)
    watch(3720)
    assert alerts() == []


def test_a_device_that_comes_and_leaves_and_a_foreign_key_are_told(mixer: str) -> None:
    for boot in range(2, 12):
        come(boot=boot, online=boot % 2 == 0)
    Device.objects.filter(pk=mixer).update(lifecycle="pending")
    assert services.check_device_password(username=mixer, password="k" * 30) is None
    with pytest.raises(BadDevice):
        services.enrol_device(site="hall", device_id=mixer, payload=b'{"key": "%s"}' % (b"kdj3o0-" * 5), at=NOW)
    Device.objects.filter(pk=mixer).update(lifecycle="approved", online=True)
    services.flush_alerts()
    assert sorted(alerts()) == [("flapping", "", 1), ("foreign_knock", "", 1), ("wrong_key", "", 1)]
    assert "two connections with its id displace each other" in sentence_of("flapping", {})
    quiet = DeviceAlert.objects.get(code="flapping").last_at
    services.watch_devices(now=quiet + timedelta(minutes=11), since=LONG_AGO, at_work=())
    assert sorted(alerts()) == [("foreign_knock", "", 1), ("wrong_key", "", 1)]


def test_a_flood_is_one_alert_and_next_to_no_statements(mixer: str) -> None:
    with CaptureQueriesContext(connection) as statements:
        for _ in range(10_000):
            services.note_alert(device_id=mixer, code="messages_dropped")
            services.note_alert(device_id="nobody", code="messages_dropped")
        services.flush_alerts()
        first = len(statements)
        for _ in range(10_000):
            services.note_alert(device_id=mixer, code="messages_dropped")
        services.flush_alerts()
    assert alerts() == [("messages_dropped", "", 10_000)]
    assert (first < 10, len(statements) - first) == (True, 0)


def test_notes_wait_for_their_turn_and_are_added_up() -> None:
    buffer = NoteBuffer()
    cause = Raised("mixer1", "messages_dropped", NOW)
    buffer.add(cause)
    assert [raised.count for raised in buffer.take(0.0)[0]] == [1]
    for _ in range(3):
        buffer.add(cause)
    assert buffer.take(AGAIN_S / 2) == ([], {})
    assert [raised.count for raised in buffer.take(AGAIN_S)[0]] == [3]
    buffer.mend(["mixer1", "other"], "messages_dropped", NOW, AGAIN_S)
    ended = {("mixer1", "messages_dropped"): NOW, ("other", "messages_dropped"): NOW}
    assert buffer.take(AGAIN_S) == ([], ended)
    assert buffer.take(AGAIN_S) == ([], ended)  # until it is settled
    buffer.settle(AGAIN_S)
    assert buffer.take(AGAIN_S + 1) == ([], {})
    assert buffer.take(2 * AGAIN_S) == ([], ended)
    buffer.settle(4 * AGAIN_S)
    assert buffer.take(8 * AGAIN_S) == ([], {})


def test_a_thousand_alerts_at_once_are_few_statements_and_one_message(
    mixer: str, heard: list[Any], django_capture_on_commit_callbacks: Any
) -> None:
    row = Device.objects.get(pk=mixer)
    row.online = False
    Device.objects.bulk_create([_copy(row, f"m{n}") for n in range(1000)])
    with django_capture_on_commit_callbacks(execute=True), CaptureQueriesContext(connection) as statements:
        watch(700)
    assert DeviceAlert.objects.filter(code="offline", over_at=None).count() == 1000
    assert len(statements) < 30
    assert heard == [("hall", {"type": "alerts"})]


def _copy(row: Device, key: str) -> Device:
    return Device(id=key, site=row.site, lifecycle="approved", description=row.description, last_seen_at=NOW)


def test_only_what_changed_is_told_live(mixer: str, heard: list[Any], django_capture_on_commit_callbacks: Any) -> None:
    with django_capture_on_commit_callbacks(execute=True):
        say(props={"error": "Jam"})
        watch(1)
    (told,) = [m["alert"] for _, m in heard if m["type"] == "alert"]
    assert {key: told[key] for key in ("device", "code", "severity", "text", "count", "state", "seen_by")} == {
        "device": "mixer1", "code": "error", "severity": "error", "text": "It reports an error: Jam", "count": 1,
        "state": "open", "seen_by": "",
    }  # fmt: skip
    heard.clear()
    with django_capture_on_commit_callbacks(execute=True):
        watch(2)
        watch(30)
    assert heard == []


def test_raised_again_soon_it_is_the_same_and_later_another(mixer: str) -> None:
    for minutes, over in ((0, 1), (3, 4), (20, 21)):
        services.raise_alert(device_id=mixer, code="error", at=NOW + timedelta(minutes=minutes))
        services.end_alert(device_id=mixer, code="error", at=NOW + timedelta(minutes=over))
    assert alerts("over") == [("error", "", 1), ("error", "", 2)]
    services.raise_alert(device_id="nobody", code="error", at=NOW)
    assert DeviceAlert.objects.count() == 2


def test_what_happens_again_long_after_it_was_seen_is_unseen(mixer: str, person: Callable[[str], User]) -> None:
    services.raise_alert(device_id=mixer, code="command_failed", at=NOW, args={"method": "mix"})
    services.mark_all_seen(site="hall", by=person("operator"), at=NOW, role="operator")
    services.raise_alert(device_id=mixer, code="command_failed", at=NOW + timedelta(seconds=30), args={"method": "mix"})
    assert [alert.seen_by for alert in services.list_alerts(site="hall", state="seen")] == ["Operator Person"]
    services.raise_alert(device_id=mixer, code="command_failed", at=NOW + timedelta(minutes=2), args={"method": "mix"})
    assert alerts("open") == [("command_failed", "", 3)]


def test_who_may_look_at_alerts_and_say_that_they_were_seen(mixer: str, person: Callable[[str], User]) -> None:
    services.raise_alert(device_id=mixer, code="error", at=NOW, args={"why": "Jam"})
    key = services.list_alerts(site="hall")[0].id
    one, every = f"/api/alerts/{key}/seen", f"{ALERTS}/seen"
    signed_out = Client()
    assert [signed_out.get(ALERTS).status_code, signed_out.post(one).status_code] == [401, 401]
    stranger, viewer = signed_in("stranger"), signed_in("viewer")
    found = [stranger.get(ALERTS), stranger.post(one), stranger.post(every), viewer.post("/api/alerts/999999/seen")]
    assert [answer.status_code for answer in found] == [404] * 4
    assert [viewer.get(ALERTS).status_code, viewer.post(one).status_code, viewer.post(every).status_code] == [
        200, 403, 403,
    ]  # fmt: skip
    assert DeviceAlert.objects.filter(seen_at=None).count() == 1
    for role in from_role("operator"):
        client = signed_in(role)
        assert [client.post(one).json()["seen_by"], client.post(every).json()[0]["seen_by"]] == ["Operator Person"] * 2
        assert client.get(f"{ALERTS}?state=open").json() == []
        assert [a["text"] for a in client.get(f"{ALERTS}?state=seen").json()] == ["It reports an error: Jam"]
    assert viewer.get(f"{ALERTS}?state=none").status_code == 422


def test_what_only_concerns_admins_is_theirs_alone(mixer: str, person: Callable[[str], User]) -> None:
    services.raise_alert(device_id=mixer, code="newcomer_waits", at=NOW)
    key = services.list_alerts(site="hall")[0].id
    for role, count, status in (*((below, 0, 404) for below in below_role("admin")), ("admin", 1, 200)):
        client = signed_in(role)
        assert (len(client.get(ALERTS).json()), client.post(f"/api/alerts/{key}/seen").status_code) == (count, status)


def test_old_alerts_are_forgotten_and_never_open_ones(mixer: str, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(inbox, "KEPT_AT_MOST", 3)
    for day in range(6):
        at = NOW - timedelta(days=8 * day)
        DeviceAlert.objects.create(device_id=mixer, code="error", first_at=at, last_at=at, over_at=at)
    DeviceAlert.objects.create(device_id=mixer, code="error", first_at=LONG_AGO, last_at=NOW - timedelta(days=90))
    assert services.prune_alerts(now=NOW) == 3
    assert (alerts(), len(alerts("over"))) == ([("error", "", 1)], 3)


def test_alerts_are_listed_on_the_command_line(mixer: str, capsys: pytest.CaptureFixture[str]) -> None:
    services.raise_alert(device_id=mixer, code="command_rejected", at=NOW, args={"method": "mix", "why": "Lid open"})
    assert main(["alerts", "--site", "hall"]) == 0
    assert capsys.readouterr().out == (
        "severity  site  device  state  times  since                 what\n"
        "warning   hall  mixer1  open   1      2026-11-21T12:00:00Z  It refused mix: Lid open\n"
    )
    assert main(["alerts", "--json"]) == 0
    assert [(a["site"], a["code"]) for a in json.loads(capsys.readouterr().out)] == [("hall", "command_rejected")]
    assert main(["alerts", "--site", "nowhere"]) == 2


def test_the_description_of_a_device_can_be_refused_and_mended(mixer: str) -> None:
    services.note_alert(device_id=mixer, code="description_refused", args={"why": "Line 3: no dot."})
    services.flush_alerts()
    assert alerts() == [("description_refused", "Line 3: no dot.", 1)]
    later = DeviceAlert.objects.get().last_at + timedelta(seconds=1)
    payload = write_description(replace(MIXER, name="Mixer Two")).encode()
    services.ingest_description(device_id=mixer, payload=payload, at=later)
    services.watch_devices(now=later, since=LONG_AGO, at_work=())
    assert alerts() == []
