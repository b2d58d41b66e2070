"""The page Storage: how long a site keeps what has ended, chosen by keyboard, and looked over."""

from __future__ import annotations

import pytest
from playwright.sync_api import Locator, Page, expect

from tests.e2e.conftest import SignIn
from tests.e2e.screens import violations

pytestmark = pytest.mark.browser
STORAGE = "/sites/painting-factory/retention"


def days(page: Page, kind: str) -> Locator:
    return page.get_by_label(f"{kind}: Days in the database")


def test_an_admin_chooses_times_of_keeping_by_keyboard_and_goes_back_to_the_servers(sign_in: SignIn) -> None:
    page = sign_in("admin", STORAGE)
    expect(days(page, "Runs")).to_have_value("")
    expect(days(page, "Runs")).to_have_accessible_description("Server's setting: 365 days")
    days(page, "Runs").focus()
    page.keyboard.type("90")
    page.keyboard.press("Tab")
    expect(days(page, "Rehearsals")).to_be_focused()
    page.keyboard.type("soon")
    expect(page.get_by_text("Enter a whole number from 0 to 36,500, or nothing.")).to_be_visible()
    expect(page.get_by_role("button", name="Save")).to_be_disabled()
    assert violations(page) == []
    page.keyboard.press("Control+a")
    page.keyboard.type("0")
    page.keyboard.press("Enter")
    expect(page.get_by_text("The retention times are saved.")).to_be_visible()
    page.reload()
    expect(days(page, "Runs")).to_have_value("90")
    expect(days(page, "Rehearsals")).to_have_value("0")
    for kind in ("Runs", "Rehearsals"):
        days(page, kind).focus()
        page.keyboard.press("Control+a")
        page.keyboard.press("Delete")
    page.keyboard.press("Enter")
    expect(page.get_by_text("The retention times are saved.")).to_be_visible()
    page.reload()
    expect(days(page, "Runs")).to_have_value("")
    expect(days(page, "Rehearsals")).to_have_value("")


@pytest.mark.parametrize(("width", "height", "dark", "language"), [(1600, 1000, True, "en"), (820, 1180, False, "de")])
def test_storage_is_sound_at_both_sizes_in_both_themes_and_languages(
    sign_in: SignIn, width: int, height: int, dark: bool, language: str
) -> None:
    page = sign_in("admin", STORAGE, width=width, height=height, dark=dark, language=language)
    expect(page.get_by_role("region", name={"en": "Archive", "de": "Archiv"}[language])).to_be_visible()
    assert violations(page) == []
    assert page.evaluate("document.documentElement.scrollWidth <= window.innerWidth")


def test_an_author_is_told_that_storage_is_for_admins(sign_in: SignIn) -> None:
    page = sign_in("author", STORAGE)
    expect(page.get_by_text("Only admins of the site see what is kept, and for how long.")).to_be_visible()
    expect(page.get_by_role("textbox")).to_have_count(0)
