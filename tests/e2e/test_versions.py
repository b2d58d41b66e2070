"""Versions on the screens: one is saved, compared with what is drawn, restored while another person draws, undone."""

from __future__ import annotations

import re

import pytest
from playwright.sync_api import Page, expect

from tests.e2e.conftest import SignIn
from tests.e2e.screens import TASK, ask, chip, draw_task, make_program, opened, saved, violations

pytestmark = pytest.mark.browser


def save_version(page: Page, name: str) -> None:
    page.get_by_role("banner").get_by_role("button", name="Save version").click()
    page.get_by_role("dialog").get_by_label("Name").fill(name)
    page.keyboard.press("Enter")
    expect(page.get_by_role("dialog")).to_have_count(0)


def test_a_step_is_restored_by_keyboard_while_another_person_draws_and_taken_back(sign_in: SignIn) -> None:
    page, other = sign_in("author"), sign_in("admin")
    path = make_program(page, "To go back in")
    draw_task(page)
    saved(page)
    page.goto(page.url.replace("/programs/", "/sites/painting-factory/history/"))
    expect(page.get_by_text("No versions yet")).to_be_visible()
    save_version(page, "With a box")
    expect(page.get_by_role("heading", name="v1 With a box")).to_be_visible()
    expect(page.get_by_text("No run used it")).to_be_visible()
    assert violations(page) == []
    save_version(page, "The same again")
    expect(page.get_by_text("Nothing has changed since v1")).to_be_visible()
    page.get_by_role("banner").get_by_role("link", name="Open the editor").click()
    chip(page, f"1, {TASK}").click()
    page.keyboard.press("Delete")
    expect(chip(page, f"1, {TASK}")).to_have_count(0)
    saved(page)
    page.get_by_role("link", name="History and versions").click()
    expect(page.get_by_role("heading", name="1 change")).to_be_visible()
    changes = page.get_by_role("complementary", name="Changes")
    expect(changes.get_by_role("listitem").filter(has_text="removed").first).to_be_visible()
    other.goto(page.url.split("/programs/")[0] + path)
    opened(other)
    draw_task(other, "Painting Machine", "Curing Oven")
    saved(other)
    expect(page.get_by_role("heading", name="2 changes")).to_be_visible()
    page.keyboard.press("ArrowRight")
    expect(changes.locator("[aria-current=true]")).to_contain_text("box")
    assert violations(page) == []
    page.keyboard.press("r")
    expect(page.get_by_text("takes it back")).to_be_visible()
    expect(chip(other, "1, Pick-and-Drop")).to_have_count(1)
    expect(chip(other, "2, Pick-and-Drop")).to_have_count(1)
    expect(page.get_by_role("heading", name="1 change")).to_be_visible()
    page.keyboard.press("Control+z")
    expect(page.get_by_text("The restore is taken back")).to_be_visible()
    expect(page.get_by_role("heading", name="2 changes")).to_be_visible()
    expect(chip(other, "2, Pick-and-Drop")).to_have_count(0)
    kept = ask(page, f"/api{path}/versions")
    assert [(each["number"], each["name"], each["cause"]) for each in kept] == [
        (2, "", "restore"),
        (1, "With a box", ""),
    ]


def test_all_of_a_version_is_restored_after_a_question_and_both_sides_are_then_the_same(sign_in: SignIn) -> None:
    page = sign_in("author")
    path = make_program(page, "To go back to")
    draw_task(page)
    saved(page)
    page.goto(page.url.replace("/programs/", "/sites/painting-factory/history/"))
    save_version(page, "Drawn")
    page.goto(page.url.split("/sites/")[0] + path)
    chip(page, f"1, {TASK}").click()
    page.keyboard.press("Delete")
    saved(page)
    page.get_by_role("link", name="History and versions").click()
    page.get_by_role("button", name="Restore all of v1").click()
    dialog = page.get_by_role("dialog", name="Restore from v1")
    expect(dialog).to_contain_text("kept as a version first")
    assert violations(page) == []
    dialog.get_by_role("button", name="Restore", exact=True).click()
    expect(page.get_by_text("No difference. Both do the same.")).to_be_visible()
    page.get_by_role("button", name=re.compile("^New side")).click()
    page.get_by_role("menuitem", name=re.compile("^v2")).click()
    expect(page.get_by_role("heading", name="1 change")).to_be_visible()
    page.get_by_role("button", name="Swap the two sides").click()
    expect(page).to_have_url(re.compile("old=2&new=1"))
    expect(page.get_by_role("complementary", name="Changes").get_by_text("added", exact=True)).to_be_visible()
