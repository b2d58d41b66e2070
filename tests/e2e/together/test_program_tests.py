"""Tests beside a program, by keyboard alone: written, mended where the parser says so, carried out, on the map."""

from __future__ import annotations

import os
import re

import pytest
from playwright.sync_api import Locator, Page, expect

from tests.e2e.conftest import SignIn
from tests.e2e.screens import ask, draw_task, make_program, program_named, saved, tell, violations
from tests.kit.waiting import wait_for

pytestmark = pytest.mark.browser
WRONG = "name: One box is carried\nwhen: {driver: kinematic}\nthen:\n- ends: badly"


def open_tests(page: Page) -> Locator:
    page.get_by_role("tab", name="Tests").press("Enter")
    return page.get_by_role("tabpanel", name="Tests")


def shoot(page: Page, name: str) -> None:
    """Keep a picture where somebody wants to look at one."""
    if folder := os.environ.get("VIPO_PICTURES"):
        page.screenshot(path=f"{folder}/{name}.png")


def press(within: Locator, name: str) -> None:
    within.get_by_role("button", name=name, exact=True).press("Enter")


def test_a_test_is_written_mended_and_carried_out_by_keyboard(sign_in: SignIn, faults: list[str]) -> None:
    page = sign_in("author")
    make_program(page, "Tested from the keyboard")
    draw_task(page)
    saved(page)
    panel = open_tests(page)
    expect(panel.get_by_text("There are no tests yet.")).to_be_visible()
    shoot(page, "tests-empty")
    press(panel, "New test")
    page.get_by_role("menuitem", name="Empty").press("Enter")
    text = panel.get_by_role("textbox", name="The test as YAML")
    text.focus()
    page.keyboard.press("Control+A")
    page.keyboard.insert_text(WRONG)
    expect(panel.get_by_role("status").filter(has_text="Line 4: Write “ends: well”")).to_be_visible()
    expect(text).to_have_attribute("aria-invalid", "true")
    shoot(page, "tests-fault")
    press(panel, "Save")
    expect(panel.get_by_role("alert")).to_contain_text("Line 4: Write “ends: well”")
    faults.clear()  # the browser complains of the refusal
    text.focus()
    page.keyboard.press("Control+End")
    for _ in "badly":
        page.keyboard.press("Backspace")
    page.keyboard.type("well\n- step: {step: 1, times: 1}")
    press(panel, "Save")
    expect(panel.get_by_role("button", name="Run this test")).to_be_visible()
    assert violations(page) == []

    press(panel, "Run all")
    row = panel.get_by_role("listitem").filter(has_text="One box is carried")
    expect(row).to_contain_text("Passed")
    shoot(page, "tests-passed")
    result = panel.get_by_role("region", name="Result")
    expect(result.get_by_role("listitem").first).to_have_text(re.compile("ends well"))
    press(panel, "All tests")
    expect(panel.get_by_text("Every step and every way through the program is taken by a test.")).to_be_visible()
    expect(page.get_by_title("taken in 1 test")).to_be_visible()
    shoot(page, "tests-coverage")
    assert violations(page) == []

    panel.get_by_label("Seeds", exact=True).select_option("20")
    press(panel, "Run all")
    expect(row).to_contain_text("Odds to fail", timeout=90_000)
    expect(row.get_by_title(re.compile("^0 of 20 seeds failed: 0%, 95 % range 0% to "))).to_be_visible()
    assert violations(page) == []
    shoot(page, "tests-odds")
    press(panel, "Try changes")
    changes = panel.get_by_role("region", name="What no test notices")
    expect(changes.get_by_text("There is nothing in the program to take out.")).to_be_visible(timeout=90_000)
    shoot(page, "tests-changes")

    program = program_named(page, "Tested from the keyboard")
    tell(page, f"/api/programs/{program}/versions", {"name": "Tested"})
    page.goto(f"{page.url.split('/programs/')[0]}/sites/painting-factory/history/{program}")
    last = wait_for(
        "tests of a version that was named",
        lambda: (last := ask(page, f"/api/programs/{program}/tests")["last"])["by_itself"] and last,
        60.0,
    )
    assert (last["number"], last["passed"], last["total"]) == (1, 1, 1)
    expect(page.get_by_text("1 of 1 test passes")).to_be_visible()
    shoot(page, "tests-history")
