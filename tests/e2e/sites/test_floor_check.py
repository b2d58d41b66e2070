"""The floor check on the map's page: what another robot would meet, and what changes when somebody draws a zone."""

from __future__ import annotations

import re

import pytest
from playwright.sync_api import expect

from tests.e2e.conftest import SignIn
from tests.e2e.screens import SITE, ask, shoot, tell, violations
from tests.kit.demo import Demo

pytestmark = pytest.mark.browser
MAP = "/sites/painting-factory/map"
BEHIND = [[8.0, -13.5], [14.0, -13.5], [14.0, -8.5], [8.0, -8.5]]


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
        answer = admin.request.delete(
            f"{demo.url}{SITE}/zones/{zone}",
            headers={"X-CSRFToken": ask(admin, "/api/me")["csrf"], "Referer": admin.url},
        )
        assert answer.status == 204
    expect(kept).to_have_count(0)
