"""Everything by keyboard, and every screen looked over: accessibility, both themes, both languages, two sizes."""

from __future__ import annotations

import re
from dataclasses import dataclass
from typing import Any

import pytest
from playwright.sync_api import Locator, Page, expect

from tests.e2e.conftest import SignIn
from tests.e2e.screens import SITE, TASK, ask, chip, draw_task, make_program, resize, saved, tell, violations

pytestmark = pytest.mark.browser

RAW_KEY = re.compile(r"\b(?:alerts|shell|pages|map|editor|run|simulation|compare|history)\.[a-z]\w+")


@dataclass(frozen=True)
class Screen:
    """A screen: where it is, and what is there once it is ready."""

    name: str
    path: str
    ready: str


def test_a_pick_and_drop_by_keyboard_alone(sign_in: SignIn) -> None:
    page = sign_in("author")
    make_program(page, "By keyboard")
    page.keyboard.press("Escape")
    page.keyboard.press("p")
    expect(page.get_by_role("combobox", name="Click where to pick from")).to_be_focused()
    page.keyboard.type("item")
    page.keyboard.press("Enter")
    expect(page.get_by_role("combobox", name="Now click where to drop")).to_be_focused()
    page.keyboard.type("painting")
    page.keyboard.press("Enter")
    expect(page.get_by_role("button", name="1 \u00d7 box", exact=True)).to_be_focused()
    page.keyboard.press("Enter")
    expect(chip(page, f"1, {TASK}")).to_be_visible()
    page.keyboard.press("Delete")
    expect(chip(page, f"1, {TASK}")).to_have_count(0)
    page.keyboard.press("Control+z")
    expect(chip(page, f"1, {TASK}")).to_be_visible()


def test_the_list_of_steps_is_walked_by_arrows(sign_in: SignIn) -> None:
    page = sign_in("author")
    make_program(page, "By arrows")
    draw_task(page)
    draw_task(page, "Painting Machine", "Curing Oven")
    page.get_by_role("tab", name="Steps").click()
    rows = page.get_by_role("treeitem")
    rows.first.focus()
    page.keyboard.press("ArrowDown")
    expect(rows.nth(1)).to_be_focused()
    expect(page.get_by_role("complementary", name="Selected step")).to_contain_text("Step 2")


def test_the_bell_is_opened_and_closed_by_keyboard(sign_in: SignIn) -> None:
    page = sign_in("author", "/")
    bell = page.get_by_role("button", name=re.compile("^Alerts: nothing new|alerts? that nobody has seen"))
    bell.focus()
    page.keyboard.press("Enter")
    expect(page.get_by_role("dialog", name="Alerts")).to_be_visible()
    assert violations(page) == []
    page.keyboard.press("Escape")
    expect(bell).to_be_focused()


@pytest.fixture(scope="package")
def things() -> dict[str, str]:
    """What the first look-over makes for the screens that need something to show."""
    return {}


def screens(page: Page, things: dict[str, str]) -> list[Screen]:
    if not things:
        things.update(make_things(page))
    site = "/sites/painting-factory"
    return [
        Screen("home", "/", "h2"),
        Screen("devices", f"{site}/devices", "tbody tr"),
        Screen("a device", f"{site}/devices/paintMixer02", "aside table"),
        Screen("programs", f"{site}/programs", "tbody tr"),
        Screen("library", f"{site}/library", "main li, main section p"),
        Screen("runs", f"{site}/runs", "tbody tr"),
        Screen("map", f"{site}/map", "main canvas"),
        Screen("a new site", "/sites/new", "main form, main p"),
        Screen("paint order", things["paint order"], "[data-shape]"),
        Screen("empty program", things["empty"], ".react-flow__node"),
        Screen("program", things["task"], "[data-shape]"),
        Screen("simulation", things["rehearsal"], "canvas[data-engine]"),
        Screen("run", things["run"], "[data-state]"),
        Screen("comparison", things["comparison"], "[data-kind='removed']"),
        Screen("function comparison", things["function"], "main aside h2"),
        Screen("history", things["history"], "main li canvas"),
        Screen("nowhere", "/no/such/page", "main, h1, h2"),
    ]


def make_things(page: Page) -> dict[str, str]:
    empty = make_program(page, "Nothing in it")
    page.goto(page.url.split("/programs/")[0])
    task = make_program(page, "To look at")
    draw_task(page)
    expect(page.get_by_text("Nothing to fix")).to_be_visible()
    saved(page)
    rehearsal = tell(page, f"/api{task}/rehearsals")["id"]
    run = tell(page, f"/api{task}/runs")["id"]
    function = ask(page, "/api/library")[0]["id"]
    programs = {each["name"]: each["id"] for each in ask(page, f"{SITE}/programs")}
    page.keyboard.press("Control+a")
    page.keyboard.press("Delete")
    page.keyboard.press("n")  # another step instead, where the map proposes
    page.keyboard.press("Enter")
    expect(page.get_by_role("complementary", name="Selected step")).to_be_visible()
    saved(page)
    return {
        "comparison": f"{task}/compare?old=1&new=draft",
        "function": f"/sites/painting-factory/library/{function}/compare?program={task.removeprefix('/programs/')}",
        "history": f"/sites/painting-factory/history/{task.removeprefix('/programs/')}",
        "empty": empty,
        "task": task,
        "paint order": f"/programs/{programs['Paint order']}",
        "rehearsal": f"{task}/simulate/{rehearsal}",
        "run": f"/runs/{run}",
    }


WIDE, TABLET, PHONE = (1600, 1000), (820, 1180), (390, 844)


@pytest.mark.parametrize(("sizes", "dark", "language"), [((WIDE, TABLET), False, "en"), ((WIDE, PHONE), True, "de")])
def test_every_screen_is_sound(
    sign_in: SignIn,
    faults: list[str],
    things: dict[str, str],
    sizes: tuple[tuple[int, int], ...],
    dark: bool,
    language: str,
) -> None:
    """Each screen is loaded at one size and then taken to the other, so that each of three is seen."""
    found: list[str] = []
    every = screens(sign_in("author"), things)
    width, height = sizes[0]
    page = sign_in("author", width=width, height=height, dark=dark, language=language)
    for screen in every:
        resize(page, *sizes[0])
        page.goto(re.sub(r"(https?://[^/]+).*", r"\1", page.url) + screen.path)
        expect(page.locator(screen.ready).first).to_be_visible(timeout=180_000)
        for size in sizes:
            resize(page, *size)
            found += [f"{screen.name} at {size}: {fault}" for fault in look_over(page, language)]
        found += [f"{screen.name}: {fault}" for fault in faults]
        faults.clear()
    assert not found, "\n".join(found)


STOP_ALL_CUT = """() => [...document.querySelectorAll('header button[aria-keyshortcuts="Control+Shift+."]')]
    .map((each) => each.getBoundingClientRect())
    .some((box) => box.left < 0 || box.top < 0 || box.right > innerWidth || box.bottom > innerHeight)"""


def look_over(page: Page, language: str) -> list[str]:
    """What is wrong with a screen, in words."""
    found = []
    overflow = page.evaluate("document.documentElement.scrollWidth - innerWidth")
    if overflow > 0:
        found.append(f"is {overflow} px wider than the window")
    if page.evaluate(STOP_ALL_CUT):
        found.append("has a Stop all that is not wholly in the window")
    if page.evaluate("document.documentElement.lang") != language:
        found.append("does not speak the chosen language")
    found += [f"shows the raw key {key}" for key in RAW_KEY.findall(page.locator("body").inner_text())]
    return found + violations(page)


def test_the_sign_in_is_sound_in_both_themes(demo: Any, chromium: Any) -> None:
    for dark in (False, True):
        context = chromium.new_context(color_scheme="dark" if dark else "light", locale="en-GB")
        page = context.new_page()
        page.goto(f"{demo.url}/sign-in")
        form: Locator = page.get_by_label("Email address")
        expect(form).to_be_visible()
        assert look_over(page, "en") == []
        context.close()
