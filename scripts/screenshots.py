"""Make the pictures of docs/images from a real demo with the paint order; a folder, if given, gets a tablet's too.

python scripts/screenshots.py [folder for the tablet pictures]
"""

from __future__ import annotations

import re
import sys
import tempfile
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

from playwright.sync_api import Browser, Page, expect, sync_playwright

ROOT = Path(__file__).resolve().parents[1]
sys.path.insert(0, str(ROOT))

from tests.e2e.conftest import CHROMIUM, FLAGS, sign_in_by_form, wait_for_devices  # noqa: E402
from tests.e2e.screens import SITE, ask, chip, tell, the_map  # noqa: E402
from tests.kit.demo import Demo, running_demo  # noqa: E402

IMAGES = ROOT / "docs" / "images"
SIZES = {"": (1600, 1000), "tablet-": (820, 1180)}


class Camera:
    """Takes a picture of a page in one size."""

    def __init__(self, folder: Path, prefix: str) -> None:
        self.folder, self.prefix = folder, prefix

    def take(self, page: Page, name: str) -> None:
        """Save the picture under its name."""
        page.mouse.move(2, 2)
        page.evaluate("document.fonts.ready")
        page.screenshot(path=self.folder / f"{self.prefix}{name}.png", animations="disabled")


@contextmanager
def window(browser: Browser, demo: Demo, state: Any, size: tuple[int, int], dark: bool) -> Iterator[Page]:
    """Open a browser window of a person who is signed in."""
    context = browser.new_context(
        viewport={"width": size[0], "height": size[1]},
        color_scheme="dark" if dark else "light",
        locale="en-GB",
        storage_state=state,
        service_workers="block",
    )
    page = context.new_page()
    page.goto(demo.url)
    yield page
    context.close()


def paint_order(page: Page) -> str:
    """Return the path of the paint order's program."""
    return next(f"/programs/{each['id']}" for each in ask(page, f"{SITE}/programs") if each["name"] == "Paint order")


def show_editor(page: Page, demo: Demo, camera: Camera, name: str) -> None:
    """The paint order with the step selected that takes the box to the oven."""
    page.goto(demo.url + paint_order(page))
    step = chip(page, "4a, Pick-and-Drop")
    expect(step).to_be_visible()
    hidden = page.get_by_role("button", name="Show the drawer")
    if hidden.is_visible():  # as on a tablet
        hidden.click()
    expect(page.get_by_text("self.parallel").first).to_be_visible()
    step.click(position={"x": 14, "y": 14})
    expect(page.get_by_role("complementary", name="Selected step")).to_be_visible()
    page.wait_for_timeout(1500)  # what is live never rests
    camera.take(page, name)


def bring_tests(page: Page) -> None:
    """Give the paint order the tests of the examples, and carry them out."""
    program = paint_order(page)
    if not ask(page, f"/api{program}/tests")["tests"]:
        tell(page, f"/api{program}/tests/import", {"text": (ROOT / "examples/tests/paint-order.yaml").read_text()})
        tell(page, f"/api{program}/test-runs", {})


def show_tests(page: Page, demo: Demo, camera: Camera) -> None:
    """The tests of the paint order, one of them open as a form."""
    page.goto(demo.url + paint_order(page))
    page.get_by_role("tab", name="Tests").click()
    page.get_by_role("button", name="Make the drawer taller").click()
    tests = page.get_by_role("list", name="Tests").get_by_role("listitem")
    expect(tests.filter(has_text=re.compile("Passed|Failed")).first).to_be_visible(timeout=180_000)
    tests.filter(has_text="scratched").get_by_role("button").first.click()
    expect(page.get_by_role("region", name="Result")).to_be_visible()
    page.wait_for_timeout(1000)
    camera.take(page, "tests")


def save_function(page: Page) -> None:
    """Put the paint order's function into the library, so that the library has something to show."""
    program = paint_order(page).rpartition("/")[2]
    document = ask(page, f"/api/programs/{program}/document")
    function, facts = next(iter(document["functions"].items()))
    if ask(page, "/api/library?q="):
        return
    description = "Fetches a can of paint, mixes it and leaves it at the mixer."
    body = {"program": program, "function": function, "name": facts["name"], "description": description}
    tell(page, f"{SITE}/library", body)


def show_pages(page: Page, demo: Demo, camera: Camera) -> None:
    """Home, devices, library and map."""
    site = f"{demo.url}/sites/painting-factory"
    page.goto(f"{site}/devices/paintMixer02")
    expect(page.get_by_role("complementary", name="Paint Mixer B")).to_contain_text("mixPaint")
    page.wait_for_timeout(1500)  # what is live never rests
    camera.take(page, "registry")
    page.goto(f"{site}/library/{ask(page, '/api/library?q=')[0]['id']}")
    expect(page.get_by_text("def ").first).to_be_visible()
    camera.take(page, "library")
    page.goto(f"{site}/map")
    expect(page.get_by_role("heading", name="Places")).to_be_visible()
    page.wait_for_timeout(1500)  # what is live never rests
    camera.take(page, "map")
    page.goto(demo.url)
    expect(page.get_by_role("region", name="Recent runs").get_by_role("listitem").first).to_be_visible()
    page.wait_for_timeout(1500)  # what is live never rests
    camera.take(page, "home")


def show_simulation(page: Page, demo: Demo, camera: Camera, rehearsal: str) -> None:
    """The rehearsal while one robot carries and the mixer mixes."""
    page.goto(f"{demo.url}{paint_order(page)}/simulate/{rehearsal}")
    expect(page.get_by_text("Finishes without errors")).to_be_visible(timeout=180_000)
    expect(page.locator("canvas[data-engine]")).to_be_visible()
    page.get_by_role("slider", name="Moment of the recording").fill("60")
    expect(page.get_by_role("img", name=re.compile("carries"))).to_be_visible()
    page.wait_for_timeout(3000)
    camera.take(page, "simulation-3d")


def show_run(page: Page, demo: Demo, camera: Camera, run: str) -> None:
    """The run at its beginning: two robots on their ways at once."""
    page.goto(f"{demo.url}/runs/{run}")
    expect(the_map(page).locator("[data-state=running]").first).to_be_visible()
    expect(page.get_by_role("tabpanel").get_by_role("button").nth(1)).to_be_visible()
    page.wait_for_timeout(1500)  # what is live never rests
    page.wait_for_timeout(1500)
    camera.take(page, "run-monitor")


def photograph(browser: Browser, demo: Demo, tablet: Path | None) -> None:
    """Take all pictures: those of the desktop into docs/images, those of the tablet elsewhere, if wanted."""
    state = sign_in_by_form(browser, demo, "author")
    wait_for_devices(browser, demo, state)
    cameras = {"": Camera(IMAGES, "")}
    if tablet is not None:
        cameras["tablet-"] = Camera(tablet, "tablet-")
    with window(browser, demo, state, SIZES[""], dark=False) as page:
        save_function(page)
        bring_tests(page)
        rehearsal = tell(page, f"/api{paint_order(page)}/rehearsals")["id"]
        run = tell(page, f"/api{paint_order(page)}/runs")["id"]
    for prefix, camera in cameras.items():
        with window(browser, demo, state, SIZES[prefix], dark=False) as page:
            show_run(page, demo, camera, run)
            show_editor(page, demo, camera, "editor-light")
            show_pages(page, demo, camera)
            show_simulation(page, demo, camera, rehearsal)
            show_tests(page, demo, camera)
        with window(browser, demo, state, SIZES[prefix], dark=True) as page:
            show_editor(page, demo, camera, "editor-dark")


def main() -> None:
    """Start a demo of its own, take the pictures, stop it."""
    tablet = Path(sys.argv[1]) if len(sys.argv) > 1 else None
    for folder in (IMAGES, tablet):
        if folder is not None:
            folder.mkdir(parents=True, exist_ok=True)
    expect.set_options(timeout=60_000)
    with tempfile.TemporaryDirectory() as state, running_demo(Path(state), speed=4) as demo, sync_playwright() as play:
        browser = play.chromium.launch(executable_path=CHROMIUM, args=FLAGS)
        photograph(browser, demo, tablet)
        browser.close()


if __name__ == "__main__":
    main()
