"""How one comes to a screen: what is fetched beside what, and what is seen while its code is on its way."""

from __future__ import annotations

from urllib.parse import urljoin

import pytest
from playwright.sync_api import Request, Route, WebSocket, expect

from tests.e2e.conftest import SignIn
from tests.e2e.screens import until
from tests.kit.demo import Demo

pytestmark = pytest.mark.browser
HOME = "/sites/painting-factory"


def is_script_of(request: Request, screen: str) -> bool:
    return f"/assets/{screen}-" in request.url and request.url.endswith(".js")


def test_a_screens_code_is_fetched_while_it_is_asked_who_looks(sign_in: SignIn) -> None:
    page = sign_in("author", HOME)
    held: list[Route] = []
    page.route("**/api/me", lambda route: held.append(route))
    with page.expect_request(lambda request: is_script_of(request, "ProgramsPage")):
        page.goto(page.url + "/programs", wait_until="commit")
    until(page, "() => document.querySelector('#root')?.childElementCount > 0")
    expect(page.get_by_role("status").first).to_be_visible()
    assert len(held) == 1
    held[0].continue_()
    expect(page.get_by_role("heading", name="Programs", level=1)).to_be_visible()


def test_what_a_screen_asks_for_after_the_sites_greeting_is_asked_once(sign_in: SignIn) -> None:
    page = sign_in("author")  # from no screen, which would have questions of its own under way
    held: list[Route] = []
    asked: list[str] = []
    page.route("**/assets/RunsPage-*.js", lambda route: held.append(route))
    page.on("request", lambda request: asked.append(request.url) if "/api/sites/" in request.url else None)
    with page.expect_websocket() as site, page.expect_request(lambda request: is_script_of(request, "RunsPage")):
        page.goto(urljoin(page.url, f"{HOME}/runs"), wait_until="commit")
    site.value.wait_for_event("framereceived")
    held[0].continue_()
    expect(page.get_by_role("heading", name="Runs", level=1)).to_be_visible()
    for name in ("questions", "alerts", "programs"):
        assert [url.rsplit("/", 1)[1] for url in asked if url.endswith(f"/{name}")] == [name]


def test_a_stranger_signs_in_on_the_way_to_a_screen_and_hears_the_site(sign_in: SignIn, demo: Demo) -> None:
    page = sign_in("nobody", "/sign-in")
    refused: list[WebSocket] = []
    page.on("websocket", lambda socket: refused.append(socket))
    page.goto(f"{demo.url}{HOME}/devices")
    account = demo.account("author")
    page.get_by_label("Email address").fill(account.email)
    page.get_by_label("Password", exact=True).fill(account.password)
    with page.expect_websocket() as socket:
        page.get_by_role("button", name="Sign in", exact=True).click()
    socket.value.wait_for_event("framereceived")
    expect(page.locator("tbody tr").first).to_be_visible()
    assert [each.is_closed() for each in refused] == [True, False]


def test_the_screen_before_stays_while_the_next_is_on_its_way(sign_in: SignIn) -> None:
    page = sign_in("author", f"{HOME}/programs")
    before = page.get_by_role("heading", name="Programs", level=1)
    expect(before).to_be_visible()
    held: list[Route] = []
    page.route("**/assets/MapPage-*.js", lambda route: held.append(route))
    with page.expect_request(lambda request: is_script_of(request, "MapPage")):
        page.get_by_role("link", name="Map", exact=True).click()
    until(page, "() => document.documentElement.hasAttribute('data-arriving')")
    expect(before).to_be_visible()
    assert page.evaluate("getComputedStyle(document.documentElement, '::before').animationName") == "arrive"
    held[0].continue_()
    expect(page.get_by_role("heading", name="Map", level=1)).to_be_visible()
    assert not page.evaluate("document.documentElement.hasAttribute('data-arriving')")


def test_a_screen_whose_code_is_gone_says_so_and_one_can_go_on(sign_in: SignIn, faults: list[str]) -> None:
    page = sign_in("author", f"{HOME}/programs")
    expect(page.get_by_role("heading", name="Programs", level=1)).to_be_visible()
    page.route("**/assets/MapPage-*.js", lambda route: route.fulfill(status=404))
    page.get_by_role("link", name="Map", exact=True).click()
    expect(page.get_by_role("button", name="Reload")).to_be_visible()
    page.unroute("**/assets/MapPage-*.js")
    page.get_by_role("button", name="Reload").click()
    expect(page.get_by_role("heading", name="Map", level=1)).to_be_visible()
    faults.clear()


def test_a_page_whose_messages_do_not_come_works_and_has_them_later(sign_in: SignIn, faults: list[str]) -> None:
    page = sign_in("author", HOME)
    page.route("**/assets/Notices-*.js", lambda route: route.abort())
    with page.expect_event("requestfailed", lambda request: is_script_of(request, "Notices")):
        page.goto(page.url + "/programs")
    expect(page.get_by_role("heading", name="Programs", level=1)).to_be_visible()
    messages = page.locator(".mantine-Notifications-root")
    expect(messages).to_have_count(0)
    page.unroute("**/assets/Notices-*.js")
    expect(messages).not_to_have_count(0)
    faults.clear()
