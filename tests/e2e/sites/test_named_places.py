"""An admin gives a place on the map a name, by keyboard; others see it at once, and hear of what is removed."""

from __future__ import annotations

from typing import Any

import pytest
from playwright.sync_api import Locator, Page, expect

from tests.e2e.conftest import SignIn, make_member
from tests.e2e.screens import (
    SITE,
    address_of,
    ask,
    run_of,
    run_state,
    saved,
    start_run,
    tell,
    violations,
    write_program,
)
from tests.kit.demo import Demo
from tests.kit.waiting import wait_for

pytestmark = pytest.mark.browser
MAP = "/sites/painting-factory/map"
SCRIPT = """class Task(object):
    def new_task(self):
        self.wait(10)
        self.robot.move(self.stool.location)

    def run(self, ctx):
        self.robot = ctx.get("robot01")
        self.stool = ctx.place("stool")
        self.new_task()
"""


def places_of(page: Page) -> dict[str, Any]:
    return {place["id"]: place for place in ask(page, f"{SITE}/map")["places"]}


def where(page: Page, place: str) -> tuple[float, float]:
    found = places_of(page)[place]
    return found["x"], found["y"]


def test_a_place_is_made_moved_and_removed_by_keyboard_and_others_see_it(sign_in: SignIn) -> None:
    admin, author = sign_in("admin", MAP), sign_in("author", MAP)
    expect(author.get_by_role("button", name="Edit places")).to_have_count(0)
    before = places_of(admin)
    admin.get_by_role("button", name="Edit places").click()
    admin.get_by_role("button", name="Add a place").click()
    admin.keyboard.press("Enter")  # on the floor: into the middle
    expect(admin.get_by_label("Name", exact=True)).to_be_focused()
    admin.keyboard.type("Quality table")
    admin.keyboard.press("Enter")
    handle = admin.get_by_role("button", name="Quality table at")
    expect(handle).to_have_attribute("aria-pressed", "true")
    expect(author.get_by_role("region", name="Places").get_by_text("Quality table")).to_be_visible()
    assert violations(admin) == []
    x, y = where(admin, "quality_table")
    handle.focus()
    for key in ("Shift+ArrowDown", "ArrowDown", "ArrowLeft", "Enter"):
        admin.keyboard.press(key)
    moved = (round(x - 0.1, 2), round(y - 1.1, 2))
    wait_for("the place where it was put", lambda: where(admin, "quality_table") == moved)
    admin.reload()
    assert places_of(admin).keys() - before.keys() == {"quality_table"}
    admin.get_by_role("button", name="Edit places").click()
    admin.get_by_role("button", name="Quality table Point").click()
    admin.get_by_role("button", name="Remove the place").click()
    dialog = admin.get_by_role("dialog", name="Remove Quality table?")
    expect(dialog.get_by_text("No program goes here.")).to_be_visible()
    dialog.get_by_role("button", name="Remove the place").click()
    expect(author.get_by_text("Quality table")).to_have_count(0)
    assert places_of(admin) == before


def remove(page: Page, path: str) -> None:
    """Remove something with another person's session."""
    headers = {"X-CSRFToken": ask(page, "/api/me")["csrf"], "Referer": page.url}
    assert page.request.delete(address_of(page, f"{SITE}/{path}"), headers=headers).status == 204


def hold(page: Page, handle: Locator) -> None:
    """Take a thing on the map and drag it a little, without letting go."""
    handle.hover()
    page.mouse.down()
    x, y, width, height = (handle.bounding_box() or {}).values()
    page.mouse.move(x + width / 2 + 30, y + height / 2 + 20, steps=4)


def test_who_drags_what_somebody_else_removes_is_told_so(
    demo: Demo, signed_in: dict[str, Any], sign_in: SignIn
) -> None:
    signed_in["other admin"] = make_member(demo, "admin", "Olga Other")
    admin, other = sign_in("admin", MAP), sign_in("other admin", MAP)
    changes: list[str] = []
    admin.on("request", lambda request: changes.append(request.method) if request.method == "PATCH" else None)
    told = admin.get_by_role("alert").filter(has_text="meanwhile")
    tell(other, f"{SITE}/places", {"name": "Stool", "kind": "point", "x": 10.0, "y": -8.0})
    admin.get_by_role("button", name="Edit places").click()
    hold(admin, admin.get_by_role("button", name="Stool at"))
    remove(other, "places/stool")
    expect(told).to_have_text(
        "Stool was removed by somebody else meanwhile, and with it what you had not finished changing of it."
    )
    assert violations(admin) == []
    admin.mouse.up()
    expect(told.get_by_role("button")).to_have_count(1)  # the one that closes it

    tell(other, f"{SITE}/places", {"name": "Stool", "kind": "point", "x": 10.0, "y": -8.0})
    admin.get_by_role("button", name="Stool Point").click()
    admin.get_by_role("button", name="Remove the place").click()
    dialog = admin.get_by_role("dialog", name="Remove Stool?")
    remove(other, "places/stool")
    expect(told).to_have_count(2)
    expect(dialog).to_have_count(0)

    corners = [[9.0, -8.9], [11.0, -8.9], [11.0, -7.1], [9.0, -7.1]]
    tell(other, f"{SITE}/zones", {"name": "Spill", "rule": "slow", "speed_m_s": 0.3, "points": corners})
    admin.get_by_role("button", name="Edit zones").click()
    hold(admin, admin.get_by_role("button", name="Spill").first)
    remove(other, "zones/spill")
    expect(told.filter(has_text="Spill was removed by somebody else")).to_be_visible()
    admin.mouse.up()
    assert changes == []


def test_a_run_under_way_goes_to_a_place_that_is_removed_and_the_question_before_says_so(sign_in: SignIn) -> None:
    admin, author = sign_in("admin", MAP), sign_in("author")
    tell(admin, f"{SITE}/places", {"name": "Stool", "kind": "point", "x": 4.0, "y": -8.0})
    write_program(author, "To the stool", SCRIPT)
    saved(author)
    start_run(author)
    tell(author, f"/api/runs/{run_of(author)}/pause")  # before it sets out, however long the page takes
    expect(run_state(author)).to_contain_text("Paused")
    admin.get_by_role("button", name="Edit places").click()
    admin.get_by_role("button", name="Stool Point").click()
    admin.get_by_role("button", name="Remove the place").click()
    dialog = admin.get_by_role("dialog", name="Remove Stool?")
    says = "A run is under way. Until it is over it goes to where the place was when it began:"
    expect(dialog.get_by_role("note").filter(has_text=says)).to_contain_text("of To the stool")
    dialog.get_by_role("button", name="Remove the place").click()
    expect(dialog).to_have_count(0)
    expect(admin.get_by_role("alert").filter(has_text="meanwhile")).to_have_count(0)
    author.get_by_role("button", name="Resume", exact=True).click()
    expect(run_state(author)).to_contain_text("Finished", timeout=180_000)
    robot = ask(admin, f"{SITE}/devices/robot01")["location"]
    assert (round(robot["x"], 1), round(robot["y"], 1)) == (4.0, -8.0)
