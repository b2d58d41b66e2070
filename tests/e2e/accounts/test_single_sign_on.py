"""Single sign-on in a browser, by a provider that nobody here wrote: linked, used, refused, taken away."""

from __future__ import annotations

import re
from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any

import pyotp
import pytest
from playwright.sync_api import Browser, Page, expect

from tests.e2e.conftest import PATIENCE_MS, listen
from tests.e2e.screens import shoot, themed, violations
from tests.kit.openid import OpenId, run_openid
from tests.kit.servers import free_port
from tests.kit.web import Web, prepare

pytestmark = pytest.mark.browser
PASSWORD = "a long password"
SIZES = [(1600, 1000), (820, 1180), (390, 844)]


@dataclass(frozen=True)
class Place:
    """A running VIPO, its provider, and what browsers of members keep."""

    url: str
    openid: OpenId
    sessions: dict[str, str]


MAIL = {"VIPO_MAIL_HOST": "localhost", "VIPO_MAIL_TLS": "none", "VIPO_MAIL_FROM": "vipo@hall.example"}


@pytest.fixture(scope="module")
def place(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Place]:
    folder, port = tmp_path_factory.mktemp("web"), free_port()
    url = f"http://127.0.0.1:{port}"
    with run_openid(tmp_path_factory.mktemp("openid"), [f"{url}/sign-on/acme"]) as openid:
        told = {"backchannel_logout_uri": f"{url}/api/sign-in/providers/acme/logout"}
        openid.restart(client={**told, "backchannel_logout_session_required": True})
        extra = openid.environment(SIGN_OUT="1") | MAIL
        web = Web(folder, prepare(folder, extra)["sessions"], "", extra, port)
        web.start()
        try:
            yield Place(url, openid, web.sessions)
        finally:
            web.kill()


def open_page(chromium: Browser, faults: list[str], **more: Any) -> Page:
    context = chromium.new_context(locale="en-GB", **more)
    listen(context, faults)
    page = context.new_page()
    page.set_default_timeout(PATIENCE_MS)
    return page


def sign_in_there(page: Page, name: str) -> None:
    """Sign in at the provider, by its own page."""
    page.get_by_label("Name there").fill(name)
    page.get_by_role("button", name="Continue").click()


def test_an_account_is_linked_and_then_signs_in_by_keyboard_and_out(
    place: Place, chromium: Browser, faults: list[str]
) -> None:
    page = open_page(chromium, faults)
    page.goto(f"{place.url}/sign-in?next=/account")
    page.get_by_label("Email address").fill("author@vipo.example")
    page.get_by_label("Password", exact=True).fill(PASSWORD)
    page.keyboard.press("Enter")
    page.get_by_role("button", name="Link Acme").press("Enter")
    expect(page.get_by_label("Your password")).to_be_focused()
    page.keyboard.type(PASSWORD)
    page.keyboard.press("Enter")
    sign_in_there(page, "bare")
    ways = page.get_by_role("region", name="How you sign in")
    expect(ways.get_by_role("listitem")).to_contain_text("Acme")
    assert violations(page) == []
    shoot(page, "sso-account")
    page.context.close()

    page = open_page(chromium, faults)
    page.goto(f"{place.url}/sites/hall/runs")
    page.get_by_role("button", name="Sign in with Acme").press("Enter")
    sign_in_there(page, "bare")
    page.wait_for_url(f"{place.url}/sites/hall/runs")
    expect(page.get_by_role("heading", level=1, name="Runs")).to_be_visible()
    page.get_by_role("button", name="Account").press("Enter")
    page.get_by_role("menuitem", name="Sign out").press("Enter")
    page.wait_for_url(f"{place.openid.issuer}/session/end?**")
    page.get_by_role("button", name="Yes, sign me out").click()
    expect(page.get_by_role("button", name="Sign in with Acme")).to_be_visible()
    page.goto(f"{place.url}/account")
    expect(page.get_by_role("button", name="Sign in with Acme")).to_be_visible()
    assert [fault for fault in faults if "401" not in fault] == []
    faults.clear()  # what the page was asking for at the moment of signing out was refused
    page.context.close()


def test_who_signs_out_at_the_provider_is_signed_out_here_in_that_browser_alone(
    place: Place, chromium: Browser, faults: list[str]
) -> None:
    link("viewer", "vague", place, chromium, faults)
    page, elsewhere = open_page(chromium, faults), open_page(chromium, faults)
    for each in (page, elsewhere):
        each.goto(f"{place.url}/sites/hall/runs")
        each.get_by_role("button", name="Sign in with Acme").click()
        sign_in_there(each, "vague")
        expect(each.get_by_role("heading", level=1, name="Runs")).to_be_visible()
    there = page.context.new_page()
    there.goto(f"{place.openid.issuer}/session/end")
    there.get_by_role("button", name="Yes, sign me out").click()
    expect(page.get_by_role("button", name="Sign in with Acme")).to_be_visible()
    elsewhere.reload()
    expect(elsewhere.get_by_role("heading", level=1, name="Runs")).to_be_visible()
    assert [fault for fault in faults if "401" not in fault and place.url in fault] == []
    faults.clear()  # what the page asked before it knew was refused; the provider's own page has faults of its own
    page.context.close()
    elsewhere.context.close()


def test_who_is_refused_is_told_why_and_what_was_given_along_is_not_in_the_address(
    place: Place, chromium: Browser, faults: list[str]
) -> None:
    for language, width, dark in (("en-GB", 1600, False), ("de-DE", 390, True)):
        page = open_page(
            chromium,
            faults,
            viewport={"width": width, "height": 844},
            color_scheme="dark" if dark else "light",
        )
        page.add_init_script(f"localStorage.setItem('vipo.language', '{language[:2]}')")
        page.goto(f"{place.url}/sign-in")
        page.get_by_role("button", name="Acme").click()
        sign_in_there(page, "new")
        alert = page.get_by_role("alert")
        expect(alert).to_contain_text("Nobody here signs in" if language[:2] == "en" else "meldet sich hier niemand an")
        assert page.url == f"{place.url}/sign-on/acme"
        assert violations(page) == []
        assert page.evaluate("document.documentElement.scrollWidth - innerWidth") <= 0
        shoot(page, f"sso-refused-{language}")
        faults.clear()  # the browser itself tells of the refusal
        page.context.close()


def come_in(page: Page, place: Place, person: str) -> None:
    cookie = {"name": "sessionid", "value": place.sessions[person], "url": place.url}
    page.context.add_cookies([cookie])  # type: ignore[list-item]  # a cookie has no more than that


def link(person: str, subject: str, place: Place, chromium: Browser, faults: list[str]) -> None:
    """Link a person with an account of the provider, as their own page does."""
    page = open_page(chromium, faults)
    come_in(page, place, person)
    headers = {"X-CSRFToken": page.request.get(f"{place.url}/api/me").json()["csrf"]}
    told = {"provider": "acme", "password": PASSWORD}
    begun = page.request.post(f"{place.url}/api/me/sign-ons", data=told, headers=headers)
    page.goto(begun.json()["address"])
    sign_in_there(page, subject)
    page.wait_for_url(f"{place.url}/account")
    page.context.close()


def set_up_factor(page: Page, place: Place) -> None:
    """Give who is signed in a second factor, as their own page does."""
    headers = {"X-CSRFToken": page.request.get(f"{place.url}/api/me").json()["csrf"]}
    path = f"{place.url}/api/me/second-factor"
    begun = page.request.post(path, data={"password": PASSWORD}, headers=headers).json()
    proof = {"password": PASSWORD, "code": pyotp.TOTP(begun["secret"]).now()}
    assert page.request.post(f"{path}/confirm", data=proof, headers=headers).ok


def test_an_invitation_is_accepted_by_a_provider_and_the_people_page_says_so(
    place: Place, chromium: Browser, faults: list[str]
) -> None:
    admin = open_page(chromium, faults)
    come_in(admin, place, "admin")
    admin.goto(f"{place.url}/sites/hall/people")
    token = {"X-CSRFToken": admin.request.get(f"{place.url}/api/me").json()["csrf"]}
    made = admin.request.post(f"{place.url}/api/sites/hall/invitations", data={"role": "viewer"}, headers=token)
    page = open_page(chromium, faults)
    page.goto(made.json()["link"])
    page.get_by_role("button", name="Come in with Acme").click()
    sign_in_there(page, "new")
    page.wait_for_url(f"{place.url}/sites/hall/programs")
    page.goto(f"{place.url}/account")
    expect(page.get_by_text("You have no password here.", exact=False)).to_be_visible()
    expect(page.get_by_label("New password")).to_have_count(0)
    assert violations(page) == []
    shoot(page, "sso-no-password")
    page.context.close()
    admin.reload()
    row = admin.get_by_role("row", name=re.compile("^Nova New"))
    expect(row).to_contain_text("signs in by Acme")
    shoot(admin, "sso-people")
    admin.context.close()


@pytest.mark.parametrize("language", ["en", "de"])
def test_the_pages_are_sound_in_both_themes_and_three_sizes(
    place: Place, chromium: Browser, faults: list[str], language: str
) -> None:
    title = {"en": ("Welcome to VIPO", "Your account"), "de": ("Willkommen bei VIPO", "Ihr Konto")}[language]
    page = open_page(chromium, faults)
    page.add_init_script(f"localStorage.setItem('vipo.language', '{language}')")
    for path, heading in zip(("/sign-in", "/account"), title, strict=True):
        if path == "/account":
            come_in(page, place, "second")
        page.goto(place.url + path)
        for width, height in SIZES:
            page.set_viewport_size({"width": width, "height": height})
            for scheme in ("light", "dark"):
                themed(page, scheme)
                expect(page.get_by_role("heading", name=heading)).to_be_visible()
                assert violations(page) == [], (path, width, scheme)
                assert page.evaluate("document.documentElement.scrollWidth - innerWidth") <= 0
                shoot(page, f"sso{path.replace('/', '-')}-{width}-{scheme}-{language}")
    page.context.close()


def test_a_second_factor_is_demanded_and_who_lacks_it_is_led_to_set_it_up(
    place: Place, chromium: Browser, faults: list[str]
) -> None:
    admin, operator = open_page(chromium, faults), open_page(chromium, faults)
    come_in(admin, place, "admin")
    come_in(operator, place, "operator")
    admin.goto(f"{place.url}/sites/hall/people")
    set_up_factor(admin, place)
    admin.reload()
    rule = admin.get_by_role("region", name="Second factor")
    rule.get_by_label("Demanded of").select_option("operator")
    expect(admin.get_by_text("That holds from now on.")).to_be_visible()
    assert violations(admin) == []
    rule.scroll_into_view_if_needed()
    shoot(admin, "factor-rule")
    operator.goto(f"{place.url}/sites/hall/runs")
    strip = operator.get_by_text("This site demands a second factor of the role Operator.", exact=False)
    expect(strip).to_be_visible()
    assert violations(operator) == []
    for width, height in SIZES:
        operator.set_viewport_size({"width": width, "height": height})
        assert operator.evaluate("document.documentElement.scrollWidth - innerWidth") <= 0
        shoot(operator, f"factor-strip-{width}")
    operator.get_by_role("link", name="Set up a second factor").press("Enter")
    expect(operator.get_by_role("button", name="Set up a second factor")).to_be_visible()
    set_up_factor(operator, place)
    operator.goto(f"{place.url}/sites/hall/runs")
    expect(operator.get_by_role("heading", level=1, name="Runs")).to_be_visible()
    expect(strip).to_have_count(0)
    rule.get_by_label("Demanded of").select_option("")
    expect(rule.get_by_label("Demanded of")).to_have_value("")
    for page in (admin, operator):
        page.context.close()
    faults[:] = [line for line in faults if "401" not in line]  # what was under way when a session was made anew


def test_comments_by_mail_are_switched_off_by_keyboard_and_stay_so(
    place: Place, chromium: Browser, faults: list[str]
) -> None:
    page = open_page(chromium, faults)
    come_in(page, place, "author")
    page.goto(f"{place.url}/account")
    switch = page.get_by_role("switch", name="E-mail to me")
    expect(switch).to_be_checked()
    with page.expect_response(re.compile("/api/me/mail$")):
        switch.press("Space")
    expect(switch).not_to_be_checked()
    for scheme in ("light", "dark"):
        themed(page, scheme)
        assert violations(page) == []
    shoot(page, "account-mail")
    page.reload()
    expect(switch).not_to_be_checked()
    with page.expect_response(re.compile("/api/me/mail$")):
        switch.press("Space")
    expect(switch).to_be_checked()
    page.context.close()
