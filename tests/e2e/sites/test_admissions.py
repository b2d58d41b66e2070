"""A robot waits before a zone that people let robots into; an operator on a tablet lets it in, by keyboard."""

from __future__ import annotations

from typing import Any

import pytest
from playwright.sync_api import expect

from tests.e2e.conftest import SignIn, make_member
from tests.e2e.screens import SITE, ask, run_state, saved, shoot, start_run, tell, violations, write_program
from tests.kit.demo import Demo

pytestmark = pytest.mark.browser
HOME = "/sites/painting-factory"
CORNERS = [[13.0, -8.9], [15.0, -8.9], [15.0, -7.1], [13.0, -7.1]]
SCRIPT = """class Task(object):
    def new_task(self):
        self.robot.move((14.0, -8.0))

    def run(self, ctx):
        self.robot = ctx.get("robot01")
        self.new_task()
"""


def test_a_robot_waits_to_be_let_in_and_an_operator_lets_it_in(
    demo: Demo, signed_in: dict[str, Any], sign_in: SignIn
) -> None:
    signed_in["door keeper"] = make_member(demo, "operator", "Dora Keeper")
    signed_in["onlooker"] = make_member(demo, "viewer", "Otto Looks")
    admin, author = sign_in("admin", f"{HOME}/map"), sign_in("author")
    zone = {"name": "Mixing corner", "rule": "release", "points": CORNERS}
    tell(admin, f"{SITE}/zones", zone)
    listed = admin.get_by_role("region", name="Zones")
    expect(listed.get_by_text("Let in by a person")).to_be_visible()
    shoot(admin, "released-zone", "light", "dark")
    try:
        write_program(author, "Into the mixing corner", SCRIPT)
        saved(author)
        program = author.url

        start_run(author)
        tablet = sign_in("door keeper", f"{HOME}/programs", width=820, height=1180)
        viewer = sign_in("onlooker", f"{HOME}/programs", language="de")
        bell = tablet.get_by_role("button", name="1 robot waits to be let in")
        expect(bell).to_be_visible(timeout=180_000)
        card = author.get_by_role("region", name="A robot waits to be let in")
        expect(card.get_by_text("TurtleBot 1 waits to be let into Mixing corner.")).to_be_visible()
        shoot(author, "let-in-run", "light", "dark")
        assert violations(author) == []
        viewer.get_by_role("button", name="1 Roboter wartet auf Einlass").press("Enter")
        expect(viewer.get_by_text("Ein Bediener kann ihn einlassen.")).to_be_visible()
        expect(viewer.get_by_role("button", name="Einlassen")).to_have_count(0)
        bell.press("Enter")
        shoot(tablet, "let-in-tablet", "light", "dark")
        assert violations(tablet) == []
        tablet.get_by_role("button", name="Let it in: TurtleBot 1, Mixing corner").press("Enter")
        expect(bell).to_have_count(0)
        expect(card).to_have_count(0)
        expect(run_state(author)).to_contain_text("Finished", timeout=180_000)
        assert ask(admin, f"{SITE}/admissions") == []

        expect(listed.get_by_text("No robot is in it.")).to_be_visible(timeout=180_000)
        author.goto(program)
        start_run(author)
        card.get_by_role("button", name="Open to all …: Mixing corner").press("Enter")
        shoot(author, "open-zone-menu", "light", "dark")
        author.keyboard.press("Escape")
        bell.click()
        tablet.get_by_role("button", name="Open to all …: Mixing corner").click()
        shoot(tablet, "open-zone-menu-tablet", "light")
        tablet.get_by_role("menuitem", name="For an hour").click()
        expect(run_state(author)).to_contain_text("Finished", timeout=180_000)
        shoot(author, "opened-zone-run", "light")
        expect(listed.get_by_text("Released until")).to_be_visible()
        expect(listed.get_by_text("In it now: TurtleBot 1.")).to_be_visible()
        shoot(admin, "opened-zone", "light", "dark")
        admin.set_viewport_size({"width": 820, "height": 1180})
        shoot(admin, "opened-zone-820", "light", "dark")
        assert violations(admin) == []
        tablet.goto(tablet.url.replace("/programs", "/map"))
        place = tablet.get_by_role("region", name="Zones")
        expect(place.get_by_text("All robots drive in until")).to_be_visible()
        shoot(tablet, "opened-zone-tablet", "light")
        place.get_by_role("button", name="Close now: Mixing corner").press("Enter")
        expect(place.get_by_text("Robots are let in one by one.")).to_be_visible()
        expect(listed.get_by_text("Released until")).to_have_count(0)
        viewer.goto(viewer.url.replace("/programs", "/map"))
        shown = viewer.get_by_role("region", name="Zonen")
        expect(shown.get_by_text("Roboter werden einzeln eingelassen.")).to_be_visible()
        expect(shown.get_by_role("button", name="Mixing corner")).to_have_count(0)
    finally:
        answer = admin.request.delete(
            f"{admin.url.split('/sites/')[0]}{SITE}/zones/mixing_corner",
            headers={"X-CSRFToken": ask(admin, "/api/me")["csrf"], "Referer": admin.url},
        )
        assert answer.status == 204
