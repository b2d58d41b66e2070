"""Tokens on their page: made, copied this once, shown to VIPO by a program, revoked."""

from __future__ import annotations

import httpx
import pytest
from playwright.sync_api import expect

from tests.e2e.conftest import SignIn
from tests.e2e.screens import violations
from tests.kit.demo import Demo

pytestmark = pytest.mark.browser
PAGE = "/sites/painting-factory/tokens"


def test_a_token_is_made_shown_once_used_and_revoked_by_keyboard(demo: Demo, sign_in: SignIn) -> None:
    page = sign_in("author", PAGE)
    expect(page.get_by_role("heading", level=1, name="Tokens")).to_be_visible()
    page.get_by_role("button", name="New token").focus()
    page.keyboard.press("Enter")
    expect(page.get_by_label("What it is for")).to_be_focused()
    page.keyboard.type("Line display")
    expect(page.get_by_role("checkbox", name="Look")).to_be_disabled()
    expect(page.get_by_role("checkbox", name="Everything")).to_have_count(0)
    page.get_by_role("checkbox", name="Operate").press("Space")
    assert violations(page) == []
    page.get_by_label("What it is for").press("Enter")
    token = page.get_by_role("dialog", name="Token for Line display").get_by_label("Token").input_value()
    assert violations(page) == []
    asked = {"Authorization": f"Bearer {token}"}
    sites = httpx.get(f"{demo.url}/api/sites", headers=asked, timeout=60).json()
    assert [(site["slug"], site["role"]) for site in sites] == [("painting-factory", "operator")]
    page.get_by_role("button", name="I have it").press("Enter")
    row = page.get_by_role("row", name="Line display")
    expect(row).to_contain_text("Operate")
    expect(page.get_by_role("dialog")).to_have_count(0)
    assert token.split("_", 2)[2] not in page.content()
    row.get_by_role("button", name="Revoke Line display").press("Enter")
    page.get_by_role("dialog").get_by_role("button", name="Revoke").press("Enter")
    expect(page.get_by_text("No tokens yet")).to_be_visible()
    assert httpx.get(f"{demo.url}/api/sites", headers=asked, timeout=60).status_code == 401


@pytest.mark.parametrize(("language", "dark"), [("en", False), ("de", True)])
def test_a_token_for_the_broker_is_for_reading_alone_and_says_how_a_dashboard_comes_in(
    sign_in: SignIn, language: str, dark: bool
) -> None:
    words = {
        "en": ("New token", "What it is for", "At the broker", "Operate", "User name", "Topics", "I have it", "Revoke"),
        "de": (
            *("Neues Zugriffstoken", "Wofür es ist", "Am Broker", "Bedienen", "Benutzername", "Themen (Topics)"),
            *("Ich habe es", "Widerrufen"),
        ),
    }
    new, name, broker, operate, username, topics, done, revoke = words[language]
    page = sign_in("author", PAGE, dark=dark, language=language)
    page.get_by_role("button", name=new).press("Enter")
    page.get_by_label(name).fill("Wall display")
    page.get_by_role("checkbox", name=operate).press("Space")
    expect(page.get_by_role("checkbox", name=broker)).to_be_disabled()
    page.get_by_role("checkbox", name=operate).press("Space")
    page.get_by_role("checkbox", name=broker).press("Space")
    expect(page.get_by_role("checkbox", name=operate)).to_be_disabled()
    page.get_by_label(name).press("Enter")
    told = page.get_by_role("dialog")
    assert told.get_by_label(username).input_value().startswith("token:")
    assert told.get_by_label(topics).input_value() == "vipo/v1/site/painting-factory/things/#"
    assert violations(page) == []
    page.get_by_role("button", name=done).press("Enter")
    row = page.get_by_role("row", name="Wall display")
    expect(row).to_contain_text(broker)
    row.get_by_role("button").press("Enter")
    page.get_by_role("dialog").get_by_role("button", name=revoke).press("Enter")
    expect(page.get_by_role("row", name="Wall display")).to_have_count(0)


@pytest.mark.parametrize(
    ("language", "dark", "width", "height"),
    [("en", False, 1600, 1000), ("de", True, 1600, 1000), ("de", False, 820, 1180), ("en", True, 820, 1180)],
)
def test_the_page_passes_axe_and_fits(sign_in: SignIn, language: str, dark: bool, width: int, height: int) -> None:
    page = sign_in("admin", PAGE, width=width, height=height, dark=dark, language=language)
    title = {"en": "Tokens", "de": "Zugriffstoken"}[language]
    expect(page.get_by_role("heading", level=1, name=title)).to_be_visible()
    expect(page.get_by_role("button", name={"en": "New token", "de": "Neues Zugriffstoken"}[language])).to_be_visible()
    assert violations(page) == []
    assert page.evaluate("document.documentElement.scrollWidth <= window.innerWidth")
