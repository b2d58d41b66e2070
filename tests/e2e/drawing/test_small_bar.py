"""The bars of the editor and of runs on a small screen: all they hold is whole, Stop all in its place, none over it."""

from __future__ import annotations

import re
from itertools import pairwise
from typing import Any

import pytest
from playwright.sync_api import Page, Route, expect

from tests.e2e.conftest import SignIn
from tests.e2e.screens import (
    SITE,
    address_of,
    ask,
    make_program,
    resize,
    run_state,
    saved,
    shoot,
    tell,
    violations,
    write_program,
)

pytestmark = pytest.mark.browser
NEVER_OVER = """class Task(object):
    def new_task(self):
        while True:
            self.wait(1)

    def run(self, ctx):
        self.new_task()
"""
TEN_HOURS = """class Task(object):
    def new_task(self):
        self.wait(36000)

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
    resize(page, 820, 1180)  # the same: for what has moved to be there
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


TERMS = {
    "priority": "high",
    "deadline": "2026-01-02T03:04:05+00:00",
    "permit": {"approved_by": ["Ada Meyer"], "emergency": ""},
}
USUAL = {"status": "finished", "started_at": "2026-01-02T03:00:00+00:00", "ended_at": "2026-01-02T04:01:28+00:00"}
AWAITED = {"zone": "gate", "zone_name": "Gate", "robot": "turtlebot1", "robot_name": "TurtleBot 1", "run": ""}
ALERT = {
    "id": 1,
    "device": "paintMixer03",
    "code": "wrong_key",
    "args": {},
    "text": "",
    "count": 1,
    "role": "viewer",
    "state": "open",
    "severity": "warning",
    "first_at": "2026-01-02T03:04:05+00:00",
    "last_at": "2026-01-02T03:04:05+00:00",
    "seen_at": None,
    "seen_by": "",
    "over_at": None,
}


def have_every_fact(page: Page, run: str) -> None:
    """Let the page hear all that a bar can tell of this run, and that a robot waits and a device has an alert."""

    def told(route: Route) -> None:
        route.fulfill(json={**route.fetch().json(), **TERMS})

    def usual(route: Route) -> None:
        version = ask(page, f"/api/runs/{run}")["version"]
        route.fulfill(json=[{**USUAL, "version": version}])

    page.route(f"**/api/runs/{run}", told)
    page.route("**/api/sites/*/runs?program=*", usual)
    page.route("**/api/sites/*/alerts*", lambda route: route.fulfill(json=[ALERT]))
    page.route("**/api/sites/*/admissions", lambda route: route.fulfill(json=[AWAITED]))


def start_waiting(page: Page, name: str) -> dict[str, Any]:
    """Start a run of a program that does nothing for ten hours, without drawing it."""
    program = f"/api/programs/{tell(page, f'{SITE}/programs', {'name': name})['id']}"
    script = address_of(page, f"{program}/script")
    known = {"X-CSRFToken": ask(page, "/api/me")["csrf"], "If-Match": page.request.get(script).headers["etag"]}
    written = page.request.put(script, data=TEN_HOURS, headers={**known, "Content-Type": "text/plain"})
    assert written.ok, written.text()
    started: dict[str, Any] = tell(page, f"{program}/runs")
    return started


def test_a_run_with_all_that_its_bar_can_tell_leaves_stop_all_its_place(sign_in: SignIn) -> None:
    author = sign_in("author")
    started = start_waiting(author, "A long name for the large autumn delivery")
    try:
        # One browser after the other, each at every width.
        for language, stop, end in (("en", "Stop all", "Cancel run"), ("de", "Alles anhalten", "Lauf abbrechen")):
            page = sign_in("admin", language=language)
            have_every_fact(page, started["id"])
            # As on a tablet, where what is pressed is wider.
            page.context.new_cdp_session(page).send("Emulation.setTouchEmulationEnabled", {"enabled": True})
            page.goto(address_of(page, f"/runs/{started['id']}"))
            bar = page.get_by_role("banner")
            expect(run_state(page).filter(has_text="1:01:28")).to_be_attached()
            expect(bar.get_by_role("button", name=re.compile("1 robot", re.IGNORECASE))).to_be_visible()
            expect(page.get_by_text("Ada Meyer", exact=False).last).to_be_visible()
            for width in (1440, 1366, 1280, 1180, 820):
                resize(page, width, 900)
                boxes = page.evaluate(BOXES)
                assert all(right <= left for (_, right), (left, _) in pairwise(boxes)), (language, width, boxes)
                assert boxes[-1][1] <= width - 8, (language, width, boxes)
                assert bar.locator("[class*=count]").evaluate("(count) => count.getBoundingClientRect().top") >= 0
                for name in (stop, end):
                    expect(bar.get_by_role("button", name=name)).to_be_in_viewport(ratio=1)
                shoot(page, f"run-bar-{language}-{width}", "light", "dark")
            assert violations(page) == []
            page.context.close()
    finally:
        tell(author, f"/api/runs/{started['id']}/cancel")
