"""The record of what was done: by whom and from where, with the change or not at all, never changed, taken away."""

from __future__ import annotations

import csv
import io
from datetime import UTC, datetime, timedelta
from typing import Any

import pytest
from asgiref.sync import async_to_sync, sync_to_async
from django.db import DatabaseError, connection, transaction
from django.test import AsyncClient, Client
from django.test.utils import CaptureQueriesContext
from pytest_django import Settings

from editor import services as editor
from execution import services as execution
from registry import services
from registry.models import AuditLine, Site
from tests.kit.sign_in import PASSWORD, find_person, post_json, signed_in
from tests.kit.sites import MIXER, describe
from vipo_device.protocol.errors import VipoError

SITE = "/api/sites/hall"
FIREFOX = "Mozilla/5.0 (X11; Linux x86_64; rv:140.0) Gecko/20100101 Firefox/140.0"


@pytest.fixture
def fresh(hall: str) -> str:
    """A site of which nothing has been told yet."""
    AuditLine.objects.all().delete()
    return hall


def told(kind: str = "") -> list[tuple[str, str, str]]:
    """Return what the record tells, the newest first: who, what, where from."""
    lines = signed_in("admin").get(f"{SITE}/audit{kind and f'?kind={kind}'}").json()
    return [(line["actor"], line["code"], line["address"]) for line in lines]


def note(count: int, code: str = "stop_reset") -> None:
    site = Site.objects.get(slug="hall").pk
    for number in range(count):
        services.note_act(site_id=site, code=code, by=f"P{number}", at=datetime.now(UTC) + timedelta(seconds=number))


def test_people_and_tokens_are_told_apart_with_where_they_came_from(fresh: str) -> None:
    client = signed_in("operator", headers={"User-Agent": FIREFOX}, REMOTE_ADDR="10.0.0.7")
    post_json(client, f"{SITE}/stop")
    _, token = services.create_token(
        user=find_person("operator"), site="hall", name="Order desk", scopes=["operate"], days=1, now=datetime.now(UTC)
    )
    bearer = Client(headers={"Authorization": f"Bearer {token}"}, REMOTE_ADDR="10.0.0.8")
    assert bearer.post(f"{SITE}/stop/reset").status_code == 200
    lines = signed_in("admin").get(f"{SITE}/audit?kind=stops").json()
    named = ("actor_kind", "actor", "code", "address", "browser", "system")
    assert [tuple(line[name] for name in named) for line in lines] == [
        ("token", "Order desk", "stop_reset", "10.0.0.8", "", ""),
        ("person", "Operator Person", "stop_pressed", "10.0.0.7", "Firefox", "Linux"),
    ]


def test_a_stop_that_is_pressed_again_is_told_once(fresh: str) -> None:
    for _ in range(2):
        post_json(signed_in("viewer"), f"{SITE}/stop")
    assert told("stops") == [("Viewer Person", "stop_pressed", "127.0.0.1")]


def test_what_devices_and_admins_do_with_devices_is_told(fresh: str) -> None:
    services.set_enrolment_key(site="hall", key="j" * 32)
    services.enrol_device(
        site="hall", device_id=MIXER.id, payload=b'{"key": "k2345678901234567890"}', at=datetime.now(UTC)
    )
    describe()
    admin = signed_in("admin")
    for what in ("approve", "credential", "retire", "readmit"):
        assert post_json(admin, f"{SITE}/devices/{MIXER.id}/{what}").status_code == 200, what
    assert post_json(admin, f"{SITE}/join-key").status_code == 200
    found = [(who, code) for who, code, _ in told("devices")][::-1]
    assert found == [
        (MIXER.id, "device_asked"),
        ("Admin Person", "device_approved"),
        ("Admin Person", "device_key_given"),
        ("Admin Person", "device_retired"),
        ("Admin Person", "device_readmitted"),
        ("Admin Person", "enrolment_key_renewed"),
    ]


def test_what_wanted_to_enrol_and_was_refused_is_told_once_a_day(fresh: str, monkeypatch: pytest.MonkeyPatch) -> None:
    services.create_site(name="Yard", slug="yard")
    now, key = datetime.now(UTC), b'{"key": "k2345678901234567890"}'

    def ask(device: str, payload: bytes, at: datetime = now) -> None:
        with pytest.raises(VipoError):
            services.enrol_device(site="yard", device_id=device, payload=payload, at=at)

    def refused() -> list[tuple[str, str]]:
        lines = AuditLine.objects.filter(site__slug="yard", code="device_turned_away").order_by("pk")
        assert {(line.actor_kind, line.kind) for line in lines} <= {("vipo", "devices")}
        return [(line.facts["device"], line.facts["because"]) for line in lines]

    for device in ("oven 1", "oven 1", "o" * 65, "two\nlines"):
        ask(device, key)
    ask("mixer1", key)
    ask("yard.mixer1", b"{")
    assert refused() == [
        ("oven 1", "device_id"),
        ("o" * 64, "device_id"),
        ("two\ufffdlines", "device_id"),
        ("mixer1", "id_of_site"),
        ("yard.mixer1", "knock_key"),
    ]
    ask("oven 1", key, now + timedelta(days=1, seconds=1))
    assert len(refused()) == 6
    monkeypatch.setattr("registry.devices.enrolment.MOST_TOLD", 7)
    for number in range(9):
        ask(f"oven {number}", key)
    assert len(refused()) == 7
    services.enrol_device(site="yard", device_id="yard.mixer1", payload=key, at=now)
    assert len(refused()) == 7


def test_a_program_that_is_deleted_is_told_by_its_name(fresh: str) -> None:
    program = editor.create_program(site="hall", name="Night paint").id
    assert signed_in("author").delete(f"/api/programs/{program}").status_code == 204
    line = AuditLine.objects.get(code="program_deleted")
    assert (line.actor, line.facts) == ("Author Person", {"program": "Night paint"})


def test_tokens_are_told_without_their_secret(fresh: str) -> None:
    made = post_json(signed_in("viewer"), f"{SITE}/tokens", {"name": "Display", "scopes": ["read"]}).json()
    assert signed_in("admin").delete(f"{SITE}/tokens/{made['id']}").status_code == 204
    assert [line[:2] for line in told("tokens")] == [
        ("Admin Person", "token_revoked"),
        ("Viewer Person", "token_made"),
    ]
    assert made["token"][-20:] not in str(list(AuditLine.objects.values()))


def test_guessing_that_is_held_up_is_told_once(fresh: str) -> None:
    for _ in range(12):
        post_json(Client(REMOTE_ADDR="10.6.6.6"), "/api/sign-in", {"email": "author@vipo.example", "password": "x"})
    line = AuditLine.objects.get(code="sign_in_locked")
    assert (line.actor_kind, line.address) == ("vipo", "10.6.6.6")
    assert line.facts == {"person": "Author Person", "minutes": 15}
    assert (
        post_json(Client(), "/api/sign-in", {"email": "author@vipo.example", "password": PASSWORD}).status_code == 200
    )


def test_what_is_taken_back_is_not_told(fresh: str) -> None:
    class Stumble(Exception):
        pass

    def stumble() -> None:
        with transaction.atomic():
            services.set_member(site="hall", email="viewer@vipo.example", role="author")
            raise Stumble

    with pytest.raises(Stumble):
        stumble()
    assert AuditLine.objects.count() == 0


def test_a_refused_change_is_not_told(fresh: str) -> None:
    answer = signed_in("admin").patch(
        f"{SITE}/members/{find_person('admin').pk}", {"role": "viewer"}, content_type="application/json"
    )
    assert (answer.status_code, AuditLine.objects.count()) == (409, 0)


def test_no_line_can_be_changed(fresh: str) -> None:
    note(1)
    with pytest.raises(DatabaseError, match="cannot be changed"), transaction.atomic():
        AuditLine.objects.update(actor="Nobody")
    assert AuditLine.objects.get().actor == "P0"


def test_the_record_comes_in_parts_of_a_kind(fresh: str) -> None:
    note(5)
    note(3, "map_published")
    admin = signed_in("admin")
    first = admin.get(f"{SITE}/audit?kind=stops&limit=2")
    assert (first["X-Total-Count"], first["X-Kept-Days"]) == ("5", "730")
    seen, answer = [], first
    while True:
        seen += [line["actor"] for line in answer.json()]
        if "Link" not in answer:
            break
        answer = admin.get(answer["Link"].partition(">")[0].strip("<"))
    assert seen == ["P4", "P3", "P2", "P1", "P0"]
    assert admin.get(f"{SITE}/audit?kind=gossip").status_code == 422


def test_the_record_is_taken_away_as_a_table_that_no_spreadsheet_carries_out(fresh: str) -> None:
    services.note_act(site_id=Site.objects.get(slug="hall").pk, code="stop_reset", by='=HYPERLINK("http://bad")')
    answer = signed_in("admin").get(f"{SITE}/audit.csv?kind=stops")
    assert (answer["Content-Type"], answer["Content-Disposition"]) == (
        "text/csv; charset=utf-8",
        'attachment; filename="hall-audit.csv"',
    )
    rows = list(csv.reader(io.StringIO(answer.getvalue().decode())))
    assert rows[0] == ["at", "kind", "code", "actor_kind", "actor", "address", "agent", "facts"]
    assert [row[1:5] for row in rows[1:]] == [["stops", "stop_reset", "person", '\'=HYPERLINK("http://bad")']]


def test_the_table_is_read_before_its_answer_begins(fresh: str) -> None:
    note(3)
    admin = signed_in("admin")
    with CaptureQueriesContext(connection) as before:
        answer = admin.get(f"{SITE}/audit.csv")
    with CaptureQueriesContext(connection) as after:
        assert len(list(csv.reader(io.StringIO(answer.getvalue().decode())))) == 4
    assert [*filter(lambda asked: "registry_auditline" in asked["sql"], before.captured_queries)] != []
    assert after.captured_queries == []


def test_a_long_table_is_read_as_it_is_sent(fresh: str) -> None:
    """More than this is never held: Django gathers a plain iterator whole, where it is served asynchronously."""
    site = Site.objects.get(slug="hall")
    AuditLine.objects.bulk_create(
        AuditLine(
            site=site, at=datetime.now(UTC), kind="stops", code="stop_reset", actor_kind="vipo", actor=f"P{number}"
        )
        for number in range(1200)
    )
    browser = AsyncClient()
    browser.cookies = signed_in("admin").cookies

    async def read() -> tuple[int, int]:
        parts = aiter(await browser.get(f"{SITE}/audit.csv?kind=stops"))
        first = await anext(parts)
        await sync_to_async(AuditLine.objects.all().delete)()
        return first.count(b"\n"), sum([part.count(b"\n") async for part in parts])

    assert async_to_sync(read)() == (501, 0)


def test_lines_are_kept_as_long_as_the_server_says(fresh: str, settings: Settings) -> None:
    settings.VIPO_AUDIT_DAYS = 30
    note(1)
    assert services.prune_audit(now=datetime.now(UTC) + timedelta(days=29)) == 0
    assert services.prune_audit(now=datetime.now(UTC) + timedelta(days=31)) == 1


def test_an_admin_of_another_site_reads_nothing_of_this_one(fresh: str) -> None:
    services.create_site(name="Shed", slug="shed")
    services.set_member(site="shed", email="stranger@vipo.example", role="admin")
    note(2)
    stranger = signed_in("stranger")
    assert stranger.get(f"{SITE}/audit").status_code == stranger.get(f"{SITE}/audit.csv").status_code == 404
    seen: list[dict[str, Any]] = stranger.get("/api/sites/shed/audit").json()
    assert [line["code"] for line in seen] == ["member_added"]


def test_a_press_that_was_reset_before_it_was_told_is_not_lost(fresh: str, monkeypatch: pytest.MonkeyPatch) -> None:
    """Whoever follows a stop may be busy while somebody presses and another one resets it."""
    with monkeypatch.context() as busy:
        busy.setattr("execution.floor.stops.follow_stop", lambda **_: False)
        execution.press_stop(site="hall", by="Ada")
    execution.reset_stop(site="hall", by="Bo")
    lines = AuditLine.objects.filter(kind="stops").order_by("pk")
    assert [(line.actor, line.code) for line in lines] == [("", "stop_pressed"), ("Bo", "stop_reset")]
