"""Hostile and unlucky ways of a sign-on: answers of others, guesses, clocks, keys, providers that are away."""

from __future__ import annotations

import json
from datetime import timedelta

import pytest
from django.contrib.sessions.models import Session as KeptSession
from django.test import Client
from django.utils import timezone
from pytest_django import Settings

from registry.models import Membership, SignOnAttempt
from registry.people.sign_on.provider_client import forget_providers
from tests.kit.openid import OpenId, make_key, stray_state, visit
from tests.kit.openid.journeys import AT, begin, come, finish, link, refusals, who_is, why
from tests.kit.sign_in import add_person, post_json, signed_in
from vipo_site.cli.main import main


def test_the_request_is_proved_by_pkce_state_and_nonce_and_nothing_of_it_is_kept(acme: OpenId) -> None:
    client = Client()
    address = begin(client)
    for part in ("code_challenge_method=S256", "code_challenge=", "state=", "nonce=", "scope=openid+email+profile"):
        assert part in address
    assert "secret" not in address
    cookie = client.cookies["vipo_sign_on"]
    assert (cookie["httponly"], cookie["samesite"], cookie["path"]) == (True, "Strict", "/api/sign-in")
    assert cookie.value not in str(list(SignOnAttempt.objects.values())) + address


def test_an_answer_is_taken_once(acme: OpenId) -> None:
    link("author", "ada", acme)
    client = Client()
    given = visit(begin(client), "ada")
    assert finish(client, given).status_code == 200
    assert why(finish(client, given)) == (403, "replayed")


def test_another_browser_cannot_finish_what_one_began(acme: OpenId) -> None:
    """So nobody is signed in as somebody else by an address that is sent to them."""
    link("author", "ada", acme)
    client, victim = Client(), Client()
    given = visit(begin(client), "ada")
    begin(victim)
    assert why(finish(victim, given)) == (403, "browser")
    assert why(finish(Client(), given)) == (403, "browser")
    assert who_is(victim) is None
    assert finish(client, given).status_code == 200, "and nobody can use it up for them"


def test_a_stolen_code_is_of_no_use_in_another_sign_on(acme: OpenId) -> None:
    link("author", "ada", acme)
    stolen = visit(begin(Client()), "ada")
    thief = Client()
    own = visit(begin(thief), "new")
    assert why(finish(thief, {**own, "code": stolen["code"]})) == (403, "code")
    assert who_is(thief) is None


def test_a_wrong_nonce_is_refused(acme: OpenId) -> None:
    link("author", "ada", acme)
    client = Client()
    address = begin(client)
    nonce = address.partition("nonce=")[2].partition("&")[0]
    given = visit(address.replace(nonce, "another-sign-ons-nonce"), "ada")
    assert why(finish(client, given)) == (403, "nonce")
    assert who_is(client) is None


def test_states_that_are_none_or_old_and_denials_are_refused_and_told(acme: OpenId) -> None:
    client = Client()
    assert why(finish(client, {"state": stray_state(), "code": "x"})) == (403, "unknown")
    given = visit(begin(client), "ada")
    SignOnAttempt.objects.update(at=timezone.now() - timedelta(minutes=11))
    assert why(finish(client, given)) == (403, "expired")
    assert why(come(client, "ada", do="deny")) == (403, "denied")
    given = visit(begin(client), "ada")
    assert why(finish(client, {**given, "iss": "https://other.example"})) == (403, "answer")
    assert [word for _, word in refusals()] == ["unknown", "expired", "denied", "answer"]


def test_guessing_is_held_up(acme: OpenId) -> None:
    client = Client()
    answers = [finish(client, {"state": stray_state(), "code": "x"}) for _ in range(9)]
    assert [answer.status_code for answer in answers] == [403] * 8 + [429]
    assert answers[-1].json()["args"]["why"] == "sign_on"
    assert len(refusals()) == 8


def test_so_many_sign_ons_begin_from_one_place_and_no_more(acme: OpenId) -> None:
    now = timezone.now()
    rows = [
        SignOnAttempt(state_hash=f"{number}", browser_hash="", provider="acme", network="127.0.0.1", at=now)
        for number in range(200)
    ]
    SignOnAttempt.objects.bulk_create(rows)
    assert post_json(Client(), AT).status_code == 429
    assert post_json(Client(REMOTE_ADDR="192.0.2.7"), AT).status_code == 200


@pytest.mark.parametrize(
    "address",
    ["https://evil.example/", "//evil.example", "/\\evil.example", "/\tx", "javascript:alert(1)", "x", "/ok\\..", ""],
)
def test_nobody_is_led_elsewhere(acme: OpenId, address: str) -> None:
    link("author", "ada", acme)
    client = Client()
    answer = post_json(client, AT, {"next": address})
    if answer.status_code == 422:  # no text of one line
        return
    assert finish(client, visit(answer.json()["address"], "ada")).json()["next"] == "/"


def test_a_page_of_another_site_begins_and_finishes_nothing(acme: OpenId) -> None:
    strict = Client(enforce_csrf_checks=True)
    assert post_json(strict, AT).status_code == 403
    assert finish(strict, {"state": "x"}).status_code == 403


# What goes wrong at the provider: it is started anew, so these stand last


def test_keys_that_are_changed_are_asked_for_and_old_ones_count_no_more(acme: OpenId) -> None:
    link("author", "ada", acme)
    acme.restart(keys=[make_key("second")])
    assert come(Client(), "ada").status_code == 200
    acme.restart(keys=[{**make_key("second")}])  # another key by the same name: not signed by whom it is known as
    assert why(come(Client(), "ada")) == (403, "answer")
    forget_providers()
    assert come(Client(), "ada").status_code == 200


@pytest.mark.parametrize("offset_s", [-1800, 1800])
def test_a_clock_that_is_off_is_told_as_such(acme: OpenId, offset_s: int) -> None:
    link("author", "ada", acme)
    acme.restart(offset_s=offset_s)
    try:
        assert why(come(Client(), "ada")) == (403, "clock")
    finally:
        acme.restart(offset_s=0)


def test_a_token_that_is_signed_with_a_shared_secret_is_none(acme: OpenId) -> None:
    acme.restart(client={"id_token_signed_response_alg": "HS256"})
    try:
        client = Client()
        assert why(come(client, "ada")) == (403, "answer")
    finally:
        acme.restart(client={})


def test_a_provider_that_is_away_or_calls_itself_otherwise_is_told_as_down(acme: OpenId, settings: Settings) -> None:
    client = Client()
    given = visit(begin(client), "ada")
    acme.stop()
    assert why(finish(client, given)) == (503, "down")
    forget_providers()
    assert why(post_json(client, AT)) == (503, "down")
    acme.start()
    assert why(finish(client, given)) == (403, "replayed")
    settings.VIPO_SIGN_ON = [acme.setting(issuer=f"http://localhost:{acme.port}")]
    assert why(post_json(client, AT)) == (503, "down")
    assert refusals()[0] == ("", "down")


def test_what_was_kept_for_a_sign_on_is_forgotten(acme: OpenId) -> None:
    from registry import services

    begin(Client())
    assert services.forget_sign_ons(now=timezone.now()) == 0
    assert services.forget_sign_ons(now=timezone.now() + timedelta(hours=2)) == 1
    assert KeptSession.objects.count() == 0, "strangers leave no session behind"
    assert Membership.objects.filter(user=add_person("late")).count() == 0


def test_who_serves_vipo_reads_what_no_site_knows(acme: OpenId, capsys: pytest.CaptureFixture[str]) -> None:
    come(Client(REMOTE_ADDR="192.0.2.7"), "new")
    assert main(["record"]) == 0
    line = capsys.readouterr().out.splitlines()[1]
    assert all(word in line for word in ("sign_on_refused", "provider Acme", "why nobody", "192.0.2.7"))
    assert main(["record", "--last", "1", "--json"]) == 0
    assert [row["facts"]["why"] for row in json.loads(capsys.readouterr().out)] == ["nobody"]
    told = signed_in("admin").get("/api/sites/hall/audit?kind=sign_in").json()
    assert told == [], "and no admin of a site does"
