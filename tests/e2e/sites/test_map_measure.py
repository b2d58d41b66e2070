"""Somebody who may only look measures on the map's page: by mouse, by finger and by keyboard, from wall to wall."""

from __future__ import annotations

import json
import re
from typing import Any

import pytest
from playwright.sync_api import Locator, Page, expect

from tests.e2e.conftest import SignIn, make_member
from tests.e2e.screens import SITE, THIN_SPACE, ask, shoot, violations
from tests.kit.demo import Demo

pytestmark = pytest.mark.browser
MAP = "/sites/painting-factory/map"
PANEL = "Measure"


def on_screen(floor: Locator, x: float, y: float) -> tuple[float, float]:
    """Return where a point of the map (metres) is on the screen while somebody measures."""
    plan, box = ask(floor.page, f"{SITE}/map"), floor.bounding_box()
    assert box is not None
    across = (x - plan["origin"]["x"]) / (plan["width"] * plan["resolution_m"])
    along = (y - plan["origin"]["y"]) / (plan["height"] * plan["resolution_m"])
    return box["x"] + across * box["width"], box["y"] + (1 - along) * box["height"]


def floor_of(page: Page) -> Locator:
    return page.get_by_role("application", name="The map, to measure on")


def tap(page: Page, spot: tuple[float, float]) -> None:
    """Touch the screen for a moment, by the browser's own protocol."""
    cdp = page.context.new_cdp_session(page)
    cdp.send("Input.dispatchTouchEvent", {"type": "touchStart", "touchPoints": [{"x": spot[0], "y": spot[1]}]})
    cdp.send("Input.dispatchTouchEvent", {"type": "touchEnd", "touchPoints": []})


def click_at(page: Page, x: float, y: float) -> None:
    page.mouse.click(*on_screen(floor_of(page), x, y))


def heard(page: Page) -> Locator:
    """Return what is read out of the measurement."""
    return page.get_by_role("region", name=PANEL).get_by_role("status")


def metres(length: str) -> str:
    return f"{length}{THIN_SPACE}m"


@pytest.fixture
def onlooker(demo: Demo, signed_in: dict[str, Any]) -> str:
    name = "onlooker who measures"
    if name not in signed_in:
        signed_in[name] = make_member(demo, "viewer", "Lara Looks")
    return name


def test_a_viewer_measures_from_wall_to_machine_and_from_wall_to_wall_by_mouse(sign_in: SignIn, onlooker: str) -> None:
    page = sign_in(onlooker, MAP)
    button = page.get_by_role("button", name="Measure")
    expect(button).to_have_attribute("aria-pressed", "false")
    expect(page.get_by_role("button", name="Edit places")).to_have_count(0)
    button.click()
    panel = page.get_by_role("region", name=PANEL)
    expect(panel.get_by_text("Choose one end.")).to_be_visible()

    click_at(page, 17.35, -3.0)
    expect(heard(page)).to_have_text("One end is at 17.30, -3.00. Choose the other end.")
    page.mouse.move(*on_screen(floor_of(page), 18.3, -3.0))
    expect(panel.get_by_text(metres("1.00"))).to_be_visible()
    click_at(page, 19.3, -3.0)
    expect(heard(page)).to_have_text(f"{metres('2.05')} measured")
    expect(page.locator("svg").get_by_text(metres("2.05"), exact=True)).to_be_visible()
    shoot(page, "measure", "light", "dark")
    assert violations(page) == []

    click_at(page, 0.16, -2.9)
    page.mouse.move(*on_screen(floor_of(page), 6.0, -2.9))
    expect(heard(page)).to_contain_text("Choose the other end.")
    click_at(page, 6.04, -2.9)
    expect(heard(page)).to_have_text(f"{metres('6.00')} measured")

    page.mouse.move(*on_screen(floor_of(page), 11.55, -2.0))
    page.mouse.down()
    page.mouse.move(*on_screen(floor_of(page), 17.05, -2.0), steps=3)
    page.mouse.up()
    expect(heard(page)).to_have_text(f"{metres('5.60')} measured")

    page.keyboard.press("Escape")
    expect(panel.get_by_text("Choose one end.")).to_be_visible()
    expect(page.locator("svg").get_by_text(metres("5.60"))).to_have_count(0)
    page.keyboard.press("Escape")
    expect(panel).to_have_count(0)
    expect(button).to_be_focused()


def test_a_viewer_measures_a_door_by_keyboard_alone(sign_in: SignIn, onlooker: str) -> None:
    page = sign_in(onlooker, MAP)
    other = page.get_by_role("region", name="Floor check").get_by_label("Check for another width")
    other.focus()
    page.keyboard.press("m")
    expect(page.get_by_role("button", name="Measure")).to_have_attribute("aria-pressed", "false")
    other.blur()
    page.keyboard.press("m")
    expect(floor_of(page)).to_be_focused()
    for key in ("ArrowRight", "ArrowDown", "ArrowDown"):  # from the middle of the map to beside the post of a door
        page.keyboard.press(key)
    expect(heard(page)).to_have_text("Cross-hair at 12.00, -6.77")
    page.keyboard.press("Enter")
    expect(heard(page)).to_have_text("One end is at 12.00, -6.77. Choose the other end.")
    for key in ["Shift+ArrowRight"] * 2 + ["ArrowRight"] * 6:
        page.keyboard.press(key)
    expect(heard(page)).to_have_text(re.compile(f"^{metres('1.40')} up to 13\\.40, -6"))
    shoot(page, "measure-by-keyboard", "light", "dark")
    page.keyboard.press("Space")
    expect(heard(page)).to_have_text(f"{metres('1.40')} measured")
    assert violations(page) == []
    page.keyboard.press("Escape")
    expect(heard(page)).to_have_text(re.compile("^Cross-hair at 13\\.40"))
    page.keyboard.press("m")
    expect(page.get_by_role("region", name=PANEL)).to_have_count(0)
    expect(page.get_by_role("button", name="Measure")).to_be_focused()


def test_who_has_switched_letters_off_does_not_measure_by_one(sign_in: SignIn, onlooker: str) -> None:
    page = sign_in(onlooker, MAP)
    measure = page.get_by_role("button", name="Measure")
    expect(measure).to_have_attribute("aria-keyshortcuts", "M")
    person = ask(page, "/api/me")["user"]["id"]
    kept = json.dumps({"own": {}, "characters": False})  # as the editor's list of keys keeps it
    page.evaluate("([name, kept]) => localStorage.setItem(name, kept)", [f"vipo.keys.{person}", kept])
    page.reload()
    expect(measure).not_to_have_attribute("aria-keyshortcuts", "M")
    page.keyboard.press("m")
    expect(measure).to_have_attribute("aria-pressed", "false")


def test_measuring_ends_where_editing_begins_and_the_other_way_round(sign_in: SignIn) -> None:
    page = sign_in("admin", MAP, width=820, height=1180, language="de", dark=True)
    measure, places = (page.get_by_role("button", name=name) for name in ("Messen", "Orte bearbeiten"))
    places.click()
    measure.click()
    expect(places).to_be_visible()
    floor = page.get_by_role("application", name="Die Karte zum Messen")
    expect(floor).to_be_focused()
    panel = page.get_by_role("region", name="Messen")
    tap(page, on_screen(floor, 14.0, -7.0))
    expect(panel.get_by_text("Wählen Sie das andere Ende.", exact=True)).to_be_visible()
    tap(page, on_screen(floor, 14.0, -9.0))
    expect(panel.get_by_role("status")).to_have_text(f"{metres('2,20')} gemessen")
    shoot(page, "measure-820", "light", "dark")
    assert violations(page) == []
    places.click()
    expect(floor).to_have_count(0)
    expect(measure).to_have_attribute("aria-pressed", "false")
    expect(page.get_by_role("button", name="Orte fertig")).to_be_visible()
