"""Drawing into branches is found, what others hold and take away is seen, and a screen says only what it knows."""

from __future__ import annotations

import re
from typing import Any

import pytest
from playwright.sync_api import Locator, Page, WebSocketRoute, expect

from tests.e2e.conftest import SignIn
from tests.e2e.screens import ask, chip, click_floor, make_program, open_program, saved, the_map, until, violations

pytestmark = pytest.mark.browser


def steps(page: Page) -> dict[str, dict[str, Any]]:
    """Return the program's steps by their kinds, as the database has them."""
    saved(page)
    found = re.search(r"/programs/[^/]+$", page.url)
    assert found is not None
    by_id = ask(page, f"/api{found[0]}/document")["steps"]
    return {each["kind"]: {**each, "id": id_} for id_, each in by_id.items()}


def draw(page: Page, key: str, x: float, y: float) -> None:
    """Set a step down at a share of the map's width and height, and close what it opened."""
    page.keyboard.press("Escape")
    page.keyboard.press(key)
    click_floor(page, x, y)
    expect(page.get_by_role("complementary", name="Selected step")).to_be_visible()


def middle(of: Locator) -> tuple[float, float]:
    box = of.bounding_box()
    assert box is not None
    return box["x"] + box["width"] / 2, box["y"] + box["height"] / 2


def test_an_open_branch_invites_takes_the_next_step_and_says_so(sign_in: SignIn) -> None:
    page = sign_in("author")
    make_program(page, "Into branches")
    draw(page, "i", 0.3, 0.4)
    expect(the_map(page).get_by_text("draw here what is done when it is true")).to_be_visible()
    expect(the_map(page).get_by_text("draw here what is done when it is false")).to_be_visible()
    x, y = middle(chip(page, "1, If"))
    page.keyboard.press("n")
    page.mouse.click(x, y - 62)
    expect(page.get_by_role("complementary", name="Selected step")).to_contain_text("Notify")
    until(page, "() => document.activeElement?.matches('textarea, input, [contenteditable]')")
    page.keyboard.press("Escape")  # its message has the keyboard
    page.keyboard.press("u")
    expect(page.get_by_text("The next step goes here: If 1, branch \u201cfalse\u201d")).to_be_visible()
    assert violations(page) == []
    page.keyboard.press("Escape")
    drawn = steps(page)
    assert drawn["notify"]["place"][:2] == [drawn["if"]["id"], "else"]


def test_a_tool_that_asks_for_a_machine_goes_into_the_frame_that_is_pressed(sign_in: SignIn) -> None:
    page = sign_in("author")
    make_program(page, "Into a frame")
    draw(page, "r", 0.3, 0.4)
    until(page, "() => document.activeElement?.matches('textarea, input, [contenteditable]')")
    page.keyboard.type("2")
    page.keyboard.press("Enter")
    page.keyboard.press("Escape")
    box = chip(page, "1, Repeat").bounding_box()
    assert box is not None
    x, y = box["x"] + box["width"] / 2, box["y"] + box["height"]
    inside = page.get_by_text("Click where to pick from. The next step goes here: inside Repeat 1")
    for below in (14, -box["height"] / 2):  # the frame, and its head
        page.keyboard.press("p")
        expect(inside).to_have_count(0)
        page.mouse.click(x, y + below)
        expect(inside).to_be_visible()
        page.keyboard.press("Escape")
        page.keyboard.press("Escape")


def test_a_step_that_somebody_holds_moves_on_the_others_screen(sign_in: SignIn) -> None:
    author, admin = sign_in("author", motion=True), sign_in("admin", motion=True)
    make_program(author, "Held")
    draw(author, "n", 0.4, 0.4)
    saved(author)
    open_program(admin, "Held")
    there = chip(admin, "1, Notify")
    own = author.get_by_role("banner").get_by_role("img", name=re.compile("you"))
    seen = admin.get_by_role("button", name=re.compile("^.*: Follow the view of")).locator("span").first
    colour = "(avatar) => getComputedStyle(avatar).backgroundColor"
    assert seen.evaluate(colour) == own.evaluate(colour)
    before = middle(there)
    x, y = middle(chip(author, "1, Notify"))
    author.mouse.move(x, y)
    author.mouse.down()
    author.mouse.move(x + 60, y + 40, steps=6)
    author.mouse.move(x + 120, y + 80, steps=6)
    until(
        admin,
        "([name, x]) => [...document.querySelectorAll('.react-flow__node')].some((each) =>"
        " each.getAttribute('aria-label')?.startsWith(name) && each.getBoundingClientRect().x > x)",
        ["1, Notify", before[0] + 20],
    )
    author.mouse.up()
    saved(author)
    x, y = middle(chip(author, "1, Notify"))
    author.mouse.move(x, y)
    author.mouse.down()
    author.mouse.move(x + 60, y - 80, steps=6)
    there.click()
    admin.keyboard.press("Delete")
    expect(chip(author, "1, Notify")).to_have_count(0)
    author.mouse.up()
    admin.keyboard.press("Control+z")
    for page in (author, admin):
        expect(chip(page, "1, Notify")).to_be_visible()
        until(
            page,
            "([name, x, y]) => [...document.querySelectorAll('.react-flow__node')].some((each) => {"
            " const box = each.getBoundingClientRect();"
            " return each.getAttribute('aria-label')?.startsWith(name)"
            " && Math.hypot(box.x + box.width / 2 - x, box.y + box.height / 2 - y) < 3; })",
            ["1, Notify", x, y],
        )
    expect(admin.get_by_role("img", name="Without a connection you cannot see who else is here")).to_have_count(0)


def test_a_branch_is_chosen_by_key_said_and_drawn_into(sign_in: SignIn) -> None:
    page = sign_in("author")
    make_program(page, "Branches by keys")
    draw(page, "i", 0.3, 0.4)
    expect(chip(page, "1, If")).to_be_visible()
    goes = "The next step goes here: If 1, branch \u201c{}\u201d"
    for key, word in (("b", "true"), ("b", "false"), ("b", "true"), ("Shift+B", "false")):
        page.keyboard.press(key)
        expect(page.get_by_text(goes.format(word))).to_be_visible()
    page.keyboard.press("Escape")
    expect(page.get_by_text(goes.format("false"))).to_have_count(0)
    for key in ("b", "b", "n", "Enter"):
        page.keyboard.press(key)
    expect(page.get_by_role("complementary", name="Selected step")).to_contain_text("Notify")
    drawn = steps(page)
    assert drawn["notify"]["place"][:2] == [drawn["if"]["id"], "else"]
    page.keyboard.press("Escape")
    page.keyboard.press("?")
    expect(page.get_by_role("dialog")).to_contain_text("Draw into the next branch of the selected step")


@pytest.mark.parametrize("reloaded", [False, True], ids=["on the same page", "after a reload"])
def test_a_move_made_offline_of_a_step_that_was_removed_is_told_and_brought_back(
    sign_in: SignIn, faults: list[str], reloaded: bool
) -> None:
    author, admin = sign_in("author"), sign_in("admin")
    cut = [False]
    sockets: list[WebSocketRoute] = []

    def route(socket: WebSocketRoute) -> None:
        if cut[0]:
            socket.close(code=4503, reason="not now")
        else:
            socket.connect_to_server()
            sockets.append(socket)

    author.route_web_socket(re.compile("/ws/program/"), route)
    name = f"Taken away {reloaded}"
    make_program(author, name)
    draw(author, "n", 0.4, 0.4)
    author.keyboard.press("Escape")
    saved(author)
    open_program(admin, name)
    expect(chip(admin, "1, Notify")).to_be_visible()
    cut[0] = True
    for each in sockets:
        each.close(code=4503, reason="not now")
    unseen = author.get_by_role("img", name="Without a connection you cannot see who else is here")
    expect(unseen).to_be_visible()
    x, y = middle(chip(author, "1, Notify"))
    author.mouse.move(x, y)
    author.mouse.down()
    author.mouse.move(x + 90, y + 50, steps=6)
    author.mouse.up()
    author.keyboard.press("Escape")
    waits = author.get_by_role("banner").get_by_text("Offline: one change waits here")
    expect(waits).to_be_visible()
    if reloaded:
        author.reload()
        expect(waits).to_be_visible()
        expect(
            the_map(author).get_by_role("group", name=re.compile("Notify"))
        ).to_be_visible()  # its number is not known
    chip(admin, "1, Notify").click()
    admin.keyboard.press("Delete")
    saved(admin)
    cut[0] = False
    told = author.get_by_role("alert").filter(has_text="removed this step, and your change of it with it")
    expect(told).to_be_visible()
    told.get_by_role("button", name="Keep").click()
    expect(chip(author, "1, Notify")).to_be_visible()
    expect(chip(admin, "1, Notify")).to_be_visible()
    faults.clear()


def test_home_does_not_say_that_nothing_runs_before_it_knows(sign_in: SignIn) -> None:
    page = sign_in("author", "/nowhere")
    held: list[Any] = []
    page.route(re.compile(r"/api/sites/[^/]+/runs"), lambda route: held.append(route))
    page.goto(re.sub(r"(https?://[^/]+).*", r"\1", page.url))
    expect(page.get_by_role("heading", name="Live now")).to_be_visible()
    expect(page.get_by_role("heading", name="Recent runs")).to_be_visible()
    expect(page.get_by_text("No program is running.")).to_have_count(0)
    for each in held:
        each.continue_()
    expect(page.get_by_text("No program is running.")).to_be_visible()
