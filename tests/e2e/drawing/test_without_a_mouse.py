"""The whole painting program is drawn by keyboard alone, is there after a reload, and is undone as by a pointer."""

from __future__ import annotations

import re

import pytest
from playwright.sync_api import Locator, Page, expect

from tests.e2e.conftest import SignIn
from tests.e2e.screens import expect_steps, make_program, saved, violations
from tests.kit.files import ROOT

pytestmark = pytest.mark.browser
GOLDEN = ROOT / "tests" / "cases" / "accessibility"
DRAWN = [
    "1, Pick-and-Drop, 1 \u00d7 can from Paint Inventory to Paint Mixer A",
    "2, Parallel",
    "2a, Pick-and-Drop, 1 \u00d7 box from Item Inventory to Painting Machine, inside Parallel 2",
    "2b, Operate, Mix paint · 3 min at Paint Mixer A, inside Parallel 2",
    "3, Pick-and-Drop, 1 \u00d7 can from Paint Mixer A to Painting Machine",
    "4, Operate, Paint · 2 min at Painting Machine",
    "5, Pick-and-Drop, 1 \u00d7 box from Painting Machine to Curing Oven",
    "6, Operate, Cure paint · 4 min at Curing Oven",
    "7, Move, Move to Goods in",
]

FLOW = [
    "1, If, temperature > 60",
    "1a, Notify, It is hot, inside If 1",
    "1b, Notify, It is cold, inside If 1",
    "2, While, temperature > 60",
    "2a, Wait, wait 5 s, inside While 2",
    "3, Try",
    "3a, Operate, Paint \u00b7 2 min at Painting Machine, inside Try 3",
    "3c, Notify, It did not paint, inside Try 3",  # a try's catches are lettered from c
]


def keys(page: Page, *pressed: str) -> None:
    for each in pressed:
        page.keyboard.press(each)


def said(page: Page, text: str) -> None:
    expect(page.locator("[data-announcer] > div").filter(has_text=text)).to_have_count(1)


def choose(page: Page, question: str, name: str) -> None:
    """Type a machine's name where the gesture asks for one."""
    expect(page.get_by_role("combobox", name=question)).to_be_focused()
    page.keyboard.type(name)
    page.keyboard.press("Enter")


def carry(page: Page, source: str, target: str) -> None:
    page.keyboard.press("p")
    choose(page, "Click where to pick from", source)
    choose(page, "Now click where to drop", target)
    expect(page.get_by_role("dialog", name="What to carry?").get_by_role("button").first).to_be_focused()
    page.keyboard.press("Enter")


def operate(page: Page, name: str, minutes: str) -> None:
    page.keyboard.press("o")
    choose(page, "Click the machine to operate", name)
    expect(page.get_by_label("time", exact=True)).to_be_focused()
    page.keyboard.type(minutes)
    page.keyboard.press("Enter")


def golden(page: Page, name: str) -> None:
    """Compare what the outline is for who listens with what was agreed on; a missing file is written, and fails."""
    tree = page.get_by_role("tree", name="Steps").aria_snapshot() + "\n"
    path = GOLDEN / f"{name}.yaml"
    if not path.exists():
        path.parent.mkdir(exist_ok=True)
        path.write_text(tree)
        pytest.fail(f"{path.name} was missing and is written: look it over, and run the test again.")
    assert tree == path.read_text()


def tab_to(page: Page, role: str, name: str) -> None:
    """Go on with Tab until something of this role has the focus whose name begins so."""
    for _ in range(120):
        page.keyboard.press("Tab")
        found = page.locator(":focus")
        if found.count() and found.get_attribute("role") == role:
            label = found.get_attribute("aria-label") or found.inner_text()
            if label.startswith(name):
                return
    pytest.fail(f"Tab leads to no {role} that begins with {name!r}")


def undo_button(page: Page, name: str) -> Locator:
    return page.get_by_role("group", name="Undo and redo").get_by_role("button", name=name)


def test_the_painting_program_is_drawn_by_keyboard_undone_and_reloaded(sign_in: SignIn) -> None:
    page = sign_in("author")
    make_program(page, "Without a mouse")
    first = page.get_by_role("region", name="Start with one task")
    expect(first).to_have_css("opacity", "1")
    tab_to(page, "group", "Paint Mixer B")  # it may stand behind that card
    expect(first).not_to_have_css("opacity", "1")
    draw_one_after_the_other(page)
    draw_a_parallel_before_all(page)
    move_the_first_steps_into_it(page)
    expect_steps(page, DRAWN)
    page.get_by_role("treeitem").last.focus()
    place_the_last_step(page)
    undo_and_redo_all(page)
    saved(page)
    page.reload()
    expect(page.get_by_role("tab", name="Steps")).to_be_visible()
    assert violations(page) == []
    page.get_by_role("tab", name="Steps").click()
    expect(page.get_by_role("treeitem")).to_have_count(len(DRAWN))
    expect_steps(page, DRAWN)
    expect(page.get_by_role("banner").get_by_role("button", name="Run", exact=True)).to_be_enabled()
    golden(page, "painting-outline")
    page.get_by_role("treeitem").first.focus()
    keys(page, "End", "Delete")
    expect(page.get_by_role("treeitem")).to_have_count(len(DRAWN) - 1)
    keys(page, "Control+z")
    expect(page.get_by_role("treeitem")).to_have_count(len(DRAWN))


def draw_one_after_the_other(page: Page) -> None:
    page.keyboard.press("Escape")
    carry(page, "paint inv", "paint mixer a")
    carry(page, "item", "painting")
    operate(page, "paint mixer a", "3")
    carry(page, "paint mixer a", "painting")
    operate(page, "painting", "2")
    carry(page, "painting", "curing")
    operate(page, "curing", "4")
    page.keyboard.press("m")
    choose(page, "Click where the robot goes", "goods")


def draw_a_parallel_before_all(page: Page) -> None:
    keys(page, "Escape", "l", "Enter")
    expect(page.get_by_role("complementary", name="Selected step")).to_contain_text("Step 9")
    keys(page, "x", "Home")
    said(page, "before 1 Pick-and-Drop")
    keys(page, "ArrowUp")
    said(page, "No more in this direction. before 1 Pick-and-Drop")
    keys(page, "ArrowDown")
    said(page, "after 1 Pick-and-Drop")
    keys(page, "Enter")
    expect(page.get_by_role("complementary", name="Selected step")).to_contain_text("Step 2")


def move_the_first_steps_into_it(page: Page) -> None:
    """Each by the words that are said, from the list of steps."""
    tab_to(page, "tab", "Steps")
    page.keyboard.press("Enter")
    tab_to(page, "treeitem", "2, Parallel")
    rows = page.get_by_role("treeitem")
    expect(rows).to_have_count(9)
    for row, up, words in (
        (2, 2, "inside 2 Parallel, branch “a”"),
        (3, 1, "inside 2 Parallel, branch “b”"),
    ):
        keys(page, "ArrowDown")
        expect(rows.nth(row)).to_be_focused()
        keys(page, "x", *["ArrowUp"] * up)
        said(page, words)
        keys(page, "Enter")
        expect(rows.nth(row)).to_have_attribute("aria-label", re.compile("inside Parallel 2"))
        expect(rows.nth(row)).to_be_focused()


def place_the_last_step(page: Page) -> None:
    rows = page.get_by_role("treeitem")
    keys(page, "Enter", "q", "g")
    said(page, "at Goods in")
    keys(page, "ArrowRight")
    said(page, "1.0 m right of Goods in")
    keys(page, "Shift+ArrowRight")
    said(page, "1.1 m right of Goods in")
    keys(page, "Enter")
    said(page, "Set down at")
    keys(page, "ArrowDown")
    said(page, "This is the last step.")
    expect(rows.last).to_be_focused()


def undo_and_redo_all(page: Page) -> None:
    """Eight steps drawn, three values, the Parallel, three moves and one placing: each is one entry."""
    undone = 0
    while undo_button(page, "Undo").is_enabled():
        keys(page, "Control+z")
        undone += 1
    assert undone == 16
    expect(page.get_by_role("heading", name="Start with one task")).to_be_visible()
    for _ in range(undone):
        keys(page, "Control+Shift+z")
    expect_steps(page, DRAWN)


def test_branches_are_drawn_by_keyboard_undone_and_reloaded(sign_in: SignIn) -> None:
    page = sign_in("author")
    make_program(page, "Branches without a mouse")
    keys(page, "Escape")
    decide(page, "i", "curing_oven.temperature > 60")
    keys(page, "b")
    notify_in(page, "If 1, branch \u201ctrue\u201d", "It is hot")
    choose_in_list(page, "1, If")
    keys(page, "b")
    notify_in(page, "If 1, branch \u201cfalse\u201d", "It is cold")
    keys(page, "Escape")
    decide(page, "w", "curing_oven.temperature > 60")
    keys(page, "b")
    next_goes(page, "inside While 2")
    keys(page, "u", "Enter")
    expect(page.get_by_label("Time", exact=True)).to_be_focused()
    page.keyboard.type("5")
    keys(page, "Enter", "Escape", "t", "Enter", "b", "b")
    notify_in(page, "Try 3, branch \u201ccatch\u201d", "It did not paint")
    choose_in_list(page, "3, Try")
    keys(page, "b")
    next_goes(page, "inside Try 3")
    operate(page, "painting", "2")
    expect_steps(page, FLOW)
    saved(page)
    page.reload()
    expect_steps(page, FLOW)
    golden(page, "branches-outline")
    page.get_by_role("treeitem").first.focus()
    keys(page, "Enter", "Delete")
    expect(page.get_by_role("treeitem")).to_have_count(5)
    keys(page, "Control+z")
    expect_steps(page, FLOW)


def next_goes(page: Page, where: str) -> None:
    expect(page.get_by_text(f"The next step goes here: {where}")).to_be_visible()


def panel(page: Page) -> Locator:
    return page.get_by_role("complementary", name="Selected step")


def decide(page: Page, tool: str, condition: str) -> None:
    """Draw what decides, and write its condition."""
    keys(page, tool, "Enter")
    expect(panel(page).get_by_text("Write it yourself")).to_be_visible()
    keys(page, "Enter")
    expect(page.get_by_role("radio", name="Choose from lists")).to_be_focused()
    keys(page, "ArrowRight", "Tab")
    expect(page.get_by_role("combobox", name="Condition", exact=True)).to_be_focused()
    page.keyboard.type(condition)
    keys(page, "Enter")
    expect(page.get_by_role("application", name="Program on the map")).to_be_focused()


def notify_in(page: Page, where: str, message: str) -> None:
    next_goes(page, where)
    keys(page, "n", "Enter")
    expect(page.get_by_label("Message", exact=True)).to_be_focused()
    page.keyboard.type(message)
    keys(page, "Enter")
    expect(panel(page)).to_contain_text("inside")


def choose_in_list(page: Page, name: str) -> None:
    """Go to a step by the list of steps, and from there back to the map."""
    tab_to(page, "tab", "Steps")
    page.keyboard.press("Enter")
    tab_to(page, "treeitem", "")
    rows = page.get_by_role("treeitem")
    keys(page, "Home")
    for _ in range(rows.count()):
        if (page.locator(":focus").get_attribute("aria-label") or "").startswith(name):
            break
        keys(page, "ArrowDown")
    keys(page, "Enter")
    expect(panel(page).get_by_role("heading", name=name[3:], exact=True)).to_be_visible()
