"""The map's page says what a zone for one robot at a time has cost in rehearsals."""

from __future__ import annotations

import pytest
from playwright.sync_api import expect

from tests.e2e.conftest import SignIn
from tests.e2e.screens import SITE, ask, saved, shoot, tell, violations, write_program
from tests.kit.demo import Demo
from tests.kit.waiting import wait_for

pytestmark = pytest.mark.browser
HOME = "/sites/painting-factory"
CORNERS = [[8.0, -10.0], [14.0, -10.0], [14.0, -6.0], [8.0, -6.0]]
SCRIPT = """class Task(object):
    def new_task(self):
        self.parallel(self.branch_1a, self.branch_1b)

    def branch_1a(self):
        self.one.move(self.shelf.location)

    def branch_1b(self):
        self.other.move(self.cans.location)

    def run(self, ctx):
        self.one = ctx.get("robot01")
        self.other = ctx.get("robot02")
        self.shelf = ctx.get("itemInventory01")
        self.cans = ctx.get("paintInventory01")
        self.new_task()
"""


def test_what_a_zone_costs_is_known_once_it_was_rehearsed(demo: Demo, sign_in: SignIn) -> None:
    admin, author = sign_in("admin", f"{HOME}/map"), sign_in("author")
    tell(admin, f"{SITE}/zones", {"name": "Crossing", "rule": "one_at_a_time", "points": CORNERS})
    listed = admin.get_by_role("region", name="Zones")
    try:
        expect(listed.get_by_text("Not rehearsed yet as it is")).to_be_visible()
        write_program(author, "Two through the crossing", SCRIPT)
        saved(author)
        program = author.url.rsplit("/", 1)[1]
        wait_for("the steps", lambda: ask(author, f"/api/programs/{program}/compiled")["order"])
        begun = tell(author, f"/api/programs/{program}/rehearsals", {"driver": "kinematic"})
        wait_for("the rehearsal", lambda: ask(author, f"/api/rehearsals/{begun['id']}")["status"] == "done")
        admin.reload()
        expect(listed.get_by_text("Waiting in front of it")).to_be_visible()
        expect(listed.get_by_text("somebody waited in 1")).to_be_visible()
        shoot(admin, "zone-costs", "light", "dark")
        admin.set_viewport_size({"width": 820, "height": 1180})
        shoot(admin, "zone-costs-820", "light", "dark")
        assert violations(admin) == []
    finally:
        answer = admin.request.delete(
            f"{demo.url}{SITE}/zones/crossing",
            headers={"X-CSRFToken": ask(admin, "/api/me")["csrf"], "Referer": admin.url},
        )
        assert answer.status == 204
