"""The paper's three steps with few presses, templates that are seen before they are taken, and a tour."""

from __future__ import annotations

import re

import pytest
from playwright.sync_api import expect

from tests.e2e.conftest import SignIn
from tests.e2e.screens import chip, expect_steps, machine, make_program, saved, violations

pytestmark = pytest.mark.browser
COUNT = """clicks = 0; entries = 0
addEventListener('pointerdown', () => clicks++, true)
addEventListener('focusin', (event) => { if (event.target.matches('input, textarea')) entries++ }, true)"""


def test_fetch_paint_and_move_on_take_five_clicks_and_one_entry(sign_in: SignIn) -> None:
    page = sign_in("author", motion=True)
    make_program(page, "Five clicks")
    page.keyboard.press("Escape")
    page.evaluate(COUNT)
    page.get_by_role("button", name="Item Inventory", exact=True).click()
    machine(page, "Painting Machine").click()
    page.get_by_role("dialog", name="What to carry?").get_by_role("button", name="1 \u00d7 box", exact=True).click()
    then = page.get_by_role("group", name="What comes next?")
    then.get_by_role("button", name="Paint", exact=True).click()
    expect(page.get_by_label("time", exact=True)).to_be_focused()
    page.keyboard.type("2")
    page.keyboard.press("Enter")
    then.get_by_role("button", name="Carry 1 \u00d7 box to Curing Oven").click()
    expect(chip(page, "3, Pick-and-Drop")).to_be_visible()
    assert page.evaluate("[clicks, entries]") == [5, 1]
    expect(page.get_by_text("Nothing to fix")).to_be_visible()
    assert violations(page) == []
    drawn = [
        "1, Pick-and-Drop, 1 \u00d7 box from Item Inventory to Painting Machine",
        "2, Operate, Paint · 2 min at Painting Machine",
        "3, Pick-and-Drop, 1 \u00d7 box from Painting Machine to Curing Oven",
    ]
    expect_steps(page, drawn)
    for _ in range(3):
        page.keyboard.press("Control+z")
    expect(page.get_by_role("treeitem")).to_have_count(1)


def test_a_template_is_seen_on_the_own_map_taken_and_undone_as_one(sign_in: SignIn) -> None:
    page = sign_in("author", motion=True)
    make_program(page, "From a template")
    page.get_by_role("button", name="Begin with a template").click()
    dialog = page.get_by_role("dialog", name="Begin with a template")
    dialog.get_by_role("radio", name=re.compile("^Process at a machine")).check()
    dialog.get_by_role("combobox", name="Work done by").click()
    page.get_by_role("option", name="Painting Machine").click()
    moving = "(all) => all.map((each) => getComputedStyle(each).animationName.includes('walk'))"
    walker = dialog.locator("g[style*=offset-path]")
    assert walker.evaluate_all(moving) == [True]
    page.emulate_media(reduced_motion="reduce")
    expect(walker).to_have_count(0)
    expect(dialog.get_by_role("listitem")).to_have_count(5)
    assert violations(page) == []
    dialog.get_by_role("button", name="Draw it").click()
    expect(chip(page, "2, Operate")).to_be_visible()
    expect(page.get_by_text("Nothing to fix")).to_be_visible()
    saved(page)
    page.get_by_role("group", name="Undo and redo").get_by_role("button", name="Undo").click()
    expect(page.get_by_role("heading", name="Start with one task")).to_be_visible()


def test_the_tour_goes_round_and_can_be_left_at_each_stop(sign_in: SignIn) -> None:
    page = sign_in("author", motion=True)
    make_program(page, "Shown around")
    begin = page.get_by_role("button", name="Show me around")
    begin.click()
    titles = []
    for _ in range(5):
        card = page.get_by_role("dialog")
        expect(card).to_be_focused()
        titles.append(card.get_by_role("heading").inner_text())
        card.get_by_role("button", name=re.compile("^(Next|Done)$")).click()
    assert titles == [
        "The map of your place",
        "What can be done",
        "What is selected",
        "The same program in words",
        "Rehearse, then run",
    ]
    expect(page.get_by_role("dialog")).to_have_count(0)
    begin.click()
    assert violations(page) == []
    page.keyboard.press("Escape")
    expect(page.get_by_role("dialog")).to_have_count(0)
