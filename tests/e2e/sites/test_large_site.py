"""A site of 200 m, far from where its map has zero: all of it is seen, and what is drawn stands on its floor."""

from __future__ import annotations

import re

import pytest
from playwright.sync_api import Locator, Page

from tests.e2e.conftest import SignIn
from tests.e2e.screens import address_of, ask, chip, opened, tell, the_map
from tests.kit.waiting import wait_for

pytestmark = pytest.mark.browser
NAME = "Yard of 200 m"
WIDTH, HEIGHT = 400, 240
HEADER = (
    "image: yard.pgm\nresolution: 0.5\norigin: [300000.0, -200000.0, 0.0]\nnegate: 0\noccupied_thresh: 0.65\n"
    "free_thresh: 0.196\n"
)


def make_yard(page: Page) -> str:
    """Make the site and return what it is called in addresses."""
    image = b"P5\n%d %d\n255\n" % (WIDTH, HEIGHT) + b"\xfe" * (WIDTH * HEIGHT)
    answer = page.request.post(
        address_of(page, "/api/sites"),
        multipart={
            "name": NAME,
            "yaml": {"name": "yard.yaml", "mimeType": "text/yaml", "buffer": HEADER.encode()},
            "image": {"name": "yard.pgm", "mimeType": "image/x-portable-graymap", "buffer": image},
        },
        headers={"X-CSRFToken": ask(page, "/api/me")["csrf"]},
    )
    assert answer.ok, answer.text()
    return str(answer.json()["slug"])


def percent(page: Page) -> int:
    """Return the zoom that the map's buttons say."""
    return int(re.sub(r"\D", "", page.get_by_text(re.compile(r"^\d+\s%$")).inner_text()))


def in_view(page: Page, thing: Locator) -> bool:
    box, pane = thing.bounding_box(), the_map(page).bounding_box()
    if box is None or pane is None:
        return False
    x, y = box["x"] + box["width"] / 2, box["y"] + box["height"] / 2
    return pane["x"] < x < pane["x"] + pane["width"] and pane["y"] < y < pane["y"] + pane["height"]


def test_all_of_a_large_site_is_seen_and_what_is_drawn_stands_on_it(sign_in: SignIn) -> None:
    page = sign_in("admin", "/sites/painting-factory")
    site = make_yard(page)
    program = tell(page, f"/api/sites/{site}/programs", {"name": "In the yard"})["id"]
    page.goto(address_of(page, f"/programs/{program}"))
    opened(page)
    start = page.locator(".react-flow__node-start")
    wait_for("the start on the floor", lambda: in_view(page, start))
    whole = percent(page)
    assert whole < 20
    pane = the_map(page).bounding_box()
    assert pane is not None
    page.mouse.move(pane["x"] + pane["width"] / 2, pane["y"] + pane["height"] / 2)
    page.mouse.wheel(0, 100)
    wait_for("farther away", lambda: percent(page) < whole)
    page.keyboard.press("1")
    wait_for("the whole site", lambda: percent(page) == whole)
    page.keyboard.press("-")
    wait_for("farther away by key", lambda: percent(page) < whole)
    page.keyboard.press("1")
    wait_for("the whole site again", lambda: percent(page) == whole)

    page.keyboard.press("Escape")
    page.keyboard.press("u")
    page.keyboard.press("Enter")
    wait_for("the step on the floor", lambda: in_view(page, chip(page, "1, Wait")))
