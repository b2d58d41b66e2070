"""Covers of zones in rehearsals: a script, real physics or plain motion, one robot or two, and a site of the field."""

import pytest

from editor.language import compile_document, parse_script, tree_to_document
from execution.rehearsals.program_file import read_site
from execution.rehearsals.rehearsal import Conditions, rehearse
from simulation.world import Scene
from tests.kit import demo_floor
from tests.kit.demo_site import factory
from tests.kit.files import ROOT
from vipo_site.cli.program_file import read_program_file

SITE = factory()
SCRIPT = """class Task(object):
    def new_task(self):
        self.robot.cover(self.hall, lane=0.5)
        self.robot.move(self.drop_off.location)

    def run(self, ctx):
        self.robot = ctx.get("robot01")
        self.drop_off = ctx.get("dropOff01")
        self.hall = ctx.zone("hall", [(1.5, -5.5), (4.5, -5.5), (4.5, -4), (1.5, -4)], rule="slow", speed=0.5)
        self.new_task()
"""
TWO = """class Task(object):
    def new_task(self):
        self.parallel(self.branch_1a, self.branch_1b)

    def branch_1a(self):
        self.robot.cover(self.hall, lane=0.5)

    def branch_1b(self):
        self.second.cover(self.hall, lane=0.5)

    def run(self, ctx):
        self.robot = ctx.get("robot01")
        self.second = ctx.get("robot02")
        self.hall = ctx.zone("hall", [(1.5, -5.5), (4.5, -5.5), (4.5, -4), (1.5, -4)], rule="slow", speed=0.5)
        self.new_task()
"""


def rehearsed(script, conditions):
    """Rehearse a script in the factory."""
    parsed = parse_script(script, SITE)
    assert parsed.tree is not None, parsed.diagnostics
    compiled = compile_document(tree_to_document(parsed.tree, SITE), SITE)
    assert [d.code for d in compiled.diagnostics] == []
    scene = Scene(demo_floor.grid(), demo_floor.devices(), seed=1)
    return rehearse(compiled.plan, scene, places=demo_floor.places(), conditions=Conditions(conditions))


def said(result, code):
    return [line["args"] for line in result["log"] if line["code"] == code]


@pytest.mark.parametrize("driver", ["kinematic", "physics"])
def test_a_robot_covers_a_zone_and_goes_on(driver):
    result = rehearsed(SCRIPT, driver)
    assert (result["ok"], result["errors"], result["collisions"]) == (True, [], [])
    assert [(step["status"], step["count"]) for step in result["steps"]] == [("done", 1), ("done", 1)]
    assert [(each["zone"], each["lanes"]) for each in said(result, "cover_begins")] == [("hall", 3)]
    assert said(result, "covered")[0]["percent"] >= 95
    path = [(x, y) for x, y, _ in result["frames"]["robots"]["robot01"]]
    for corner in ((1.75, -5.25), (4.25, -5.25), (4.25, -4.25), (1.75, -4.25)):
        assert min(abs(x - corner[0]) + abs(y - corner[1]) for x, y in path) < 0.2


def test_two_robots_cover_one_zone_and_do_not_touch():
    result = rehearsed(TWO, "kinematic")
    assert (result["ok"], result["errors"], result["collisions"]) == (True, [], [])
    assert [each["percent"] >= 95 for each in said(result, "covered")] == [True, True]


def test_the_estimate_of_time_is_of_the_right_size_on_a_site_of_the_field():
    program = read_program_file(ROOT / "examples" / "field" / "rmf-cleaning.json", None)
    surroundings, scene, places = read_site(program.site, 0)
    compiled = compile_document(program.document, surroundings)
    result = rehearse(compiled.plan, scene, places=places, conditions=Conditions("kinematic"))
    assert (result["ok"], result["errors"]) == (True, [])
    (begun,), (ended,) = said(result, "cover_begins"), said(result, "covered")
    times = [line["t"] for line in result["log"] if line["code"] in {"cover_begins", "covered"}]
    minutes = (times[1] - times[0]) / 60
    assert minutes / 2 <= begun["minutes"] <= minutes * 1.5
    assert ended["percent"] >= 80
