"""The page of one's own account: another password, and signing out everywhere, by keyboard and in both languages."""

from __future__ import annotations

import os
import sys
from itertools import count

import pyotp
import pytest
from playwright.sync_api import Browser, BrowserContext, Page, expect

from tests.e2e.conftest import PATIENCE_MS, SignIn, listen
from tests.e2e.screens import shoot, themed, violations
from tests.kit.demo import Demo
from tests.kit.files import ROOT
from tests.kit.processes.forked import run_forked

pytestmark = pytest.mark.browser
NUMBERS = count(1)
SECOND = "four words of mine"
SIZES = [(1600, 1000, "light"), (1600, 1000, "dark"), (820, 1180, "light"), (820, 1180, "dark")]


@pytest.fixture
def email() -> str:
    return f"own.account{next(NUMBERS)}@vipo.example"


@pytest.fixture
def password(demo: Demo, email: str) -> str:
    """Somebody with an account of their own, whose password is told."""
    command = [sys.executable, "-m", "vipo_site.cli.main", "account", email, "--site", "painting-factory"]
    environment = {**os.environ, "VIPO_STATE_DIR": str(demo.state)}
    environment.pop("DJANGO_SETTINGS_MODULE", None)
    done = run_forked(command, cwd=ROOT, env=environment, capture_output=True, text=True)
    assert done.returncode == 0, done.stderr
    return done.stdout.splitlines()[1].removeprefix("The password, shown this once: ")


def come_in(context: BrowserContext, demo: Demo, email: str, password: str) -> Page:
    page = context.new_page()
    page.set_default_timeout(PATIENCE_MS)
    page.goto(f"{demo.url}/sign-in?next=/account")
    page.get_by_label("Email address").fill(email)
    page.get_by_label("Password", exact=True).fill(password)
    page.keyboard.press("Enter")
    expect(page.get_by_role("heading", name="Your account")).to_be_visible()
    return page


def test_an_own_password_is_changed_and_all_sessions_are_ended(
    demo: Demo, chromium: Browser, email: str, password: str, faults: list[str]
) -> None:
    here, there = (chromium.new_context(locale="en-GB") for _ in range(2))
    listen(here, faults)
    page, other = come_in(here, demo, email, password), come_in(there, demo, email, password)
    page.get_by_label("Password that you have now").fill(password)
    page.keyboard.press("Tab")
    page.get_by_label("New password").fill("own.account")
    page.keyboard.press("Enter")
    expect(page.get_by_text("too much like your name or e-mail address")).to_be_visible()
    faults.clear()  # the browser itself tells of the refusal
    page.get_by_label("New password").fill(SECOND)
    page.keyboard.press("Enter")
    expect(page.get_by_text("Your password is changed. You are signed out everywhere else.")).to_be_visible()
    expect(other.get_by_role("button", name="Sign in", exact=True)).to_be_visible()
    page.reload()
    third = chromium.new_context(locale="en-GB")
    elsewhere = come_in(third, demo, email, SECOND)
    page.get_by_role("button", name="Sign out everywhere").focus()
    page.keyboard.press("Enter")
    for each in (page, elsewhere):
        expect(each.get_by_role("button", name="Sign in", exact=True)).to_be_visible()
    for context in (here, there, third):
        context.close()


def test_one_session_is_ended_from_the_list_by_keyboard(
    demo: Demo, chromium: Browser, email: str, password: str, faults: list[str]
) -> None:
    here, there = (chromium.new_context(locale="en-GB") for _ in range(2))
    listen(here, faults)
    page, other = come_in(here, demo, email, password), come_in(there, demo, email, password)
    page.reload()
    listed = page.get_by_role("list", name="Where you are signed in").get_by_role("listitem")
    expect(listed).to_have_count(2)
    expect(listed.filter(has_text="This one")).to_have_count(1)
    assert violations(page) == []
    page.get_by_role("button", name="Sign out: ").focus()
    page.keyboard.press("Enter")
    expect(listed).to_have_count(1)
    expect(page.get_by_role("heading", name="Where you are signed in")).to_be_focused()
    expect(other.get_by_role("button", name="Sign in", exact=True)).to_be_visible()
    for context in (here, there):
        context.close()


def test_a_second_factor_is_set_up_by_keyboard_and_asked_for_when_signing_in(
    demo: Demo, chromium: Browser, email: str, password: str, faults: list[str]
) -> None:
    here = chromium.new_context(locale="en-GB")
    listen(here, faults)
    page = come_in(here, demo, email, password)
    page.get_by_role("button", name="Set up a second factor").press("Enter")
    dialog = page.get_by_role("dialog")
    expect(dialog.get_by_label("Your password")).to_be_focused()
    page.keyboard.type(password)
    page.keyboard.press("Enter")
    expect(dialog.get_by_role("img", name="QR code for the authenticator app")).to_be_visible()
    assert violations(page) == []
    shoot(page, "factor-picture")
    app = pyotp.TOTP(dialog.get_by_label("Secret").input_value())
    expect(dialog.get_by_label("Code", exact=True)).to_be_focused()
    page.keyboard.type(app.now())
    page.keyboard.press("Enter")
    codes = dialog.get_by_role("list", name="Your recovery codes").get_by_role("listitem")
    expect(codes).to_have_count(10)
    stands_in = codes.first.inner_text()
    shoot(page, "factor-codes")
    dialog.get_by_role("button", name="I have them").press("Enter")
    expect(page.get_by_role("region", name="Second factor")).to_contain_text("10 recovery codes are left.")
    there = chromium.new_context(locale="en-GB")
    other = there.new_page()
    other.set_default_timeout(PATIENCE_MS)
    other.goto(f"{demo.url}/sign-in?next=/account")
    other.get_by_label("Email address").fill(email)
    other.get_by_label("Password", exact=True).fill(password)
    other.keyboard.press("Enter")
    expect(other.get_by_label("Code of your authenticator app")).to_be_focused()
    assert violations(other) == []
    shoot(other, "factor-sign-in")
    other.keyboard.type(stands_in)
    other.keyboard.press("Enter")
    expect(other.get_by_role("region", name="Second factor")).to_contain_text("9 recovery codes are left.")
    for context in (here, there):
        context.close()


def test_the_page_is_sound_in_both_themes_sizes_and_languages(sign_in: SignIn) -> None:
    for width, height, scheme in SIZES:
        for language, title in (("en", "Your account"), ("de", "Ihr Konto")):
            page = sign_in("author", "/account", width=width, height=height, dark=scheme == "dark", language=language)
            expect(page.get_by_role("heading", name=title)).to_be_visible()
            assert violations(page) == []
            shoot(page, f"account-{width}-{scheme}-{language}")
            assert page.evaluate("document.documentElement.scrollWidth - innerWidth") <= 0
            assert "account." not in page.locator("main").inner_text()


def test_the_menu_of_the_account_leads_there(sign_in: SignIn) -> None:
    page = sign_in("author", "/")
    page.get_by_role("button", name="Account").press("Enter")
    page.get_by_role("menuitem", name="Password and sessions").press("Enter")
    expect(page.get_by_role("heading", name="Your account")).to_be_visible()


def test_a_name_is_changed_by_keyboard_and_is_the_one_on_the_next_page(
    demo: Demo, chromium: Browser, email: str, password: str, faults: list[str]
) -> None:
    context = chromium.new_context(locale="en-GB", viewport={"width": 820, "height": 1180})
    listen(context, faults)
    page = come_in(context, demo, email, password)
    field = page.get_by_label("Your name")
    save = page.get_by_role("button", name="Change name")
    expect(save).to_be_disabled()
    field.fill("Nova Lind")
    field.press("Enter")
    expect(page.get_by_text("That is your name now.")).to_be_visible()
    expect(page.get_by_role("main").get_by_text("Nova Lind", exact=True)).to_be_visible()
    expect(save).to_be_disabled()
    for scheme in ("light", "dark"):
        themed(page, scheme)
        assert violations(page) == []
    if folder := os.environ.get("VIPO_PICTURES"):
        page.screenshot(path=f"{folder}/account-name.png")
    page.reload()
    expect(field).to_have_value("Nova Lind")
    context.close()
