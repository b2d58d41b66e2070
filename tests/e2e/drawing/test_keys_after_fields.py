"""A field never eats the drawing's keys: Enter settles it, Esc takes its change back, both give the map the keys."""

from __future__ import annotations

import re
from typing import Any

import pytest
from playwright.sync_api import Locator, Page, Route, expect

from tests.e2e.conftest import SignIn
from tests.e2e.screens import ask, chip, open_program, saved, the_map, write_program
from tests.kit.waiting import PATIENCE_S, wait_for

pytestmark = pytest.mark.browser
WAIT_S = PATIENCE_S

EVERY_FIELD = """class Task(object):
    def new_task(self):
        self.curing_oven.cure_paint(4)
        self.notify("Next", level="info")
        self.wait(60)
        self.count = 3
        if self.curing_oven.temperature > 40:
            self.curing_oven.cure_paint(4)

    def run(self, ctx):
        self.curing_oven = ctx.get("curingOven01")
        self.new_task()
"""


def document(page: Page) -> dict[str, Any]:
    saved(page)
    found = re.search(r"/programs/[^/]+$", page.url)
    assert found is not None
    answer: dict[str, Any] = ask(page, f"/api{found[0]}/document")
    return answer


def params(page: Page, kind: str) -> dict[str, Any]:
    (step,) = (each for each in document(page)["steps"].values() if each["kind"] == kind)
    return dict(step["params"])


def panel(page: Page) -> Locator:
    return page.get_by_role("complementary", name="Selected step")


def every_tool_answers(page: Page) -> None:
    """Type each tool's letter, and see that it is taken and nothing is written."""
    buttons = page.get_by_role("toolbar", name="Tools").locator("button[aria-keyshortcuts]")
    letters: list[str] = buttons.evaluate_all("(all) => all.map((each) => each.getAttribute('aria-keyshortcuts'))")
    assert {"M", "P", "W", "I", "N", "Z"} < set(letters)
    for letter in letters:
        if letter in "FVH.":  # F opens a dialog, the dot a list; V and H draw nothing
            continue
        page.keyboard.press(letter.lower())
        pressed = page.get_by_role("toolbar", name="Tools").locator("button[aria-pressed=true]")
        expect(pressed).to_have_attribute("aria-keyshortcuts", letter)
        page.keyboard.press("Escape")
        expect(pressed).to_have_attribute("aria-keyshortcuts", "V")


def test_each_kind_of_field_gives_the_keys_back(sign_in: SignIn) -> None:
    page = sign_in("author")
    write_program(page, "Keys after fields", EVERY_FIELD)
    page.get_by_role("banner").get_by_label("Name of the program").click()
    page.keyboard.press("Enter")
    every_tool_answers(page)
    chip(page, "3, Wait").click()
    panel(page).get_by_label("Time", exact=True).fill("90")
    page.keyboard.press("Enter")
    every_tool_answers(page)
    assert params(page, "wait") == {"duration": 90}
    chip(page, "2, Notify").click()
    panel(page).get_by_label("Message", exact=True).fill("box")
    page.keyboard.press("Enter")
    every_tool_answers(page)
    panel(page).get_by_text("Warning", exact=True).click()
    every_tool_answers(page)
    assert params(page, "notify") == {"message": "box", "level": "warning"}
    chip(page, "4, Set").click()
    panel(page).get_by_label("Variable", exact=True).fill("boxes")
    page.keyboard.press("Enter")
    every_tool_answers(page)
    assert params(page, "set") == {"variable": "boxes", "value": 3}
    chip(page, "5, If").click()
    panel(page).get_by_role("combobox", name="Comparison").click()
    page.get_by_role("option", name="<", exact=True).click()
    every_tool_answers(page)
    panel(page).get_by_role("combobox", name="Reading").click()
    page.keyboard.type("door")
    page.keyboard.press("ArrowDown")
    page.keyboard.press("Enter")
    every_tool_answers(page)
    assert params(page, "if")["condition"]["op"] == "<"


def test_escape_takes_a_fields_change_back_and_ctrl_z_undoes_the_drawing(sign_in: SignIn) -> None:
    page = sign_in("author")
    write_program(page, "Taken back", EVERY_FIELD)
    expect(chip(page, "5, If")).to_be_visible()
    before = document(page)
    for step, field in (("3, Wait", "Time"), ("2, Notify", "Message"), ("4, Set", "Variable")):
        chip(page, step).click()
        box = panel(page).get_by_label(field, exact=True)
        was = box.input_value()
        box.press_sequentially("7")
        page.keyboard.press("Escape")
        if box.evaluate("(box) => box === document.activeElement"):  # the first one closed its list
            page.keyboard.press("Escape")
        expect(box).to_have_value(was)
        expect(box).not_to_be_focused()
    assert document(page)["steps"] == before["steps"]
    page.keyboard.press("Escape")
    chip(page, "3, Wait").click()
    page.keyboard.press("Delete")
    expect(chip(page, "3, Wait")).to_have_count(0)
    chip(page, "2, Notify").click()
    panel(page).get_by_label("Message", exact=True).press_sequentially("7")
    page.keyboard.press("Escape")
    page.keyboard.press("Control+z")
    expect(chip(page, "3, Wait")).to_be_visible()
    assert document(page)["steps"] == before["steps"]


def test_a_value_that_is_typed_slowly_is_one_entry_to_undo_also_while_somebody_else_edits(sign_in: SignIn) -> None:
    author, admin = sign_in("author"), sign_in("admin")
    write_program(author, "Typed slowly", EVERY_FIELD)
    saved(author)
    open_program(admin, "Typed slowly")
    chip(author, "3, Wait").click()
    time = panel(author).get_by_label("Time", exact=True)
    time.select_text()
    author.keyboard.type("9")
    wait_for("the first digit", lambda: params(author, "wait") == {"duration": 9}, WAIT_S)
    chip(admin, "2, Notify").click()
    panel(admin).get_by_label("Message", exact=True).fill("meanwhile")
    admin.keyboard.press("Enter")
    wait_for("the other's message", lambda: params(author, "notify")["message"] == "meanwhile", WAIT_S)
    author.keyboard.type("0")
    wait_for("the second digit", lambda: params(author, "wait") == {"duration": 90}, WAIT_S)
    author.keyboard.press("Enter")
    author.keyboard.press("Control+z")
    wait_for("the value of before", lambda: params(author, "wait") == {"duration": 60}, WAIT_S)
    assert params(author, "notify")["message"] == "meanwhile"
    expect(time).to_have_value("60")
    author.keyboard.press("Control+Shift+z")
    wait_for("the whole value again", lambda: params(author, "wait") == {"duration": 90}, WAIT_S)


def test_what_is_typed_before_a_window_is_there_stands_in_its_field(sign_in: SignIn) -> None:
    page, held = sign_in("author"), list[Route]()
    write_program(page, "Typed ahead", EVERY_FIELD)
    wait_for("the program", lambda: len(document(page)["steps"]) == 6, WAIT_S)
    page.route(re.compile(r"/assets/Palette-[^/]*\.js"), lambda route: held.append(route))
    page.reload()
    saved(page)
    the_map(page).focus()
    page.keyboard.press("Control+k")
    page.keyboard.type("wait")
    page.keyboard.press("Enter")
    wait_for("the palette's script", lambda: page.wait_for_timeout(50) or held, WAIT_S)
    for each in held:
        each.continue_()
    expect(page.get_by_role("combobox", name="Search or jump to")).to_have_value("wait")
    page.keyboard.press("Escape")
    expect(page.get_by_role("dialog")).to_have_count(0)
    the_map(page).focus()
    for keys in ("Control+a", "Control+g"):
        page.keyboard.press(keys)
    page.keyboard.type("carry")
    expect(page.get_by_role("dialog").get_by_role("textbox").first).to_have_value("carry")
    assert len(document(page)["steps"]) == 6
