"""Zones that people let robots into, in rehearsals: there a robot is let in by itself, and the course says so."""

from __future__ import annotations

import pytest

from editor.language import compile_document, parse_script, tree_to_document
from editor.language.site.surroundings import ZoneFacts
from execution.rehearsals.rehearsal import REPLY_S, Conditions, rehearse
from simulation.world import Scene
from tests.kit import demo_floor
from tests.kit.demo_site import factory

SITE = factory()
SCRIPT = """class Task(object):
    def new_task(self):
        self.robot.move(self.shelf.location)
        self.robot.move(self.dock.location)
        self.robot.move(self.shelf.location)

    def run(self, ctx):
        self.robot = ctx.get("robot01")
        self.shelf = ctx.get("paintInventory01")
        self.dock = ctx.get("dropOff01")
        self.new_task()
"""


@pytest.mark.parametrize("driver", ["kinematic", "physics"])
def test_a_robot_is_let_in_at_each_visit_and_the_course_says_so(driver: str) -> None:
    parsed = parse_script(SCRIPT, SITE)
    assert parsed.tree is not None, parsed.diagnostics
    compiled = compile_document(tree_to_document(parsed.tree, SITE), SITE)
    scene = Scene(demo_floor.grid(), demo_floor.devices(), seed=1)
    shelf = next(d.pose for d in demo_floor.devices() if d.id == "paintInventory01")
    corners = tuple((shelf.x + x, shelf.y + y) for x, y in ((-1.5, -1.5), (1.5, -1.5), (1.5, 1.5), (-1.5, 1.5)))
    zone = ZoneFacts("shelf", "The shelf", "release", corners)
    results = [
        rehearse(compiled.plan, scene, places=demo_floor.places(), zones=zones, conditions=Conditions(driver))
        for zones in ((), (zone,))
    ]
    free, let_in = results
    assert let_in["ok"]
    lines = [line for line in let_in["log"] if line["code"] == "let_in_itself"]
    assert [(line["device"], line["args"]["zone"]) for line in lines] == [("robot01", "The shelf")] * 2
    assert let_in["duration_s"] >= free["duration_s"] + 2 * REPLY_S
