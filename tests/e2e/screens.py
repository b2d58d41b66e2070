"""What a person does on VIPO's screens, by the words that stand there."""

from __future__ import annotations

import os
import re
from typing import Any

from playwright.sync_api import Locator, Page, expect

from tests.kit.files import ROOT
from tests.kit.waiting import wait_for

THIN_SPACE = "\u202f"
OTHERS = re.compile(r"(?:, [A-Z]\w+ [A-Z]\w+)+ here\b")
SITE = "/api/sites/painting-factory"
TASK = "Pick-and-Drop, 1 \u00d7 box from Item Inventory to Painting Machine"


def ask(page: Page, path: str) -> Any:
    """Read from the interface with the page's own session."""
    answer = page.request.get(address_of(page, path))
    assert answer.ok, f"{path}: {answer.status} {answer.text()}"
    return answer.json()


def make_program(page: Page, name: str) -> str:
    """Make a program in the painting factory and open it; return its path."""
    path = f"/programs/{tell(page, f'{SITE}/programs', {'name': name})['id']}"
    page.goto(address_of(page, path))
    expect(page.get_by_label("Name of the program")).to_have_value(name)
    return path


def make_program_by_form(page: Page, name: str) -> None:
    """Make a program by the form of the programs page."""
    show_programs(page)
    page.get_by_role("banner").get_by_role("button", name="New program").click()
    page.get_by_role("dialog").get_by_label("Name").fill(name)
    page.keyboard.press("Enter")
    expect(page.get_by_label("Name of the program")).to_have_value(name)


def address_of(page: Page, path: str) -> str:
    """The address of a path where this page is from."""
    origin = re.match(r"https?://[^/]+", page.url)
    assert origin is not None
    return origin[0] + path


def show_programs(page: Page) -> None:
    """Go to the list of the painting factory's programs and wait until it is there."""
    page.goto(address_of(page, "/sites/painting-factory/programs"))
    expect(page.get_by_role("heading", level=1, name="Programs")).to_be_visible()
    expect(page.get_by_role("table")).to_be_visible()


def open_program(page: Page, name: str) -> None:
    show_programs(page)
    page.get_by_role("table").get_by_role("link", name=name, exact=True).click()
    expect(page.get_by_label("Name of the program")).to_have_value(name)


def opened(page: Page) -> None:
    """Wait until the program itself is here, from the server or from the browser's copy."""
    expect(page.get_by_role("toolbar", name="Tools")).to_be_visible()


def program_named(page: Page, name: str) -> str:
    """The id of the painting factory's program of this name."""
    return str(next(each["id"] for each in ask(page, f"{SITE}/programs") if each["name"] == name))


def the_map(page: Page) -> Locator:
    return page.get_by_role("application", name=re.compile("on the map"))


def machine(page: Page, name: str) -> Locator:
    return the_map(page).get_by_role("group", name=re.compile(f"^{re.escape(name)}\\b"))


def chip(page: Page, name: str) -> Locator:
    """A step on the map, by its number and what it says."""
    return the_map(page).get_by_role("group", name=re.compile(f"^{re.escape(name)}"))


def draw_task(
    page: Page, source: str = "Item Inventory", target: str = "Painting Machine", load: str = "1 \u00d7 box"
) -> None:
    """Draw a Pick-and-Drop as a novice does: one key, three clicks."""
    page.keyboard.press("p")
    machine(page, source).click()
    machine(page, target).click()
    page.get_by_role("dialog", name="What to carry?").get_by_role("button", name=load, exact=True).click()


def click_floor(page: Page, x: float, y: float) -> None:
    """Click the map at a share of its width and height."""
    box = the_map(page).bounding_box()
    assert box is not None
    page.mouse.click(box["x"] + box["width"] * x, box["y"] + box["height"] * y)


def saved(page: Page) -> None:
    """Wait until everything that was drawn is in the database."""
    expect(page.get_by_text("Saved", exact=True)).to_be_visible()


def script_lines(page: Page) -> list[str]:
    """The script beside the drawing, without the space at lines' ends."""
    text = page.get_by_role("textbox", name="Script").locator(".cm-line").all_inner_texts()
    return [line.rstrip() for line in text]


def problems(page: Page) -> Locator:
    page.get_by_role("tab", name=re.compile("^Problems")).click()
    return page.get_by_role("tabpanel", name=re.compile("^Problems")).get_by_role("listitem")


def steps_in_list(page: Page) -> list[str]:
    """The names of the steps as the list of steps reads them out, without who else is there."""
    page.get_by_role("tab", name="Steps").click()
    rows = page.get_by_role("tree", name="Steps").get_by_role("treeitem")
    names: list[str] = rows.evaluate_all("(rows) => rows.map((row) => row.getAttribute('aria-label') ?? '')")
    return [OTHERS.sub("", name.replace(THIN_SPACE, " ")) for name in names]


def expect_steps(page: Page, wanted: list[str]) -> None:
    """Wait until these are in the list of steps: their numbers and places come after them, from the server."""
    wait_for("the list of steps", lambda: steps_in_list(page) == wanted, story=lambda: "\n".join(steps_in_list(page)))


def same_steps(*pages: Page) -> list[str]:
    """Wait until the list of steps is the same on all of these pages; return it."""

    def shown() -> list[list[str]]:
        return [steps_in_list(page) for page in pages]

    def same() -> list[str]:
        first, *others = shown()
        return first if all(each == first for each in others) else []

    return wait_for("the same list of steps", same, story=lambda: "\n".join(map(str, shown())))


def start_run(page: Page) -> None:
    page.get_by_role("banner").get_by_role("button", name="Run", exact=True).click()
    page.get_by_role("dialog").get_by_role("button", name="Run", exact=True).click()
    expect(page).to_have_url(re.compile("/runs/"))


def run_of(page: Page) -> str:
    """The id of the run whose page this is."""
    found = re.search(r"/runs/([0-9a-f-]+)", page.url)
    assert found is not None
    return found[1]


def end_run(page: Page, run: str) -> None:
    """Cancel a run, unless it is over by now."""
    headers = {"X-CSRFToken": ask(page, "/api/me")["csrf"]}
    answer = page.request.post(address_of(page, f"/api/runs/{run}/cancel"), data={}, headers=headers)
    assert answer.ok or answer.status == 409, answer.text()


def run_state(page: Page) -> Locator:
    """How a run stands, which is read out, and its clock beside that, which is not."""
    state = page.get_by_role("banner").locator("[data-status]").filter(has=page.get_by_role("status"))
    return state.filter(has_text=re.compile(r"\d:\d\d"))


def device(page: Page, name: str) -> dict[str, Any]:
    found: dict[str, Any] = ask(page, f"{SITE}/devices/{name}")
    return found


def reading(page: Page, device_id: str, name: str) -> Any:
    return next(each["value"] for each in device(page, device_id)["properties"] if each["name"] == name)


def tell(page: Page, path: str, body: dict[str, Any] | None = None) -> Any:
    """Change something over the interface with the page's own session."""
    token = ask(page, "/api/me")["csrf"]
    answer = page.request.post(address_of(page, path), data=body or {}, headers={"X-CSRFToken": token})
    assert answer.ok, f"{path}: {answer.status} {answer.text()}"
    return answer.json()


AXE = ROOT / "frontend" / "node_modules" / "axe-core" / "axe.min.js"


SERIOUS = {"serious", "critical"}


FRAMES = "() => new Promise((done) => requestAnimationFrame(() => requestAnimationFrame(() => done())))"


MOVED = """() => Promise.allSettled(
    document.getAnimations()
        .filter((each) => each.playState === "running" && each.effect.getTiming().iterations !== Infinity)
        .map((each) => each.finished),
)"""


def resize(page: Page, width: int, height: int) -> None:
    """Give the window another size, and wait until what moves into its new place is there."""
    page.set_viewport_size({"width": width, "height": height})
    page.evaluate(FRAMES)
    page.evaluate(MOVED)


STILL = """() => document.getAnimations().every(
  (each) => each.playState !== "running" || each.effect?.getTiming().iterations === Infinity)"""
"""What fades in has the colours of both: contrast is measured when nothing moves but what always does."""


def shoot(page: Page, name: str, *schemes: str) -> None:
    """Keep a picture where somebody wants to look at one (`VIPO_PICTURES` names a folder); one of each scheme named."""
    if not (folder := os.environ.get("VIPO_PICTURES")):
        return
    for scheme in schemes:
        themed(page, scheme)
        until(page, "() => document.getAnimations().every((each) => !(each instanceof CSSTransition))")
        page.screenshot(path=f"{folder}/{name}-{scheme}.png")
    if schemes:
        themed(page, "light")
    else:
        page.screenshot(path=f"{folder}/{name}.png")


def until(page: Page, expression: str, argument: Any = None) -> None:
    """Wait until a JavaScript function is true on the page; asked from here, since pages allow no `eval` to wait by."""
    wait_for(expression, lambda: bool(page.evaluate(expression, argument)))


def themed(page: Page, scheme: str) -> None:
    """Prefer light or dark, as the system does, and wait until the page has followed."""
    page.emulate_media(color_scheme=scheme)  # type: ignore[arg-type]  # one of two words
    until(page, "(scheme) => document.documentElement.dataset.mantineColorScheme === scheme", scheme)


def violations(page: Page) -> list[str]:
    """Return what axe finds of serious faults; what it finds is looked at again, since something may have faded in."""
    return _violations(page) and _violations(page)


def _violations(page: Page) -> list[str]:
    page.evaluate(FRAMES)  # what a change of style sets off begins with a frame
    until(page, STILL)
    if not page.evaluate("'axe' in window"):
        page.evaluate(AXE.read_text())
    result: dict[str, Any] = page.evaluate("axe.run(document, { resultTypes: ['violations'] })")
    return [
        f"{each['id']} ({each['impact']}): "
        + "; ".join(str(node["target"]) + node["html"][:120] for node in each["nodes"][:3])
        for each in result["violations"]
        if each["impact"] in SERIOUS
    ]


def editor(page: Page) -> Locator:
    return page.get_by_role("textbox", name="Script")


def open_script(page: Page) -> Locator:
    page.get_by_role("tab", name="Script").click()
    expect(editor(page)).to_be_visible()
    return editor(page)


def write_program(page: Page, name: str, script: str) -> None:
    """Make a program by putting a whole script into its panel."""
    make_program(page, name)
    open_script(page)
    editor(page).click()
    page.keyboard.press("Control+a")
    page.keyboard.insert_text(script)
    saved(page)
