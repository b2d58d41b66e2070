"""Two people talk beside a program: a comment on a step is there at once, is counted, answered and resolved."""

from __future__ import annotations

import os
import re
from typing import Any

import pytest
from playwright.sync_api import Locator, Page, expect

from tests.e2e.conftest import SignIn, make_member
from tests.e2e.screens import draw_task, make_program, saved, violations
from tests.kit.demo import Demo

pytestmark = pytest.mark.browser


@pytest.fixture
def commenter(demo: Demo, signed_in: dict[str, Any]) -> str:
    """Somebody who may look at the painting factory and write comments, signed in."""
    if "commenter" not in signed_in:
        signed_in["commenter"] = make_member(demo, "commenter", "Cora Word")
    return "commenter"


def open_comments(page: Page, name: str = "Comments") -> Locator:
    page.get_by_role("tab", name=re.compile(f"^{name}")).press("Enter")
    return page.get_by_role("tabpanel", name=re.compile(f"^{name}"))


def shoot(page: Page, name: str) -> None:
    """Keep a picture where somebody wants to look at one."""
    if folder := os.environ.get("VIPO_PICTURES"):
        page.screenshot(path=f"{folder}/{name}.png")


def test_a_comment_on_a_step_is_counted_answered_and_resolved_while_both_look(sign_in: SignIn, commenter: str) -> None:
    author = sign_in("author")
    path = make_program(author, "Talked about")
    draw_task(author)
    saved(author)
    page = sign_in(commenter, path, dark=True, language="de")
    page.get_by_role("application").get_by_role("group", name=re.compile("^1, ")).click()
    written = open_comments(page, "Kommentare")
    written.get_by_role("button", name=re.compile("^Kommentar zu 1 ")).press("Enter")
    written.get_by_role("textbox", name=re.compile("^Kommentar zu")).fill("Is one box enough?")
    written.get_by_role("button", name="Kommentieren", exact=True).press("Enter")
    expect(written.get_by_text("Is one box enough?")).to_be_visible()
    expect(author.get_by_role("tab", name="Comments")).to_have_text("Comments1")
    talk = open_comments(author)
    thread = talk.get_by_role("listitem").filter(has_text="Is one box enough?").first
    expect(thread).to_contain_text("Cora Word")
    thread.get_by_role("button", name="Mark 1 as read").press("Enter")
    expect(author.get_by_role("tab", name="Comments")).to_have_text("Comments")
    expect(thread.get_by_role("textbox")).to_have_count(0)
    thread.get_by_role("button", name="Answer", exact=True).press("Enter")
    author.keyboard.type("Yes, for today.")
    shoot(author, "comments-answer")
    thread.get_by_role("button", name="Answer", exact=True).press("Enter")
    expect(written.get_by_text("Yes, for today.")).to_be_visible()
    shoot(page, "comments-dark-de")
    assert violations(page) == []
    assert violations(author) == []
    shoot(author, "comments")
    thread.get_by_role("button", name="Resolve").press("Enter")
    expect(talk.get_by_text("No open comments.")).to_be_visible()
    expect(written.get_by_text("Is one box enough?")).to_have_count(0)
