"""The map's page is seen from nearer: by buttons, wheel and dragging, and what is pointed at stays right."""

from __future__ import annotations

import pytest
from playwright.sync_api import Page, expect

from tests.e2e.conftest import SignIn
from tests.e2e.screens import shoot, violations

pytestmark = pytest.mark.browser
MAP = "/sites/painting-factory/map"
OVEN = "Curing Oven"


def box_of(page: Page) -> tuple[float, float, float]:
    """Return the middle of the oven on the screen and how wide it is, in pixels."""
    found = page.get_by_role("button", name=OVEN, exact=True).bounding_box()
    assert found is not None
    return found["x"] + found["width"] / 2, found["y"] + found["height"] / 2, found["width"]


def test_one_comes_nearer_by_keyboard_by_wheel_and_by_dragging_and_sees_the_whole_again(sign_in: SignIn) -> None:
    page = sign_in("author", MAP)
    nearer = page.get_by_role("button", name="Nearer")
    whole = page.get_by_role("button", name="The whole map")
    expect(whole).to_be_disabled()
    x, y, width = box_of(page)
    page.mouse.move(x, y)
    page.mouse.wheel(0, -400)
    expect(whole).to_be_enabled()
    near_x, near_y, near_width = box_of(page)
    assert near_width > 2 * width
    assert (near_x, near_y) == pytest.approx((x, y), abs=12)

    page.mouse.move(x, y + 200)
    page.mouse.down()
    page.mouse.move(x + 120, y + 140, steps=4)
    page.mouse.up()
    moved_x, moved_y, _ = box_of(page)
    assert (moved_x - near_x, moved_y - near_y) == pytest.approx((120, -60), abs=3)
    shoot(page, "map-nearer", "light", "dark")
    assert violations(page) == []

    whole.focus()
    page.keyboard.press("Enter")
    expect(whole).to_be_disabled()
    assert box_of(page) == pytest.approx((x, y, width), abs=1)
    page.mouse.move(x, y)
    page.mouse.wheel(0, 400)  # there is nothing farther: the page may scroll
    assert box_of(page)[2] == pytest.approx(width, abs=1)
    nearer.focus()
    page.keyboard.press("Enter")
    assert box_of(page)[2] > 1.2 * width
    page.get_by_role("button", name="Farther").click()
    expect(whole).to_be_disabled()
    page.set_viewport_size({"width": 820, "height": 1180})
    shoot(page, "map-whole-820", "light", "dark")
    assert violations(page) == []


def test_a_length_is_the_same_from_nearer(sign_in: SignIn) -> None:
    page = sign_in("author", MAP)
    x, y, width = box_of(page)
    page.get_by_role("button", name="Measure").click()
    page.mouse.move(x, y)
    page.mouse.wheel(0, -300)
    floor = page.get_by_role("application", name="The map, to measure on")
    expect(floor).to_be_visible()
    page.mouse.click(x - 40, y - 90)
    page.mouse.click(x + 60, y - 90)
    length = page.get_by_role("region", name="Measure").locator("p").first
    metres = float(length.inner_text().split()[0])
    page.keyboard.press("Escape")
    page.keyboard.press("Escape")
    near = box_of(page)[2]
    oven_m = 2.7
    assert metres == pytest.approx(100 * oven_m / near, abs=0.35)
    assert near > 1.5 * width


def test_what_is_seen_from_nearer_is_moved_by_keys_and_what_has_the_focus_is_seen(sign_in: SignIn) -> None:
    page = sign_in("author", MAP)
    nearer = page.get_by_role("button", name="Nearer")
    nearer.focus()
    for _ in range(6):
        page.keyboard.press("Enter")
    floor = page.get_by_role("group", name="Map, moved by arrow keys")
    expect(floor).to_be_visible()
    assert violations(page) == []
    x, y, _ = box_of(page)
    floor.focus()
    page.keyboard.press("ArrowRight")
    page.keyboard.press("ArrowUp")
    moved_x, moved_y, _ = box_of(page)
    assert (moved_x - x, moved_y - y) == pytest.approx((-60, 60), abs=2)
    for name in (OVEN, "Item Inventory"):
        page.get_by_role("button", name=name, exact=True).focus()
        pane = floor.bounding_box()
        box = page.get_by_role("button", name=name, exact=True).bounding_box()
        assert pane is not None
        assert box is not None
        assert pane["x"] <= box["x"] + box["width"] / 2 <= pane["x"] + pane["width"]
        assert pane["y"] <= box["y"] + box["height"] / 2 <= pane["y"] + pane["height"]
    page.get_by_role("button", name="The whole map").press("Enter")
    expect(floor).to_have_count(0)
