"""A provider says that a session has ended there: ours that began by it end, and nobody else can say so."""

from __future__ import annotations

import time
from collections.abc import Iterator
from typing import Any

import pytest
from django.contrib.sessions.models import Session as KeptSession
from django.test import Client
from joserfc import jwt
from joserfc.jwk import OctKey, RSAKey
from pytest_django import Settings

from registry.models import AuditLine, OpenSession, SignOn
from registry.people.sign_on import provider_client
from registry.people.sign_on.provider_client import LOGOUT_EVENT, MOST_TOKEN, _Known, _known
from registry.people.sign_on.provider_sessions import bind_session
from registry.people.sign_on.providers import Identity
from tests.kit.sign_in import find_person, signed_in

AT = "/api/sign-in/providers/acme/logout"
ISSUER, OTHER = "https://acme.example", "https://other.example"
KEY, STRANGE = RSAKey.generate_key(2048, {"kid": "rsa"}), RSAKey.generate_key(2048, {"kid": "rsa"})
ACME = {
    "name": "acme",
    "title": "Acme",
    "issuer": ISSUER,
    "client_id": "vipo",
    "client_secret": "of these tests",
    "domains": [],
    "amr": [],
    "acr": [],
}
pytestmark = pytest.mark.django_db


@pytest.fixture(autouse=True)
def provider(hall: str, settings: Settings) -> Iterator[None]:
    settings.VIPO_SIGN_ON = [ACME]
    _known[(ISSUER, "vipo")] = _Known({"issuer": ISSUER}, {"keys": [KEY.as_dict(private=False)]}, time.monotonic())
    yield
    provider_client.forget_providers()


def come(person: str, sid: str, issuer: str = ISSUER) -> Client:
    """Sign somebody in, by a session of a provider where they are called like here."""
    client = signed_in(person)
    assert client.get("/api/me/sessions").status_code == 200  # from then on it is known as open
    bind_session(key=str(client.session.session_key), identity=Identity(issuer, person, sid=sid))
    return client


def is_in(client: Client) -> bool:
    return bool(client.get("/api/sites").status_code == 200)


def logout_token(key: Any = KEY, alg: str = "RS256", typ: str = "logout+jwt", **changes: Any) -> str:
    """Return what is right, with something changed; None leaves it out."""
    now = int(time.time())
    right = {"iss": ISSUER, "aud": "vipo", "iat": now, "exp": now + 120, "jti": "once", "events": {LOGOUT_EVENT: {}}}
    claims = {name: value for name, value in {**right, **changes}.items() if value is not None}
    return jwt.encode({"alg": alg, "kid": "rsa", "typ": typ}, claims, key, algorithms=[alg])


def send(token: str) -> int:
    return int(Client(enforce_csrf_checks=True).post(AT, {"logout_token": token}).status_code)


def test_one_session_ends_by_its_name_and_all_of_a_person_by_theirs() -> None:
    first, second, other = come("author", "s1"), come("author", "s2"), come("viewer", "s3")
    by_password = signed_in("author")
    assert send(logout_token(sid="s1")) == 204
    assert [is_in(each) for each in (first, second, other, by_password)] == [False, True, True, True]
    assert send(logout_token(sub="author")) == 204
    assert [is_in(each) for each in (first, second, other, by_password)] == [False, False, True, True]
    assert not KeptSession.objects.filter(session_key=second.session.session_key).exists()
    lines = AuditLine.objects.filter(code="sign_on_ended")
    assert {(line.facts["person"], line.facts["provider"]) for line in lines} == {
        (find_person("author").display_name, "Acme")
    }


def test_subject_and_session_must_both_be_right_where_both_are_told_and_another_issuer_is_none() -> None:
    mine, elsewhere = come("author", "s1"), come("author", "s1", OTHER)
    assert send(logout_token(sub="viewer", sid="s1")) == 204
    assert is_in(mine)
    assert send(logout_token(sub="author", sid="s1")) == 204
    assert [is_in(mine), is_in(elsewhere)] == [False, True]


def test_a_token_that_is_sent_again_later_ends_no_session_that_began_since() -> None:
    token = logout_token(sub="author", iat=int(time.time()) - 300)
    client = come("author", "s1")
    assert send(token) == 204
    assert is_in(client)


NOT_TAKEN = {
    "another's key": {"key": STRANGE},
    "a shared secret": {"key": OctKey.import_key("of these tests"), "alg": "HS256"},
    "another issuer": {"iss": OTHER},
    "another audience": {"aud": "other"},
    "an ID token": {"events": None, "nonce": "n"},
    "a nonce": {"nonce": "n"},
    "another event": {"events": {"https://example.org/other": {}}},
    "events that are none": {"events": [LOGOUT_EVENT]},
    "an event that is none": {"events": {LOGOUT_EVENT: True}},
    "no name": {"jti": None},
    "no time": {"iat": None},
    "no end": {"exp": None},
    "over": {"exp": 1},
    "of the future": {"iat": 4_000_000_000},
    "nobody": {"sub": None},
    "a subject that is none": {"sub": 7},
    "a subject with NUL": {"sub": "a\0b"},
    "a session that is none": {"sid": ["s1"]},
    "too long": {"sid": "s" * MOST_TOKEN},
}


@pytest.mark.parametrize("changes", NOT_TAKEN.values(), ids=NOT_TAKEN)
def test_what_is_not_the_providers_word_ends_nothing(changes: dict[str, Any]) -> None:
    client = come("author", "s1")
    answer = Client().post(AT, {"logout_token": logout_token(**{"sub": "author", **changes})})
    assert (answer.status_code, answer.json()["code"]) == (400, "bad_logout_token")
    assert is_in(client)


def test_strangers_are_refused_without_a_statement_and_do_not_have_the_provider_asked(
    django_assert_num_queries: Any,
) -> None:
    strange = RSAKey.generate_key(2048, {"kid": "unknown"})
    unknown = jwt.encode({"alg": "RS256", "kid": "unknown"}, {"iss": ISSUER}, strange, algorithms=["RS256"])
    with django_assert_num_queries(0):  # the provider's address does not exist: asking it would be another status
        for said in ("", "nonsense", "a.b.c", unknown, "\0", "\u202e" * 40):
            assert send(said) == 400
        assert Client().post(AT, {"logout_token": logout_token(sub="author")}, "application/json").status_code == 400
        assert Client().post(AT.replace("acme", "other"), {"logout_token": "x"}).status_code == 404
    assert OpenSession.objects.count() == SignOn.objects.count() == 0
