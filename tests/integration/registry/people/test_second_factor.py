"""A second factor: set up and confirmed, asked for at signing in, a code taken once, and ways out for who loses it."""

from __future__ import annotations

import sys
from concurrent.futures import ThreadPoolExecutor
from datetime import UTC, datetime, timedelta
from pathlib import Path
from typing import Any

import httpx
import pyotp
import pytest
from django.test import Client
from pytest_django import Settings

from registry import services
from registry.models import AuditLine, RecoveryCode, SecondFactor, User
from registry.people import second_factor
from registry.people.second_factor import WrongCode, check_code, confirm_factor
from registry.sites.sites import NoEnrolmentKey, get_enrolment_key
from tests.kit.processes.forked import run_forked
from tests.kit.sign_in import PASSWORD, find_person, post_json, signed_in
from tests.kit.web import Web, environment, prepare
from vipo_site.cli.main import main

ME = "/api/me/second-factor"
EMAIL = "author@vipo.example"


def code_at(secret: str, steps: int = 0) -> str:
    """Return the app's code of now, or of so many steps of 30 s away."""
    return pyotp.TOTP(secret).at(datetime.now(UTC) + timedelta(seconds=30 * steps))


def wrong_for(secret: str) -> str:
    """Return six digits that are no code of about now."""
    right = {code_at(secret, steps) for steps in range(-2, 3)}
    return next(code for code in ("000000", "111111", "222222", "333333", "444444", "555555") if code not in right)


def begin(client: Client, password: str = PASSWORD) -> Any:
    return post_json(client, ME, {"password": password})


def set_up(client: Client) -> tuple[str, list[str]]:
    """Give who is signed in a second factor, by the code of now; return its secret and recovery codes."""
    secret = begin(client).json()["secret"]
    confirmed = post_json(client, f"{ME}/confirm", {"password": PASSWORD, "code": code_at(secret)})
    assert confirmed.status_code == 200, confirmed.content
    return secret, confirmed.json()["codes"]


def sign_in(code: str | None = None, password: str = PASSWORD, client: Client | None = None) -> Any:
    body = {"email": EMAIL, "password": password, **({} if code is None else {"code": code})}
    return post_json(client or Client(), "/api/sign-in", body)


def refusal(answer: Any) -> tuple[int, str]:
    return answer.status_code, answer.json().get("code", "")


def test_it_counts_once_a_code_of_it_was_shown(hall: str) -> None:
    client = signed_in("author")
    assert refusal(begin(client, "not this one")) == (422, "wrong_old_password")
    made = begin(client)
    secret = made.json()["secret"]
    assert (made.status_code, made["Cache-Control"]) == (201, "no-store")
    assert pyotp.parse_uri(made.json()["address"]).secret == secret
    assert made.json()["picture"].startswith("data:image/svg+xml")
    assert sign_in().status_code == 200, "it does not count yet"
    wrong = post_json(client, f"{ME}/confirm", {"password": PASSWORD, "code": wrong_for(secret)})
    assert refusal(wrong) == (422, "wrong_code")
    confirmed = post_json(client, f"{ME}/confirm", {"password": PASSWORD, "code": code_at(secret)})
    assert (confirmed.status_code, len(set(confirmed.json()["codes"]))) == (200, 10)
    shown = client.get(ME).json()
    assert (shown["since"] is not None, shown["recovery_codes"]) == (True, 10)
    assert refusal(begin(client)) == (409, "second_factor_on")


def test_neither_the_secret_nor_a_recovery_code_is_kept_or_told_again(hall: str) -> None:
    client = signed_in("author")
    secret, codes = set_up(client)
    kept = (
        f"{list(SecondFactor.objects.values())}{list(RecoveryCode.objects.values())}{list(AuditLine.objects.values())}"
    )
    told = client.get(ME).content.decode() + signed_in("admin").get("/api/sites/hall/members").content.decode()
    assert [each for each in (secret, *codes) if each in kept + told] == []


def test_signing_in_asks_for_a_code_and_takes_each_once(hall: str) -> None:
    secret, _ = set_up(signed_in("author"))
    assert refusal(sign_in()) == (401, "second_factor_needed")
    assert refusal(sign_in(code_at(secret, 1), "not this one")) == (401, "wrong_password")
    assert refusal(sign_in(wrong_for(secret))) == (422, "wrong_code")
    older_than_the_confirming = code_at(secret, -1)
    assert refusal(sign_in(older_than_the_confirming)) == (422, "wrong_code")
    code = code_at(secret, 1)
    assert sign_in(f"{code[:3]} {code[3:]}").status_code == 200
    assert refusal(sign_in(code)) == (422, "wrong_code")


def test_a_recovery_code_stands_in_once_however_it_is_typed(hall: str) -> None:
    client = signed_in("author")
    _, codes = set_up(client)
    assert sign_in(codes[0].upper().replace("-", " ")).status_code == 200
    assert refusal(sign_in(codes[0])) == (422, "wrong_code")
    assert client.get(ME).json()["recovery_codes"] == 9
    renewed = post_json(client, f"{ME}/recovery-codes", {"password": PASSWORD, "code": codes[1]}).json()["codes"]
    assert refusal(sign_in(codes[2])) == (422, "wrong_code")
    assert sign_in(renewed[0]).status_code == 200


def test_wrong_codes_are_held_up_as_wrong_passwords_are(hall: str) -> None:
    client = signed_in("author")
    secret, _ = set_up(client)
    wrong = wrong_for(secret)
    assert [refusal(sign_in(wrong))[1] for _ in range(7)] == ["wrong_code"] * 7
    assert refusal(sign_in())[1] == "second_factor_needed", "it counts, too: asking for nothing forgets no guess"
    assert refusal(sign_in(code_at(secret, 1)))[1] == "too_many_attempts"
    off = [post_json(client, f"{ME}/off", {"password": PASSWORD, "code": wrong}) for _ in range(9)]
    assert [refusal(answer)[0] for answer in off] == [422] * 8 + [429]


def test_turning_it_on_ends_other_sessions_and_leaves_this_one_and_tokens(hall: str) -> None:
    client, other = signed_in("author"), signed_in("author")
    made = post_json(client, "/api/sites/hall/tokens", {"name": "Desk", "scopes": ["read"]}).json()["token"]
    set_up(client)
    bearer = {"HTTP_AUTHORIZATION": f"Bearer {made}"}
    found = (client.get(ME), other.get(ME), Client().get("/api/sites/hall", **bearer))
    assert [answer.status_code for answer in found] == [200, 401, 200]
    assert len(client.get("/api/me/sessions").json()) == 1


def test_turning_it_off_asks_for_the_password_and_a_code(hall: str) -> None:
    client = signed_in("author")
    secret, _ = set_up(client)
    code = code_at(secret, 1)
    assert refusal(post_json(client, f"{ME}/off", {"password": "no", "code": code})) == (422, "wrong_old_password")
    assert refusal(post_json(client, f"{ME}/off", {"password": PASSWORD, "code": ""})) == (422, "wrong_code")
    assert post_json(client, f"{ME}/off", {"password": PASSWORD, "code": code}).status_code == 200
    assert sign_in().status_code == 200
    assert refusal(post_json(client, f"{ME}/off", {"password": PASSWORD, "code": code})) == (409, "second_factor_off")
    lines = AuditLine.objects.filter(code__startswith="second_factor").order_by("pk")
    assert [line.code for line in lines] == ["second_factor_on", "second_factor_off"]


def reset(by: str, person: User) -> Any:
    return signed_in(by).delete(f"/api/sites/hall/members/{person.pk}/second-factor")


def test_an_admin_of_all_sites_of_a_member_resets_it(hall: str) -> None:
    client, author = signed_in("author"), find_person("author")
    set_up(client)
    services.create_site(name="Shed", slug="shed")
    services.set_member(site="shed", email=EMAIL, role="viewer")
    refused = reset("admin", author)
    assert (refused.status_code, "sites that are not yours" in refused.json()["detail"]) == (403, True)
    services.set_member(site="shed", email="admin@vipo.example", role="admin")
    assert reset("operator", author).status_code == 403
    assert reset("admin", author).status_code == 204
    assert (client.get(ME).status_code, sign_in().status_code) == (401, 200)
    assert refusal(reset("admin", author)) == (409, "second_factor_off")
    told = AuditLine.objects.filter(code="second_factor_reset").values_list("site__slug", "actor")
    assert sorted(told) == [("hall", find_person("admin").display_name), ("shed", find_person("admin").display_name)]


def test_who_serves_vipo_resets_it(hall: str, capsys: pytest.CaptureFixture[str]) -> None:
    set_up(signed_in("author"))
    assert main(["account", EMAIL, "--no-second-factor"]) == 0
    assert f"{EMAIL} has no second factor any more." in capsys.readouterr().out
    assert sign_in().status_code == 200
    assert main(["account", EMAIL, "--no-second-factor"]) == 2
    assert "There is no second factor." in capsys.readouterr().err


def test_a_former_key_of_the_server_still_reads_it_and_is_needed_until_one_has_signed_in(
    hall: str, settings: Settings
) -> None:
    before = signed_in("author")
    secret, codes = set_up(before)
    assert before.get("/api/sites").status_code == 200
    former, settings.SECRET_KEY = settings.SECRET_KEY, "another key of the server, as long as it should be 0123456789"
    assert refusal(sign_in(code_at(secret, 1))) == (422, "wrong_code")
    settings.VIPO_FORMER_KEYS = [former]
    assert before.get("/api/sites").status_code == 401, "what the former key signed is worth nothing"
    assert sign_in(codes[0]).status_code == 200
    assert sign_in(code_at(secret, 1)).status_code == 200
    settings.VIPO_FORMER_KEYS = []
    SecondFactor.objects.update(last_step=0)
    assert [sign_in(code).status_code for code in (codes[1], code_at(secret, 1))] == [422, 200]


def test_an_enrolment_key_is_read_by_a_former_key_and_needs_it_no_more_once_it_was_looked_at(
    hall: str, settings: Settings
) -> None:
    services.set_enrolment_key(site="hall", key="j" * 32)
    former, settings.SECRET_KEY = settings.SECRET_KEY, "another key of the server, as long as it should be 0123456789"
    with pytest.raises(NoEnrolmentKey):
        get_enrolment_key(site="hall")
    settings.VIPO_FORMER_KEYS = [former]
    assert get_enrolment_key(site="hall") == "j" * 32
    settings.VIPO_FORMER_KEYS = []
    assert get_enrolment_key(site="hall") == "j" * 32


def test_a_step_that_was_taken_takes_none_before_it(hall: str) -> None:
    author, now = find_person("author"), datetime.now(UTC)
    secret = second_factor.begin_factor(user=author).secret
    totp = pyotp.TOTP(secret)
    confirm_factor(user=author, code=totp.at(now), now=now)
    check_code(user=author, code=totp.at(now + timedelta(seconds=30)), now=now)
    with pytest.raises(WrongCode):
        check_code(user=author, code=totp.at(now), now=now)
    later = now + timedelta(minutes=10)
    with pytest.raises(WrongCode):
        check_code(user=author, code=totp.at(now + timedelta(minutes=8)), now=later)
    check_code(user=author, code=totp.at(later), now=later)


SET_UP = """
import sys
import django
django.setup()
from datetime import UTC, datetime
import pyotp
from registry.models import User
from registry.people.second_factor import begin_factor, confirm_factor
user, now = User.objects.get(email="author@vipo.example"), datetime.now(UTC)
secret = begin_factor(user=user).secret
confirm_factor(user=user, code=pyotp.TOTP(secret).at(now), now=now)
print(secret)
"""


def test_of_seven_who_sign_in_at_once_with_one_code_one_comes_in(tmp_path: Path) -> None:

    web = Web(tmp_path, **prepare(tmp_path, {}))
    made = run_forked(
        [sys.executable, "-c", SET_UP], env=environment(tmp_path, {}), capture_output=True, text=True, check=True
    )
    secret = made.stdout.strip()
    web.start()
    try:
        code = code_at(secret, 1)

        def try_it(_: int) -> int:
            with web.client(None) as client:
                body = {"email": EMAIL, "password": "a long password", "code": code}
                return int(post(client, body))

        with ThreadPoolExecutor(7) as pool:
            statuses = sorted(pool.map(try_it, range(7)))
    finally:
        web.kill()
    assert statuses == [200] + [422] * 6


def post(client: httpx.Client, body: dict[str, str]) -> int:
    return client.post("/sign-in", json=body).status_code
