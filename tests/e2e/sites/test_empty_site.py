"""A new user sets up an empty site in the browser: map, place, robot, program; then the map is changed by hand."""

from __future__ import annotations

import re
from pathlib import Path

import pytest
from playwright.sync_api import Page, expect

from tests.e2e.conftest import SignIn
from tests.e2e.screens import ask, opened, saved, tell, violations
from tests.kit.files import ROOT
from tests.kit.mqtt import PlainDevice

pytestmark = pytest.mark.browser

ROBOT = "bare-hall.robot"
"""Where several sites share a server, ids of new ones begin with their site."""
TEXT = (ROOT / "registry" / "demo" / "devices" / "robot01.ttl").read_text().replace("robot01", ROBOT)
HEADER = "image: hall.pgm\nresolution: 0.1\norigin: [-4.0, -3.0, 0.0]\n"
WIDTH, HEIGHT = 80, 60


def write_hall(folder: Path) -> list[Path]:
    """A hall of 8 by 6 metres with a wall around it."""
    edges = ({0, WIDTH - 1}, {0, HEIGHT - 1})
    cells = bytes(0 if x in edges[0] or y in edges[1] else 254 for y in range(HEIGHT) for x in range(WIDTH))
    (folder / "hall.yaml").write_text(HEADER)
    (folder / "hall.pgm").write_bytes(b"P5\n%d %d\n255\n" % (WIDTH, HEIGHT) + cells)
    return [folder / "hall.yaml", folder / "hall.pgm"]


def go_on(page: Page, does: str) -> None:
    """Press what the start card says comes next."""
    page.get_by_role("link", name="Home", exact=True).click()
    page.get_by_role("region", name="Set up Bare hall").get_by_role("link", name=does).click()


def test_an_empty_site_comes_to_its_first_program_and_a_change_of_its_map(sign_in: SignIn, tmp_path: Path) -> None:
    page = sign_in("admin", "/sites/new")
    page.get_by_label("Name of the site").fill("Bare hall")
    page.get_by_role("button", name="Make it without a map for now").click()
    card = page.get_by_role("region", name="Set up Bare hall")
    expect(card.get_by_role("listitem").filter(has_text="Give the site its map")).to_have_attribute(
        "aria-current", "step"
    )
    assert violations(page) == []
    card.get_by_role("link", name="Upload a map").click()
    page.get_by_label("Choose a map, a picture or a drawing, or drop it here").set_input_files(write_hall(tmp_path))
    page.get_by_role("button", name="Use this map").click()
    expect(page).to_have_url(re.compile("/sites/bare-hall/map$"))

    go_on(page, "Name places")
    page.get_by_role("button", name="Add a place").click()
    page.keyboard.press("Enter")
    expect(page.get_by_label("Name", exact=True)).to_be_focused()
    page.keyboard.type("Bench")
    page.keyboard.press("Enter")
    expect(page.get_by_role("button", name="Bench at")).to_be_visible()

    go_on(page, "Open the devices")
    setup = tell(page, "/api/sites/bare-hall/newcomers", {"id": ROBOT})
    text = TEXT.replace('"painting-factory"', '"bare-hall"').replace("15.78 -11.75", "1.0 1.0")
    with PlainDevice(setup) as robot:
        robot.introduce(text, loc=[1, 1, 0, 0], props={"battery": 90})
        page.get_by_role("button", name="Approve").click()
        expect(page.locator("tr[data-status]", has_text="TurtleBot 1")).to_contain_text("Idle")
        page.get_by_role("link", name="Home", exact=True).click()
        card.get_by_role("button", name="Draw a program").click()
        expect(page).to_have_url(re.compile("/programs/"))
        opened(page)
        page.keyboard.press("m")
        page.keyboard.type("Bench")
        page.keyboard.press("Enter")
        expect(page.get_by_text("Nothing to fix")).to_be_visible()
        saved(page)
        page.get_by_role("button", name="Simulate", exact=True).click()
        expect(page.get_by_role("region", name="Result")).to_contain_text("Finishes without errors")
    change_the_map(page)


def change_the_map(page: Page) -> None:
    """Draw a wall over the place by the keyboard; it is named before it is saved, and the old map stays."""
    origin = page.url.split("/programs/")[0]
    page.goto(f"{origin}/sites/bare-hall/map/edit")
    surface = page.get_by_role("application", name="The map. Tool: Wall")
    surface.focus()
    for key in ("Shift+ArrowLeft", "Enter", "Shift+ArrowRight", "Shift+ArrowRight", "Enter"):
        page.keyboard.press(key)
    page.keyboard.press("Control+z")
    expect(page.get_by_role("button", name="Save")).to_be_disabled()
    page.keyboard.press("Control+y")
    assert violations(page) == []
    page.get_by_role("button", name="Save").click()
    dialog = page.get_by_role("dialog", name="Save the changed map?")
    expect(dialog.get_by_text("Bench would lie where no robot can stand.")).to_be_visible()
    dialog.get_by_role("button", name="Save as a new version").click()
    expect(page).to_have_url(re.compile("/sites/bare-hall/map$"))
    versions = ask(page, "/api/sites/bare-hall/map/versions")
    assert [(each["version"], each["source"]) for each in versions] == [(2, "edit"), (1, "upload")]
    page.get_by_role("button", name="Look at version 1").click()
    expect(page.get_by_role("dialog", name="Version 1 of the map")).to_be_visible()
