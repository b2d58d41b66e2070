"""Tests beside a program, by keyboard alone: written, mended where the parser says so, carried out, on the map."""

from __future__ import annotations

import re
from typing import Any

import pytest
from playwright.sync_api import Locator, Page, expect

from tests.e2e.conftest import SignIn, make_member
from tests.e2e.screens import ask, draw_task, make_program, program_named, saved, shoot, tell, violations
from tests.kit.demo import Demo
from tests.kit.programs import document, step
from tests.kit.waiting import wait_for

pytestmark = pytest.mark.browser
WRONG = "name: One box is carried\nwhen: {driver: kinematic}\nthen:\n- ends: badly"


def open_tests(page: Page) -> Locator:
    page.get_by_role("tab", name="Tests").press("Enter")
    return page.get_by_role("tabpanel", name="Tests")


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
    panel.get_by_role("radio", name="Text").press("Space")
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
    expect(panel.get_by_text("Every step and every way through the program is covered by a test.")).to_be_visible()
    expect(page.get_by_title("covered by 1 test")).to_be_visible()
    shoot(page, "tests-coverage")
    assert violations(page) == []

    panel.get_by_label("Seeds", exact=True).select_option("20")
    press(panel, "Run all")
    expect(row).to_contain_text("Failure rate", timeout=180_000)
    expect(row.get_by_title(re.compile("^0 of 20 seeds failed: 0%, 95 % interval 0% to "))).to_be_visible()
    assert violations(page) == []
    shoot(page, "tests-odds")
    press(panel, "Try changes")
    changes = panel.get_by_role("region", name="What no test notices")
    expect(changes.get_by_text("There is nothing in the program to take out.")).to_be_visible(timeout=180_000)
    shoot(page, "tests-changes")

    program = program_named(page, "Tested from the keyboard")
    tell(page, f"/api/programs/{program}/versions", {"name": "Tested"})
    page.goto(f"{page.url.split('/programs/')[0]}/sites/painting-factory/history/{program}")
    last = wait_for(
        "tests of a version that was named",
        lambda: (last := ask(page, f"/api/programs/{program}/tests")["last"])["by_itself"] and last,
    )
    assert (last["number"], last["passed"], last["total"]) == (1, 1, 1)
    expect(page.get_by_text("1 of 1 test passes")).to_be_visible()
    shoot(page, "tests-history")


def choose(page: Page, field: Locator, option: str) -> None:
    """Choose in a list by typing a part of it."""
    field.focus()
    page.keyboard.type(option)
    page.get_by_role("option").filter(has_text=option).first.click()


def line(panel: Locator, part: str, number: int) -> Locator:
    """Find a line of a part of the form."""
    return panel.get_by_role("region", name=part).get_by_role("listitem", name=f"Line {number}", exact=True)


def add(page: Page, panel: Locator, button: str, kind: str) -> None:
    """Add a line to the form by the keyboard."""
    panel.get_by_role("button", name=button).press("Enter")
    page.get_by_role("menuitem", name=kind, exact=True).press("Enter")


def test_a_test_is_filled_in_without_writing_text_and_its_fault_strikes(sign_in: SignIn) -> None:
    page = sign_in("author")
    make_program(page, "Tested with a form")
    draw_task(page)
    saved(page)
    panel = open_tests(page)
    press(panel, "New test")
    page.get_by_role("menuitem", name="Empty").press("Enter")
    panel.get_by_role("textbox", name="Name", exact=True).fill("The robot loses its box")
    add(page, panel, "Something that is given", "A machine holds something")
    given = line(panel, "Given", 1)
    choose(page, given.get_by_role("combobox", name="Device"), "Item Inventory")
    given.get_by_role("textbox", name="How many").fill("24")
    given.get_by_role("combobox", name="What").fill("box")
    page.keyboard.press("Escape")
    press(panel, "Add a fault")
    fault = panel.get_by_role("group", name="Fault 1")
    shoot(page, "test-form")
    fault.get_by_role("combobox", name="What goes wrong").focus()
    page.keyboard.press("ArrowDown")
    page.get_by_role("option", name="Something lies on the floor").click()
    for field, metres in (("x", "10"), ("y", "-7.7"), ("Size", "2")):
        fault.get_by_role("textbox", name=f"{field} (m)").fill(metres)
    add(page, panel, "Something that holds", "A step is carried out")
    choose(page, line(panel, "Then", 2).get_by_role("combobox", name="Step"), "Pick")
    assert violations(page) == []
    shoot(page, "test-form-filled")
    add(page, panel, "Something that holds", "It fails")
    press(panel, "Save")
    expect(panel.get_by_role("button", name="Save")).to_have_count(0)
    unfinished = line(panel, "Then", 3)
    expect(unfinished).to_be_visible()
    press(panel, "All tests")
    panel.get_by_role("button", name="The robot loses its box").click()
    expect(unfinished).to_be_visible()
    press(panel, "Run this test")
    ends, picks = (line(panel, "Then", number) for number in (1, 2))
    expect(ends.get_by_label("Does not hold")).to_be_visible(timeout=180_000)
    expect(picks.get_by_label("Holds", exact=True)).to_be_visible()
    shoot(page, "test-form-failed")
    assert violations(page) == []

    panel.get_by_role("radio", name="Text").press("Space")
    text = panel.get_by_role("textbox", name="The test as YAML")
    expect(text).to_contain_text("fault: obstacle")
    text.focus()
    page.keyboard.press("Control+End")
    page.keyboard.type("# in the morning things lie about\n")
    panel.get_by_role("radio", name="Form").press("Space")
    expect(fault.get_by_role("combobox", name="What goes wrong")).to_have_value("Something lies on the floor")
    press(fault, "Remove fault 1")
    press(panel, "Save")
    program = program_named(page, "Tested with a form")
    [kept] = ask(page, f"/api/programs/{program}/tests")["tests"]
    written = ask(page, f"/api/programs/{program}/tests/{kept['id']}")["text"]
    assert "fault" not in written
    assert "# in the morning things lie about" in written
    assert "box: 24" in written
    press(panel, "Run this test")
    expect(ends.get_by_label("Holds", exact=True)).to_be_visible(timeout=180_000)


def test_what_is_wrong_with_a_test_is_told_in_the_reader_s_language(sign_in: SignIn, faults: list[str]) -> None:
    page = sign_in("author", at=make_program(sign_in("author"), "Gestörter Test"), language="de")
    panel = open_tests(page)
    press(panel, "Neuer Test")
    page.get_by_role("menuitem", name="Leer").press("Enter")
    shoot(page, "test-form-german")
    panel.get_by_role("radio", name="Text").press("Space")
    text = panel.get_by_role("textbox", name="Der Test als YAML")
    text.focus()
    page.keyboard.press("Control+a")
    page.keyboard.insert_text("name: Zu lang\nthen:\n  - within_s: ewig\n")
    told = "„within_s“ ist eine Zahl, nicht 'ewig'."
    expect(panel.get_by_role("status").filter(has_text=f"Zeile 3: {told}")).to_be_visible()
    expect(text).to_contain_text(told)
    shoot(page, "test-text-german")
    press(panel, "Speichern")
    expect(panel.get_by_role("alert")).to_have_text(f"Zeile 3: {told}")
    assert all("422" in fault for fault in faults)
    faults.clear()
    assert violations(page) == []


def missed(page: Page) -> str:
    """Make a program with a check that its only test does not look at, try its changes, and return its address."""
    steps = {
        "choice": step("if", condition={"op": ">", "args": [2, 1]}),
        "pause": step("wait", ("choice", "then"), duration=5),
    }
    program = tell(page, "/api/sites/painting-factory/programs", {"name": "With a check"})["id"]
    base = re.sub(r"(https?://[^/]+).*", r"\1", page.url)
    path = f"/api/programs/{program}"
    tag = page.request.get(f"{base}{path}/document").headers["etag"]
    headers = {"X-CSRFToken": ask(page, "/api/me")["csrf"], "If-Match": tag}
    put = page.request.put(f"{base}{path}/document", data={**document(steps), "format": 2}, headers=headers)
    assert put.status == 204, put.text()
    tell(page, f"{path}/tests", {"text": "name: It ends\nthen:\n- ends: well\n"})
    tell(page, f"{path}/test-runs", {"changes": True})
    wait_for("what came of the changes", lambda: ask(page, f"{path}/tests")["changes"])
    return f"{base}/programs/{program}"


def test_what_is_meant_so_is_set_aside_for_all_until_the_step_is_changed(
    sign_in: SignIn, demo: Demo, signed_in: dict[str, Any]
) -> None:
    signed_in["reader"] = make_member(demo, "viewer", "Rita Reads")
    page, other, reader = sign_in("author"), sign_in("admin"), sign_in("reader")
    address = missed(page)
    panels = []
    for each in (page, other, reader):
        each.goto(address)
        panels.append(open_tests(each))
    mine, theirs, seen = (panel.get_by_role("region", name="What no test notices") for panel in panels)
    for region in (mine, theirs, seen):
        expect(region.get_by_text("0 of 3 noticed")).to_be_visible()
    expect(seen.get_by_role("button", name=re.compile("intended"))).to_have_count(0)
    turned = re.compile("^This is intended: .* if the condition is turned round$")
    mine.get_by_role("button", name=turned).press("Enter")
    for region in (mine, theirs, seen):
        expect(region.get_by_text("1 is intended")).to_be_visible()
    expect(theirs.get_by_role("button", name=turned)).to_have_count(0)
    shoot(page, "tests-meant")
    assert violations(page) == []
    theirs.locator("summary").press("Enter")
    expect(theirs.get_by_text(re.compile("Marked by .*; holds until the step is changed."))).to_be_visible()
    shoot(other, "tests-meant-open")
    assert violations(other) == []
    theirs.get_by_role("button", name=re.compile("^This is not intended: ")).press("Enter")
    for region in (mine, theirs, seen):
        expect(region.get_by_text("1 is intended")).to_have_count(0)
    expect(mine.get_by_role("button", name=turned)).to_be_visible()
