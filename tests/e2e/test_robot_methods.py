"""A robot's own method, drawn on the map, given to any robot that can, and carried out by a simulated one."""

from __future__ import annotations

import re

import pytest
from playwright.sync_api import expect

from tests.e2e.conftest import SignIn
from tests.e2e.screens import chip, make_program, open_script, run_state, script_lines, start_run, violations

pytestmark = pytest.mark.browser


def test_a_robot_honks_without_a_line_of_code(sign_in: SignIn) -> None:
    page = sign_in("author")
    make_program(page, "Honks")
    page.keyboard.press("o")
    page.keyboard.type("TurtleBot 2")
    page.keyboard.press("Enter")
    page.get_by_role("combobox", name="What it does").click()
    expect(page.get_by_role("option")).to_have_text(["Honk", "Blink"])
    page.get_by_role("option", name="Honk").click()
    page.get_by_role("combobox", name="times").fill("5")
    page.keyboard.press("Tab")
    expect(chip(page, "1, Operate, TurtleBot 2 · Honk · 5")).to_be_visible()
    page.get_by_role("combobox", name="Machine or robot").click()
    page.get_by_role("option", name=re.compile("^Robot ")).click()
    expect(chip(page, "1, Operate, Robot · Honk · 5")).to_be_visible()
    open_script(page)
    expect(page.get_by_text('ctx.any("honk")')).to_be_visible()
    assert "        self.robot.honk(5)" in script_lines(page)
    assert violations(page) == []
    start_run(page)
    expect(run_state(page)).to_contain_text("Finished")
    expect(page.get_by_text(re.compile("TurtleBot [123].*honk", re.IGNORECASE)).first).to_be_visible()


def test_what_is_tried_again_in_one_dialog_can_be_cancelled_again(sign_in: SignIn) -> None:
    page = sign_in("author", "/sites/painting-factory/devices/paintMixer02")
    page.get_by_role("button", name="Try mixPaint").click()
    dialog = page.get_by_role("dialog")
    for parameter in dialog.get_by_role("textbox").all():
        parameter.fill("9")
    for _ in range(2):
        dialog.get_by_role("button", name="Start").click()
        dialog.get_by_role("button", name="Cancel it").click()
        expect(dialog.get_by_text("Cancelled", exact=True)).to_be_visible()
        expect(dialog.get_by_role("button", name="Cancel it")).to_have_count(0)
    assert violations(page) == []
