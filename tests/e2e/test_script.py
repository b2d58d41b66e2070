"""The script beside the drawing, written by one person while another draws."""

from __future__ import annotations

import re

import pytest
from playwright.sync_api import Locator, Page, expect

from tests.e2e.conftest import SignIn
from tests.e2e.screens import (
    ask,
    chip,
    draw_task,
    editor,
    make_program,
    open_program,
    open_script,
    same_steps,
    script_lines,
    steps_in_list,
    the_map,
    violations,
)
from tests.kit.waiting import wait_for

pytestmark = pytest.mark.browser
CURE = "        self.curing_oven.cure_paint("


def strip(page: Page) -> Locator:
    return page.get_by_role("status").filter(has_text="last valid program")


def type_behind(page: Page, line: str, text: str) -> None:
    """Put the cursor at the end of a line of the script and type a new line."""
    editor(page).locator(".cm-line").filter(has_text=line).first.click()
    page.keyboard.press("End")
    page.keyboard.press("Enter")
    page.keyboard.insert_text(text)


def document(page: Page) -> dict[str, dict[str, object]]:
    found: dict[str, dict[str, object]] = ask(page, f"/api{path_of(page)}/document")["steps"]
    return found


def path_of(page: Page) -> str:
    found = re.search(r"/programs/[^/]+$", page.url)
    assert found is not None
    return found[0]


def test_what_an_author_types_is_drawn(sign_in: SignIn) -> None:
    page = sign_in("author")
    make_program(page, "Typed")
    draw_task(page)
    open_script(page)
    expect(editor(page)).to_contain_text("self.robot.drop(")
    before = document(page)
    type_behind(page, "self.robot.drop(", "self.wait(60)")
    expect(chip(page, "2, Wait")).to_be_visible()
    type_behind(page, "self.wait(60)", "self.wait(until=self.painting_machine.location == 1)")
    expect(strip(page)).to_be_visible()
    page.keyboard.press("Control+z")
    expect(strip(page)).to_have_count(0)
    assert "        self.wait(60)" in script_lines(page)
    for name, step in document(page).items():
        assert step["kind"] == "wait" or step == before[name]


def test_a_device_that_is_completed_is_given_in_run(sign_in: SignIn) -> None:
    page = sign_in("author")
    make_program(page, "Completed")
    draw_task(page)
    open_script(page)
    expect(editor(page)).to_contain_text("self.robot.drop(")
    type_behind(page, "self.robot.drop(", "self.curing")
    page.keyboard.type("_")
    page.get_by_role("option", name=re.compile("curing_oven")).click()
    page.keyboard.insert_text(".cure_paint(10)")
    expect(chip(page, "2, Operate, Cure paint")).to_be_visible()
    assert '        self.curing_oven = ctx.get("curingOven01")' in script_lines(page)


def test_an_invalid_script_marks_the_place_and_leaves_the_map(sign_in: SignIn) -> None:
    page = sign_in("author")
    make_program(page, "Invalid")
    draw_task(page)
    open_script(page)
    expect(editor(page)).to_contain_text("self.robot.drop(")
    type_behind(page, "self.robot.drop(", "import os")
    expect(strip(page)).to_contain_text("Line 7, column 9:")
    expect(editor(page).locator(".vipo-script-error")).to_have_text("import os")
    expect(editor(page)).to_have_attribute("aria-invalid", "true")
    assert len(document(page)) == 1
    assert violations(page) == []
    page.get_by_role("tab", name="Steps").click()
    open_script(page)
    expect(editor(page)).to_contain_text("import os")
    page.get_by_role("button", name="Go back to what the map shows").click()
    expect(strip(page)).to_have_count(0)
    expect(editor(page)).not_to_contain_text("import os")


def test_one_types_while_another_draws_and_nothing_is_lost(sign_in: SignIn) -> None:
    author, admin = sign_in("author"), sign_in("admin")
    make_program(author, "Both at once")
    draw_task(author)
    open_program(admin, "Both at once")
    expect(chip(admin, "1, Pick-and-Drop")).to_be_visible()
    open_script(author)
    expect(editor(author)).to_contain_text("self.robot.drop(")
    type_behind(author, "self.robot.drop(", "self.wait(60")
    expect(strip(author)).to_be_visible()
    draw_task(admin, "Paint Inventory", "Painting Machine", "1 \u00d7 can")
    expect(editor(author)).to_contain_text("self.robot.move(self.paint_inventory.location)")
    expect(editor(author)).to_contain_text("self.wait(60")
    author.keyboard.insert_text(")")
    expect(chip(admin, "3, Wait")).to_be_visible()
    wanted = ["1, Pick", "2, Pick", "3, Wait"]
    wait_for("all three", lambda: [step[:7] for step in steps_in_list(admin)] == wanted)
    same_steps(author, admin)


def test_the_keyboard_gets_out_of_the_script_and_the_step_follows_the_cursor(sign_in: SignIn) -> None:
    page = sign_in("author")
    make_program(page, "Keys")
    draw_task(page)
    open_script(page)
    expect(editor(page)).to_contain_text("self.robot.drop(")
    page.get_by_role("tab", name="Steps").focus()
    type_behind(page, "self.robot.drop(", "self.wait(60)")
    expect(chip(page, "2, Wait")).to_be_visible()
    page.keyboard.press("ArrowUp")
    expect(editor(page).locator(".vipo-line-selected")).to_have_count(4)
    page.keyboard.press("ArrowDown")
    expect(editor(page).locator(".vipo-line-selected")).to_have_text(re.compile(r"self\.wait\(60\)"))
    page.keyboard.press("Escape")
    expect(page.get_by_role("tab", name="Script")).to_be_focused()
    expect(editor(page)).not_to_be_focused()


def test_script_pasted_on_the_map_becomes_steps(sign_in: SignIn) -> None:
    page = sign_in("author")
    make_program(page, "Pasted")
    draw_task(page)
    expect(editor(page)).to_contain_text("self.robot.drop(")
    page.evaluate("navigator.clipboard.writeText('self.wait(7)\\nself.curing_oven.cure_paint(4)')")
    the_map(page).focus()
    page.keyboard.press("Control+v")
    expect(chip(page, "2, Wait")).to_be_visible()
    expect(chip(page, "3, Operate, Cure paint")).to_be_visible()
    page.keyboard.press("Control+z")
    expect(chip(page, "2, Wait")).to_have_count(0)
    expect(chip(page, "1, Pick-and-Drop")).to_be_visible()
