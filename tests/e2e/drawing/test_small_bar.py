"""The editor's bar on a small screen: whatever stands in it, Stop all is whole and nothing lies over it."""

from __future__ import annotations

import re
from itertools import pairwise

import pytest
from playwright.sync_api import expect

from tests.e2e.conftest import SignIn
from tests.e2e.screens import saved, violations, write_program

pytestmark = pytest.mark.browser
NEVER_OVER = """class Task(object):
    def new_task(self):
        while True:
            self.wait(1)

    def run(self, ctx):
        self.new_task()
"""
PARTS = "header > div:first-child > *:not(.visually-hidden)"
BOXES = f"""() => [...document.querySelectorAll({PARTS!r})]
    .map((part) => part.getBoundingClientRect()).filter((box) => box.width > 1)
    .map((box) => [Math.round(box.left), Math.round(box.right)])"""


def test_two_people_and_an_error_leave_stop_all_its_place_in_german(sign_in: SignIn) -> None:
    author = sign_in("author")
    write_program(author, "Ein Programm mit einem langen Namen", NEVER_OVER)
    saved(author)
    path = re.sub(r"https?://[^/]+", "", author.url)
    page = sign_in("admin", path, width=820, height=1180, language="de")
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
