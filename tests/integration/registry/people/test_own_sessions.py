"""A person sees their own sessions, in plain words, and ends each by itself; nobody else's can be seen or ended."""

from __future__ import annotations

from datetime import timedelta
from typing import Any

import pytest
from django.contrib.sessions.models import Session as KeptSession
from django.test import Client
from django.utils import timezone

from registry import services
from registry.models import OpenSession
from registry.people.open_sessions import name_browser
from registry.people.sessions import Session, read_standings
from tests.kit.sign_in import PASSWORD, find_person, post_json, signed_in

pytestmark = pytest.mark.django_db
FIREFOX = "Mozilla/5.0 (X11; Linux x86_64; rv:140.0) Gecko/20100101 Firefox/140.0"
SESSIONS = "/api/me/sessions"


def come_in(name: str = "author", agent: str = FIREFOX) -> Client:
    client = Client(headers={"User-Agent": agent})
    answer = post_json(client, "/api/sign-in", {"email": f"{name}@vipo.example", "password": PASSWORD})
    assert answer.status_code == 200
    return client


def seen(client: Client) -> list[tuple[Any, ...]]:
    return [(each["browser"], each["system"], each["here"]) for each in client.get(SESSIONS).json()]


def test_sessions_are_listed_in_plain_words_and_this_one_is_marked(hall: str) -> None:
    first = come_in()
    second = come_in(agent="curl/8.5.0")
    come_in("admin")
    assert seen(first) == [("curl", "", False), ("Firefox", "Linux", True)]
    assert seen(second) == [("curl", "", True), ("Firefox", "Linux", False)]
    told = first.get(SESSIONS)
    assert not any(str(second.session.session_key) in str(each) for each in told.json())


def test_one_session_is_ended_and_the_others_go_on(hall: str) -> None:
    here, there = come_in(), come_in()
    ended = Session(str(there.session.session_key), find_person("author").pk)
    assert ended in read_standings([ended])
    other = next(each["id"] for each in here.get(SESSIONS).json() if not each["here"])
    assert here.delete(f"{SESSIONS}/{other}").status_code == 204
    assert read_standings([ended]) == {}, "the watch closes its sockets"
    assert there.get("/api/sites").status_code == 401
    assert len(here.get(SESSIONS).json()) == 1
    assert here.delete(f"{SESSIONS}/{other}").status_code == 404


def test_somebody_elses_session_is_not_there(hall: str) -> None:
    mine, theirs = come_in(), come_in("admin")
    key = theirs.get(SESSIONS).json()[0]["id"]
    assert mine.delete(f"{SESSIONS}/{key}").status_code == 404
    assert mine.delete(f"{SESSIONS}/{2**70}").status_code in (404, 422)
    assert theirs.get("/api/sites").status_code == 200


def test_no_token_sees_or_ends_sessions(hall: str) -> None:
    _, text = services.create_token(
        user=find_person("author"), site="hall", name="T", scopes=["read"], days=1, now=timezone.now()
    )
    program = Client(headers={"Authorization": f"Bearer {text}"})
    assert [program.get(SESSIONS).status_code, program.delete(f"{SESSIONS}/1").status_code] == [403, 403]


def test_a_new_password_leaves_the_session_that_gave_it_with_when_it_began(hall: str) -> None:
    here, _ = come_in(), come_in()
    begun = next(each["begun_at"] for each in here.get(SESSIONS).json() if each["here"])
    changed = post_json(here, "/api/me/password", {"old": PASSWORD, "new": "four quiet words 77"})
    assert changed.status_code == 200
    (left,) = here.get(SESSIONS).json()
    assert (left["here"], left["begun_at"]) == (True, begun)


def test_when_a_session_was_last_seen_is_kept_to_the_minute(hall: str, monkeypatch: pytest.MonkeyPatch) -> None:
    client = come_in()
    OpenSession.objects.update(seen_at=timezone.now() - timedelta(hours=2))
    client.get("/api/sites")
    old = OpenSession.objects.get().seen_at
    monkeypatch.setattr("registry.people.open_sessions.NOTED_EVERY", timedelta(0))
    client.get("/api/sites")
    assert OpenSession.objects.get().seen_at - old > timedelta(hours=1)


def test_what_stands_beside_expired_sessions_goes_with_them(hall: str) -> None:
    client = come_in()
    KeptSession.objects.update(expire_date=timezone.now() - timedelta(days=1))
    assert services.drop_expired(now=timezone.now()) == 1
    assert OpenSession.objects.count() == 0
    assert client.get(SESSIONS).status_code == 401


def test_a_session_of_before_is_listed_once_it_is_used(hall: str) -> None:
    assert seen(signed_in("viewer")) == [("", "", True)]


@pytest.mark.parametrize(
    ("agent", "named"),
    [
        (FIREFOX, ("Firefox", "Linux")),
        ("Mozilla/5.0 (Windows NT 10.0; Win64; x64) AppleWebKit/537.36 (KHTML, like Gecko) Chrome/141.0.0.0 "
         "Safari/537.36 Edg/141.0.0.0", ("Edge", "Windows")),
        ("Mozilla/5.0 (iPhone; CPU iPhone OS 18_0 like Mac OS X) AppleWebKit/605.1.15 (KHTML, like Gecko) "
         "Version/18.0 Mobile/15E148 Safari/604.1", ("Safari", "iPhone")),
        ("Mozilla/5.0 (Linux; Android 15) AppleWebKit/537.36 (KHTML, like Gecko) Chrome/141.0.0.0 Mobile "
         "Safari/537.36", ("Chrome", "Android")),
        ("python-httpx/0.28.1", ("python-httpx", "")),
        ("", ("", "")),
        ("<script>", ("", "")),
        ("x" * 5000, ("x" * 40, "")),
    ],
)  # fmt: skip
def test_a_browser_has_a_name_in_plain_words(agent: str, named: tuple[str, str]) -> None:
    assert name_browser(agent) == named


def test_what_was_asked_before_a_session_got_its_new_key_does_not_sign_the_browser_out(hall: str) -> None:
    here, late = come_in(), Client()
    late.cookies["sessionid"] = here.cookies["sessionid"].value
    answer = post_json(here, "/api/me/password", {"old": PASSWORD, "new": "another long sentence"})
    assert answer.status_code == 200
    assert answer.cookies["sessionid"].value not in {"", late.cookies["sessionid"].value}
    for path, status in (("/api/sites", 401), ("/api/me", 200)):
        behind = late.get(path)
        assert behind.status_code == status
        assert "sessionid" not in behind.cookies
    assert "sessionid" not in post_json(late, "/api/me/tokens", {"name": "x"}).cookies
    assert "Cookie" in late.get("/api/sites").headers["Vary"]
    assert "Cookie" not in Client().get("/health").headers.get("Vary", ""), (
        "an answer for everybody may be kept for all"
    )
    assert here.get("/api/sites").status_code == 200
    assert post_json(here, "/api/sign-out", {}).cookies["sessionid"].value == ""
