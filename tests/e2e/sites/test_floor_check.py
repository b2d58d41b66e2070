"""The floor check on the map's page: what another robot would meet, and what changes when somebody draws a zone."""

from __future__ import annotations

import re

import pytest
from playwright.sync_api import Page, expect

from tests.e2e.conftest import SignIn
from tests.e2e.screens import SITE, ask, shoot, tell, violations
from tests.kit.demo import Demo

pytestmark = pytest.mark.browser
MAP = "/sites/painting-factory/map"
BEHIND = [[8.0, -13.5], [14.0, -13.5], [14.0, -8.5], [8.0, -8.5]]


def headers_of(page: Page) -> dict[str, str]:
    return {"X-CSRFToken": ask(page, "/api/me")["csrf"], "Referer": page.url}


def remove(page: Page, address: str) -> None:
    assert page.request.delete(address, headers=headers_of(page)).status == 204


def change(page: Page, address: str, fields: dict[str, float]) -> None:
    assert page.request.patch(address, headers=headers_of(page), data=fields).status == 200


def test_a_floor_is_checked_for_another_width_by_keyboard_and_again_when_a_zone_is_drawn(
    demo: Demo, sign_in: SignIn
) -> None:
    viewer, admin = sign_in("author", MAP), sign_in("admin", MAP)
    check = viewer.get_by_role("region", name="Floor check")
    expect(check.get_by_text(re.compile("^All \\d+ machines can be reached$"))).to_be_visible()
    expect(check.get_by_role("listitem").filter(has=viewer.get_by_role("button"))).to_have_count(0)

    width = check.get_by_label("Check for another width")
    width.focus()
    viewer.keyboard.type("1.2")
    expect(check.get_by_text("As it would be for robots 1.20 m wide.".replace(" m ", "\u202fm "))).to_be_visible()
    narrow = check.get_by_role("button", name=re.compile("too narrow by")).first
    expect(narrow).to_contain_text("Between")
    narrow.focus()
    viewer.keyboard.press("Enter")
    expect(narrow).to_have_attribute("aria-pressed", "true")
    shoot(viewer, "floor-check", "light", "dark")
    assert violations(viewer) == []
    viewer.set_viewport_size({"width": 820, "height": 1180})
    shoot(viewer, "floor-check-820", "light", "dark")
    assert violations(viewer) == []
    viewer.set_viewport_size({"width": 1600, "height": 1000})
    width.fill("")

    expect(check.get_by_text(re.compile("^All \\d+ machines can be reached$"))).to_be_visible()
    zone = tell(admin, f"{SITE}/zones", {"name": "Wet paint", "rule": "keep_out", "points": BEHIND})["id"]
    try:
        kept = check.get_by_role("button", name=re.compile("robots keep out|cut off by a zone"))
        expect(kept.first).to_contain_text("Wet paint")
        shoot(viewer, "floor-check-zone", "light")
    finally:
        remove(admin, f"{demo.url}{SITE}/zones/{zone}")
    expect(kept).to_have_count(0)


def test_a_finding_is_mended_by_a_press_and_taken_back_unless_somebody_moved_it_since(
    demo: Demo, sign_in: SignIn
) -> None:
    admin, author = sign_in("admin", MAP), sign_in("author", MAP)
    dock = next(each for each in ask(admin, f"{SITE}/map")["places"] if each["kind"] == "dock")
    where = {"name": "Spare dock", "kind": "dock", "x": dock["x"] - 0.5, "y": dock["y"]}
    spare = tell(admin, f"{SITE}/places", where)["id"]
    try:
        finding = author.get_by_role("button", name=re.compile("one robot at a time"))
        finding.click()
        expect(author.get_by_role("button", name=re.compile("^Move "))).to_have_count(0)

        check = admin.get_by_role("region", name="Floor check")
        mine = check.get_by_role("button", name=re.compile("one robot at a time"))
        mine.focus()
        admin.keyboard.press("Enter")
        moves = check.get_by_role("button", name=re.compile("^Move .* by "))
        expect(moves.first).to_be_visible()
        admin.keyboard.press("Tab")
        expect(moves.first).to_be_focused()
        expect(admin.locator("[data-ghost]")).to_have_count(1)
        shoot(admin, "floor-check-remedy", "light", "dark")
        assert violations(admin) == []
        admin.set_viewport_size({"width": 820, "height": 1180})
        shoot(admin, "floor-check-remedy-820", "light", "dark")
        admin.set_viewport_size({"width": 1600, "height": 1000})
        moves.first.focus()
        admin.keyboard.press("Enter")
        undo = admin.get_by_role("button", name="Undo")
        expect(undo).to_be_visible()
        expect(mine).to_have_count(0)
        expect(finding).to_have_count(0)
        expect(check.get_by_role("heading", name="Floor check")).to_be_focused()
        assert violations(admin) == []

        undo.click()
        expect(admin.get_by_text(re.compile("is back where it was"))).to_be_visible()
        expect(mine).to_have_attribute("aria-pressed", "true")

        name = re.sub("^Move (.*) by .*$", r"\1", moves.first.inner_text())
        moves.first.click()
        expect(mine).to_have_count(0)
        moved = next(each for each in ask(admin, f"{SITE}/map")["places"] if each["name"] == name)
        elsewhere = {"x": moved["x"] + 0.1, "y": moved["y"]}
        change(admin, f"{demo.url}{SITE}/places/{moved['id']}", elsewhere)
        undo.click()
        expect(admin.get_by_text(f"Somebody has moved {name} since. It stays where it is now.")).to_be_visible()
        stands = next(each for each in ask(admin, f"{SITE}/map")["places"] if each["id"] == moved["id"])
        assert stands["x"] == pytest.approx(elsewhere["x"])
    finally:
        remove(admin, f"{demo.url}{SITE}/places/{spare}")
        back = {"x": dock["x"], "y": dock["y"]}
        change(admin, f"{demo.url}{SITE}/places/{dock['id']}", back)


def test_what_a_zone_does_is_mended_at_the_zone(demo: Demo, sign_in: SignIn) -> None:
    admin = sign_in("admin", MAP)
    zone = tell(admin, f"{SITE}/zones", {"name": "Wet paint", "rule": "keep_out", "points": BEHIND})["id"]
    try:
        check = admin.get_by_role("region", name="Floor check")
        check.get_by_role("button", name=re.compile("robots keep out|cut off by a zone")).first.click()
        check.get_by_role("button", name="Change the zone Wet paint").click()
        expect(admin.get_by_role("button", name="Finish zones", exact=False)).to_be_visible()
        expect(admin.get_by_label("Name")).to_have_value("Wet paint")
    finally:
        remove(admin, f"{demo.url}{SITE}/zones/{zone}")
