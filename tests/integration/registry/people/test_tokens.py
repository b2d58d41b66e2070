"""Tokens: how people make, see and end them, what is kept of them, and how programs show them."""

from __future__ import annotations

import asyncio
import base64
import logging
from collections.abc import AsyncIterator
from contextlib import aclosing
from datetime import UTC, datetime, timedelta
from typing import Any

import pytest
from asgiref.sync import sync_to_async
from django.conf import LazySettings, settings
from django.db import connection
from django.test import Client
from django.utils import timezone

from registry import services
from registry.broker import accounts
from registry.models import ApiToken, AuditLine, Membership
from registry.people import tokens, watch
from registry.people.sessions import Session
from registry.thing_directory import event_stream
from registry.thing_directory.event_stream import Listener, stream_events
from tests.kit.command_line import run_vipo
from tests.kit.servers import free_port
from tests.kit.sign_in import find_person, post_json, signed_in
from tests.kit.sites import make_mixers
from tests.kit.waiting import PATIENCE_S
from vipo_device.protocol.credentials import broker_hash, secret_hash

TOKENS = "/api/sites/hall/tokens"


def make(person: str = "operator", *scopes: str, **more: Any) -> dict[str, Any]:
    body = {"name": "Line display", "scopes": scopes or ["read"], **more}
    answer = post_json(signed_in(person), TOKENS, body)
    assert answer.status_code == 201, answer.content
    told: dict[str, Any] = answer.json()
    return told


def bearer(token: str, **more: Any) -> Client:
    return Client(enforce_csrf_checks=True, headers={"Authorization": f"Bearer {token}", **more})


def kept_of_everything() -> str:
    """Return all that the database holds, as text."""
    with connection.cursor() as cursor:
        names = connection.introspection.table_names(cursor)
        rows = [cursor.execute(f'SELECT * FROM "{name}"').fetchall() for name in names]
    return repr(rows)


def test_a_token_is_told_once_and_kept_as_a_hash(hall: str, caplog: pytest.LogCaptureFixture) -> None:
    caplog.set_level(logging.DEBUG)
    answer = post_json(signed_in("operator"), TOKENS, {"name": " Line  display ", "scopes": ["run", "read"]})
    made = answer.json()
    assert (answer.status_code, answer["Cache-Control"], made["scopes"]) == (201, "no-store", ["read", "run"])
    mark, public_id, secret = made["token"].split("_", 2)
    assert (mark, public_id, len(secret), made["name"]) == ("vipo", made["id"], 43, "Line display")
    assert bearer(made["token"]).get("/api/sites/hall").json()["role"] == "operator"
    assert bearer(made["token"] + "x").get("/api/sites/hall").status_code == 401
    listed = signed_in("operator").get(TOKENS)
    assert [(row["id"], row["mine"], row["expired"]) for row in listed.json()] == [(public_id, True, False)]
    assert "token" not in listed.json()[0]
    everything = kept_of_everything() + listed.content.decode() + caplog.text
    assert (secret in everything, public_id in everything) == (False, True)


def test_a_token_needs_no_csrf_and_goes_before_the_cookie(hall: str) -> None:
    operate = make("operator", "operate")["token"]
    assert bearer(operate).post("/api/sites/hall/stop/reset").json() == {"active": False, "by": "", "at": None}
    both = signed_in("admin", headers={"Authorization": f"Bearer {make('viewer')['token']}"})
    assert both.get("/api/sites/hall").json()["role"] == "viewer"
    assert both.post("/api/sites/hall/stop/reset").json()["code"] == "insufficient_scope"
    broken = signed_in("admin", headers={"Authorization": "Bearer vipo_0_0"})
    assert broken.get("/api/sites/hall").status_code == 401
    basic = signed_in("admin", headers={"Authorization": "Basic YTpi"})
    assert basic.get("/api/sites/hall").json()["role"] == "admin"
    assert "sessionid" not in bearer(operate).get("/api/sites").cookies


@pytest.mark.parametrize(
    "text",
    ["", "vipo_", "vipo__", "vipo", "_", "a" * 5000, "vipo_\0_a", "vipo_ä_ö", "' OR 1=1", "vipo_" + "0" * 16 + "_x"],
)
def test_what_is_no_token_is_refused_alike(hall: str, text: str) -> None:
    answer = bearer(text).get("/api/sites/hall")
    told = answer.json()
    assert (answer.status_code, told["code"], answer["WWW-Authenticate"]) == (
        401,
        "invalid_token",
        'Bearer error="invalid_token"',
    )
    assert told["detail"] == tokens.InvalidToken(told["detail"]).detail
    assert Client().get("/api/sites")["WWW-Authenticate"] == "Bearer"


def test_the_secret_is_compared_in_constant_time_also_where_there_is_no_such_token(
    hall: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    made, compared = make()["token"], []
    plain = tokens.hmac.compare_digest
    monkeypatch.setattr(tokens.hmac, "compare_digest", lambda a, b: compared.append((len(a), len(b))) or plain(a, b))
    for text in (made, made[:-1] + "-", "vipo_0123456789abcdef_" + "a" * 43, "nonsense"):
        bearer(text).get("/api/sites")
    assert compared == [(64, 64)] * 4


def test_a_token_for_the_broker_says_how_to_come_in_and_reads_over_http_as_others_do(hall: str) -> None:
    made = make("operator", "broker", "read")
    assert made["scopes"] == ["read", "broker"]
    assert made["broker"] == {
        "address": settings.VIPO_BROKER_URL,
        "username": f"token:{made['id']}",
        "topics": "vipo/v1/site/hall/things/#",
    }
    assert make()["broker"] is None
    assert bearer(made["token"]).get("/api/sites/hall").json()["role"] == "viewer"
    refused = bearer(made["token"]).post("/api/sites/hall/stop")
    assert (refused.status_code, refused.json()["code"]) == (403, "insufficient_scope")
    check = services.check_device_password
    asked = {"username": made["broker"]["username"], "password": made["token"]}
    assert check(**asked) == services.Principal(asked["username"], False, secret_hash(made["token"]), site="hall")
    other = make("viewer", "broker")
    for username, password in (
        (asked["username"], other["token"]),
        (asked["username"], made["token"] + "x"),
        (f"token:{made['id'].upper()}x", made["token"]),
        ("mixer1", made["token"]),
        (f"token:{make()['id']}", make()["token"]),
    ):
        assert check(username=username, password=password) is None
    assert set(services.list_broker_hashes()) == {asked["username"], other["broker"]["username"]}
    kept = services.list_broker_hashes()[asked["username"]]
    salt = base64.b64decode(kept.split("$")[3])
    assert kept == broker_hash(made["token"], salt)


def test_a_token_for_the_broker_ends_for_good_with_its_account_and_the_record_says_so(hall: str) -> None:
    made, other, expired = make("viewer", "broker"), make("operator", "broker"), make("author", "broker")
    names = {told["id"]: told["broker"]["username"] for told in (made, other, expired)}
    known = services.end_readers(known=None, now=timezone.now())
    assert known == set(names.values())
    ApiToken.objects.filter(public_id=expired["id"]).update(expires_at=timezone.now() - timedelta(seconds=1))
    of_viewer = Membership.objects.filter(user=find_person("viewer"))
    of_viewer.update(ends_at=timezone.now() - timedelta(seconds=1))
    known = services.end_readers(known=known, now=timezone.now())
    assert known == {names[other["id"]]}
    of_viewer.update(ends_at=None)
    assert services.end_readers(known=known, now=timezone.now()) == known
    assert bearer(made["token"]).get("/api/sites/hall").status_code == 401
    assert {view.id for view in services.list_tokens(site="hall")} == {other["id"], expired["id"]}
    line = AuditLine.objects.get(code="token_revoked")
    assert (line.actor_kind, line.facts) == ("vipo", {"name": "Line display", "person": "Viewer Person"})


def test_whose_access_was_given_again_before_anybody_looked_keeps_token_and_account(hall: str) -> None:
    made = make("viewer", "broker")
    known = services.end_readers(known=None, now=timezone.now())
    of_viewer = Membership.objects.filter(user=find_person("viewer"))
    of_viewer.update(ends_at=timezone.now() - timedelta(seconds=1))
    of_viewer.update(ends_at=None)
    assert services.end_readers(known=known, now=timezone.now()) == known == {made["broker"]["username"]}
    assert bearer(made["token"]).get("/api/sites/hall").status_code == 200


def test_a_broker_that_does_not_take_the_account_leaves_no_token(
    hall: str, settings: LazySettings, monkeypatch: pytest.MonkeyPatch
) -> None:
    settings.VIPO_BROKER_ACCOUNTS = "registry.broker.accounts.DynamicSecurity"
    settings.VIPO_MQTT = {**settings.VIPO_MQTT, "port": free_port()}
    monkeypatch.setattr(accounts, "ANSWER_LIMIT_S", 0.5)
    accounts.accounts.cache_clear()
    try:
        answer = post_json(signed_in("viewer"), TOKENS, {"name": "a", "scopes": ["broker"]})
    finally:
        accounts.accounts.cache_clear()
    assert (answer.status_code, answer.json()["code"]) == (503, "broker_away")
    assert ApiToken.objects.count() == 0


def test_people_see_and_end_their_own_and_admins_all_of_their_site(hall: str) -> None:
    services.create_site(name="Shed", slug="shed")
    services.set_member(site="shed", email="stranger@vipo.example", role="admin")
    made = {person: make(person) for person in ("viewer", "operator", "admin")}
    assert [row["person"] for row in signed_in("viewer").get(TOKENS).json()] == ["Viewer Person"]
    assert [row["person"] for row in signed_in("admin").get(TOKENS).json()] == [
        "Admin Person",
        "Operator Person",
        "Viewer Person",
    ]
    assert signed_in("stranger").get(TOKENS).status_code == 404
    one = f"{TOKENS}/{made['operator']['id']}"
    foreign = f"/api/sites/shed/tokens/{made['operator']['id']}"
    absent = [signed_in("viewer").delete(one), signed_in("stranger").delete(foreign)]
    assert [(a.status_code, a.json()["detail"]) for a in absent] == [
        (404, "There is no such token here. It may have been revoked already.")
    ] * 2
    assert bearer(made["operator"]["token"]).get("/api/sites/hall").status_code == 200
    assert [signed_in("admin").delete(one).status_code for _ in range(2)] == [204, 404]
    assert bearer(made["operator"]["token"]).get("/api/sites/hall").status_code == 401
    assert bearer(made["viewer"]["token"]).get("/api/sites/hall").status_code == 200


@pytest.mark.parametrize(
    ("person", "body", "status", "code"),
    [
        ("viewer", {"name": "a", "scopes": ["run"]}, 403, "not_allowed"),
        ("author", {"name": "a", "scopes": ["admin"]}, 403, "not_allowed"),
        ("viewer", {"name": "a", "scopes": ["operate"]}, 201, None),
        ("viewer", {"name": "a", "scopes": ["broker"]}, 201, None),
        ("admin", {"name": "a", "scopes": ["broker", "operate"]}, 422, "bad_token"),
        ("admin", {"name": "a", "scopes": ["read", "broker", "admin"]}, 422, "bad_token"),
        ("admin", {"name": "a", "scopes": []}, 422, "bad_request"),
        ("admin", {"name": "a", "scopes": ["everything"]}, 422, "bad_request"),
        ("admin", {"name": " ", "scopes": ["read"]}, 422, "bad_token"),
        ("admin", {"name": "a\0", "scopes": ["read"]}, 422, "bad_request"),
        ("admin", {"name": "a" * 101, "scopes": ["read"]}, 422, "bad_request"),
        ("admin", {"name": "a", "scopes": ["read"], "days": 0}, 422, "bad_request"),
        ("admin", {"name": "a", "scopes": ["read"], "days": 367}, 422, "bad_request"),
        ("stranger", {"name": "a", "scopes": ["read"]}, 404, "not_found"),
        ("nobody", {"name": "a", "scopes": ["read"]}, 401, "signed_out"),
    ],
)
def test_which_tokens_can_be_made(hall: str, person: str, body: dict[str, Any], status: int, code: str | None) -> None:
    answer = post_json(signed_in(person), TOKENS, body)
    assert (answer.status_code, answer.json().get("code")) == (status, code)
    assert ApiToken.objects.count() == (1 if status == 201 else 0)


def test_a_member_has_so_many_tokens_at_most(hall: str, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(tokens, "MOST_OF_MEMBER", 2)
    first = make()
    make()
    refused = post_json(signed_in("operator"), TOKENS, {"name": "a", "scopes": ["read"]})
    assert (refused.status_code, refused.json()["code"]) == (409, "too_many_tokens")
    make("viewer")
    signed_in("operator").delete(f"{TOKENS}/{first['id']}")
    make()
    ApiToken.objects.update(expires_at=datetime.now(UTC) - timedelta(seconds=1))
    make()


def test_use_is_noted_to_the_minute_and_what_ended_long_ago_is_forgotten(hall: str) -> None:
    token, now = make()["token"], datetime.now(UTC)
    for later, noted in ((1, 1), (30, 1), (62, 62)):
        services.find_bearer(token=token, now=now + timedelta(seconds=later))
        assert ApiToken.objects.get().last_used_at == now + timedelta(seconds=noted)
    assert services.prune_tokens(now=now + timedelta(days=119)) == 0
    assert signed_in("operator").get(TOKENS).json()[0]["last_used_at"] is not None
    assert services.prune_tokens(now=now + timedelta(days=121)) == 1


def test_vipo_token(hall: str, capsys: pytest.CaptureFixture[str]) -> None:
    wanted = ("operator@vipo.example", "--site", "hall", "--name", "Press")
    code, out, err = run_vipo(capsys, "token", "create", *wanted, "--scope", "run", "--scope", "operate")
    first, second = out.splitlines()
    token = second.removeprefix("The token, shown this once: ")
    public_id = token.split("_")[1]
    assert (code, err, first.split(" until ")[0]) == (0, "", "Press asks as operator@vipo.example at hall")
    assert first.endswith(": operate run.")
    assert bearer(token).get("/api/sites").json()[0]["role"] == "operator"
    code, out, _ = run_vipo(capsys, "token", "list", "--site", "hall")
    assert (code, out.splitlines()[1].split()[:5]) == (
        0,
        [public_id, "Press", "hall", "operator@vipo.example", "operate"],
    )
    assert token.split("_", 2)[2] not in out
    assert run_vipo(capsys, "token", "revoke", public_id)[:2] == (
        0,
        "Press of operator@vipo.example at hall has ended.\n",
    )
    assert bearer(token).get("/api/sites").status_code == 401
    assert run_vipo(capsys, "token", "revoke", public_id)[0] == 2
    assert run_vipo(capsys, "token", "create", "stranger@vipo.example", *wanted[1:])[0] == 2
    assert run_vipo(capsys, "token", "list", "--site", "nowhere")[0] == 2
    assert run_vipo(capsys, "token", "create", *wanted, "--scope", "admin")[0] == 2


@sync_to_async
def open_stream() -> tuple[str, AsyncIterator[bytes]]:
    """Open a stream of events with a token; return the token's id, too."""
    made = make("viewer")
    row = ApiToken.objects.get(public_id=made["id"])
    session = Session("", find_person("viewer").pk, row.pk)
    return made["id"], stream_events(Listener(session, "hall", ("thing_updated",), diff=False), "")


async def hear_the_end(events: AsyncIterator[bytes]) -> None:
    async with asyncio.timeout(PATIENCE_S):
        async for _ in events:
            pass


@pytest.mark.django_db(transaction=True)
async def test_a_stream_ends_when_its_token_is_revoked_or_expires(hall: str, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(event_stream, "HEARTBEAT_S", 3600.0)  # at which it would look by itself
    await sync_to_async(make_mixers)("a")
    token_id, events = await open_stream()
    async with aclosing(events):
        await anext(events)
        await sync_to_async(services.revoke_token)(token_id=token_id)
        await hear_the_end(events)
    token_id, events = await open_stream()
    async with aclosing(events):
        await anext(events)
        await ApiToken.objects.filter(public_id=token_id).aupdate(expires_at=timezone.now())
        await hear_the_end(events)
    assert watch.EVERY_S <= 1.0, "so soon does the watch see it"


@pytest.mark.django_db(transaction=True)
async def test_a_stream_opens_with_a_token_alone(hall: str) -> None:
    token = (await sync_to_async(make)("viewer"))["token"]
    client = await sync_to_async(bearer)(token)
    answer = await sync_to_async(client.get)("/api/sites/hall/things/events")
    assert answer.status_code == 200
    stream = aiter(answer.streaming_content) if answer.is_async else iter(answer.streaming_content)
    assert b"retry" in (await anext(stream) if answer.is_async else next(stream))
    if answer.is_async:
        await stream.aclose()
