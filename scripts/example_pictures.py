"""Make the pictures of docs/language/examples.md: each program of the field, as the editor draws it on its site's map.

python scripts/example_pictures.py [program …]; needs the built frontend.
"""

from __future__ import annotations

import json
import os
import re
import sys
import tempfile
from collections.abc import Sequence
from datetime import UTC, datetime, timedelta
from io import BytesIO
from pathlib import Path
from typing import Any

from PIL import Image
from playwright.sync_api import Browser, ViewportSize, expect, sync_playwright

ROOT = Path(__file__).resolve().parents[1]
sys.path.insert(0, str(ROOT))

from scripts.construct_pictures import clip_of  # noqa: E402
from scripts.example_sites import EAST_M, FOLDER, SOUTH_M, Example, hospital, warehouse  # noqa: E402
from tests.e2e.conftest import CHROMIUM, FLAGS, sign_in_by_form  # noqa: E402
from tests.kit.demo import Demo, running_demo  # noqa: E402

IMAGES = ROOT / "docs" / "language" / "images" / "examples"
SITES = (hospital(), warehouse())
WINDOW: ViewportSize = {"width": 1500, "height": 1000}
WIDTH = 1200
COLOURS = 128
DAY = timedelta(days=1)


def program_files(wanted: Sequence[str]) -> list[Path]:
    """Return the files of the programs, all of them if none is asked for."""
    sites = {site.id for site in SITES}
    return sorted(p for p in FOLDER.glob("*.json") if p.stem not in sites and (not wanted or p.stem in wanted))


def _make_site(site: Example) -> None:
    """Put a site into the database, its devices idle and online for the day."""
    from registry.demo.factory import make_grid
    from registry.maps.site_maps import save_map
    from registry.models import Device, Site
    from registry.sites.members import set_member
    from registry.sites.sites import create_site, save_places
    from registry.sites.views import PlaceView

    create_site(name=site.id.capitalize(), slug=site.id)
    save_map(site=site.id, grid=make_grid(dict(site.plan)), source="example")
    body = site.to_json()
    labels = {key: (x, -y) for key, (x, y) in site.labels.items()}
    save_places(
        site=site.id,
        places=[
            PlaceView(p["id"], p["name"], p["kind"], p["x"], p["y"], p["theta"], label=labels.get(p["id"]))
            for p in body["places"]
        ],
    )
    set_member(site=site.id, email="author@vipo.example", role="author")
    row, now = Site.objects.get(slug=site.id), datetime.now(UTC)
    for device in body["devices"]:
        readings = device.pop("readings", {})
        Device.objects.create(
            id=device["id"],
            site=row,
            lifecycle=Device.Lifecycle.APPROVED,
            description=device,
            online=True,
            properties=readings,
            first_seen_at=now,
            last_seen_at=now + DAY,
        )


def make_programs(state: Path, files: Sequence[Path]) -> dict[str, str]:
    """Put sites and programs into the demo's database; return the id of each program by its file's name."""
    os.environ["VIPO_STATE_DIR"] = str(state)
    os.environ["DJANGO_SETTINGS_MODULE"] = "vipo_site.settings"
    # imported late: the settings look at the state folder
    import django

    django.setup()
    from editor.services import create_program

    for site in SITES:
        _make_site(site)
    made = {}
    for path in files:
        body: dict[str, Any] = json.loads(path.read_text())
        site_id = str(body["site"]).removesuffix(".json")
        made[path.stem] = str(create_program(site=site_id, name=body["name"], document=body["document"]).id)
    return made


def photograph(browser: Browser, demo: Demo, files: Sequence[Path], made: dict[str, str]) -> None:
    """Take one picture of each program: the whole floor."""
    state = sign_in_by_form(browser, demo, "author")
    context = browser.new_context(viewport=WINDOW, color_scheme="light", locale="en-GB", storage_state=state)
    for path in files:
        page = context.new_page()
        page.goto(f"{demo.url}/programs/{made[path.stem]}")
        expect(page.get_by_text("self.new_task()").first).to_be_visible()
        page.keyboard.press("Control+j")
        page.get_by_role("button", name=re.compile("^Fit|whole floor", re.IGNORECASE)).first.click()
        page.wait_for_timeout(900)
        page.mouse.move(2, 2)
        page.evaluate("document.fonts.ready")
        clip = clip_of(page, (-0.2, 0.2, EAST_M + 0.2, -SOUTH_M - 0.2), widest=WINDOW["width"])
        _save(page.screenshot(clip=clip, animations="disabled"), IMAGES / f"{path.stem}.png")
        page.close()
    context.close()


def _save(picture: bytes, path: Path) -> None:
    """Write a picture as wide as all others, in few colours."""
    image = Image.open(BytesIO(picture)).convert("RGB")
    height = round(image.height * WIDTH / image.width)
    small = image.resize((WIDTH, height), Image.Resampling.LANCZOS)
    small.quantize(COLOURS, dither=Image.Dither.NONE).save(path, optimize=True)


def main() -> None:
    """Start a demo of its own, add the two sites, take the pictures, stop it."""
    IMAGES.mkdir(parents=True, exist_ok=True)
    files = program_files(sys.argv[1:])
    expect.set_options(timeout=60_000)
    with tempfile.TemporaryDirectory() as folder, running_demo(Path(folder)) as demo:
        made = make_programs(Path(folder), files)
        with sync_playwright() as play:
            browser = play.chromium.launch(executable_path=CHROMIUM, args=FLAGS)
            photograph(browser, demo, files, made)
            browser.close()


if __name__ == "__main__":
    main()
