"""Six browsers in one program: all draw, one goes offline, one undoes, and all show the same."""

from __future__ import annotations

import re

import pytest
from playwright.sync_api import Page, expect

from tests.e2e.conftest import SignIn
from tests.e2e.screens import ask, expect_steps, make_program, opened, same_steps, saved

pytestmark = pytest.mark.browser
PEOPLE = 6


def draw(page: Page) -> None:
    """Set a Notify down where the map proposes."""
    page.keyboard.press("Escape")
    page.keyboard.press("n")
    page.keyboard.press("Enter")
    expect(page.get_by_role("complementary", name="Selected step")).to_be_visible()


def test_six_people_draw_one_program_and_all_see_the_same(sign_in: SignIn, faults: list[str]) -> None:
    first = sign_in("author", width=1200, height=700)
    path = make_program(first, "Six people")
    pages = [
        first,
        *(sign_in("admin" if number % 2 else "author", path, width=1200, height=700) for number in range(1, PEOPLE)),
    ]
    for page in pages:
        opened(page)
    away = pages[3]
    away.context.set_offline(offline=True)
    for page in pages:
        draw(page)
    away.context.set_offline(offline=False)
    for page in (pages[1], away):
        draw(page)
    pages[1].keyboard.press("Escape")
    pages[1].keyboard.press("Control+z")  # takes back one's own, whatever the others have drawn since
    wanted = PEOPLE + 2 - 1
    for page in pages:
        page.get_by_role("tab", name="Steps").click()
        rows = page.get_by_role("tree", name="Steps").get_by_role("treeitem")
        expect(rows.filter(has_text=re.compile("Notify"))).to_have_count(wanted)
    for page in pages:
        saved(page)
        page.keyboard.press("Escape")  # rows say who has a step selected, of others alone
        page.keyboard.press("Escape")
    shown = same_steps(*pages)
    stored = ask(first, f"/api{re.sub('^/sites/[^/]+', '', path)}/document")["steps"]
    assert len(stored) == wanted
    faults[:] = [each for each in faults if "ERR_INTERNET_DISCONNECTED" not in each]
    pages[0].reload()
    opened(pages[0])
    expect_steps(pages[0], shown)
