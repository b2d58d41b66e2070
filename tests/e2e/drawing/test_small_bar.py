"""The editor's bars on a small screen: whatever they hold, Stop all and every tool is whole, nothing lies over it."""

from __future__ import annotations

import re
from itertools import pairwise

import pytest
from playwright.sync_api import expect

from tests.e2e.conftest import SignIn
from tests.e2e.screens import make_program, resize, saved, violations, write_program

pytestmark = pytest.mark.browser
NEVER_OVER = """class Task(object):
    def new_task(self):
        while True:
            self.wait(1)

    def run(self, ctx):
        self.new_task()
"""
PARTS = "header > div:first-child > *:not(.visually-hidden), header > div:first-child > [class*=middle] > *"
BOXES = f"""() => [...document.querySelectorAll({PARTS!r})]
    .map((part) => part.getBoundingClientRect()).filter((box) => box.width > 1)
    .map((box) => [Math.round(box.left), Math.round(box.right)])"""


def test_two_people_and_an_error_leave_stop_all_its_place_in_german(sign_in: SignIn) -> None:
    author = sign_in("author")
    write_program(author, "Ein Programm mit einem langen Namen", NEVER_OVER)
    saved(author)
    path = re.sub(r"https?://[^/]+", "", author.url)
    page = sign_in("admin", path, width=820, height=1180, language="de", motion=True)
    bar = page.get_by_role("banner")
    expect(bar.get_by_role("button", name="1 Fehler")).to_be_visible()
    expect(bar.get_by_role("button", name="Simulieren")).to_be_visible()
    expect(bar.get_by_role("button", name="Der Sicht von Otto Brandt folgen")).to_be_visible()
    boxes = page.evaluate(BOXES)
    assert len(boxes) >= 6
    assert all(right <= left for (_, right), (left, _) in pairwise(boxes))
    assert boxes[-1][1] <= 820 - 8
    name = page.get_by_label("Name des Programms").bounding_box()
    assert name is not None
    assert name["width"] >= 72
    assert violations(page) == []


TOOLS = """(bar) => [...bar.querySelectorAll('button')].map((tool) => {
    const { left, top, right, bottom } = tool.getBoundingClientRect();
    const over = document.elementFromPoint((left + right) / 2, (top + bottom) / 2);
    const inside = left >= 0 && top >= 0 && right <= innerWidth && bottom <= innerHeight;
    return { name: tool.ariaLabel, whole: inside && tool.contains(over), wide: right - left, high: bottom - top };
})"""


def test_every_tool_is_whole_on_a_small_screen_and_can_be_pressed(sign_in: SignIn) -> None:
    page = sign_in("author", width=820, height=1180)
    make_program(page, "Tools on small screens")
    bar = page.get_by_role("toolbar", name="Tools")
    every = bar.get_by_role("button", name="All constructs")
    for width, height in ((820, 1180), (1003, 760), (1004, 760)):
        resize(page, width, height)
        expect(every).to_be_visible()
        tools: list[dict[str, object]] = bar.evaluate(TOOLS)
        assert len(tools) == 20
        assert [each["name"] for each in tools if not each["whole"]] == [], width
        assert {(each["wide"], each["high"]) for each in tools} == {(44, 44)}, width
        zone = bar.get_by_role("button", name="Zone")
        zone.click()
        expect(zone).to_have_attribute("aria-pressed", "true")
        every.click()
        expect(page.get_by_role("listbox", name="All constructs")).to_be_visible()
        for _ in range(2):  # the list closes, then the tool is laid down
            page.keyboard.press("Escape")
        expect(zone).to_have_attribute("aria-pressed", "false")


def test_on_a_phone_the_tools_scroll_and_the_list_of_all_stays(sign_in: SignIn) -> None:
    page = sign_in("author", width=390, height=844)
    make_program(page, "Tools on a phone")
    bar = page.get_by_role("toolbar", name="Tools")
    every = bar.get_by_role("button", name="All constructs")
    expect(every).to_be_visible()
    box = bar.bounding_box()
    assert box is not None
    assert box["height"] <= 60
    assert box["x"] >= 0
    assert box["x"] + box["width"] <= 390
    zone = bar.get_by_role("button", name="Zone")
    for tool in (zone, bar.get_by_role("button", name="Select")):
        tool.focus()  # what has the keyboard comes into sight, and is not under the list of all
        expect(tool).to_be_in_viewport(ratio=1)
        over = "(tool) => { const { left, right, top } = tool.getBoundingClientRect();" + (
            "return tool.contains(document.elementFromPoint((left + right) / 2, top + 22)); }"
        )
        assert tool.evaluate(over)
        found: list[dict[str, object]] = bar.evaluate(TOOLS)
        assert [each["whole"] for each in found if each["name"] == "All constructs"] == [True]
        assert {(each["wide"], each["high"]) for each in found} == {(44, 44)}
    zone.click()
    expect(zone).to_have_attribute("aria-pressed", "true")
    every.click()
    expect(page.get_by_role("listbox", name="All constructs")).to_be_visible()
    assert violations(page) == []
