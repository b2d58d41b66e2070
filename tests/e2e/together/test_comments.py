"""Two people talk beside a program: a comment on a step is there at once, has a pin, is answered and resolved."""

from __future__ import annotations

import re
from typing import Any

import pytest
from playwright.sync_api import Locator, Page, expect

from tests.e2e.conftest import SignIn, make_member
from tests.e2e.screens import ask, draw_task, make_program, saved, shoot, violations
from tests.kit.demo import Demo

pytestmark = pytest.mark.browser
STEP = re.compile("^1, ")


@pytest.fixture(scope="module")
def commenter(demo: Demo, signed_in: dict[str, Any]) -> str:
    """Somebody who may look at the painting factory and write comments, signed in."""
    signed_in["commenter"] = make_member(demo, "commenter", "Cora Word")
    return "commenter"


def open_comments(page: Page, name: str = "Comments") -> Locator:
    page.get_by_role("tab", name=re.compile(f"^{name}")).press("Enter")
    return page.get_by_role("tabpanel", name=re.compile(f"^{name}"))


def chip(page: Page) -> Locator:
    return page.get_by_role("application").get_by_role("group", name=STEP)


def pins(page: Page, word: str = "open thread") -> Locator:
    return page.get_by_role("button", name=re.compile(word))


def test_a_comment_on_a_step_has_a_pin_and_is_answered_and_resolved_while_both_look(
    sign_in: SignIn, commenter: str
) -> None:
    author = sign_in("author")
    path = make_program(author, "Talked about")
    draw_task(author)
    saved(author)
    me = ask(author, "/api/me")["user"]["name"]
    page = sign_in(commenter, path, dark=True, language="de")
    chip(page).click()
    page.keyboard.press("Shift+C")
    written = page.get_by_role("tabpanel", name=re.compile("^Kommentare"))
    expect(written.get_by_role("textbox", name=re.compile("^Kommentar zu 1 "))).to_be_focused()
    page.keyboard.type(f"Is one box enough, @{me[:3]}")
    expect(written.get_by_role("option", name=me)).to_be_visible()
    shoot(page, "comments-names-dark-de")
    page.keyboard.press("Enter")
    page.keyboard.type("?")
    page.keyboard.press("Control+Enter")
    said = f"Is one box enough, @{me} ?"
    expect(written.get_by_text(said)).to_be_visible()

    expect(author.get_by_role("tab", name="Comments")).to_have_text("Comments1")
    author.keyboard.press("Escape")
    expect(pins(author)).to_have_accessible_name(re.compile("^1 open thread: 1 "))
    shoot(author, "comments-pin")
    pins(author).press("Enter")
    talk = author.get_by_role("tabpanel", name=re.compile("^Comments"))
    thread = talk.get_by_role("listitem").filter(has_text=said).first
    expect(thread).to_be_focused()
    expect(thread).to_contain_text("Cora Word")
    expect(author.get_by_role("tab", name="Comments")).to_have_text("Comments")
    talk.get_by_text("Mention me").click()
    expect(thread).to_be_visible()
    thread.get_by_role("button", name="Answer", exact=True).press("Enter")
    expect(thread.get_by_role("textbox", name="Answer")).to_be_focused()
    author.keyboard.type("Yes, for today.")
    shoot(author, "comments-answer")
    author.keyboard.press("Control+Enter")
    expect(written.get_by_text("Yes, for today.")).to_be_visible()
    shoot(page, "comments-dark-de")
    shoot(author, "comments")
    assert violations(page) == []
    assert violations(author) == []
    author.set_viewport_size({"width": 820, "height": 1180})
    pins(author).click()
    thread.get_by_role("button", name="Answer", exact=True).click(trial=True)
    shoot(author, "comments-small")
    assert violations(author) == []
    author.set_viewport_size({"width": 1600, "height": 1000})

    chip(author).click()
    author.keyboard.press("Delete")
    expect(chip(author)).to_have_count(0)
    expect(thread).to_contain_text("was deleted")
    expect(pins(page, "offene Diskussion")).to_have_count(1)
    shoot(author, "comments-deleted")
    thread.get_by_role("button", name="Resolve").press("Enter")
    expect(pins(page, "offene Diskussion")).to_have_count(0)
    expect(pins(author)).to_have_count(0)
    open_comments(page, "Kommentare").get_by_text("Erledigt", exact=True).click()
    expect(written.get_by_text(said)).to_be_visible()
