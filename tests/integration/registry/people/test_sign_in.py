"""Signing in: guessing is slowed down however it is done, and does not keep people out of their own account."""

from __future__ import annotations

import json
from collections import Counter
from collections.abc import Iterator
from concurrent.futures import ThreadPoolExecutor
from datetime import UTC, datetime, timedelta
from pathlib import Path
from typing import Any

import httpx
import pytest
from django.contrib.sessions.backends.db import SessionStore
from django.contrib.sessions.models import Session as KeptSession
from django.test import Client
from pytest_django import DjangoAssertNumQueries

from execution.ticker.ticker import Ticker
from registry import services
from registry.models import SignInFailure, User
from registry.people import throttle
from registry.people.sessions import Session, Standing, read_standings
from registry.people.throttle import Attempt, TooManyAttempts, counted, network_of
from tests.kit.served import served_without_broker
from tests.kit.servers import Redis
from tests.kit.sign_in import PASSWORD, find_person, post_json, signed_in
from tests.kit.web import Web, prepare

NOW = datetime(2026, 11, 21, 12, 0, tzinfo=UTC)
ADMIN = "admin@vipo.example"


def sign_in(client: Client, password: str, email: str = ADMIN, **where: Any) -> Any:
    return (
        post_json(client, "/api/sign-in", {"email": email, "password": password})
        if not where
        else client.post(
            "/api/sign-in", {"email": email, "password": password}, content_type="application/json", **where
        )
    )


def statuses(attempts: int, **where: Any) -> list[int]:
    return [sign_in(Client(), "wrong", **where).status_code for _ in range(attempts)]


def test_a_refusal_says_when_to_come_again_and_attempts_meanwhile_do_not_prolong_it(hall: str) -> None:
    assert statuses(8) == [401] * 8
    first = sign_in(Client(), PASSWORD)
    assert (first.status_code, first.json()["code"]) == (429, "too_many_attempts")
    assert first.json()["detail"] == "Too many sign-ins failed. Try again in 15 min."
    assert 890 <= int(first["Retry-After"]) <= 900
    assert statuses(20) == [429] * 20
    assert SignInFailure.objects.count() == 8
    SignInFailure.objects.update(at=datetime.now(UTC) - throttle.WINDOW)
    assert sign_in(Client(), PASSWORD).status_code == 200


@pytest.mark.parametrize("header", ["X-Forwarded-For", "X-Real-IP", "Forwarded", "Client-IP", "True-Client-IP"])
def test_a_forged_header_gives_no_further_attempts(hall: str, header: str) -> None:
    forged = [statuses(1, headers={header: f"10.1.2.{number}"})[0] for number in range(10)]
    assert forged == [401] * 8 + [429] * 2


def test_guessing_from_many_addresses_ends_and_the_owner_comes_in_from_a_known_browser(hall: str) -> None:
    browser = Client()
    assert sign_in(browser, PASSWORD).status_code == 200
    browser.post("/api/sign-out")
    guessed = Counter(statuses(1, REMOTE_ADDR=f"10.0.{n}.1")[0] for n in range(60))
    assert guessed == {401: throttle.MOST_FOR_EMAIL, 429: 60 - throttle.MOST_FOR_EMAIL}
    assert sign_in(Client(), PASSWORD).status_code == 429
    assert sign_in(browser, PASSWORD).status_code == 200


def test_a_known_browser_is_slowed_down_too_and_knows_nobody_else(hall: str) -> None:
    browser = Client()
    sign_in(browser, PASSWORD)
    assert [sign_in(browser, "wrong").status_code for _ in range(9)] == [401] * 8 + [429]
    cookie = next(c for name, c in browser.cookies.items() if name.startswith("vipo_known_"))
    assert (cookie["httponly"], cookie["samesite"], cookie["path"]) == (True, "Lax", "/api/sign-in")
    assert sign_in(Client(), PASSWORD).status_code == 200, "guessing there does not count here"
    forged = Client()
    forged.cookies[cookie.key] = "x" * 22 + ":1abcde:" + "y" * 43
    assert [sign_in(forged, "wrong").status_code for _ in range(9)] == [401] * 8 + [429]


def test_one_customer_of_ipv6_is_one_address() -> None:
    assert network_of("2001:db8:1:2:3:4:5:6") == network_of("2001:db8:1:2::9%eth0") == "2001:db8:1:2::/64"
    assert network_of("::ffff:10.0.0.1") == network_of("10.0.0.1") == "10.0.0.1"
    assert network_of("unix:\0" + "x" * 100) == ("unix:\0" + "x" * 100)[:64]


def test_an_attempt_that_is_still_under_way_counts(hall: str) -> None:
    attempt = Attempt(ADMIN, "10.0.0.1")
    for _ in range(7):
        SignInFailure.objects.create(email=ADMIN, address="10.0.0.1", at=NOW)
    with counted(attempt, NOW), pytest.raises(TooManyAttempts) as refused, counted(attempt, NOW):
        pytest.fail("the ninth was let through while the eighth was under way")
    assert refused.value.facts == {"why": "wait", "minutes": 15, "retry_after_s": 900}
    assert SignInFailure.objects.count() == 0, "the eighth ended well"


@pytest.fixture(scope="module")
def served(tmp_path_factory: pytest.TempPathFactory, module_database_url: str, shared_redis: Redis) -> Iterator[Web]:
    folder = tmp_path_factory.mktemp("served")
    told = served_without_broker(folder, module_database_url, shared_redis.url)
    yield from running(folder, {name: value for name, value in told.items() if name.startswith("VIPO_")})


@pytest.fixture(scope="module")
def embedded(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Web]:
    yield from running(tmp_path_factory.mktemp("embedded"), {})


def running(folder: Path, extra: dict[str, str]) -> Iterator[Web]:
    web = Web(folder, **prepare(folder, extra), extra=extra)
    web.start()
    yield web
    web.kill()


@pytest.mark.servers
@pytest.mark.parametrize("form", ["embedded", "served"])
def test_of_forty_at_once_no_more_than_eight_are_tried(form: str, request: pytest.FixtureRequest) -> None:
    web: Web = request.getfixturevalue(form)
    with web.client(None) as client, ThreadPoolExecutor(40) as pool:
        headers, cookies = dict(client.headers), dict(client.cookies)

        def guess(_number: int) -> int:
            body = {"email": "viewer@vipo.example", "password": "wrong"}
            url = f"http://127.0.0.1:{web.port}/api/sign-in"
            return httpx.post(url, json=body, headers=headers, cookies=cookies, timeout=60).status_code

        answers = Counter(pool.map(guess, range(40)))
        more = [guess(number) for number in range(9)]
    assert set(answers) <= {401, 429}
    assert answers[401] + more.count(401) == 8


@pytest.mark.parametrize(
    ("password", "why", "says"),
    [
        ("short", "too_short", "at least 10 characters"),
        ("1234567890", "too_common", "tried first"),
        ("password123", "too_common", "tried first"),
        ("83749283749", "entirely_numeric", "Add letters"),
        ("admin@vipo.example", "too_similar", "too much like the name or the e-mail address"),
        ("Admin Person", "too_similar", "too much like the name or the e-mail address"),
    ],
)
def test_a_weak_password_is_refused_with_how_to_mend_it(hall: str, password: str, why: str, says: str) -> None:
    answer = post_json(signed_in("admin"), "/api/me/password", {"old": PASSWORD, "new": password})
    assert (answer.status_code, answer.json()["code"], answer.json()["args"]["why"]) == (422, "bad_password", why)
    assert says in answer.json()["detail"]
    assert find_person("admin").check_password(PASSWORD)


def test_a_new_password_keeps_this_session_and_ends_the_others(hall: str) -> None:
    here, there = signed_in("admin"), signed_in("admin")
    before = here.cookies["sessionid"].value
    answer = post_json(here, "/api/me/password", {"old": PASSWORD, "new": "four words of mine"})
    assert (answer.status_code, answer.json()["user"]["email"]) == (200, ADMIN)
    assert here.cookies["sessionid"].value != before
    assert [client.get("/api/sites").status_code for client in (here, there)] == [200, 401]
    assert sign_in(Client(), PASSWORD).status_code == 401
    assert sign_in(Client(), "four words of mine").status_code == 200


def test_the_old_password_cannot_be_guessed_with_a_session_found_open(hall: str) -> None:
    client = signed_in("admin")
    told = [post_json(client, "/api/me/password", {"old": "wrong", "new": "four words of mine"}) for _ in range(9)]
    assert [answer.status_code for answer in told] == [422] * 8 + [429]
    assert (told[0].json()["code"], told[8].json()["code"]) == ("wrong_old_password", "too_many_attempts")
    assert find_person("admin").check_password(PASSWORD)
    assert sign_in(Client(), PASSWORD).status_code == 200, "who knows it still comes in"


def test_signing_out_everywhere_ends_every_session_of_the_person_alone(hall: str) -> None:
    here, there, other = signed_in("admin"), signed_in("admin"), signed_in("author")
    answer = post_json(here, "/api/me/sign-out-everywhere")
    assert (answer.status_code, answer.json()["user"]) == (200, None)
    assert [client.get("/api/sites").status_code for client in (here, there, other)] == [401, 401, 200]
    assert sign_in(here, PASSWORD).status_code == 200
    assert here.get("/api/sites").status_code == 200


@pytest.mark.parametrize("path", ["/api/me/password", "/api/me/sign-out-everywhere"])
def test_strangers_and_pages_without_the_token_change_nothing(hall: str, path: str) -> None:
    body = {"old": PASSWORD, "new": "four words of mine"}
    assert post_json(Client(), path, body).status_code == 401
    assert post_json(signed_in("admin", enforce_csrf_checks=True), path, body).status_code == 403
    assert find_person("admin").check_password(PASSWORD)


def test_the_standing_of_many_sessions_takes_two_statements(
    hall: str, django_assert_num_queries: DjangoAssertNumQueries
) -> None:
    keys = {role: signed_in(role).cookies["sessionid"].value for role in ("viewer", "author", "stranger")}
    sessions = {role: Session(key, find_person(role).pk) for role, key in keys.items()}
    strange = Session(keys["viewer"], sessions["author"].person)
    more = [Session(f"none{number}", number) for number in range(300)]
    with django_assert_num_queries(2):
        found = read_standings([*sessions.values(), strange, *more])
    assert found == {
        sessions["viewer"]: Standing({"hall": "viewer"}),
        sessions["author"]: Standing({"hall": "author"}),
        sessions["stranger"]: Standing({}),
    }


def test_expired_sessions_and_attempts_that_count_no_more_are_removed_by_the_ticker(hall: str) -> None:
    kept, expired = signed_in("admin"), signed_in("viewer")
    now = datetime.now(UTC)
    key = expired.cookies["sessionid"].value
    KeptSession.objects.filter(session_key=key).update(expire_date=now - timedelta(seconds=1))
    SignInFailure.objects.create(email=ADMIN, address="10.0.0.1", at=now - throttle.WINDOW)
    SignInFailure.objects.create(email=ADMIN, address="10.0.0.1", at=now)
    assert Ticker("a test").tick(now)
    assert not SessionStore().exists(key)
    assert SessionStore().exists(kept.cookies["sessionid"].value)
    assert SignInFailure.objects.count() == 1


def test_a_closed_account_signs_in_no_more_and_a_reopened_one_has_a_new_password(hall: str) -> None:
    client = signed_in("admin")
    services.close_account(email=ADMIN)
    assert (client.get("/api/sites").status_code, sign_in(Client(), PASSWORD).status_code) == (401, 401)
    services.reopen_account(email=ADMIN, password="four words of mine")
    assert client.get("/api/sites").status_code == 401, "sessions from before do not come back"
    assert sign_in(Client(), "four words of mine").status_code == 200
    assert User.objects.get(email=ADMIN).is_active


def test_the_cookie_of_a_known_browser_is_of_no_use_without_the_password(hall: str) -> None:
    browser = Client()
    sign_in(browser, PASSWORD)
    names = [name for name in browser.cookies if name.startswith("vipo_known_")]
    alone = Client()
    alone.cookies[names[0]] = browser.cookies[names[0]].value
    assert json.loads(alone.get("/api/me").content)["user"] is None
    assert sign_in(alone, "wrong").status_code == 401
