"""A program of very many constructs: few elements, few styles reckoned anew, and each construct can still be used."""

from __future__ import annotations

import json
from typing import Any

import pytest
from playwright.sync_api import Browser, Locator, Page, expect

from bench.programs import make_program as document_of
from scripts.construct_pictures import clip_of
from tests.e2e.conftest import SignIn
from tests.e2e.screens import ask, make_program, saved, the_map
from tests.kit.waiting import wait_for

pytestmark = pytest.mark.browser
CONSTRUCTS = 600
MOST_ELEMENTS = 3_000
MOST_RESTYLED = 200


def open_many(page: Page, name: str) -> str:
    """Open a program of so many constructs, all over each other in the factory; return the path of its document."""
    path = make_program(page, name)
    saved(page)
    document = f"/api{path}/document"
    origin = page.url.removesuffix(path)
    tag = page.request.get(origin + document).headers["etag"]
    headers = {"X-CSRFToken": ask(page, "/api/me")["csrf"], "If-Match": tag}
    assert page.request.put(origin + document, data=document_of(CONSTRUCTS), headers=headers).ok
    expect(painted(page)).to_have_attribute("data-constructs", str(CONSTRUCTS))
    return document


def painted(page: Page) -> Locator:
    return page.locator("canvas[data-constructs]")


def steps(page: Page) -> Locator:
    return page.locator(".react-flow__node-step")


def elements(page: Page) -> int:
    return int(page.evaluate("document.querySelectorAll('*').length"))


def leave(page: Page) -> None:
    """Let neither the pointer nor the keyboard be at a construct."""
    page.mouse.move(5, 5)
    page.get_by_role("tab", name="Script").focus()


def place_of(page: Page, step: Any) -> tuple[float, float]:
    x, y = step["pos"]
    at = clip_of(page, (x, y, x, y))
    return at["x"], at["y"]


def test_many_constructs_are_painted_and_each_is_an_element_once_it_is_wanted(sign_in: SignIn) -> None:
    page = sign_in("author", motion=True)
    document = open_many(page, "Six hundred")
    expect(steps(page)).to_have_count(0)
    assert elements(page) <= MOST_ELEMENTS
    uppermost = ask(page, document)["steps"]["s599"]
    at = place_of(page, uppermost)
    page.mouse.move(*at)
    expect(steps(page)).to_have_count(1)
    page.mouse.down()
    page.mouse.move(at[0] + 60, at[1] + 40)
    page.mouse.move(at[0] + 90, at[1] + 60)
    page.mouse.up()
    wait_for("the step's new place", lambda: ask(page, document)["steps"]["s599"]["pos"] != uppermost["pos"])
    leave(page)
    page.keyboard.press("Escape")
    expect(steps(page)).to_have_count(0)
    page.mouse.click(*place_of(page, ask(page, document)["steps"]["s599"]))
    expect(page.locator('.react-flow__node-step.selected[data-id="s599"]')).to_have_count(1)
    leave(page)
    page.keyboard.press("ArrowLeft")
    expect(page.locator(".react-flow__node-step.selected")).not_to_have_attribute("data-id", "s599")
    page.keyboard.press("Control+a")
    expect(steps(page)).to_have_count(0)
    assert elements(page) <= MOST_ELEMENTS


def test_a_frame_of_pan_or_zoom_restyles_next_to_nothing(sign_in: SignIn, chromium: Browser) -> None:
    page = sign_in("author", motion=True)
    open_many(page, "Moved about")
    box = the_map(page).bounding_box()
    assert box is not None
    x, y = box["x"] + box["width"] / 2, box["y"] + box["height"] / 3
    page.mouse.move(x, y)
    chromium.start_tracing(page=page, categories=["devtools.timeline"])
    page.mouse.down(button="middle")
    for index in range(20):
        page.mouse.move(x + index * 4, y + index * 2)
    page.mouse.up(button="middle")
    for index in range(10):
        page.mouse.wheel(0, 40 if index < 5 else -40)
        page.wait_for_timeout(20)
    events = json.loads(chromium.stop_tracing())["traceEvents"]
    restyled = [
        each["args"]["elementCount"] for each in events
        if each["name"] == "UpdateLayoutTree" and "elementCount" in each.get("args", {})
    ]  # fmt: skip
    assert len(restyled) >= 10
    few = [each for each in restyled if each <= MOST_RESTYLED]
    assert len(few) >= 0.8 * len(restyled)  # where the gesture begins and rests, more may be
