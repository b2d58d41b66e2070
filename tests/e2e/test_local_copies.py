"""What a browser keeps of programs: drawn on without the server, sent when it is back, gone with signing out."""

from __future__ import annotations


import pytest
from playwright.sync_api import Page, expect

from tests.e2e.conftest import SignIn
from tests.e2e.screens import ask, chip, click_floor, draw_task, make_program, saved
from tests.kit.waiting import wait_for

pytestmark = pytest.mark.browser

DATABASES = "async () => (await indexedDB.databases()).map((each) => each.name)"
CACHES = "async () => (await caches.keys()).filter((name) => name === 'vipo-answers')"
WORKS = "async () => (await navigator.serviceWorker.ready).active?.state === 'activated'"
KEEPS = "async (path) => (await (await caches.open('vipo-answers')).match(path)) !== undefined"


def come_ready(page: Page) -> None:
    """Wait until the service worker can open this program without the server."""
    wait_for("the service worker", lambda: page.evaluate(WORKS), 30)
    program = page.url.rsplit("/", 1)[1]
    for path in ("/api/me", f"/api/programs/{program}", "/api/sites/painting-factory/map/cells"):
        wait_for(f"the worker to keep {path}", lambda path=path: page.evaluate(KEEPS, path), 30)


def draw_move(page: Page, x: float, y: float) -> None:
    page.keyboard.press("Escape")
    page.keyboard.press("m")
    click_floor(page, x, y)
    page.keyboard.press("Escape")


def waiting(page: Page, count: int) -> None:
    words = "Offline: one change waits here" if count == 1 else f"Offline: {count} changes wait here"
    expect(page.get_by_role("banner").get_by_text(words)).to_be_visible()


def steps_on_server(page: Page) -> int:
    return len(ask(page, f"/api/programs/{page.url.rsplit('/', 1)[1]}/document")["steps"])


def test_a_program_opens_without_a_server_and_what_is_drawn_is_sent_later(
    sign_in: SignIn, faults: list[str]
) -> None:
    page = sign_in("author")
    make_program(page, "Drawn in a tunnel")
    draw_task(page)
    saved(page)
    come_ready(page)
    before = steps_on_server(page)
    page.context.set_offline(True)
    page.reload()
    expect(chip(page, "")).not_to_have_count(0)
    expect(page.get_by_role("banner").get_by_text("Connecting again")).to_be_visible()
    draw_move(page, 0.4, 0.3)
    waiting(page, 1)
    page.reload()
    waiting(page, 1)
    page.context.set_offline(False)
    saved(page)
    assert steps_on_server(page) == before + 1
    page.reload()
    saved(page)
    faults.clear()  # a browser complains of each call that gets no answer
