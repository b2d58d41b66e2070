"""The map of the editor with few and with many constructs, in the factory and in a hall, beside React Flow alone.

Frame intervals swing with whatever else the machine does; processor time for a frame, how many styles are reckoned
anew, elements and heap do not.
"""

from __future__ import annotations

import json
import os
import subprocess
import sys
import tempfile
import time
from collections.abc import Iterator
from pathlib import Path

from playwright.sync_api import Browser, BrowserContext, Page

from bench.canvas.browser import BARE, FRAMES, HEIGHT, MOVES, ROBOTS, WIDTH, Seen, Traced, bare_page, chromium
from bench.canvas.filling import COUNTS, FACTORY, HALL, robot_id
from bench.canvas.filling import ROBOTS as ROBOT_COUNT
from bench.figures import figure, share
from bench.flow import ROOT
from tests.kit.demo import Demo, running_demo

PATIENCE_MS = 120_000
PIXELS_PER_METRE = 46
HERE = Path(__file__).resolve().parent
FIRST = "[data-map] canvas[data-constructs]:not([data-constructs='0']), .react-flow__node-step"


def measure() -> Iterator[dict[str, object]]:
    with tempfile.TemporaryDirectory() as name, chromium() as browser:
        folder = Path(name)
        yield from _bare(browser, folder)
        with running_demo(folder / "state", speed=1) as demo:
            programs = fill_demo(demo)
            context = sign_in(browser, demo)
            for site in (HALL, FACTORY):
                for count in COUNTS:
                    yield from _editor(browser, context, demo, site, count, programs[f"{site} {count}"])


def fill_demo(demo: Demo) -> dict[str, str]:
    """Make the hall and its programs beside a running demo; return the ids of the programs by their names."""
    environment = {**os.environ, "VIPO_STATE_DIR": str(demo.state), "VIPO_MODE": "embedded", "VIPO_LOG": "ERROR",
                   "DJANGO_SETTINGS_MODULE": "vipo_site.settings"}  # fmt: skip
    command = [sys.executable, "-m", "bench.canvas.filling", demo.account("author").email]
    done = subprocess.run(command, cwd=ROOT, env=environment, capture_output=True, text=True)
    if done.returncode:
        raise RuntimeError(done.stderr)
    made: dict[str, str] = json.loads(done.stdout.splitlines()[-1])
    return made


def sign_in(browser: Browser, demo: Demo) -> BrowserContext:
    """Return a browser of the demo's author, whose pages count the intervals of their frames."""
    context = browser.new_context(
        viewport={"width": WIDTH, "height": HEIGHT}, locale="en-GB", service_workers="block",
        base_url=demo.url, color_scheme="light",
    )  # fmt: skip
    context.add_init_script(FRAMES)
    page = context.new_page()
    account = demo.account("author")
    page.goto("/sign-in")
    page.get_by_label("Email address").fill(account.email)
    page.get_by_label("Password", exact=True).fill(account.password)
    page.get_by_role("button", name="Sign in", exact=True).click()
    page.wait_for_url(f"{demo.url}/")
    page.close()
    return context


def _editor(
    browser: Browser, context: BrowserContext, demo: Demo, site: str, count: int, program: str
) -> Iterator[dict[str, object]]:
    more: dict[str, object] = {"of": "the editor", "site": site, "constructs": count}
    page = context.new_page()
    page.set_default_timeout(PATIENCE_MS)
    if site == HALL:
        page.add_init_script(f"const ROBOTS = {json.dumps(live_robots())};{ROBOTS}")
        more["live_robots"] = ROBOT_COUNT
    for warm in (False, True):
        began = time.perf_counter()
        page.goto(f"/programs/{program}")
        page.wait_for_selector(FIRST, state="attached")
        opened_ms = (time.perf_counter() - began) * 1000
        if warm:
            yield figure("first construct, warm page", opened_ms, "ms", **more)
    page.wait_for_timeout(4000)
    traced = Traced(browser, page)
    for name, zoom in (("the whole in view", None), ("zoom 1", 1.0)):
        if zoom:
            traced.zoom_to(zoom)
        where = {**more, "view": name, "zoom": round(traced.view()[2], 2)}
        yield figure("elements", traced.elements(), "elements", **where)
        yield figure("heap", traced.heap_mb(), "MB", **where)
        yield from _frames("pan", traced.pan(), where)
        yield from _frames("zoom", traced.zoom(), where)
        yield from _frames("drag", traced.drag(_construct(page, traced, demo, program)), where)
    page.close()


def live_robots() -> list[list[object]]:
    """Each robot of the hall: its id and the middle of the circle that it drives, metres."""
    return [[robot_id(n), 6 + n % 10 * 11.0, -(6 + n // 10 * 13.0)] for n in range(ROBOT_COUNT)]


def _construct(page: Page, traced: Traced, demo: Demo, program: str) -> tuple[float, float]:
    """Where the construct stands that is nearest to the middle of the map, pixels of the window."""
    document = page.request.get(f"/api/programs/{program}/document").json()
    x, y, zoom = traced.view()
    places = [
        (x + each["pos"][0] * PIXELS_PER_METRE * zoom, y - each["pos"][1] * PIXELS_PER_METRE * zoom)
        for each in document["steps"].values()
        if each["kind"] in {"wait", "operate"}
    ]
    return min(places, key=lambda at: abs(at[0] - WIDTH / 2 + 100) + abs(at[1] - HEIGHT / 2 + 120))


def _bare(browser: Browser, folder: Path) -> Iterator[dict[str, object]]:
    page = bare_page(browser, HERE / "bare", folder / "bare")
    for count in COUNTS:
        page.goto(f"{BARE}/index.html?nodes={count}")
        page.wait_for_selector(".react-flow__node")
        page.wait_for_timeout(1500)
        traced = Traced(browser, page)
        for name, zoom in (("the whole in view", None), ("zoom 1", 1.0)):
            if zoom:
                traced.zoom_to(zoom)
            where = {"of": "React Flow alone", "constructs": count, "view": name, "zoom": round(traced.view()[2], 2)}
            yield figure("elements", traced.elements(), "elements", **where)
            yield figure("heap", traced.heap_mb(), "MB", **where)
            yield from _frames("zoom", traced.zoom(), where)
    page.close()


def _frames(gesture: str, seen: Seen, more: dict[str, object]) -> Iterator[dict[str, object]]:
    """The figures of one gesture: its frames and what they cost."""
    frames = {**more, "frames": len(seen.frames_ms)}
    for name, quantile in (("p50", 0.5), ("p95", 0.95)):
        yield figure(f"{gesture}: interval of frames, {name}", share(seen.frames_ms, quantile), "ms", **frames)
        yield figure(
            f"{gesture}: main thread at work for a frame, {name}", share(seen.at_work_ms, quantile), "ms", **more
        )
    turns = MOVES if gesture != "zoom" else MOVES // 2
    yield figure(f"{gesture}: renderer at work for a move", seen.renderer_s * 1000 / turns, "ms", **more)
    yield figure(f"{gesture}: browser at work for a move", seen.all_s * 1000 / turns, "ms", **more)
    restyled = {"recalculations": seen.recalculations, "most_at_once": seen.most_restyled}
    yield figure(f"{gesture}: elements restyled for a move", seen.restyled / turns, "elements", **more, **restyled)
