"""The map's page shows where robots drove in runs and what waiting before a zone cost; its layers stay as chosen."""

from __future__ import annotations

import os
import re
import sys

import pytest
from playwright.sync_api import Page, expect

from tests.e2e.conftest import SignIn
from tests.e2e.screens import SITE, THIN_SPACE, ask, saved, shoot, tell, themed, violations, write_program
from tests.kit.demo import Demo
from tests.kit.files import ROOT
from tests.kit.processes.forked import run_forked
from tests.kit.waiting import wait_for

pytestmark = pytest.mark.browser
MAP = "/sites/painting-factory/map"
CORNERS = [[8.0, -10.0], [14.0, -10.0], [14.0, -6.0], [8.0, -6.0]]
SCRIPT = """class Task(object):
    def new_task(self):
        self.one.move(self.shelf.location)
        self.one.move(self.cans.location)

    def run(self, ctx):
        self.one = ctx.get("robot01")
        self.shelf = ctx.get("itemInventory01")
        self.cans = ctx.get("paintInventory01")
        self.new_task()
"""
WAIT = """
import os
from datetime import timedelta
from execution.models import Run, RunEvent
from registry.models import SiteMap
run = Run.objects.get(id=os.environ["RUN"])
told = {"run": run, "t_s": 0, "kind": "wait", "step": "a", "robot": "robot01"}
args = {"zone_key": "site/" + os.environ["ZONE"], "zone": "Narrows"}
begun_at, seq = run.ended_at - timedelta(seconds=200), run.events.count() + 1000
SiteMap.objects.update(frame_since=begun_at - timedelta(days=1))  # it lay so before
RunEvent.objects.create(seq=seq, at=begun_at, code="zone_taken", text="waits", args=args, **told)
RunEvent.objects.create(seq=seq + 1, at=run.ended_at, code="wait_over", text="goes on", **told)
"""


def add_wait(demo: Demo, run: str, zone: str) -> None:
    """Write into a run's journal that its robot waited for 200 s before a zone: how long it does is up to chance."""
    command = [sys.executable, "manage.py", "shell", "--verbosity", "0", "-c", WAIT]
    environment = {**os.environ, "VIPO_STATE_DIR": str(demo.state), "RUN": run, "ZONE": zone}
    environment.pop("DJANGO_SETTINGS_MODULE", None)
    run_forked(command, cwd=ROOT, env=environment, check=True, capture_output=True)


def run_program(author: Page) -> str:
    """Let a robot drive to one machine and to another; return the id of the run."""
    write_program(author, "There and on", SCRIPT)
    saved(author)
    program = author.url.rsplit("/", 1)[1]
    wait_for("the steps", lambda: ask(author, f"/api/programs/{program}/compiled")["order"])
    run = str(tell(author, f"/api/programs/{program}/runs")["id"])
    wait_for("the end of the run", lambda: ask(author, f"/api/runs/{run}")["status"] == "finished")
    return run


def test_heat_and_waiting_of_a_run_are_seen_and_the_layers_stay_as_chosen(demo: Demo, sign_in: SignIn) -> None:
    admin, author = sign_in("admin"), sign_in("author")
    zone = tell(admin, f"{SITE}/zones", {"name": "Narrows", "rule": "one_at_a_time", "points": CORNERS})["id"]
    try:
        add_wait(demo, run_program(author), zone)
        # what is told may be a minute old, if somebody has asked before
        told = f"{SITE}/floor-use?days=7&utc_offset_min={admin.evaluate('0 - new Date().getTimezoneOffset()')}"
        wait_for("the wait", lambda: any(each["waits"] for each in ask(admin, told)["zones"]))
        found = ask(admin, told)
        most = max(drives for *_, drives in found["heat"])
        assert found["runs"] >= 1
        assert len(found["heat"]) > 20

        admin.goto(demo.url + MAP)
        listed = admin.get_by_role("region", name="Zones")
        expect(listed.get_by_text(f"3{THIN_SPACE}min 20{THIN_SPACE}s, once")).to_be_visible()
        expect(listed.get_by_text(re.compile(r"^\d\d:\d\d to \d\d:\d\d$"))).to_be_visible()
        layers = admin.get_by_role("region", name="Layers")
        heat = layers.get_by_role("switch", name="Heat, 7 days")
        expect(heat).not_to_be_checked()
        shoot(admin, "layers", "light", "dark")
        heat.focus()
        admin.keyboard.press("Space")
        expect(layers.get_by_text("1 drive" if most == 1 else f"up to {most} drives", exact=True)).to_be_visible()
        shoot(admin, "heat", "light", "dark")
        assert violations(admin) == []

        layers.get_by_role("switch", name="Places").focus()
        admin.keyboard.press("Space")
        admin.reload()
        expect(heat).to_be_checked()
        expect(layers.get_by_role("switch", name="Places")).not_to_be_checked()
        expect(layers.get_by_role("switch", name="Zones")).to_be_checked()
        author.goto(demo.url + MAP)
        expect(author.get_by_role("switch", name="Heat, 7 days")).not_to_be_checked()

        fold = layers.get_by_role("button", name="Layers")
        fold.press("Enter")
        expect(heat).to_have_count(0)
        admin.set_viewport_size({"width": 820, "height": 1180})
        shoot(admin, "heat-820", "light", "dark")
        fold.press("Enter")
        expect(heat).to_be_checked()
        shoot(admin, "heat-820-open", "light", "dark")
        for scheme in ("light", "dark"):
            themed(admin, scheme)
            assert violations(admin) == []
        admin.get_by_role("button", name="Edit zones").click()
        expect(layers).to_have_count(0)
    finally:
        answer = admin.request.delete(
            f"{demo.url}{SITE}/zones/{zone}",
            headers={"X-CSRFToken": ask(admin, "/api/me")["csrf"], "Referer": demo.url},
        )
        assert answer.status == 204
