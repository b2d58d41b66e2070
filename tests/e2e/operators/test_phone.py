"""On a phone people look, stop, approve and comment: nothing lies beside the screen or on top of something else."""

from __future__ import annotations

import re

import pytest
from playwright.sync_api import Locator, Page, expect

from tests.e2e.conftest import SignIn
from tests.e2e.screens import address_of, program_named, tell, violations

pytestmark = pytest.mark.browser
SITE = "painting-factory"
PHONE = {"width": 390, "height": 844}
PAGES = (
    ("programs", "Paint order", "Paint order"),
    ("runs", "Runs", "Läufe"),
    ("devices", "TurtleBot 1", "TurtleBot 1"),
    ("library", "functions", "Funktionen"),
    ("operations", "What waits at this site", "Was an diesem Standort wartet"),
    ("people", "Members", "Mitglieder"),
)
"""Each page's path, and what is there once it is ready, in English and in German."""
BESIDE = """() => [...document.querySelectorAll('main table td, main table a, main table button, header button')]
    .filter((each) => each.getClientRects().length > 0 && each.getBoundingClientRect().right > innerWidth + 1)
    .map((each) => each.textContent)"""


def fits(page: Page) -> None:
    """Nothing makes the page wider than the screen, and no cell or key of it is cut."""
    assert page.evaluate("document.documentElement.scrollWidth <= document.documentElement.clientWidth")
    assert page.evaluate(BESIDE) == []


def apart(one: Locator, other: Locator) -> bool:
    a, b = one.bounding_box(), other.bounding_box()
    assert a is not None
    assert b is not None
    beside = a["x"] + a["width"] <= b["x"] or b["x"] + b["width"] <= a["x"]
    return beside or a["y"] + a["height"] <= b["y"] or b["y"] + b["height"] <= a["y"]


@pytest.mark.parametrize("language", ["en", "de"])
def test_pages_fit_a_phone_in_both_languages(sign_in: SignIn, language: str) -> None:
    page = sign_in("admin", dark=language == "de", language=language, **PHONE)
    for path, *seen in PAGES:
        page.goto(address_of(page, f"/sites/{SITE}/{path}"))
        expect(page.get_by_text(seen[language == "de"]).filter(visible=True).first).to_be_visible()
        page.wait_for_load_state("networkidle")
        fits(page)
        assert violations(page) == [], path


def test_a_run_is_watched_and_stopped_on_a_phone(sign_in: SignIn) -> None:
    page = sign_in("admin", **PHONE)
    run = tell(page, f"/api/programs/{program_named(page, 'Paint order')}/runs", {})["id"]
    page.goto(re.sub(r"(https?://[^/]+).*", rf"\1/runs/{run}", page.url))
    ways, zoom = (
        page.get_by_role("radiogroup", name="How the place is shown"),
        page.get_by_role("button", name="Zoom in"),
    )
    expect(ways).to_be_visible()
    expect(zoom).to_be_visible()
    assert apart(ways, zoom)
    fits(page)
    page.get_by_role("banner").get_by_role("button", name="Cancel run").click()
    page.get_by_role("dialog").get_by_role("button", name="Cancel run").click()
    expect(page.get_by_role("banner").get_by_text("Cancelled")).to_be_visible(timeout=180_000)
    page.goto(re.sub(r"(https?://[^/]+).*", rf"\1/sites/{SITE}/runs", page.url))
    row = page.get_by_role("row").filter(has_text="Paint order").first
    expect(row).to_contain_text("Cancelled")
    fits(page)


def test_the_history_of_a_program_fits_a_phone(sign_in: SignIn) -> None:
    page = sign_in("admin", **PHONE)
    program = program_named(page, "Paint order")
    tell(page, f"/api/programs/{program}/versions", {})
    page.goto(re.sub(r"(https?://[^/]+).*", rf"\1/sites/{SITE}/history/{program}", page.url))
    version = page.get_by_role("listitem").filter(has=page.get_by_role("heading", level=2)).first
    expect(version).to_be_visible()
    compare = version.get_by_role("link", name="Compare with the draft")
    assert apart(compare, version.get_by_role("heading", level=2))
    fits(page)
