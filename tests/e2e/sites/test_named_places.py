"""An admin gives a place on the map a name, by keyboard; others see it at once."""

from __future__ import annotations

from typing import Any

import pytest
from playwright.sync_api import Page, expect

from tests.e2e.conftest import SignIn
from tests.e2e.screens import SITE, ask, violations
from tests.kit.waiting import wait_for

pytestmark = pytest.mark.browser
MAP = "/sites/painting-factory/map"


def places_of(page: Page) -> dict[str, Any]:
    return {place["id"]: place for place in ask(page, f"{SITE}/map")["places"]}


def where(page: Page, place: str) -> tuple[float, float]:
    found = places_of(page)[place]
    return found["x"], found["y"]


def test_a_place_is_made_moved_and_removed_by_keyboard_and_others_see_it(sign_in: SignIn) -> None:
    admin, author = sign_in("admin", MAP), sign_in("author", MAP)
    expect(author.get_by_role("button", name="Edit places")).to_have_count(0)
    before = places_of(admin)
    admin.get_by_role("button", name="Edit places").click()
    admin.get_by_role("button", name="Add a place").click()
    admin.keyboard.press("Enter")  # on the floor: into the middle
    expect(admin.get_by_label("Name", exact=True)).to_be_focused()
    admin.keyboard.type("Quality table")
    admin.keyboard.press("Enter")
    handle = admin.get_by_role("button", name="Quality table at")
    expect(handle).to_have_attribute("aria-pressed", "true")
    expect(author.get_by_role("region", name="Places").get_by_text("Quality table")).to_be_visible()
    assert violations(admin) == []
    x, y = where(admin, "quality_table")
    handle.focus()
    for key in ("Shift+ArrowDown", "ArrowDown", "ArrowLeft", "Enter"):
        admin.keyboard.press(key)
    moved = (round(x - 0.1, 2), round(y - 1.1, 2))
    wait_for("the place where it was put", lambda: where(admin, "quality_table") == moved)
    admin.reload()
    assert places_of(admin).keys() - before.keys() == {"quality_table"}
    admin.get_by_role("button", name="Edit places").click()
    admin.get_by_role("button", name="Quality table Point").click()
    admin.get_by_role("button", name="Remove the place").click()
    dialog = admin.get_by_role("dialog", name="Remove Quality table?")
    expect(dialog.get_by_text("No program goes here.")).to_be_visible()
    dialog.get_by_role("button", name="Remove the place").click()
    expect(author.get_by_text("Quality table")).to_have_count(0)
    assert places_of(admin) == before
