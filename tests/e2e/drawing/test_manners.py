"""One table of commands behind keys, menus, palette and short list: each way ends in the same operation."""

from __future__ import annotations

import re
from typing import Any

import pytest
from playwright.sync_api import Locator, Page, expect

from tests.e2e.conftest import SignIn
from tests.e2e.screens import (
    ask,
    chip,
    machine,
    make_program,
    opened,
    saved,
    the_map,
    violations,
    write_program,
)
from tests.kit.waiting import wait_for

pytestmark = pytest.mark.browser

TWO_STEPS = """class Task(object):
    def new_task(self):
        self.curing_oven.cure_paint(4)
        self.wait(60)

    def run(self, ctx):
        self.curing_oven = ctx.get("curingOven01")
        self.new_task()
"""
FROM_ELSEWHERE = """class Task(object):
    def new_task(self):
        self.old_kiln.cure_paint(7)
        self.lamp.glow(1)

    def run(self, ctx):
        self.old_kiln = ctx.get("oldKiln07")
        self.lamp = ctx.get("lamp99")
        self.new_task()
"""


def steps(page: Page) -> dict[str, Any]:
    saved(page)
    found = re.search(r"/programs/[^/]+$", page.url)
    assert found is not None
    answer: dict[str, Any] = ask(page, f"/api{found[0]}/document")
    return dict(answer["steps"])


def kinds(page: Page) -> list[str]:
    return sorted(str(step["kind"]) for step in steps(page).values())


def palette(page: Page, text: str) -> Locator:
    """Open the palette, type, and return what is found."""
    page.keyboard.press("Control+k")
    page.get_by_role("combobox", name="Search or jump to").fill(text)
    return page.get_by_role("listbox", name="Results").get_by_role("option")


def bare_floor(page: Page) -> tuple[float, float]:
    """A point of the window where the floor is bare."""
    box = the_map(page).bounding_box()
    assert box is not None
    return box["x"] + box["width"] * 0.28, box["y"] + box["height"] * 0.44


def test_the_palette_draws_what_is_said_finds_in_both_languages_and_says_why_not(sign_in: SignIn) -> None:
    page = sign_in("author")
    make_program(page, "Said in the palette")
    opened(page)
    expect(palette(page, "add cure at oven").first).to_contain_text("at Curing Oven")
    page.keyboard.press("Enter")
    expect(chip(page, "1, Operate")).to_be_visible()
    (step,) = steps(page).values()
    assert (step["kind"], step["params"]["device"], step["params"]["method"]) == (
        "operate",
        {"device": "curingOven01"},
        "curePaint",
    )
    expect(palette(page, "add cure at inventory").first).to_contain_text("does not do this")
    page.keyboard.press("Escape")
    expect(palette(page, "rückgängig").first).to_contain_text("Undo")
    page.keyboard.press("Enter")
    expect(chip(page, "1, Operate")).to_have_count(0)
    refused = palette(page, "tidy up").first
    expect(refused).to_have_attribute("aria-disabled", "true")
    expect(refused).to_contain_text("Select at least two steps first.")
    page.keyboard.press("Escape")
    expect(palette(page, "to the devices").first).to_be_hidden()
    page.keyboard.press("Escape")
    palette(page, "devices").filter(has_text="Page").first.click()
    expect(page.get_by_role("heading", level=1, name="Devices")).to_be_visible()
    # What was used last comes first, on every page.
    page.keyboard.press("Control+k")
    found = page.get_by_role("listbox", name="Results").get_by_role("option")
    expect(found.first).to_contain_text("Devices")
    assert violations(page) == []


def test_the_short_list_draws_at_the_pointer_what_the_machine_there_can_do_first(sign_in: SignIn) -> None:
    page = sign_in("author")
    make_program(page, "Short list")
    opened(page)
    x, y = bare_floor(page)
    page.mouse.dblclick(x, y)
    short = page.get_by_role("dialog", name="Add a step")
    short.get_by_role("combobox").fill("notif")
    page.keyboard.press("Enter")
    expect(chip(page, "1, Notify")).to_be_visible()
    page.keyboard.press("Escape")
    machine(page, "Curing Oven").dblclick()
    expect(short.get_by_role("option").first).to_contain_text("At Curing Oven")
    short.get_by_role("option").first.click()
    expect(chip(page, "2, Operate")).to_be_visible()
    page.keyboard.press("Escape")
    page.mouse.move(x, y + 90)
    page.keyboard.press("/")
    assert violations(page) == []
    page.keyboard.type("wait")
    page.keyboard.press("Enter")
    expect(chip(page, "3, Wait")).to_be_visible()
    assert kinds(page) == ["notify", "operate", "wait"]


def test_menus_keys_and_the_rail_end_in_the_same_edits(sign_in: SignIn) -> None:
    page = sign_in("author")
    make_program(page, "Menus")
    opened(page)
    for key in ("n", "Enter", "Escape"):
        page.keyboard.press(key)
    chip(page, "1, Notify").click(button="right")
    page.get_by_role("menuitem", name=re.compile("^Duplicate")).click()
    expect(chip(page, "2, Notify")).to_be_visible()
    page.keyboard.press("Control+d")
    expect(chip(page, "3, Notify")).to_be_visible()
    page.keyboard.press("Shift+F10")
    page.get_by_role("menuitem", name=re.compile("^Delete")).click()
    expect(chip(page, "3, Notify")).to_have_count(0)
    page.keyboard.press("Control+a")
    before = {key: step["pos"] for key, step in steps(page).items()}
    panel = page.get_by_role("complementary", name="Selected step")
    panel.get_by_role("button", name="Align top").click()
    after = {key: step["pos"] for key, step in steps(page).items()}
    assert len({pos[1] for pos in after.values()}) == 1 < len({pos[1] for pos in before.values()})
    panel.get_by_label("Kind of message").click()
    page.get_by_role("option", name="Warning").click()
    assert {step["params"]["level"] for step in steps(page).values()} == {"warning"}
    page.keyboard.press("Control+z")
    page.keyboard.press("Control+z")
    restored = steps(page)
    assert {key: step["pos"] for key, step in restored.items()} == before
    assert {step["params"]["level"] for step in restored.values()} == {"info"}
    machine(page, "Curing Oven").click(button="right")
    page.get_by_role("menuitem", name="Drive a robot here").click()
    expect(chip(page, "3, Move")).to_be_visible()
    page.keyboard.press("Escape")
    page.keyboard.press("Escape")
    x, y = bare_floor(page)
    rail = page.get_by_role("toolbar", name="Tools")
    rail.get_by_role("button", name="Notify", exact=True).hover()
    page.mouse.down()
    page.mouse.move(x - 40, y - 20)
    page.mouse.move(x, y)
    page.mouse.up()
    expect(chip(page, "4, Notify")).to_be_visible()
    assert kinds(page) == ["move", "notify", "notify", "notify"]


def test_keys_are_listed_changed_and_letters_switched_off(sign_in: SignIn) -> None:
    page = sign_in("author")
    make_program(page, "Own keys")
    opened(page)
    page.keyboard.press("?")
    sheet = page.get_by_role("dialog", name="Shortcuts")
    sheet.get_by_role("button", name="Change the key of “Notify”").click()
    page.keyboard.press("m")
    expect(sheet).to_contain_text("M means “Move” already.")
    page.keyboard.press("Shift+M")
    expect(sheet.get_by_role("listitem").filter(has_text="Notify")).to_contain_text("Shift+M")
    page.keyboard.press("Escape")
    pressed = page.get_by_role("toolbar", name="Tools").locator("button[aria-pressed=true]")
    page.keyboard.press("Shift+M")
    expect(pressed).to_have_attribute("aria-label", "Notify")
    page.keyboard.press("Escape")
    page.reload()
    opened(page)
    page.keyboard.press("Shift+M")
    expect(pressed).to_have_attribute("aria-label", "Notify")
    page.keyboard.press("Escape")
    palette(page, "shortcuts").first.click()
    sheet.get_by_role("switch").click(force=True)
    assert violations(page) == []
    page.keyboard.press("Escape")
    expect(sheet).to_have_count(0)
    page.keyboard.press("m")
    page.keyboard.press("Shift+M")
    expect(pressed).to_have_attribute("aria-label", "Select")
    palette(page, "shortcuts").first.click()
    sheet.get_by_role("button", name="All keys as usual").click()
    expect(sheet.get_by_role("button", name="All keys as usual")).to_have_count(0)


def test_steps_are_copied_as_script_and_unknown_devices_are_asked_for(sign_in: SignIn) -> None:
    page = sign_in("author")
    write_program(page, "Copied", TWO_STEPS)
    chip(page, "1, Operate").click()
    saved(page)
    page.evaluate("navigator.clipboard.writeText('')")
    page.keyboard.press("Control+c")
    copied = wait_for("what is copied", lambda: str(page.evaluate("navigator.clipboard.readText()")))
    assert copied.splitlines() == [line for line in TWO_STEPS.splitlines() if "wait" not in line]
    page.keyboard.press("Control+v")
    expect(chip(page, "2, Operate")).to_be_visible()
    page.evaluate("text => navigator.clipboard.writeText(text)", FROM_ELSEWHERE)
    page.keyboard.press("Control+v")
    asked = page.get_by_role("dialog", name="Who stands in here?")
    expect(asked.get_by_label("oldKiln07")).to_have_value("Curing Oven")
    expect(asked.get_by_label("lamp99")).to_have_value("Leave it open")
    assert violations(page) == []
    asked.get_by_role("button", name="Insert the steps").click()
    expect(chip(page, "4, Operate")).to_be_visible()
    pasted = [step["params"] for step in steps(page).values() if step["params"].get("method") in ("glow", "curePaint")]
    assert sorted((each["method"], each.get("device", {}).get("device", "")) for each in pasted) == [
        ("curePaint", "curingOven01"),
        ("curePaint", "curingOven01"),
        ("curePaint", "curingOven01"),
        ("glow", ""),
    ]
    page.keyboard.press("Control+z")
    expect(chip(page, "4, Operate")).to_have_count(0)


def test_a_machine_is_looked_at_tried_and_found_in_the_program(sign_in: SignIn) -> None:
    page = sign_in("author")
    write_program(page, "Looked at", TWO_STEPS)
    expect(chip(page, "1, Operate")).to_be_visible()
    page.keyboard.press("Escape")
    machine(page, "Curing Oven").click()
    panel = page.get_by_role("complementary", name="Machine or robot")
    expect(panel.get_by_role("heading", name="Curing Oven")).to_be_visible()
    expect(panel).to_contain_text("temperature")
    assert violations(page) == []
    panel.get_by_role("button", name=re.compile("^Try curePaint")).click()
    page.get_by_role("dialog").get_by_role("button", name="Start").wait_for()
    page.keyboard.press("m")
    expect(page.get_by_role("toolbar", name="Tools").locator("button[aria-pressed=true]")).to_have_attribute(
        "aria-label", "Select"
    )
    page.keyboard.press("Escape")
    panel.get_by_role("button", name=re.compile("1, Operate")).click()
    expect(page.get_by_role("complementary", name="Selected step")).to_contain_text("Operate")
    page.keyboard.press("Control+f")
    find = page.get_by_role("dialog", name="Find in this program")
    find.get_by_role("textbox").fill("oven")
    expect(find.get_by_role("button", name="Curing Oven used in one step", exact=True)).to_be_visible()
