"""Fifty robots in 3D, in a rehearsal that is played and in a run that is watched, beside three.js with as many alone.

Without a graphics card the processor fills every pixel, so intervals of frames say how fast this machine paints; what a
frame asks of the page's main thread, and how many calls it makes to draw, hold on every machine.
"""

from __future__ import annotations

import json
import tempfile
from collections.abc import Iterator
from pathlib import Path

from playwright.sync_api import Browser, BrowserContext, Page

from bench.canvas import PATIENCE_MS, fill_demo, live_robots, sign_in
from bench.canvas.browser import BARE, ROBOTS, Seen, Traced, bare_page, chromium
from bench.canvas.filling import ROBOTS as ROBOT_COUNT
from bench.canvas.filling import TOUR
from bench.figures import figure, share
from tests.kit.demo import running_demo

HERE = Path(__file__).resolve().parent
WATCHED_S = 8
SETTLES_MS = 6000
"""After so long it is drawn with as many pixels as this machine can."""
REHEARSED_MS = 240_000
DRAWS = """
window.__draws = 0;
for (const name of ["drawArrays", "drawElements", "drawArraysInstanced", "drawElementsInstanced"]) {
  const real = WebGL2RenderingContext.prototype[name];
  WebGL2RenderingContext.prototype[name] = function (...given) {
    window.__draws += 1;
    return real.apply(this, given);
  };
}
"""
START = """async ([address, body]) => {
  const token = document.cookie.match(/csrftoken=([^;]+)/)?.[1] ?? "";
  const headers = { "content-type": "application/json", "x-csrftoken": token };
  const answer = await fetch(address, { method: "POST", headers, body: JSON.stringify(body) });
  return [answer.status, await answer.json()];
}"""


def measure() -> Iterator[dict[str, object]]:
    with tempfile.TemporaryDirectory() as name, chromium() as browser:
        folder = Path(name)
        yield from _bare(browser, folder)
        with running_demo(folder / "state", speed=1) as demo:
            programs = fill_demo(demo)
            context = sign_in(browser, demo)
            yield from _rehearsal(browser, context, programs[TOUR])
            yield from _run(browser, context, programs[TOUR])


def _page(context: BrowserContext) -> Page:
    page = context.new_page()
    page.set_default_timeout(PATIENCE_MS)
    page.add_init_script(DRAWS)
    return page


def _start(page: Page, address: str, body: dict[str, object]) -> str:
    status, made = page.evaluate(START, [address, body])
    if status >= 300:
        raise RuntimeError(f"{address} answered {status}: {made}")
    return str(made["id"])


def _rehearsal(browser: Browser, context: BrowserContext, program: str) -> Iterator[dict[str, object]]:
    page = _page(context)
    page.goto("/health")
    rehearsal = _start(page, f"/api/programs/{program}/rehearsals", {"driver": "kinematic", "seed": 1})
    page.goto(f"/programs/{program}/simulate/{rehearsal}")
    page.wait_for_selector("[data-scene] canvas", timeout=REHEARSED_MS)
    traced = Traced(browser, page)
    for names in (True, False):
        if not names:
            page.get_by_role("button", name="Names").click()
        page.get_by_role("button", name="Play", exact=True).click()
        yield from _figures(page, traced, {"of": "a rehearsal", "names": names})
        page.get_by_role("button", name="Pause", exact=True).click()
    page.close()


def _run(browser: Browser, context: BrowserContext, program: str) -> Iterator[dict[str, object]]:
    page = _page(context)
    page.add_init_script(f"const ROBOTS = {json.dumps(live_robots())};{ROBOTS}")
    page.goto("/health")
    run = _start(page, f"/api/programs/{program}/runs", {})
    page.goto(f"/runs/{run}?view=3d")
    page.wait_for_selector("[data-scene] canvas")
    yield from _figures(page, Traced(browser, page), {"of": "a run", "names": True})
    page.close()


def _bare(browser: Browser, folder: Path) -> Iterator[dict[str, object]]:
    page = bare_page(browser, HERE / "bare", folder / "bare")
    page.add_init_script(DRAWS)
    page.goto(f"{BARE}/index.html?robots={ROBOT_COUNT}")
    page.wait_for_selector("canvas")
    yield from _figures(page, Traced(browser, page), {"of": "three.js alone", "names": False})
    page.close()


def _figures(page: Page, traced: Traced, more: dict[str, object]) -> Iterator[dict[str, object]]:
    box = page.locator("canvas").last.bounding_box()
    more = {**more, "robots": ROBOT_COUNT, "of_the_page": round(box["width"] * box["height"]) if box else None}
    page.wait_for_timeout(SETTLES_MS)
    page.evaluate("window.__draws = 0")
    seen: Seen = traced.measure(lambda: page.wait_for_timeout(WATCHED_S * 1000))
    draws = page.evaluate("window.__draws")
    more["drawn"] = page.evaluate(
        "(() => { const c = [...document.querySelectorAll('canvas')].at(-1); return c.width * c.height; })()"
    )
    frames = {**more, "frames": len(seen.frames_ms)}
    for name, quantile in (("p50", 0.5), ("p95", 0.95)):
        yield figure(f"interval of frames, {name}", share(seen.frames_ms, quantile), "ms", **frames)
        yield figure(f"main thread at work for a frame, {name}", share(seen.at_work_ms, quantile), "ms", **more)
    count = max(1, len(seen.frames_ms))
    yield figure("calls to draw for a frame", draws / count, "calls", **more)
    yield figure("renderer at work for a frame", seen.renderer_s * 1000 / count, "ms", **more)
    yield figure("browser at work for a frame", seen.all_s * 1000 / count, "ms", **more)
