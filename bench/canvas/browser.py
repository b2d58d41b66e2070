"""A traced Chromium: what the frames of a gesture take, and what a page holds."""

from __future__ import annotations

import json
import math
import subprocess
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from playwright.sync_api import Browser, CDPSession, Page, sync_playwright

from bench.flow import ROOT

CHROMIUM = "/usr/bin/chromium-headless-shell"
FLAGS = ["--no-sandbox", "--disable-gpu", "--use-angle=swiftshader", "--enable-unsafe-swiftshader", "--no-first-run"]
WIDTH, HEIGHT = 1600, 1000
MOVES = 60
MB = 1_000_000
BARE = "http://bare.test"

FRAMES = """
window.__frames = [];
let last = performance.now();
requestAnimationFrame(function look(now) {
  window.__frames.push(now - last);
  last = now;
  requestAnimationFrame(look);
});
"""
VIEW = """(() => {
  const found = new DOMMatrix(getComputedStyle(document.querySelector(".react-flow__viewport")).transform);
  const pane = document.querySelector(".react-flow").getBoundingClientRect();
  return [found.e + pane.left, found.f + pane.top, found.a];
})()"""

ROBOTS = """
const Native = window.WebSocket;
let site = null;
window.WebSocket = class extends Native {
  constructor(...address) {
    super(...address);
    if (String(address[0]).includes("/ws/site/")) site = this;
  }
};
let turn = 0;
setInterval(() => {
  if (site?.readyState !== 1) return;
  turn += 1;
  const say = (said) => site.dispatchEvent(new MessageEvent("message", { data: JSON.stringify(said) }));
  const robots = {};
  for (const [number, [id, x, y]] of ROBOTS.entries()) {
    const angle = turn / 20 + number;
    const location = { x: x + 1.5 * Math.cos(angle), y: y + 1.5 * Math.sin(angle), z: 0, theta: angle };
    say({ type: "device", device: { id, location } });
    robots[id] = { route: [[location.x, location.y], [x, y], [x + 3, y]], reserved: [], wait: null };
  }
  say({ type: "traffic", robots });
}, 200);
"""
"""Fifty robots drive in circles: five times a second the site's socket says where each is, as the server would."""


@dataclass(frozen=True)
class Seen:
    """What a gesture took: intervals between frames, processor time, and styles reckoned anew."""

    frames_ms: list[float]
    at_work_ms: list[float]
    """Of each frame: the processor time of the page's main thread, which no other process changes."""
    renderer_s: float
    all_s: float
    recalculations: int
    restyled: int
    most_restyled: int


@contextmanager
def chromium() -> Iterator[Browser]:
    """Debian's browser, without a screen and without a graphics card."""
    with sync_playwright() as playwright:
        browser = playwright.chromium.launch(executable_path=CHROMIUM, args=FLAGS)
        yield browser
        browser.close()


def bare_page(browser: Browser, source: Path, built: Path) -> Page:
    """Build a folder's page with the frontend's libraries into another; return a page that finds it at BARE."""
    vite = ROOT / "frontend" / "node_modules" / "vite" / "bin" / "vite.js"
    config = ROOT / "bench" / "bare.config.mjs"
    subprocess.run(
        ["node", str(vite), "build", str(source), "-c", str(config), "--outDir", str(built)],
        check=True, capture_output=True, cwd=ROOT,
    )  # fmt: skip
    page = browser.new_page(viewport={"width": WIDTH, "height": HEIGHT})
    page.add_init_script(FRAMES)
    page.route(f"{BARE}/**", lambda route: route.fulfill(path=built / route.request.url.split("/", 3)[3].split("?")[0]))
    return page


class Traced:
    """A page whose gestures are measured."""

    def __init__(self, browser: Browser, page: Page) -> None:
        self._browser, self._page = browser, page
        self._cdp = page.context.new_cdp_session(page)
        self._cdp.send("Performance.enable")
        self._cdp.send("HeapProfiler.enable")
        self._all: CDPSession = browser.new_browser_cdp_session()

    def view(self) -> tuple[float, float, float]:
        """Where the drawing plane's origin lies on the screen, and the zoom."""
        x, y, zoom = self._page.evaluate(VIEW)
        return x, y, zoom

    def zoom_to(self, wanted: float) -> None:
        """Zoom about the middle of the map with one turn of the wheel."""
        for _ in range(6):
            zoom = self.view()[2]
            if abs(zoom - wanted) < 0.01:
                break
            self._page.mouse.move(WIDTH / 2 - 100, HEIGHT / 2 - 120)
            self._page.mouse.wheel(0, max(-700.0, min(700.0, -math.log2(wanted / zoom) / 0.002)))
            self._page.wait_for_timeout(400)

    def pan(self) -> Seen:
        """Drag the map about with the middle button, 60 moves."""
        return self.measure(lambda: self._drag(WIDTH / 2 - 100, HEIGHT / 2 - 120, "middle"))

    def drag(self, at: tuple[float, float]) -> Seen:
        """Drag what lies at a point of the window about, 60 moves."""
        return self.measure(lambda: self._drag(*at, "left"))

    def zoom(self) -> Seen:
        """Turn the wheel out and in again, 30 turns of 10 %."""

        def turn() -> None:
            self._page.mouse.move(WIDTH / 2 - 100, HEIGHT / 2 - 120)
            for index in range(MOVES // 2):
                self._page.mouse.wheel(0, 69 if index % 10 < 5 else -69)
                self._page.wait_for_timeout(16)

        return self.measure(turn)

    def elements(self) -> int:
        """How many elements the document has."""
        return int(self._page.evaluate("document.querySelectorAll('*').length"))

    def heap_mb(self) -> float:
        """What the page's scripts hold after a collection."""
        for _ in range(2):
            self._cdp.send("HeapProfiler.collectGarbage")
        return float(self._metrics()["JSHeapUsedSize"]) / MB

    def _drag(self, x: float, y: float, button: Any) -> None:
        self._page.mouse.move(x, y)
        self._page.mouse.down(button=button)
        for index in range(MOVES):
            angle = 2 * math.pi * index / MOVES
            self._page.mouse.move(x + 160 * math.sin(angle), y + 90 * (1 - math.cos(angle)) * 0.7)
        self._page.mouse.up(button=button)

    def measure(self, gesture: Callable[[], None]) -> Seen:
        """What a gesture takes, whatever it is."""
        self._browser.start_tracing(page=self._page, categories=["devtools.timeline", "cc"])
        self._page.evaluate("window.__frames.length = 0")
        before, every = self._processor_s()
        gesture()
        frames = self._page.evaluate("window.__frames.slice()")
        after, every_after = self._processor_s()
        events = json.loads(self._browser.stop_tracing())["traceEvents"]
        restyled = [int(e["args"]["elementCount"]) for e in events
                    if e["name"] == "UpdateLayoutTree" and "elementCount" in e.get("args", {})]  # fmt: skip
        at_work = [float(e["tdur"]) / 1000 for e in events if e["name"] == "ProxyMain::BeginMainFrame" and "tdur" in e]
        return Seen(
            frames, at_work, after - before, every_after - every, len(restyled), sum(restyled), max(restyled, default=0)
        )

    def _processor_s(self) -> tuple[float, float]:
        told = self._all.send("SystemInfo.getProcessInfo")["processInfo"]
        renderers = sum(each["cpuTime"] for each in told if each["type"] == "renderer")
        return renderers, sum(each["cpuTime"] for each in told)

    def _metrics(self) -> dict[str, float]:
        return {each["name"]: each["value"] for each in self._cdp.send("Performance.getMetrics")["metrics"]}
