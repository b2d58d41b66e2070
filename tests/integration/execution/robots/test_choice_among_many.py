"""A robot is chosen by what it reports among 300: what a step asks of the database and works for it is bounded."""

import re
from uuid import uuid4

import pytest
from django.db import connection
from django.test.utils import CaptureQueriesContext

from bench.hall import OVEN, SITE, fill_hall
from editor.language import plan_to_json
from editor.language.expressions.nodes import Constant, Located, Operation, PlaceRef, Reading
from editor.language.plan.instructions import End, Instruction, Move, Plan, RoleBinding
from execution import services
from execution.engine import commit
from execution.engine.drive import advance_site
from registry.models import Device
from tests.kit.work import count_work, within_processor_time

pytestmark = pytest.mark.django_db(transaction=True)
FEW, MANY = 30, 300
CHARGED = Operation(">", (Reading(Located(role="robot"), "battery"), Constant(30)))
LINES_EACH = 1_000
"""Of Python, that the choice may add for each robot to a step of the floor; 400 among 30, 240 among 300 were seen."""


def start(where=CHARGED):
    """Start a run in which a robot that is charged goes to the oven; the floor has heard of it afterwards."""
    binding = RoleBinding("robot", None, ("move",), where, "battery > 30 %" if where else "")
    plan = Plan((Instruction(Move("robot", PlaceRef(device=OVEN)), "s1"), Instruction(End())), {"robot": binding})
    prepared = services.Prepared(uuid4(), SITE, "Task", 1, {}, {}, plan_to_json(plan), {})
    run = services.start_run(prepared=prepared, by="Ada").id
    advance_site(SITE)
    advance_site(SITE)
    return run


def report(robot, battery):
    Device.objects.filter(id=robot).update(properties={"battery": battery})


def fill(robots):
    """Make a hall of so many robots whose batteries are nearly empty."""
    fill_hall(robots + 1, robots)
    Device.objects.filter(description__kind="robot").update(properties={"battery": 10})


def look():
    """Let the floor look again; return what it asks the database for, and the lines of Python that it runs."""
    with CaptureQueriesContext(connection) as asked, count_work() as work:
        assert advance_site(SITE)
    return [each["sql"] for each in asked.captured_queries], work.lines


def reads_of_reports(statements):
    return [each for each in statements if re.search(r'SELECT [^()]*"properties"', each)]


def chosen(run):
    advance_site(SITE)
    return services.get_run(run_id=run).run.roles


@pytest.mark.parametrize("robots", [FEW, MANY])
def test_a_choice_among_300_asks_one_statement_more_as_among_30_and_works_for_each_robot_as_much(robots, monkeypatch):
    monkeypatch.setattr(commit, "FLOOR_BEAT_S", 600.0)  # however long this takes, only the look is counted
    fill(robots)
    start(None)  # a floor with something under way is looked at
    _, before = look()
    run = start()
    assert chosen(run) == {}
    statements, lines = look()
    # Whether the floor is still as it was costs three of them: places, zones, map.
    assert (len(statements), len(reads_of_reports(statements))) == (13, 1)
    assert lines - before < robots * LINES_EACH


def test_the_only_one_of_300_that_is_charged_is_found_in_one_step():
    fill(MANY)
    run = start()
    report("robot217", 31)
    with within_processor_time(5):
        assert advance_site(SITE)
    assert chosen(run) == {"robot": "robot217"}
    report("robot218", 31)
    other = start()
    assert (chosen(run), chosen(other)) == ({"robot": "robot217"}, {"robot": "robot218"})


def test_ten_runs_that_wait_for_a_charged_robot_share_one_read_and_take_turns():
    fill(MANY)
    runs = [start() for _ in range(10)]
    statements, _ = look()
    assert len(reads_of_reports(statements)) == 1
    for number in range(1, 4):
        report(f"robot{number:03}", 90)
    with within_processor_time(20):
        assert advance_site(SITE)
    taken = [chosen(run)["robot"] for run in runs if chosen(run)]
    assert sorted(taken) == ["robot001", "robot002", "robot003"]
