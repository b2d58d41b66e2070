"""A new user begins with an empty floor: TurtleBot 1 maps it, places get names, a program is drawn and run on it."""

from __future__ import annotations

import re
from collections.abc import Iterator

import pytest
from playwright.sync_api import Browser, Locator, Page, expect

from registry.demo.factory import make_grid, read_plan
from registry.floorplan.map_server import read_map
from simulation.mapping.floor import TrueFloor
from simulation.mapping.scores import score
from tests.e2e.conftest import PATIENCE_MS, listen, sign_in_by_form
from tests.e2e.screens import ask, chip, opened, saved, violations
from tests.kit.demo import Demo, running_demo
from tests.kit.waiting import wait_for
from vipo_device.protocol.description import Pose

pytestmark = pytest.mark.browser
SITE, ROBOT = "workshop", "workshop.robot01"
MAPPING_LIMIT_MS = 180_000


@pytest.fixture(scope="module")
def empty_demo(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Demo]:
    with running_demo(tmp_path_factory.mktemp("empty") / "state", speed=10, empty_floor=True) as running:
        yield running


def open_at(chromium: Browser, demo: Demo, role: str, at: str, faults: list[str]) -> Page:
    context = chromium.new_context(
        viewport={"width": 1600, "height": 1000}, locale="en-GB", storage_state=sign_in_by_form(chromium, demo, role)
    )
    listen(context, faults)
    page = context.new_page()
    page.set_default_timeout(PATIENCE_MS)
    page.goto(demo.url + at)
    return page


def home(page: Page) -> None:
    page.get_by_role("link", name="Home", exact=True).click()


def test_an_empty_floor_is_mapped_by_a_robot_furnished_with_places_and_driven_on(
    empty_demo: Demo, chromium: Browser, faults: list[str]
) -> None:
    page = open_at(chromium, empty_demo, "admin", f"/sites/{SITE}", faults)
    watcher = open_at(chromium, empty_demo, "author", f"/sites/{SITE}", faults)
    let_in(page)
    map_the_floor(page, watcher)
    home(watcher)
    expect(watcher.get_by_label("The map that TurtleBot 1 is making")).to_be_visible()
    take_the_map(page)
    check_the_map(page)
    expect(watcher.get_by_role("region", name="Set up Workshop").get_by_label("Map of Workshop")).to_be_visible()
    name_places(page)
    expect(watcher.get_by_text("Somebody who may draw programs")).to_have_count(0)
    draw_and_run(watcher)
    assert "Traceback" not in empty_demo.log.read_text()
    assert [fault for fault in faults if not ("404" in fault and "/map" in fault)] == []
    faults.clear()  # of a map that is not there yet, the browser's console says 404
    for each in (page, watcher):
        each.context.close()


def test_the_address_of_a_site_that_nobody_has_is_told(empty_demo: Demo, chromium: Browser, faults: list[str]) -> None:
    page = open_at(chromium, empty_demo, "author", "/sites/no-such-hall", faults)
    expect(page.get_by_role("main").get_by_role("alert")).to_be_visible()
    expect(page.get_by_role("region", name="Set up Workshop")).to_have_count(0)
    page.context.close()
    faults.clear()  # of the refusals, the browser's console says 404 when each of them comes


def let_in(page: Page) -> None:
    """The card of an empty site leads to the robot that waits, and back to what it can do."""
    expect(page.get_by_role("region", name="Set up Workshop")).to_be_visible()
    page.get_by_role("link", name="Let TurtleBot 1 in to map the floor").click()
    page.get_by_role("button", name="Approve").click()
    page.get_by_role("button", name="I have it").click()
    home(page)
    expect(page.get_by_role("link", name="Map the floor with TurtleBot 1")).to_be_visible()
    assert violations(page) == []
    page.get_by_role("link", name="Map the floor with TurtleBot 1").click()


def map_the_floor(page: Page, other: Page) -> None:
    """By keyboard: begin and leave the form; another person ends it; then let it go on until it is done."""
    at_work = begin_to_map(page, "Start mapping")
    expect(page.get_by_role("button", name="Map it again")).to_be_visible()
    other.goto(page.url)
    seen = other.get_by_role("region", name="What it does now")
    expect(seen.get_by_text("Ada Meyer told it to explore")).to_be_visible()
    seen.get_by_role("button", name="Cancel it").press("Enter")
    for each in (at_work, seen):
        expect(each).to_have_count(0)
    assert violations(page) == []
    expect(begin_to_map(page, "Map it again")).to_have_count(0, timeout=MAPPING_LIMIT_MS)


def begin_to_map(page: Page, words: str) -> Locator:
    """Tell the robot to map and close the form; return what says on its page that it does."""
    page.get_by_role("button", name=words).press("Enter")
    dialog = page.get_by_role("dialog")
    dialog.get_by_role("button", name="Start").press("Enter")
    expect(dialog.get_by_text("Under way")).to_be_visible()
    page.keyboard.press("Escape")
    at_work = page.get_by_role("region", name="What it does now")
    expect(at_work.get_by_text("Ada Meyer told it to explore")).to_be_visible()
    return at_work


def take_the_map(page: Page) -> None:
    page.get_by_role("button", name="Use as this site's map").click()
    dialog = page.get_by_role("dialog", name="Use the map of TurtleBot 1 as this site's map?")
    expect(dialog.get_by_text("New floor")).to_be_visible()
    dialog.get_by_role("button", name="Use this map").click()
    expect(page.get_by_text("is the site's map now: version 1")).to_be_visible()


def check_the_map(page: Page) -> None:
    """Hold the site's map against the floor of which nobody here was told."""
    origin = page.url.split("/sites/")[0]
    header, image = (page.request.get(f"{origin}/api/sites/{SITE}/map.{form}").body() for form in ("yaml", "pgm"))
    plan = read_plan(SITE)
    x, y = plan["start"]
    found = score(read_map(header, image), TrueFloor(make_grid(plan)), Pose(x, -y))
    assert found.f1 >= 0.95
    assert found.iou >= 0.97


def name_places(page: Page) -> None:
    home(page)
    page.get_by_role("region", name="Set up Workshop").get_by_role("link", name="Name places").click()
    for name, keys in (("Bench", ("Shift+ArrowLeft",) * 2), ("Loading bay", ("Shift+ArrowRight",) * 3)):
        page.get_by_role("button", name="Add a place").click()
        page.keyboard.press("Enter")
        expect(page.get_by_label("Name", exact=True)).to_be_focused()
        page.keyboard.type(name)
        page.keyboard.press("Enter")
        handle = page.get_by_role("button", name=f"{name} at")
        before = handle.get_attribute("aria-label")
        handle.focus()
        for key in (*keys, "Enter"):
            page.keyboard.press(key)
        expect(handle).not_to_have_attribute("aria-label", before or "")
    assert violations(page) == []


def draw_and_run(page: Page) -> None:
    """The author draws two moves by keyboard, rehearses them, and lets the robot drive."""
    page.get_by_role("button", name="Draw a program").click()
    expect(page).to_have_url(re.compile("/programs/"))
    opened(page)
    for number, place in enumerate(("Bench", "Loading bay"), 1):
        page.keyboard.press("m")
        page.keyboard.type(place)
        page.keyboard.press("Enter")
        expect(chip(page, f"{number}, Move")).to_be_visible()
    expect(page.get_by_text("Nothing to fix")).to_be_visible()
    saved(page)
    page.get_by_role("button", name="Simulate", exact=True).click()
    expect(page.get_by_role("region", name="Result")).to_contain_text("Finishes without errors")
    page.go_back()
    opened(page)
    page.get_by_role("banner").get_by_role("button", name="Run", exact=True).click()
    dialog = page.get_by_role("dialog", name="Run this program")
    expect(dialog.get_by_text("All checks passed")).to_be_visible()
    dialog.get_by_role("button", name="Run", exact=True).click()

    def last_run() -> str:
        runs = ask(page, f"/api/sites/{SITE}/runs")
        return str(runs[0]["status"]) if runs else ""

    wait_for("the end of the run", lambda: last_run() in {"finished", "failed", "cancelled"})
    assert last_run() == "finished"
    places = {each["name"]: each for each in ask(page, f"/api/sites/{SITE}/map")["places"]}
    robot = next(each for each in ask(page, f"/api/sites/{SITE}/devices") if each["id"] == ROBOT)
    bay = places["Loading bay"]
    assert abs(robot["location"]["x"] - bay["x"]) + abs(robot["location"]["y"] - bay["y"]) < 0.2
