"""The forms of what holds steps: catches, time limits, loops over a list; also when two people change one of them."""

from __future__ import annotations

import re
from collections.abc import Iterator
from contextlib import contextmanager
from typing import Any

import pytest
from playwright.sync_api import Locator, Page, WebSocketRoute, expect

from tests.e2e.conftest import SignIn
from tests.e2e.screens import ask, chip, editor, open_program, saved, script_lines, violations, write_program

pytestmark = pytest.mark.browser
GUARDED = """class Task(object):
    def new_task(self):
        try:
            self.curing_oven.cure_paint(4)
        except Refused:
            self.wait(1)

    def run(self, ctx):
        self.curing_oven = ctx.get("curingOven01")
        self.new_task()
"""
TWO_STEPS = """class Task(object):
    def new_task(self):
        self.curing_oven.cure_paint(4)
        self.wait(60)

    def run(self, ctx):
        self.curing_oven = ctx.get("curingOven01")
        self.new_task()
"""
A_LIST = """class Task(object):
    def new_task(self):
        self.colours = ["red", "blue"]
        for item in [self.curing_oven]:
            self.notify("Next", level="info")

    def run(self, ctx):
        self.curing_oven = ctx.get("curingOven01")
        self.new_task()
"""


def params(page: Page, kind: str) -> dict[str, Any]:
    """Return the parameters of the program's only step of a kind, as the database has them."""
    saved(page)
    found = re.search(r"/programs/[^/]+$", page.url)
    assert found is not None
    (step,) = (each for each in ask(page, f"/api{found[0]}/document")["steps"].values() if each["kind"] == kind)
    return dict(step["params"])


def inspector(page: Page) -> Locator:
    return page.get_by_role("complementary", name="Selected step")


def catch(page: Page, number: int) -> Locator:
    """A catch of the form of a Try that has several."""
    return inspector(page).get_by_role("group", name=f"Catch {number}: when a step is", exact=True)


class Wire:
    """What a browser says of a program, which can be held up on its way."""

    def __init__(self, page: Page) -> None:
        self._held: list[tuple[WebSocketRoute, Any]] | None = None
        page.route_web_socket(re.compile("/ws/program/"), self._take)

    def _take(self, socket: WebSocketRoute) -> None:
        server = socket.connect_to_server()

        def said(message: Any) -> None:
            if self._held is None:
                server.send(message)
            else:
                self._held.append((server, message))

        socket.on_message(said)

    @contextmanager
    def held_up(self) -> Iterator[None]:
        self._held = []
        try:
            yield
        finally:
            held, self._held = self._held, None
            for server, message in held:
                server.send(message)


def test_two_people_who_add_a_catch_to_one_try_at_the_same_moment_have_both(sign_in: SignIn) -> None:
    author, admin = sign_in("author"), sign_in("admin")
    wires = [Wire(author), Wire(admin)]
    write_program(author, "Caught by two", GUARDED)
    open_program(admin, "Caught by two")
    for page in (author, admin):
        chip(page, "1, Try").click()
    expect(inspector(author)).to_contain_text("Ada")
    expect(inspector(admin)).to_contain_text("Otto")
    with wires[0].held_up(), wires[1].held_up():
        for page, kind in ((author, "timed out"), (admin, "blocked")):
            inspector(page).get_by_role("button", name="Add a catch").click()
            catch(page, 2).get_by_role("checkbox", name=kind, exact=True).check()
            expect(catch(page, 3)).to_have_count(0)
    for page in (author, admin):
        expect(catch(page, 3)).to_be_visible()
        taken = [value for name, value in params(page, "try").items() if name.startswith("kinds")]
        assert sorted(taken) == [["blocked"], ["refused"], ["timed_out"]]


def test_a_catch_is_added_says_what_it_takes_and_is_removed(sign_in: SignIn) -> None:
    page = sign_in("author")
    write_program(page, "Catches", GUARDED)
    chip(page, "1, Try").click()
    form = inspector(page)
    expect(
        form.get_by_role("group", name="Go to catch when a step is").get_by_role("checkbox", checked=True)
    ).to_have_count(1)
    form.get_by_role("button", name="Add a catch").press("Enter")
    expect(catch(page, 2).get_by_role("checkbox", name="refused")).to_be_focused()
    expect(catch(page, 2)).to_contain_text("Nothing chosen: at any problem that is left")
    page.keyboard.press("Tab")
    page.keyboard.press("Space")
    catch(page, 2).get_by_role("checkbox", name="timed out").check()
    expect(editor(page)).to_contain_text("except (Failed, TimedOut)")
    assert params(page, "try") == {"kinds": ["refused"], "kinds2": ["failed", "timed_out"]}
    assert violations(page) == []
    expect(form.get_by_role("button", name="Remove catch 1")).to_be_disabled()
    form.get_by_role("button", name="Remove catch 2").click()
    expect(form.get_by_role("button", name="Add a catch")).to_be_focused()
    expect(editor(page)).not_to_contain_text("TimedOut")
    assert params(page, "try") == {"kinds": ["refused"]}


def test_steps_get_a_time_limit_by_their_menu_and_its_time_in_the_form(sign_in: SignIn) -> None:
    page = sign_in("author")
    write_program(page, "Limited", TWO_STEPS)
    chip(page, "1, Operate").click()
    chip(page, "2, Wait").click(modifiers=["Shift"])
    chip(page, "2, Wait").click(button="right")
    page.get_by_role("menu").get_by_role("menuitem", name="Set a time limit").click()
    expect(inspector(page).get_by_role("heading", name="Time limit")).to_be_visible()
    expect(page.get_by_role("banner").get_by_role("button", name=re.compile("error"))).to_be_visible()
    duration = inspector(page).get_by_label("How long it may take")
    duration.fill("5 min")
    duration.press("Enter")
    expect(chip(page, "1, Time limit")).to_be_visible()
    expect(page.get_by_text("Nothing to fix")).to_be_visible()
    assert params(page, "limit") == {"duration": {"quantity": [5, "MIN"]}}
    assert script_lines(page)[1:5] == [
        "    def new_task(self):",
        '        with self.limit(quantity(5, "min")):',
        "            self.curing_oven.cure_paint(4)",
        "            self.wait(60)",
    ]
    chip(page, "1, Time limit").click(button="right")
    page.get_by_role("menu").get_by_role("menuitem", name="Take the frame apart").click()
    expect(editor(page)).not_to_contain_text("self.limit")
    expect(chip(page, "2, Wait")).to_be_visible()


def test_a_for_each_is_switched_to_a_list_and_back(sign_in: SignIn) -> None:
    page = sign_in("author")
    write_program(page, "Through a list", A_LIST)
    chip(page, "2, For each").click()
    mode = inspector(page).get_by_role("radiogroup", name="What it goes through")
    expect(mode.get_by_role("radio", name="Items named here")).to_be_checked()
    mode.get_by_text("A list", exact=True).click()
    expect(inspector(page).get_by_label("For each of the list", exact=True)).to_have_value("colours")
    expect(editor(page)).to_contain_text("for item in self.colours:")
    assert params(page, "for_each")["list"] == {"param": "colours"}
    mode.get_by_role("radio", name="A list").focus()
    page.keyboard.press("ArrowLeft")
    expect(editor(page)).to_contain_text("for item in [self.curing_oven]:")
    assert "list" not in params(page, "for_each")
    assert violations(page) == []
