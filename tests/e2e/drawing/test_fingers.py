"""By touch: one finger pans, two zoom, none leaves a moved step or an arrow behind, one that stays opens the menu."""

from __future__ import annotations

from typing import Any

import pytest
from playwright.sync_api import Locator, Page, expect

from tests.e2e.conftest import PATIENCE_MS, Demo, SignIn
from tests.e2e.screens import chip, draw_task, make_program, saved, the_map
from tests.kit.waiting import wait_for

pytestmark = pytest.mark.browser
TASK = "1, Pick-and-Drop"
Spot = tuple[float, float]


class Fingers:
    """Fingers on a page's screen, by the browser's own protocol."""

    def __init__(self, page: Page) -> None:
        self.page = page
        self.cdp = page.context.new_cdp_session(page)

    def _send(self, kind: str, spots: list[Spot]) -> None:
        points = [{"x": x, "y": y, "id": index} for index, (x, y) in enumerate(spots)]
        self.cdp.send("Input.dispatchTouchEvent", {"type": kind, "touchPoints": points})

    def move(self, *ways: tuple[Spot, Spot]) -> None:
        """Put one finger after the other down, move them all to where they go, and lift them."""
        begun = [begin for begin, _ in ways]
        for count in range(1, len(begun) + 1):
            self._send("touchStart", begun[:count])
        for part in range(1, 9):
            self._send("touchMove", [between(*way, part / 8) for way in ways])
        self._send("touchEnd", [])

    def hold(self, spot: Spot) -> None:
        self._send("touchStart", [spot])
        expect(self.page.get_by_role("menu")).to_be_visible()
        self._send("touchEnd", [])


def between(begin: Spot, end: Spot, part: float) -> Spot:
    return begin[0] + (end[0] - begin[0]) * part, begin[1] + (end[1] - begin[1]) * part


def middle(of: Locator) -> Spot:
    box = of.bounding_box()
    assert box is not None
    return box["x"] + box["width"] / 2, box["y"] + box["height"] / 2


def resting(of: Locator) -> Spot:
    """Return where something is once it has stood there for a moment: what is pinched goes on for some frames."""
    places: list[Spot] = [middle(of)]

    def is_still() -> bool:
        of.page.wait_for_timeout(200)
        places.append(middle(of))
        return places[-1] == places[-2]

    wait_for("it rests", is_still)
    return places[-1]


def step(page: Page) -> dict[str, Any]:
    """The one step as the map's nodes have it: where it stands on the floor does not change with the view."""
    found: dict[str, Any] = page.evaluate(
        "() => { const node = document.querySelector('.react-flow__node-step');"
        " return { at: node.style.transform, view: document.querySelector('.react-flow__viewport').style.transform } }"
    )
    return found


def test_fingers_pan_zoom_and_leave_nothing_behind(sign_in: SignIn, demo: Demo, signed_in: dict[str, Any]) -> None:
    author = sign_in("author")
    path = make_program(author, "By touch")
    draw_task(author)
    saved(author)
    browser = author.context.browser
    assert browser is not None
    context = browser.new_context(
        viewport={"width": 820, "height": 1180}, has_touch=True, locale="en-GB", storage_state=signed_in["author"]
    )
    page = context.new_page()
    page.set_default_timeout(PATIENCE_MS)
    page.goto(demo.url + path)
    expect(chip(page, TASK)).to_be_visible()
    fingers, before = Fingers(page), step(page)
    box = the_map(page).bounding_box()
    assert box is not None
    floor = (box["x"] + box["width"] * 0.5, box["y"] + 60)
    fingers.move((floor, (floor[0] + 90, floor[1] + 40)))
    wait_for("another view", lambda: step(page)["view"] != before["view"])
    assert step(page)["at"] == before["at"]
    at = middle(chip(page, TASK))
    fingers.move((at, (at[0] - 60, at[1] - 60)), ((at[0] + 40, at[1] + 40), (at[0] + 140, at[1] + 140)))
    expect(page.locator(".react-flow__connection")).to_have_count(0)
    assert step(page)["at"] == before["at"]
    fingers.hold(resting(chip(page, TASK)))
    page.get_by_role("menuitem", name="Duplicate").tap()
    expect(page.locator(".react-flow__node-step")).to_have_count(2)
    page.get_by_role("button", name="All constructs").tap()
    listed = page.get_by_role("listbox", name="All constructs")
    row = middle(listed.get_by_role("option").nth(5))
    fingers.move((row, (row[0], row[1] - 160)))
    wait_for("the list goes with the finger", lambda: listed.evaluate("(list) => list.scrollTop") > 50)
    expect(page.locator(".react-flow__node-step")).to_have_count(2)
    listed.get_by_role("option", name="Notify").tap()
    expect(listed).to_have_count(0)
    page.keyboard.press("Escape")
    small = page.evaluate(
        "() => [...document.querySelectorAll('main [role=toolbar] button, main [role=tab]')]"
        ".map((each) => each.getBoundingClientRect()).filter((box) => box.height < 44 || box.width < 44).length"
    )
    assert small == 0
    context.close()
