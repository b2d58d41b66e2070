"""Somebody is invited, comes in, draws, is given another role while they look, and is removed: on the screens."""

from __future__ import annotations

import re
from typing import Any

import pytest
from playwright.sync_api import Browser, Page, expect

from registry.people.rights import DEEDS
from tests.e2e.conftest import SignIn, listen
from tests.e2e.screens import ask, chip, draw_task, make_program, saved, tell, violations
from tests.kit.demo import Demo

pytestmark = pytest.mark.browser
PAGE = "/sites/painting-factory/people"
TASK = "1, Pick-and-Drop, 1 \u00d7 box from Item Inventory to Painting Machine"


def make_link(page: Page) -> str:
    """Make an invitation as author by keyboard, and return its link."""
    page.get_by_role("banner").get_by_role("button", name="Invite people").press("Enter")
    form = page.get_by_role("dialog", name="Invite people")
    expect(form.get_by_role("radio", name="Author")).to_be_checked()
    assert violations(page) == []
    form.get_by_role("button", name="Make the link").press("Enter")
    shown = page.get_by_role("dialog", name="Invitation as Author")
    link = shown.get_by_label("Link", exact=True).input_value()
    assert violations(page) == []
    shown.get_by_role("button", name="I have it").press("Enter")
    expect(page.get_by_role("region", name="Invitations by link").get_by_role("row", name="Author")).to_contain_text(
        "0 of 1"
    )
    expect(shown).to_have_count(0)
    assert link.partition("#")[2] not in page.content()
    return link


def come_in(page: Page, link: str) -> None:
    """Make an account by a link."""
    page.goto(link)
    expect(page.get_by_role("heading", level=1, name="You are invited")).to_be_visible()
    expect(page.get_by_text("Ada Meyer invites you to Painting Factory.")).to_be_visible()
    assert violations(page) == []
    page.get_by_label("Your name").fill("Nora Lind")
    page.get_by_label("Email address").fill("nora.lind@fab.example")
    page.get_by_label("Password", exact=True).fill("four odd words here")
    page.keyboard.press("Enter")
    expect(page.get_by_role("heading", level=1, name="Programs")).to_be_visible()


def person_row(page: Page) -> Any:
    return page.get_by_role("region", name="Members").get_by_role("row", name="Nora Lind")


def test_somebody_is_invited_comes_in_draws_is_lowered_and_removed(
    sign_in: SignIn, demo: Demo, chromium: Browser, faults: list[str]
) -> None:
    admin = sign_in("admin", PAGE)
    context = chromium.new_context(viewport={"width": 1600, "height": 1000}, locale="en-GB")
    listen(context, faults)
    guest = context.new_page()
    try:
        come_in(guest, make_link(admin))
        make_program(guest, "By Nora")
        guest.keyboard.press("Escape")
        draw_task(guest)
        expect(chip(guest, TASK)).to_be_visible()
        saved(guest)
        admin.reload()
        expect(person_row(admin)).to_contain_text("Here now")
        expect(person_row(admin)).to_contain_text("Invited by Ada Meyer")
        record = admin.get_by_role("complementary", name="What was done")
        expect(record.get_by_text("Nora Lind joined by link as Author, invited by Ada Meyer")).to_be_visible()
        admin.get_by_label("Role of Nora Lind").select_option("Viewer")
        expect(record.get_by_text("Ada Meyer changed Nora Lind from Author to Viewer")).to_be_visible()
        expect(guest.get_by_text("An admin has changed your role here: Viewer.")).to_be_visible()
        tools = guest.get_by_role("toolbar", name="Tools").get_by_role("button")
        expect(tools).to_have_count(2)  # to select and to pan; those that draw are gone
        remove(admin)
        expect(guest).to_have_url(re.compile("/sign-in"))
        faults.clear()  # the guest's page asked for what is not theirs any more
    finally:
        context.close()
    program = next(each for each in ask(admin, "/api/sites/painting-factory/programs") if each["name"] == "By Nora")
    assert program["id"]


def remove(page: Page) -> None:
    """Remove the guest by keyboard, after a look at what that ends."""
    person_row(page).get_by_role("button", name="More for Nora Lind").press("Enter")
    page.get_by_role("menuitem", name="Remove…").press("Enter")
    dialog = page.get_by_role("dialog", name="Remove Nora Lind?")
    expect(dialog.get_by_text("all their sessions: this is their only site")).to_be_visible()
    assert violations(page) == []
    dialog.get_by_role("button", name="Remove").press("Enter")
    expect(person_row(page)).to_have_count(0)


def test_a_link_that_lets_nobody_in_says_why(sign_in: SignIn, demo: Demo, faults: list[str]) -> None:
    page = sign_in("admin", PAGE)
    made = tell(page, "/api/sites/painting-factory/invitations", {"role": "viewer"})
    page.reload()
    row = page.get_by_role("region", name="Invitations by link").get_by_role("row", name="Viewer")
    row.get_by_role("button", name=re.compile("^Revoke")).click()
    expect(row).to_contain_text("Revoked")
    guest = sign_in("nobody", made["link"].removeprefix(demo.url))
    expect(guest.get_by_role("heading", level=1, name="This invitation is over")).to_be_visible()
    expect(guest.get_by_text("This invitation was revoked. Ask for another one.")).to_be_visible()
    assert "Painting" not in guest.content()
    guest.goto(f"{demo.url}/invitation#not-one-at-all")
    guest.reload()
    expect(guest.get_by_role("heading", level=1, name="This is no invitation")).to_be_visible()
    assert violations(guest) == []
    faults.clear()  # 410 and 404 are what was tried


@pytest.mark.parametrize(
    ("role", "language", "dark", "width", "height"),
    [
        ("admin", "en", False, 1600, 1000),
        ("admin", "en", False, 1600, 560),  # so low that all that can scroll does
        ("admin", "de", True, 820, 1180),
        ("author", "de", True, 1600, 1000),
    ],
)
def test_the_page_passes_axe_and_fits(
    sign_in: SignIn, role: str, language: str, dark: bool, width: int, height: int
) -> None:
    page = sign_in(role, PAGE, width=width, height=height, dark=dark, language=language)
    words = {
        "en": ("People", "Members", "Who may do what", "Invitations by link", "What was done"),
        "de": ("Personen", "Mitglieder", "Wer was darf", "Einladungen per Link", "Was getan wurde"),
    }[language]
    title, members, rights, invitations, record = words
    expect(page.get_by_role("heading", level=1, name=title)).to_be_visible()
    expect(page.get_by_role("region", name=members).get_by_role("row").nth(1)).to_be_visible()
    expect(page.get_by_role("region", name=rights).get_by_role("row")).to_have_count(
        1 + sum(bool(deed.roles) for deed in DEEDS)
    )
    count = 1 if role == "admin" else 0
    expect(page.get_by_role("region", name=invitations)).to_have_count(count)
    expect(page.get_by_role("complementary", name=record)).to_have_count(count)
    assert violations(page) == []
    assert page.evaluate("document.documentElement.scrollWidth <= window.innerWidth")
