"""A zone is drawn and covered: the step takes the zone it is set down in, shows its lanes, and a robot drives them."""

from __future__ import annotations

import re

import pytest
from playwright.sync_api import Page, expect

from scripts.construct_pictures import clip_of
from tests.e2e.conftest import SignIn
from tests.e2e.screens import (
    chip,
    make_program,
    open_script,
    run_state,
    script_lines,
    start_run,
    violations,
)

pytestmark = pytest.mark.browser


def press_at(page: Page, x: float, y: float) -> None:
    """Click the map at a point in metres."""
    at = clip_of(page, (x, y, x, y))
    page.mouse.click(at["x"], at["y"])


def test_a_zone_is_drawn_and_a_robot_covers_it(sign_in: SignIn) -> None:
    page = sign_in("author")
    make_program(page, "Sweeps")
    page.keyboard.press("z")
    for x, y in ((1.5, -5.4), (4.5, -5.4), (4.5, -4.2), (1.5, -4.2)):
        press_at(page, x, y)
    page.keyboard.press("Enter")
    page.keyboard.press("Escape")
    page.keyboard.press(".")
    page.keyboard.type("Cover zone")
    page.keyboard.press("Enter")
    press_at(page, 4.1, -4.5)
    expect(chip(page, "1, Cover zone, Cover Zone 1")).to_be_visible()
    lanes = page.locator("svg[data-lanes] path")
    expect(lanes).to_have_count(2)
    line = str(lanes.last.get_attribute("d"))
    assert len(re.findall("[ML]", line)) == 2 * 4  # 1.2 m in lanes as wide as the robot, 0.36 m at most
    page.get_by_role("combobox", name="Width of a lane").fill("0.6")
    page.keyboard.press("Tab")
    expect(lanes.last).not_to_have_attribute("d", line)
    assert len(re.findall("[ML]", str(lanes.last.get_attribute("d")))) == 2 * 2
    assert violations(page) == []
    open_script(page)
    expect(page.get_by_text("lane=0.6")).to_be_visible()
    assert "        self.robot.cover(self.zone_1, lane=0.6)" in script_lines(page)
    start_run(page)
    expect(run_state(page)).to_contain_text("Finished", timeout=180_000)
    expect(page.get_by_text(re.compile("TurtleBot [123] has covered 9[0-9] % of Zone 1")).first).to_be_visible()
