"""An admin draws a zone for so many robots on the site's map, by keyboard; others see it at once."""

from __future__ import annotations

from typing import Any

import pytest
from playwright.sync_api import Page, expect

from tests.e2e.conftest import SignIn
from tests.e2e.screens import SITE, ask, violations
from tests.kit.waiting import wait_for

pytestmark = pytest.mark.browser
MAP = "/sites/painting-factory/map"


def zones_of(page: Page) -> list[dict[str, Any]]:
    return [{k: zone[k] for k in ("name", "rule", "robots")} for zone in ask(page, f"{SITE}/map")["zones"]]


def test_a_zone_for_two_robots_is_drawn_changed_and_removed_by_keyboard(sign_in: SignIn) -> None:
    admin, author = sign_in("admin", MAP), sign_in("author", MAP)
    expect(author.get_by_role("button", name="Edit zones")).to_have_count(0)
    assert zones_of(admin) == []
    admin.get_by_role("button", name="Edit zones").press("Enter")
    admin.get_by_role("button", name="Add a zone").press("Enter")
    admin.get_by_role("button", name="Draw the new zone").press("Enter")
    form = admin.get_by_role("form", name="New zone")
    expect(form.get_by_label("Name")).to_be_focused()
    admin.keyboard.type("Mixing door")
    form.get_by_role("radio", name="At most so many robots").press("Space")
    number = form.get_by_role("textbox", name="Robots at once")
    expect(number).to_have_value("1")
    number.press("ArrowUp")
    expect(number).to_have_value("2")
    assert violations(admin) == []
    number.press("Tab")
    form.get_by_role("button", name="Add the zone").press("Enter")
    listed = author.get_by_role("region", name="Zones")
    expect(listed.get_by_text("Mixing door")).to_be_visible()
    expect(listed.get_by_text("2 robots")).to_be_visible()
    assert zones_of(author) == [{"name": "Mixing door", "rule": "one_at_a_time", "robots": 2}]
    admin.reload()
    admin.get_by_role("button", name="Edit zones").press("Enter")
    row = admin.get_by_role("region", name="Zones").get_by_role("button", name="Mixing door")
    if row.get_attribute("aria-expanded") != "true":
        row.press("Enter")
    changed = admin.get_by_role("group", name="Zone Mixing door")
    changed.get_by_role("textbox", name="Robots at once").fill("3")
    admin.keyboard.press("Enter")
    wait_for("the other number", lambda: zones_of(admin)[0]["robots"] == 3)
    changed.get_by_role("radio", name="Drive slowly").press("Space")
    wait_for("the other rule", lambda: zones_of(admin)[0] == {"name": "Mixing door", "rule": "slow", "robots": None})
    changed.get_by_role("radio", name="One way").press("Space")
    wait_for("the third rule", lambda: zones_of(admin)[0]["rule"] == "one_way")
    direction = changed.get_by_role("combobox", name="Where robots drive")
    expect(direction).to_have_value("0")
    direction.press("ArrowDown")
    direction.press("ArrowDown")
    expect(listed.get_by_text("One way ↑")).to_be_visible()
    wait_for("the direction", lambda: ask(admin, f"{SITE}/map")["zones"][0]["heading_deg"] == 90)
    assert violations(admin) == []
    changed.get_by_role("radio", name="Preferred").press("Space")
    expect(listed.get_by_text("Preferred")).to_be_visible()
    changed.get_by_role("button", name="Remove the zone").press("Enter")
    admin.get_by_role("dialog", name="Remove Mixing door?").get_by_role("button", name="Remove the zone").press("Enter")
    expect(listed.get_by_text("Mixing door")).to_have_count(0)
    assert zones_of(admin) == []
