"""Make the pictures of docs/language/images: one small program for each construct, as the editor draws it.

python -m scripts.construct_pictures [kind …]; needs a frontend that was built since the last `make constructs`.
"""

from __future__ import annotations

import os
import re
import sys
import tempfile
from pathlib import Path

from playwright.sync_api import Browser, FloatRect, Page, expect, sync_playwright

ROOT = Path(__file__).resolve().parents[1]
sys.path.insert(0, str(ROOT))

from scripts.construct_programs import Frame, Picture, pictures  # noqa: E402
from tests.e2e.conftest import CHROMIUM, FLAGS, sign_in_by_form, wait_for_devices  # noqa: E402
from tests.kit.demo import Demo, running_demo  # noqa: E402

IMAGES = ROOT / "docs" / "language" / "images"
BUILT = ROOT / "frontend" / "dist" / "index.html"
CONSTRUCTS = ROOT / "frontend" / "src" / "program" / "constructs.json"
PIXELS_PER_METRE = 46
WIDEST_PIXELS = 900
WINDOW = {"width": 1500, "height": 1000}
TRANSFORM = "document.querySelector('.react-flow__viewport').style.transform"


def make_programs(state: Path, wanted: dict[str, Picture]) -> dict[str, str]:
    """Put the programs into the demo's database; return the id of each."""
    os.environ["VIPO_STATE_DIR"] = str(state)
    os.environ["DJANGO_SETTINGS_MODULE"] = "vipo_site.settings"
    # imported late: the settings look at the state folder
    import django

    django.setup()
    from editor.services import create_program

    made = {
        kind: create_program(site="painting-factory", name=kind, document=picture.document())
        for kind, picture in wanted.items()
    }
    return {kind: str(program.id) for kind, program in made.items()}


def clip_of(page: Page, frame: Frame, widest: int = WIDEST_PIXELS) -> FloatRect:
    """Return where a part of the map stands on the screen, cut at so many pixels."""
    numbers = [float(n) for n in re.findall(r"-?[\d.]+", page.evaluate(TRANSFORM))]
    x, y, zoom = numbers[0], numbers[1], numbers[-1]
    origin = page.locator(".react-flow").bounding_box()
    assert origin is not None
    scale = PIXELS_PER_METRE * zoom
    left, top, right, bottom = frame
    width = min((right - left) * scale, widest)
    at = {"x": origin["x"] + x + left * scale, "y": origin["y"] + y - top * scale}
    return {"x": at["x"], "y": at["y"], "width": width, "height": (top - bottom) * scale}


def photograph(browser: Browser, demo: Demo, wanted: dict[str, Picture], made: dict[str, str]) -> None:
    """Take one picture of each program."""
    state = sign_in_by_form(browser, demo, "author")
    wait_for_devices(browser, demo, state)
    context = browser.new_context(viewport=WINDOW, color_scheme="light", locale="en-GB", storage_state=state)
    for kind, picture in wanted.items():
        page = context.new_page()
        page.goto(f"{demo.url}/programs/{made[kind]}")
        expect(page.get_by_text("self.new_task()").first).to_be_visible()
        page.keyboard.press("Control+j")
        page.get_by_role("button", name=re.compile("^Fit|whole floor", re.IGNORECASE)).first.click()
        page.wait_for_timeout(900)
        if picture.selected:
            page.locator(f'.react-flow__node[data-id="{picture.selected}"]').click()
        page.mouse.move(2, 2)
        page.evaluate("document.fonts.ready")
        page.screenshot(path=IMAGES / f"{kind}.png", clip=clip_of(page, picture.frame), animations="disabled")
        page.close()
    context.close()


def main() -> None:
    """Start a demo of its own, take the pictures, stop it."""
    IMAGES.mkdir(parents=True, exist_ok=True)
    asked = sys.argv[1:]
    if not BUILT.exists() or BUILT.stat().st_mtime < CONSTRUCTS.stat().st_mtime:
        sys.exit("The built frontend is older than the kinds of steps: run `make frontend`, then this again.")
    wanted = {kind: picture for kind, picture in pictures().items() if not asked or kind in asked}
    expect.set_options(timeout=60_000)
    with tempfile.TemporaryDirectory() as folder, running_demo(Path(folder)) as demo:
        made = make_programs(Path(folder), wanted)
        with sync_playwright() as play:
            browser = play.chromium.launch(executable_path=CHROMIUM, args=FLAGS)
            photograph(browser, demo, wanted, made)
            browser.close()


if __name__ == "__main__":
    main()
