"""What a browser keeps of programs: drawn on without the server, sent when it is back, gone with signing out."""

from __future__ import annotations

import json
import os
import re
import signal
import sys
from pathlib import Path

import pytest
from playwright.sync_api import Browser, Page, WebSocketRoute, expect

from tests.e2e.conftest import SignIn, sign_in_by_form
from tests.e2e.screens import (
    SITE,
    address_of,
    ask,
    click_floor,
    draw_task,
    make_program,
    opened,
    program_named,
    saved,
    show_programs,
    tell,
)
from tests.kit.demo import Demo, running_demo
from tests.kit.files import ROOT
from tests.kit.processes.forked import run_forked
from tests.kit.waiting import wait_for

pytestmark = pytest.mark.browser

DATABASES = "async () => (await indexedDB.databases()).map((each) => each.name)"
CACHES = "async () => (await caches.keys()).filter((name) => name === 'vipo-answers')"
WORKS = "async () => (await navigator.serviceWorker.ready).active?.state === 'activated'"
KEEPS = "async (path) => (await (await caches.open('vipo-answers')).match(path)) !== undefined"


def come_ready(page: Page) -> None:
    """Wait until the service worker can open this program without the server."""
    wait_for("the service worker", lambda: page.evaluate(WORKS))
    program = page.url.rsplit("/", 1)[1]
    for path in ("/api/me", f"/api/programs/{program}", "/api/sites/painting-factory/map/cells"):
        wait_for(f"the worker to keep {path}", lambda path=path: page.evaluate(KEEPS, path))


def draw_move(page: Page, x: float, y: float) -> None:
    page.keyboard.press("Escape")
    page.keyboard.press("m")
    click_floor(page, x, y)
    page.keyboard.press("Escape")


def waiting(page: Page, count: int) -> None:
    words = "Offline: one change waits here" if count == 1 else f"Offline: {count} changes wait here"
    expect(page.get_by_role("banner").get_by_text(words)).to_be_visible()


def draw_offline(page: Page) -> None:
    """Open the program anew without a network, and draw one step; sockets that are open do not notice a cut."""
    page.context.set_offline(True)
    page.reload()
    opened(page)
    draw_move(page, 0.4, 0.3)
    waiting(page, 1)


def give_role(demo: Demo, role: str) -> None:
    """Give the demo's author another role at all sites."""
    find = f"Membership.objects.filter(user__email={demo.account('author').email!r})"
    code = f"from registry.models import Membership; {find}.update(role={role!r})"
    environment = {**os.environ, "VIPO_STATE_DIR": str(demo.state)}
    environment.pop("DJANGO_SETTINGS_MODULE", None)
    command = [sys.executable, "manage.py", "shell", "--verbosity", "0", "-c", code]
    run_forked(command, cwd=ROOT, env=environment, check=True)


def sign_in_anew(chromium: Browser, demo: Demo, role: str) -> Page:
    """A browser with a session of its own, which may be ended."""
    context = chromium.new_context(locale="en-GB", storage_state=sign_in_by_form(chromium, demo, role))
    page = context.new_page()
    page.goto(demo.url)
    return page


def sign_out(page: Page) -> None:
    page.get_by_role("button", name="Account").click()
    page.get_by_role("menuitem", name="Sign out").click()


def steps_on_server(page: Page) -> int:
    return len(ask(page, f"/api/programs/{page.url.rsplit('/', 1)[1]}/document")["steps"])


def test_a_program_opens_without_a_server_and_what_is_drawn_is_sent_later(sign_in: SignIn, faults: list[str]) -> None:
    page = sign_in("author", offline=True)
    make_program(page, "Drawn in a tunnel")
    draw_task(page)
    saved(page)
    come_ready(page)
    before = steps_on_server(page)
    page.context.set_offline(True)
    page.reload()
    opened(page)
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


def test_a_killed_server_takes_nothing_along(chromium: Browser, tmp_path: Path) -> None:
    with running_demo(tmp_path / "state") as demo:
        context = chromium.new_context(locale="en-GB", storage_state=sign_in_by_form(chromium, demo, "author"))
        page = context.new_page()
        page.goto(demo.url)
        make_program(page, "Drawn beside a dead server")
        draw_task(page)
        saved(page)
        come_ready(page)
        os.killpg(demo.process.pid, signal.SIGKILL)
        demo.process.wait(20)
        draw_move(page, 0.4, 0.3)
        # Sometimes a second change puts right what the first has moved.
        words = re.compile(r"^Offline: (one change waits|2 changes wait) here$")
        waits = page.get_by_role("banner").get_by_text(words)
        expect(waits).to_be_visible()
        page.reload()
        expect(waits).to_be_visible()
        expect(page.get_by_text(re.compile("^Move to")).first).to_be_attached()  # perhaps out of view
        expect(page.get_by_text("The script and the checks do not know your last changes.")).to_be_visible()
        expect(page.get_by_text("Not checked yet")).to_be_visible()
        context.close()


def test_what_a_viewer_had_drawn_is_shown_kept_and_sent_when_the_role_comes_back(
    sign_in: SignIn, demo: Demo, faults: list[str]
) -> None:
    page = sign_in("author", offline=True)
    make_program(page, "Drawn without a right")
    draw_task(page)
    saved(page)
    come_ready(page)
    draw_offline(page)
    try:
        give_role(demo, "viewer")
        page.context.set_offline(False)
        expect(page.get_by_role("heading", name="One change of yours was not taken")).to_be_visible()
        with page.expect_download() as download:
            page.get_by_role("button", name="Download my version").click()
        kept = json.loads(download.value.path().read_text())
        assert sorted(step["kind"] for step in kept["steps"].values()) == ["move", "pick_and_drop"]
        assert steps_on_server(page) == 1
    finally:
        give_role(demo, "author")
    page.reload()
    saved(page)
    assert steps_on_server(page) == 2
    faults.clear()


def test_a_version_that_is_too_large_becomes_a_program_of_its_own(sign_in: SignIn, faults: list[str]) -> None:
    page = sign_in("author", offline=True)
    make_program(page, "Too large")
    draw_task(page)
    saved(page)
    come_ready(page)
    draw_offline(page)
    program = page.url.rsplit("/", 1)[1]
    page.route_web_socket(re.compile(program), lambda socket: socket.close(code=4413, reason="too large"))
    page.context.set_offline(False)
    page.reload()
    expect(page.get_by_role("heading", name="One change of yours was not taken")).to_be_visible()
    expect(page.get_by_role("banner").get_by_text("One change is not saved")).to_be_visible()
    page.get_by_role("button", name="Save my version as a copy").focus()
    page.keyboard.press("Enter")
    expect(page.get_by_label("Name of the program")).to_have_value("Too large (my version)")
    assert steps_on_server(page) == 2
    faults.clear()


SLOW_STORE = """
const { open } = IDBFactory.prototype;
IDBFactory.prototype.open = function (...asked) {
  const request = open.apply(this, asked);
  Object.defineProperty(request, "onsuccess", {
    set: (then) => request.addEventListener("success", (event) => setTimeout(() => then.call(request, event), 6000)),
  });
  return request;
};
window.wronglyAway = false;
new MutationObserver(() => {
  window.wronglyAway ||= document.body?.textContent.includes("The server does not answer");
}).observe(document, { subtree: true, childList: true, characterData: true });
"""


def test_a_browser_that_is_slow_to_give_back_its_copy_is_not_told_that_the_server_is_away(sign_in: SignIn) -> None:
    page = sign_in("author")
    page.add_init_script(SLOW_STORE)
    held: list[tuple[WebSocketRoute, str | bytes]] = []
    slow = [True]

    def relay(socket: WebSocketRoute) -> None:
        def pass_on(message: str | bytes) -> None:
            if slow[0]:
                held.append((socket, message))
            else:
                socket.send(message)

        socket.connect_to_server().on_message(pass_on)

    page.route_web_socket(re.compile("/ws/program/"), relay)
    program = tell(page, f"{SITE}/programs", {"name": "From a slow disk"})["id"]
    page.goto(address_of(page, f"/programs/{program}"))
    expect(page.get_by_role("heading", name="Opening the program")).to_be_visible()

    def is_made_anew() -> bool:
        page.wait_for_timeout(50)
        return len({id(socket) for socket, _ in held}) > 1

    wait_for("the connection that is made anew for the copy", is_made_anew)
    slow[0] = False
    sockets = [socket for socket, _ in held]
    for socket, message in held:
        if socket is sockets[-1]:
            socket.send(message)
    opened(page)
    draw_task(page)
    saved(page)
    assert not page.evaluate("window.wronglyAway")
    assert steps_on_server(page) == 1


@pytest.mark.parametrize(
    ("code", "words", "button"),
    [
        (4404, "This program cannot be opened", ""),
        (4429, "Too much at once", "Connect again"),
        (4503, "The server does not answer", ""),
    ],
)
def test_a_program_that_did_not_come_is_not_shown_as_an_empty_one(
    sign_in: SignIn, faults: list[str], code: int, words: str, button: str
) -> None:
    page = sign_in("author")
    before = len(ask(page, f"/api/programs/{program_named(page, 'Paint order')}/document")["steps"])
    refused = [True]
    page.route_web_socket(
        re.compile("/ws/program/"),
        lambda socket: socket.close(code=code, reason="not now") if refused[0] else socket.connect_to_server(),
    )
    show_programs(page)
    page.get_by_role("table").get_by_role("link", name="Paint order", exact=True).click()
    expect(page.get_by_role("alert").get_by_role("heading", name=words)).to_be_visible()
    expect(page.get_by_role("banner").get_by_text("Not opened")).to_be_visible()
    expect(page.get_by_role("toolbar", name="Tools")).to_have_count(0)
    page.keyboard.press("m")
    click_floor(page, 0.4, 0.3)
    refused[0] = False
    if button:
        page.get_by_role("button", name=button).click()
    elif code == 4404:
        page.reload()
    saved(page)
    expect(page.get_by_role("alert").get_by_role("heading", name=words)).to_have_count(0)
    assert steps_on_server(page) == before
    faults.clear()


def test_signing_out_asks_and_then_leaves_nothing(chromium: Browser, demo: Demo) -> None:
    page = sign_in_anew(chromium, demo, "author")
    make_program(page, "Left behind")
    draw_task(page)
    saved(page)
    come_ready(page)
    draw_offline(page)
    page.route_web_socket(re.compile("/ws/program/"), lambda socket: socket.close(code=4503, reason="not now"))
    page.context.set_offline(False)
    page.goto(demo.url)
    sign_out(page)
    question = page.get_by_role("dialog", name="Changes wait in this browser")
    expect(question.get_by_role("link", name="Left behind")).to_be_visible()
    expect(question).to_contain_text("Left behind: one change")
    question.get_by_role("button", name="Sign out anyway").click()
    page.wait_for_url(f"{demo.url}/sign-in")
    wait_for("the copies to go", lambda: page.evaluate(DATABASES) == [])
    wait_for("the answers to go", lambda: page.evaluate(KEEPS, "/api/me") is False)
    page.context.close()


def test_the_next_person_at_a_browser_finds_nothing_of_the_one_before(chromium: Browser, demo: Demo) -> None:
    page = sign_in_anew(chromium, demo, "author")
    path = make_program(page, "Of the one before")
    draw_task(page)
    saved(page)
    come_ready(page)
    (before,) = page.evaluate(DATABASES)
    page.context.clear_cookies()  # a session that ended by itself
    admin = demo.account("admin")
    page.goto(f"{demo.url}/sign-in")
    page.get_by_label("Email address").fill(admin.email)
    page.get_by_label("Password", exact=True).fill(admin.password)
    page.get_by_role("button", name="Sign in", exact=True).click()
    page.wait_for_url(f"{demo.url}/")
    page.goto(demo.url + path)
    saved(page)

    def is_alone() -> bool:
        after = page.evaluate(DATABASES)
        return len(after) == 1 and after != [before]

    wait_for("the own copy alone", is_alone)
    page.context.close()


def test_each_of_two_tabs_counts_its_own(sign_in: SignIn, faults: list[str]) -> None:
    page = sign_in("author", offline=True)
    make_program(page, "In two tabs")
    draw_task(page)
    saved(page)
    come_ready(page)
    other = page.context.new_page()
    other.goto(page.url)
    saved(other)
    page.context.set_offline(True)
    page.reload()
    other.reload()
    opened(page)
    opened(other)
    draw_move(page, 0.4, 0.3)
    waiting(page, 1)
    draw_move(other, 0.5, 0.3)
    waiting(other, 1)
    page.context.set_offline(False)
    saved(page)
    saved(other)
    wait_for("both tabs' steps", lambda: steps_on_server(page) == 3)
    faults.clear()
