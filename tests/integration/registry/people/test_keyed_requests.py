"""The header Idempotency-Key: what was done is not done again, on each database and with two servers at once."""

from __future__ import annotations

import threading
from concurrent.futures import ThreadPoolExecutor
from datetime import UTC, datetime, timedelta
from pathlib import Path
from typing import Any

import httpx
import pytest
from django.test import Client

from editor.models import Program
from registry import services
from registry.api import once
from registry.models import ApiToken, KeyedRequest
from registry.people import keyed_requests
from registry.people.keyed_requests import KeptAnswer, begin_request, end_request
from tests.kit.api_calls import ask, make_one_of_each, undone
from tests.kit.api_rights import OPERATIONS, RIGHTS
from tests.kit.served import served_without_broker
from tests.kit.servers import Redis
from tests.kit.sign_in import find_person, signed_in
from tests.kit.web import Web, prepare

PROGRAMS = "/api/sites/hall/programs"
NOW = datetime.now(UTC)


def make(client: Client, name: str = "Mix", key: str = "k1", path: str = PROGRAMS) -> Any:
    return client.post(path, {"name": name}, content_type="application/json", headers={"Idempotency-Key": key})


def test_a_second_request_is_given_the_first_ones_answer(hall: str) -> None:
    author = signed_in("author")
    first, again, quoted = make(author), make(author), make(author, key='"k1"')
    assert (first.status_code, again.status_code, quoted.content) == (201, 201, first.content)
    assert (first.content, first["Content-Type"]) == (again.content, again["Content-Type"])
    assert ("Idempotency-Replayed" in first, again["Idempotency-Replayed"]) == (False, "true")
    assert Program.objects.count() == 1
    assert make(author, key="k2").json()["id"] != first.json()["id"]


def test_a_key_belongs_to_one_request_and_one_person(hall: str) -> None:
    author = signed_in("author")
    first = make(author)
    other = make(author, name="Other")
    assert (other.status_code, other.json()["code"]) == (422, "key_used_otherwise")
    elsewhere = author.delete(f"/api/programs/{first.json()['id']}", headers={"Idempotency-Key": "k1"})
    assert (elsewhere.status_code, Program.objects.count()) == (422, 1)
    assert make(signed_in("admin")).json()["id"] != first.json()["id"]


def test_a_token_has_keys_of_its_own(hall: str) -> None:
    first = make(signed_in("author"))
    _, token = services.create_token(
        user=find_person("author"), site="hall", name="a", scopes=["read"], days=1, now=datetime.now(UTC)
    )
    answer = make(Client(headers={"Authorization": f"Bearer {token}"}))
    assert (first.status_code, answer.status_code, answer.json()["code"]) == (201, 403, "insufficient_scope")


def test_a_refusal_changes_nothing_and_frees_the_key(hall: str) -> None:
    viewer = signed_in("viewer")
    assert make(viewer).status_code == 403
    services.set_member(site="hall", email="viewer@vipo.example", role="author")
    assert make(viewer).status_code == 201
    assert make(signed_in("author"), name=" ").status_code == make(signed_in("author"), name=" ").status_code == 422


def test_what_is_told_once_is_not_kept_and_not_done_again(hall: str) -> None:
    body = {"name": "Display", "scopes": ["read"]}

    def ask() -> Any:
        return signed_in("admin").post(
            "/api/sites/hall/tokens", body, content_type="application/json", headers={"Idempotency-Key": "k1"}
        )

    first, again = ask(), ask()
    assert (first.status_code, again.status_code, again.json()["code"]) == (201, 409, "answer_not_kept")
    assert (ApiToken.objects.count(), KeyedRequest.objects.get().body) == (1, None)


def test_a_request_that_is_under_way_was_cut_off_or_failed(hall: str, monkeypatch: pytest.MonkeyPatch) -> None:
    author = signed_in("author")
    author.raise_request_exception = False
    make(author)
    KeyedRequest.objects.update(status=0, body=None, begun_at=datetime.now(UTC))
    under_way = make(author)
    assert (under_way.status_code, under_way.json()["code"], under_way["Retry-After"]) == (409, "under_way", "1")
    KeyedRequest.objects.update(begun_at=datetime.now(UTC) - keyed_requests.LONGEST)
    assert make(author).json()["code"] == "outcome_unknown"
    monkeypatch.setattr("editor.services.create_program", lambda **asked: 1 / 0)
    assert [make(author, key="k3").json()["code"] for _ in range(2)] == ["failed", "outcome_unknown"]
    assert Program.objects.count() == 1


@pytest.mark.usefixtures("impatient")
@pytest.mark.parametrize("role", ["none", "viewer"])
def test_no_answer_is_given_again_to_who_may_not_do_it_any_more(hall: str, role: str) -> None:
    ids, odd, given_again = {**make_one_of_each("hall"), "token_id": "0" * 16}, {}, 0
    services.set_site_quota(email="admin@vipo.example", sites=1)
    changing = [(method, path) for path, calls in OPERATIONS.items() for method in calls if method != "get"]
    for method, path in changing:
        name = OPERATIONS[path][method]["operationId"]
        if RIGHTS[name].role in ("anybody", "person"):
            continue
        with undone():
            admin = signed_in("admin", headers={"Idempotency-Key": "k1"})
            first, again = (ask(admin, method, path, name, ids) for _ in range(2))
            given_again += "Idempotency-Replayed" in again
            for site in services.list_slugs():
                move(site, role)
            later = ask(admin, method, path, name, ids)
            allowed = role == "viewer" and RIGHTS[name].role == "viewer"
            if (later.status_code < 400 and not allowed) or first.status_code >= 500:
                odd[name] = (first.status_code, later.status_code, later.content[:200])
    assert odd == {}
    assert given_again >= 15


def move(site: str, role: str) -> None:
    """Give the admin another role at a site."""
    if role == "none":
        services.remove_member(site=site, email="admin@vipo.example")
    else:
        services.set_member(site=site, email="admin@vipo.example", role=role)


def test_an_answer_of_an_earlier_version_is_given_to_nobody(hall: str) -> None:
    first = make(signed_in("author"))
    KeyedRequest.objects.update(needs=None)
    again = make(signed_in("author"))
    assert (first.status_code, again.status_code, again.json()["code"]) == (201, 409, "answer_not_kept")


@pytest.mark.parametrize("key", ["", '""', "a b", "a" * 256, "ä", "\0"])
def test_a_key_that_is_none_is_refused(hall: str, key: str) -> None:
    answer = make(signed_in("author"), key=key)
    assert (answer.status_code, answer.json()["code"], Program.objects.count()) == (400, "bad_idempotency_key", 0)


def test_reading_takes_no_notice_of_a_key_and_strangers_keep_nothing(hall: str) -> None:
    assert signed_in("viewer").get("/api/sites/hall", headers={"Idempotency-Key": " "}).status_code == 200
    assert make(Client()).status_code == 401
    assert KeyedRequest.objects.count() == 0


def test_answers_are_kept_for_a_day_and_so_many_at_most(db: None, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(keyed_requests, "MOST_OF_OWNER", 3)
    kept = KeptAnswer(200, {}, b"{}")

    def done(key: str, at: datetime) -> KeptAnswer | None:
        found = begin_request(owner="1:0", key=key, fingerprint="f", now=at)
        if found is None:
            end_request(owner="1:0", key=key, answer=kept, is_secret=False)
        return found

    assert [done(key, NOW + timedelta(seconds=i)) for i, key in enumerate("abcd")] == [None] * 4
    assert set(KeyedRequest.objects.values_list("key", flat=True)) == {"b", "c", "d"}
    assert done("d", NOW + timedelta(hours=23)) == kept
    assert done("d", NOW + timedelta(hours=25)) is None
    assert services.prune_keyed_requests(now=NOW + timedelta(hours=25)) == 2
    for key in "xyz":
        begin_request(owner="2:0", key=key, fingerprint="f", now=NOW)
    with pytest.raises(keyed_requests.TooManyKeys):
        begin_request(owner="2:0", key="w", fingerprint="f", now=NOW)


def test_a_form_is_the_same_when_its_fields_and_files_are(rf: Any) -> None:
    from django.core.files.uploadedfile import SimpleUploadedFile

    def form(name: str, content: bytes) -> str:
        return once._fingerprint(rf.post("/api/sites", {"name": name, "yaml": SimpleUploadedFile("a", content)}))

    assert form("A", b"x") == form("A", b"x")
    assert len({form("A", b"x"), form("B", b"x"), form("A", b"y")}) == 3


@pytest.mark.parametrize("database", ["sqlite", "postgresql"])
def test_of_many_at_two_servers_at_once_one_is_carried_out(
    tmp_path: Path, database: str, request: pytest.FixtureRequest
) -> None:
    extra = {}
    if database == "postgresql":
        redis: Redis = request.getfixturevalue("shared_redis")
        told = served_without_broker(tmp_path, request.getfixturevalue("database_url"), redis.url)
        extra = {name: value for name, value in told.items() if name.startswith("VIPO_")}
    prepared = prepare(tmp_path, extra)
    servers = [Web(tmp_path, prepared["sessions"], prepared["program"], extra) for _ in range(2)]
    try:
        for server in servers:
            server.start()
        answers = ask_at_once(servers)
        assert {answer.status_code for answer in answers} <= {201, 409}
        assert {answer.json()["code"] for answer in answers if answer.status_code == 409} <= {"under_way"}
        with servers[0].client("author") as client:
            again = client.post("/sites/hall/programs", json={"name": "Mix"}, headers={"Idempotency-Key": "k1"})
            assert [p["name"] for p in client.get("/sites/hall/programs").json()].count("Mix") == 1
        made = {again.json()["id"], *(answer.json()["id"] for answer in answers if answer.status_code == 201)}
        assert (again.headers["Idempotency-Replayed"], len(made)) == ("true", 1)
    finally:
        for server in servers:
            server.kill()


def ask_at_once(servers: list[Web]) -> list[httpx.Response]:
    """Send the same request ten times to both servers, all at one moment."""
    ready = threading.Barrier(20)

    def ask(number: int) -> httpx.Response:
        with servers[number % 2].client("author") as client:
            ready.wait(60)
            return client.post("/sites/hall/programs", json={"name": "Mix"}, headers={"Idempotency-Key": "k1"})

    with ThreadPoolExecutor(20) as pool:
        return list(pool.map(ask, range(20)))
