"""Who may only look sees the whole editor, and can change nothing in it."""

from __future__ import annotations

import re
from typing import Any

import pytest
from playwright.sync_api import Locator, Page, expect

from tests.e2e.conftest import SignIn, make_member
from tests.e2e.screens import SITE, address_of, ask, chip, the_map
from tests.kit.demo import Demo

pytestmark = pytest.mark.browser


@pytest.fixture(scope="module")
def viewer(demo: Demo, signed_in: dict[str, Any]) -> None:
    """Somebody who may look at the painting factory, signed in."""
    signed_in["viewer"] = make_member(demo, "viewer", "Vera Look")


def open_paint_order(page: Page) -> None:
    program = next(each["id"] for each in ask(page, f"{SITE}/programs") if each["name"] == "Paint order")
    page.goto(address_of(page, f"/programs/{program}"))
    expect(page.get_by_role("banner").get_by_text("Read only")).to_be_visible()


@pytest.mark.usefixtures("viewer")
def test_who_may_only_look_changes_nothing(sign_in: SignIn) -> None:
    page = sign_in("viewer")
    open_paint_order(page)
    expect(page.get_by_label("Name of the program")).to_have_count(0)
    expect(page.get_by_role("toolbar", name="Tools").get_by_role("button")).to_have_count(2)
    for name in ("Simulate", "Run"):
        expect(page.get_by_role("banner").get_by_role("button", name=name, exact=True)).to_be_disabled()
    task = chip(page, "2, Pick-and-Drop")
    task.click()
    expect(page.get_by_role("complementary", name="Selected step")).to_contain_text("Step 2")
    expect(page.get_by_role("combobox", name="Quantity")).to_be_disabled()
    expect(page.locator("[data-form] :is(input, textarea, button):enabled")).to_have_count(0)
    expect(page.get_by_role("tabpanel").locator(".cm-content")).to_have_attribute("contenteditable", "false")
    keys_do_nothing(page)
    dragging_moves_nothing(page)
    page.get_by_role("tab", name="Comments").click()
    comments = page.get_by_role("tabpanel", name="Comments")
    expect(comments.get_by_text("No open comments.")).to_be_visible()
    expect(comments.get_by_role("button")).to_have_count(0)


def keys_do_nothing(page: Page) -> None:
    steps = chip(page, "").count()
    for key in ("Delete", "p", "Control+d", "Alt+ArrowLeft"):
        page.keyboard.press(key)
    expect(page.get_by_role("toolbar", name="Tools").get_by_role("button", pressed=True)).to_have_accessible_name(
        "Select"
    )
    assert chip(page, "").count() == steps


def away(first: Locator, second: Locator) -> dict[str, float]:
    """Return how far one stands from the other, both measured at one moment: the map may still be moving."""
    places = "(one, other) => [one, other].map((each) => each.getBoundingClientRect().toJSON())"
    one, other = first.evaluate(places, second.element_handle())
    return {axis: one[axis] - other[axis] for axis in ("x", "y")}


def dragging_moves_nothing(page: Page) -> None:
    """The map moves under the pointer as a whole: the step stays where it is among the machines."""
    first, second = chip(page, "2, Pick-and-Drop"), chip(page, "9, Move")
    before = away(first, second)
    first.hover()
    page.mouse.down()
    page.mouse.move(500, 500, steps=4)
    page.mouse.up()
    assert away(first, second) == pytest.approx(before, abs=1)
    expect(the_map(page).get_by_role("group", name=re.compile("^2, Pick-and-Drop"))).to_have_count(1)
