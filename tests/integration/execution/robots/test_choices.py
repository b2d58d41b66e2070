"""Robots that are chosen by what they report, in runs: as the database keeps it, and as little read as can be."""

import pytest
from django.db import connection
from django.test.utils import CaptureQueriesContext

from editor.language.expressions.nodes import Constant, Located, Operation, PlaceRef, Reading
from editor.language.plan.instructions import End, Instruction, Move, Plan, RoleBinding
from execution import services
from execution.engine.drive import advance_site
from registry.models import Device
from simulation.services import make_world
from simulation.world import Scene
from tests.integration.execution.conftest import DEVICES, SITE
from tests.kit import demo_floor
from tests.kit.programs import run_status

pytestmark = pytest.mark.django_db(transaction=True)
CHARGED = Operation(">", (Reading(Located(role="robot"), "battery"), Constant(30)))


def going(where=CHARGED):
    """Return a plan in which a robot that is charged goes to the shelf."""
    move = Instruction(Move("robot", PlaceRef(device="paintInventory01")), "s1", 1, ("s1",), ("s1",))
    said = "battery > 30 %" if where else ""
    return Plan((move, Instruction(End())), {"robot": RoleBinding("robot", None, ("move",), where, said)})


@pytest.fixture
def hall(factory):
    """The factory in which the robots report their batteries, which are nearly empty."""
    readings = {d.id: {"battery": 10} for d in demo_floor.devices() if d.kind == "robot"}
    factory.world = make_world(scene=Scene(demo_floor.grid(), DEVICES, seed=1, readings=readings), driver="kinematic")
    report(robot01=10, robot02=10, robot03=10)
    return factory


def report(**battery):
    for robot, value in battery.items():
        Device.objects.filter(id=robot).update(properties={"battery": value})


def look():
    """Let the floor look again, as it does while a task waits; return what it asks the database for."""
    with CaptureQueriesContext(connection) as asked:
        assert advance_site(SITE)
    return [each["sql"] for each in asked.captured_queries]


def readings_read(statements):
    return [each for each in statements if '"properties"' in each.split(" FROM ")[0] and "IN (" in each]


def test_a_run_waits_for_a_charged_robot_and_takes_the_one_that_reports_so(hall):
    run = hall.start(going())
    hall.work()
    assert services.get_run(run_id=run).run.roles == {}
    waits = [event for event in services.list_events(run_id=run) if "battery > 30 %" in event.text]
    assert [event.text for event in waits] == [
        "It waits for a robot that can do this to be free and online, with battery > 30 %."
    ]
    look()
    report(robot02=31)
    Device.objects.filter(id="robot02").update(online=False)
    look()
    hall.work()
    assert services.get_run(run_id=run).run.roles == {}
    Device.objects.filter(id="robot02").update(online=True)
    look()
    hall.work()
    assert services.get_run(run_id=run).run.roles == {"robot": "robot02"}
    report(robot02=1)
    hall.go(lambda: run_status(run) == "finished")
    assert services.get_run(run_id=run).run.roles == {"robot": "robot02"}


def test_two_runs_that_want_the_only_charged_robot_have_it_one_after_the_other(hall):
    report(robot03=80)
    runs = [hall.start(going()), hall.start(going())]
    hall.work()
    taken = [services.get_run(run_id=run).run.roles for run in runs]
    assert sorted(map(len, taken)) == [0, 1]
    hall.go(lambda: all(run_status(run) == "finished" for run in runs))
    assert [services.get_run(run_id=run).run.roles for run in runs] == [{"robot": "robot03"}] * 2


def test_what_robots_report_is_read_once_a_step_and_only_while_a_run_waits_for_such_a_choice(hall):
    plain = hall.start(going(None))
    hall.work()
    assert readings_read(look()) == []
    hall.go(lambda: run_status(plain) == "finished")
    run = hall.start(going())
    hall.work()
    assert len(readings_read(look())) == 1
    report(robot01=50)
    assert len(readings_read(look())) == 1
    assert readings_read(look()) == []
    hall.go(lambda: run_status(run) == "finished")
