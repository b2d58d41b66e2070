"""Who comes in by a provider: linked people, invited ones, addresses that the settings let in; everybody else not."""

from __future__ import annotations

from datetime import timedelta
from typing import Any

import pyotp
import pytest
from django.test import Client
from django.utils import timezone
from pytest_django import Settings

from registry import services
from registry.models import AuditLine, SignOn, SignOnAttempt, User
from registry.people.wall_screens import list_wall_screens, make_wall_screen
from registry.sites.invitations import Wanted, make_invitation
from tests.kit.openid import OpenId, visit
from tests.kit.openid.journeys import AT, begin, come, finish, link, refusals, who_is, why
from tests.kit.sign_in import PASSWORD, find_person, post_json, signed_in
from tests.kit.sites import hear_news


def test_a_linked_person_comes_in_by_issuer_and_subject_and_goes_where_they_wanted(acme: OpenId) -> None:
    link("operator", "ada", acme)  # her address there is another one's here, and says nothing
    client = Client()
    answer = come(client, "ada", next="/sites/hall/programs?x=1")
    assert (answer.status_code, answer.json()["next"]) == (200, "/sites/hall/programs?x=1")
    assert who_is(client) == "operator@vipo.example"
    assert client.get("/api/sites/hall").json()["role"] == "operator"
    assert [row["here"] for row in client.get("/api/me/sessions").json()].count(True) == 1
    told = client.get("/api/me/sign-ons").json()
    assert (told["has_password"], [(row["title"], row["label"]) for row in told["sign_ons"]]) == (
        True,
        [("Acme", "author@vipo.example")],
    )


def test_the_buttons_are_told_and_no_secret(acme: OpenId) -> None:
    told = Client().get("/api/sign-in/providers")
    assert told.json() == [{"name": "acme", "title": "Acme"}]
    assert post_json(Client(), "/api/sign-in/providers/other").status_code == 404


def test_a_session_of_a_provider_ends_as_those_of_passwords_do(acme: OpenId) -> None:
    link("viewer", "ada", acme)
    client, other = Client(), Client()
    come(client, "ada")
    come(other, "ada")
    person = find_person("viewer")
    assert signed_in("admin").delete(f"/api/sites/hall/members/{person.pk}").status_code == 200
    assert client.get("/api/sites").status_code == 401, "it was their only site"
    come(client, "ada")
    assert client.get("/api/sites").json() == []
    assert post_json(client, "/api/sign-out").json()["provider_sign_out"] == ""
    assert client.get("/api/sites").status_code == 401


@pytest.mark.parametrize("name", ["new", "ada", "mallory", "vague", "bare"])
def test_strangers_of_the_provider_are_strangers_here(acme: OpenId, name: str) -> None:
    people = User.objects.count()
    client = Client()
    expected = (403, "address" if name == "ada" else "nobody")  # only who owns an address is told of an account
    assert why(come(client, name)) == expected
    assert (who_is(client), User.objects.count(), SignOn.objects.count()) == (None, people, 0)
    assert refusals() == [("", expected[1])]
    assert AuditLine.objects.get(code="sign_on_refused").site_id is None


def test_a_verified_address_links_where_the_settings_allow_it_and_voids_the_password(
    acme: OpenId, settings: Settings
) -> None:
    settings.VIPO_SIGN_ON = [acme.setting(links_by_email=True)]
    before = signed_in("author")
    assert why(come(Client(), "mallory")) == (403, "nobody"), "an address that is not verified links nothing"
    client = Client()
    assert come(client, "ada").status_code == 200
    assert who_is(client) == "author@vipo.example"
    assert before.get("/api/sites").status_code == 401
    again = post_json(Client(), "/api/sign-in", {"email": "author@vipo.example", "password": PASSWORD})
    assert again.status_code == 401
    lines = AuditLine.objects.filter(code="sign_on_linked")
    assert [(line.site.slug if line.site else "", line.facts["provider"]) for line in lines] == [("hall", "Acme")]


def test_whoever_made_an_account_beforehand_stays_in_it_by_no_token_and_no_other_provider(
    acme: OpenId, settings: Settings, django_capture_on_commit_callbacks: Any
) -> None:
    settings.VIPO_SIGN_ON = [acme.setting(links_by_email=True)]
    services.create_site(name="Shed", slug="shed")
    services.set_member(site="shed", email="author@vipo.example", role="admin")
    author, now = find_person("author"), timezone.now()
    made = {"user": author, "days": 30, "now": now}
    _, asks = services.create_token(**made, site="hall", name="Asks", scopes=["run"])
    _, hears = services.create_token(**made, site="shed", name="Hears", scopes=["broker"])
    other = {"user": find_person("viewer"), "days": 30, "now": now}
    _, stays = services.create_token(**other, site="hall", name="Stays", scopes=["broker"])
    make_wall_screen(site="shed", by=author, name="East wall", days=30, now=now)
    make_wall_screen(site="shed", by=find_person("admin"), name="West wall", days=30, now=now)
    elsewhere = {"provider": "gone", "issuer": "https://gone.example", "subject": "somebody", "linked_at": now}
    SignOn.objects.create(user=author, **elsewhere)
    SignOn.objects.create(user=find_person("viewer"), **{**elsewhere, "subject": "viewer"})
    with hear_news() as heard, django_capture_on_commit_callbacks(execute=True):
        assert come(Client(), "ada").status_code == 200
    answers = [Client(headers={"Authorization": f"Bearer {token}"}).get("/api/sites") for token in (asks, hears, stays)]
    assert [answer.status_code for answer in answers] == [401, 401, 200]
    assert len(services.list_broker_hashes()) == 1
    assert [wall.name for wall in list_wall_screens(site="shed")] == ["West wall"]
    assert AuditLine.objects.filter(site__slug="shed", code="wall_screen_revoked").count() == 1
    assert {site for site, news in heard if news == {"type": "members"}} >= {"hall", "shed"}
    links = SignOn.objects.order_by("pk").values_list("user__email", "issuer")
    assert list(links) == [("viewer@vipo.example", "https://gone.example"), ("author@vipo.example", acme.issuer)]
    for site, token in (("hall", "Asks"), ("shed", "Hears")):
        lines = AuditLine.objects.filter(site__slug=site, actor="Author Person").order_by("pk")
        assert [(line.code, line.facts.get("name", line.facts.get("provider"))) for line in lines][-3:] == [
            ("sign_on_unlinked", "gone"),
            ("token_revoked", token),
            ("sign_on_linked", "Acme"),
        ]


def test_whoever_made_an_account_beforehand_lets_nobody_in_by_an_invitation(acme: OpenId, settings: Settings) -> None:
    settings.VIPO_SIGN_ON = [acme.setting(links_by_email=True)]
    services.create_site(name="Shed", slug="shed")
    services.set_member(site="shed", email="author@vipo.example", role="admin")
    wanted = Wanted(role="admin", days=30, uses=2)
    now = timezone.now()
    _, code = make_invitation(site="shed", by=find_person("author"), wanted=wanted, now=now)
    _, stays = make_invitation(site="hall", by=find_person("admin"), wanted=wanted, now=now)
    assert come(Client(), "ada").status_code == 200
    viewer = signed_in("viewer")
    over = post_json(viewer, "/api/invitations/accept", {"code": code})
    assert (over.status_code, over.json()["args"]["why"]) == (410, "revoked")
    look = post_json(Client(), "/api/invitations/look", {"code": stays})
    assert look.status_code == 200
    line = AuditLine.objects.get(site__slug="shed", code="invitation_revoked")
    assert (line.actor, line.facts) == ("Author Person", {"role": "admin", "used": 0})


def test_a_link_that_fails_ends_nothing_of_the_account(acme: OpenId, settings: Settings) -> None:
    link("author", "new", acme)
    settings.VIPO_SIGN_ON = [acme.setting(links_by_email=True)]
    _, token = services.create_token(
        user=find_person("author"), site="hall", name="Asks", scopes=["run"], days=30, now=timezone.now()
    )
    assert why(come(Client(), "ada")) == (409, "other"), "a person has one account of each issuer"
    assert Client(headers={"Authorization": f"Bearer {token}"}).get("/api/sites").status_code == 200
    assert find_person("author").has_usable_password()
    assert SignOn.objects.count() == 1


def test_an_address_of_another_domain_links_nothing(acme: OpenId, settings: Settings) -> None:
    settings.VIPO_SIGN_ON = [acme.setting(links_by_email=True, domains=["acme.example"])]
    assert why(come(Client(), "ada")) == (403, "address")


def test_an_account_is_made_for_a_verified_address_of_a_domain_that_may_come(acme: OpenId, settings: Settings) -> None:
    settings.VIPO_SIGN_ON = [acme.setting(domains=["vipo.example"])]
    assert why(come(Client(), "vague")) == (403, "unverified")
    client = Client()
    assert come(client, "new").status_code == 200
    assert client.get("/api/me").json()["user"]["name"] == "Nova New"
    assert client.get("/api/sites").json() == []
    assert client.get("/api/me/sign-ons").json()["has_password"] is False
    only = SignOn.objects.get()
    assert client.delete(f"/api/me/sign-ons/{only.pk}").json()["code"] == "only_way_in"
    assert [line.code for line in AuditLine.objects.filter(site=None).order_by("pk")] == [
        "sign_on_refused",
        "sign_on_account_made",
        "sign_on_linked",
    ]


def test_who_was_invited_comes_in_once_as_the_link_says(acme: OpenId) -> None:
    made = post_json(signed_in("admin"), "/api/sites/hall/invitations", {"role": "operator"}).json()
    code = made["link"].partition("#")[2]
    client = Client()
    answer = come(client, "new", invitation=code)
    assert (answer.status_code, answer.json()["next"]) == (200, "/sites/hall/programs")
    assert client.get("/api/sites/hall").json()["role"] == "operator"
    late = post_json(Client(), AT, {"invitation": code})
    assert (late.status_code, late.json()["code"]) == (410, "link_over")


def test_an_invitation_that_ends_meanwhile_makes_no_account(acme: OpenId) -> None:
    made = post_json(signed_in("admin"), "/api/sites/hall/invitations", {"role": "operator"}).json()
    client = Client()
    given = visit(begin(client, invitation=made["link"].partition("#")[2]), "new")
    assert signed_in("admin").delete(f"/api/sites/hall/invitations/{made['id']}").status_code == 204
    assert finish(client, given).json()["code"] == "link_over"
    assert not User.objects.filter(email="new@vipo.example").exists()


def test_linking_asks_for_the_password_and_for_the_same_person_at_its_end(acme: OpenId) -> None:
    client = signed_in("author")
    wrong = post_json(client, "/api/me/sign-ons", {"provider": "acme", "password": "not this one"})
    assert (wrong.status_code, wrong.json()["code"]) == (422, "wrong_old_password")
    address = post_json(client, "/api/me/sign-ons", {"provider": "acme", "password": PASSWORD}).json()["address"]
    given = visit(address, "ada")
    client.force_login(find_person("viewer"))
    assert why(finish(client, given)) == (403, "signed_out")
    assert SignOn.objects.count() == 0


def test_an_account_of_the_provider_is_one_persons_and_a_person_has_one(acme: OpenId) -> None:
    link("author", "ada", acme)
    for name, subject, expected in (("viewer", "ada", "taken"), ("author", "new", "other")):
        client = signed_in(name)
        address = post_json(client, "/api/me/sign-ons", {"provider": "acme", "password": PASSWORD}).json()["address"]
        assert why(finish(client, visit(address, subject))) == (409, expected)
    assert SignOn.objects.count() == 1


def test_a_link_that_is_taken_away_ends_all_sessions_and_lets_nobody_in(acme: OpenId) -> None:
    client = link("author", "ada", acme)
    elsewhere = Client()
    come(elsewhere, "ada")
    row = SignOn.objects.get()
    assert signed_in("viewer").delete(f"/api/me/sign-ons/{row.pk}").status_code == 404
    assert client.delete(f"/api/me/sign-ons/{row.pk}").status_code == 204
    assert (client.get("/api/sites").status_code, elsewhere.get("/api/sites").status_code) == (401, 401)
    assert why(come(Client(), "ada")) == (403, "address")
    assert AuditLine.objects.filter(code="sign_on_unlinked", site__slug="hall").count() == 1


def test_a_closed_account_stays_closed(acme: OpenId) -> None:
    link("author", "ada", acme)
    User.objects.filter(email="author@vipo.example").update(is_active=False)
    assert why(come(Client(), "ada")) == (403, "closed")
    assert refusals() == [("Author Person", "closed")]


def give_factor(client: Client) -> pyotp.TOTP:
    secret = post_json(client, "/api/me/second-factor", {"password": PASSWORD}).json()["secret"]
    app = pyotp.TOTP(secret)
    proof = {"password": PASSWORD, "code": app.now()}
    assert post_json(client, "/api/me/second-factor/confirm", proof).status_code == 200
    return app


def test_the_own_second_factor_is_asked_for_and_a_code_is_taken_once(acme: OpenId) -> None:
    app = give_factor(link("author", "ada", acme))
    client = Client()
    given = visit(begin(client), "ada", amr="pwd mfa")
    needed = finish(client, given)
    assert (needed.status_code, needed.json()["code"], who_is(client)) == (401, "second_factor_needed", None)
    assert finish(client, given, factor="abc").json()["code"] == "wrong_code"
    code = app.at(timezone.now() + timedelta(seconds=30))
    assert why(finish(Client(), given, factor=code)) == (403, "browser"), "no other browser goes on with it"
    assert finish(client, given, factor=code).status_code == 200
    assert who_is(client) == "author@vipo.example"
    assert why(finish(client, given, factor=code)) == (403, "replayed")
    assert SignOnAttempt.objects.exclude(identity=None).count() == 0


@pytest.mark.parametrize(("amr", "acr", "stands"), [("pwd mfa", "", True), ("", "two", True), ("pwd", "one", False)])
def test_the_providers_second_factor_stands_for_it_by_setting_alone(
    acme: OpenId, settings: Settings, amr: str, acr: str, stands: bool
) -> None:
    give_factor(link("author", "ada", acme))
    settings.VIPO_SIGN_ON = [acme.setting(amr=["mfa"], acr=["two"])]
    answer = come(Client(), "ada", amr=amr, acr=acr)
    assert answer.status_code == (200 if stands else 401), answer.content


def test_an_address_never_links_past_a_second_factor(acme: OpenId, settings: Settings) -> None:
    give_factor(signed_in("author"))
    settings.VIPO_SIGN_ON = [acme.setting(links_by_email=True, amr=["mfa"])]
    assert come(Client(), "ada", amr="mfa").status_code == 401
    assert SignOn.objects.count() == 0


def test_wrong_codes_are_held_up_as_beside_passwords(acme: OpenId) -> None:
    give_factor(link("author", "ada", acme))
    client = Client()
    given = visit(begin(client), "ada")
    codes = [finish(client, given, factor=f"{number:06}") for number in range(9)]
    assert [answer.status_code for answer in codes] == [422] * 8 + [429]


def test_who_has_no_password_sets_a_second_factor_up_right_after_coming_in(acme: OpenId, settings: Settings) -> None:
    settings.VIPO_SIGN_ON = [acme.setting(domains=["vipo.example"])]
    client = Client()
    come(client, "new")
    begun = post_json(client, "/api/me/second-factor", {"password": ""})
    assert begun.status_code == 201
    session = client.session
    session["sign_on"] = {**session["sign_on"], "at": (timezone.now() - timedelta(minutes=11)).isoformat()}
    session.save()
    late = post_json(client, "/api/me/second-factor", {"password": ""})
    assert (late.status_code, late.json()["code"]) == (403, "sign_on_again")


def test_signing_out_goes_on_at_the_provider_where_the_settings_say_so(acme: OpenId, settings: Settings) -> None:
    link("author", "ada", acme)
    settings.VIPO_SIGN_ON = [acme.setting(signs_out=True)]
    client = Client()
    come(client, "ada")
    address = post_json(client, "/api/sign-out").json()["provider_sign_out"]
    assert address.startswith(f"{acme.issuer}/session/end?client_id=vipo-tests&id_token_hint=ey")
    assert address.endswith("post_logout_redirect_uri=http%3A%2F%2Ftestserver%2Fsign-in")
    assert who_is(client) is None
    assert post_json(signed_in("author"), "/api/sign-out").json()["provider_sign_out"] == "", "came by a password"
