"""What a rehearsal shows before there is a recording: its place, its course, that it was cancelled or refused."""

from __future__ import annotations

import re
from collections.abc import Iterator

import pytest
from playwright.sync_api import Page, expect

from tests.e2e.conftest import SignIn
from tests.e2e.screens import SITE, ask, saved, tell, violations, write_program

pytestmark = pytest.mark.browser
LONG = """class Task(object):
    def new_task(self):
        for _ in range(1000):
            for _ in range(1000):
                self.wait(0.02)

    def run(self, ctx):
        self.new_task()
"""
MOST_OF_PERSON = 5
AT_ONCE = 2


@pytest.fixture
def author(sign_in: SignIn) -> Iterator[Page]:
    page = sign_in("author")
    yield page
    for each in ask(page, f"{SITE}/rehearsals"):
        if each["mine"]:
            tell(page, f"/api/rehearsals/{each['id']}/cancel")


def make_long(page: Page, name: str) -> str:
    write_program(page, name, LONG)
    expect(page.get_by_role("banner").get_by_role("button", name="Run", exact=True)).to_be_enabled()
    saved(page)
    return re.sub(r"https?://[^/]+", "", page.url)


def start(page: Page, program: str) -> str:
    return str(tell(page, f"/api{program}/rehearsals")["id"])


def show(page: Page, program: str, rehearsal: str = "") -> None:
    origin = re.match(r"https?://[^/]+", page.url)
    assert origin is not None
    page.goto(f"{origin[0]}{program}/simulate/{rehearsal}")


def test_what_waits_and_what_is_under_way_is_shown_with_its_place_and_cancelled_by_keyboard(author: Page) -> None:
    program = make_long(author, "Never over")
    rehearsals = [start(author, program) for _ in range(AT_ONCE + 2)]
    show(author, program, rehearsals[0])
    bar = author.get_by_role("progressbar", name="Rehearsing the program in the simulated factory")
    expect(bar).to_be_visible()
    expect(author.get_by_text(re.compile("of simulated time"))).to_be_visible()
    assert violations(author) == []
    show(author, program, rehearsals[-1])
    expect(author.get_by_role("heading", name="Waiting for its turn")).to_be_visible()
    expect(author.get_by_text("One rehearsal is before it.")).to_be_visible()
    others = author.get_by_role("region", name="Rehearsals of this site that are not over")
    expect(others.get_by_text("Under way")).to_have_count(AT_ONCE)
    expect(others.get_by_text("Place 1")).to_have_count(1)
    assert violations(author) == []
    others.get_by_role("listitem").filter(has_text="Place 1").get_by_role("button").press("Enter")
    expect(author.get_by_text("It is next.")).to_be_visible()
    author.get_by_role("button", name="Cancel", exact=True).press("Enter")
    expect(author.get_by_role("heading", name="The rehearsal was cancelled")).to_be_visible()
    again = author.get_by_role("button", name="Simulate again")
    expect(again).to_be_visible()
    assert violations(author) == []
    show(author, program, rehearsals[0])
    author.get_by_role("button", name="Cancel", exact=True).press("Enter")
    expect(author.get_by_role("heading", name="The rehearsal was cancelled")).to_be_visible()


def test_who_has_as_many_as_may_be_is_told_so_and_makes_room_by_keyboard(author: Page, faults: list[str]) -> None:
    program = make_long(author, "One too many")
    for _ in range(MOST_OF_PERSON):
        start(author, program)
    author.get_by_role("button", name="Simulate", exact=True).press("Enter")
    expect(author.get_by_role("heading", name="Not rehearsed yet")).to_be_visible()
    expect(author.get_by_role("alert").filter(has_text="you may have 5 at a time")).to_be_visible()
    assert violations(author) == []
    others = author.get_by_role("region", name="Rehearsals of this site that are not over").get_by_role("listitem")
    expect(others).to_have_count(MOST_OF_PERSON)
    others.last.get_by_role("button").press("Enter")
    expect(others).to_have_count(MOST_OF_PERSON - 1)
    author.get_by_role("button", name="Simulate", exact=True).press("Enter")
    expect(author.get_by_role("heading", name="Waiting for its turn")).to_be_visible()
    assert [fault for fault in faults if "429" not in fault] == []
    faults.clear()
