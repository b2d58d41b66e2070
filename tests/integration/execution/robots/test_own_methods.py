"""Robots' own methods, releases and races in runs: the journal tells them, and nothing is done twice."""

from dataclasses import replace

import pytest

from editor.language.expressions.nodes import Constant, PlaceRef
from editor.language.plan.instructions import (
    End,
    Fork,
    Instruction,
    Join,
    Move,
    Perform,
    Plan,
    Release,
    RoleBinding,
    Wait,
)
from execution import services
from execution.models import Command, InboxEvent
from simulation.services import make_world
from simulation.world import Scene
from tests.kit import demo_floor
from tests.kit.programs import describe_anew, run_status
from vipo_device.protocol.description import MethodSpec, ParameterSpec, description_to_json
from vipo_device.protocol.messages import down_topic

pytestmark = pytest.mark.django_db(transaction=True)
HONK = MethodSpec("honk", down_topic("robot02", "honk"), parameters=(ParameterSpec("times", "number", "", 1, 10),))
ROLES = {"robot": RoleBinding("robot", None, ("honk",))}


def honking(times):
    honk = Perform("robot", "honk", {"times": Constant(times)})
    return Plan((Instruction(honk, "s1", 1, ("s1",), ("s1",)), Instruction(End())), ROLES)


@pytest.fixture
def hall(factory):
    """The factory in which TurtleBot 2 alone honks."""
    devices = [replace(d, methods=(*d.methods, HONK)) if d.id == "robot02" else d for d in demo_floor.devices()]
    factory.world = make_world(scene=Scene(demo_floor.grid(), devices, seed=1), driver="kinematic")
    honker = next(device for device in devices if device.id == "robot02")
    describe_anew("robot02", description_to_json(honker))
    return factory


def test_the_robot_that_can_honk_honks_and_the_journal_tells_it(hall):
    run = hall.start(honking(5))
    hall.go(lambda: run_status(run) == "finished")
    view = services.get_run(run_id=run).run
    assert (view.roles, view.steps["s1"]["status"]) == ({"robot": "robot02"}, "done")
    texts = [event.text for event in services.list_events(run_id=run)]
    assert "TurtleBot 2: honk(5)" in texts
    assert "TurtleBot 2 is done: honk." in texts


def test_it_honks_once_where_messages_come_twice_and_the_inbox_is_taken_in_again(hall):
    hall.deliveries = 2
    run = hall.start(honking(5))
    hall.go(lambda: run_status(run) == "finished")
    InboxEvent.objects.update(taken_at=None)
    hall.work()
    assert list(Command.objects.filter(run=run, method="honk").values_list("status", flat=True)) == ["done"]
    assert run_status(run) == "finished"


def test_two_runs_that_both_want_the_only_robot_that_honks_have_it_one_after_the_other(hall):
    first, second = hall.start(honking(1)), hall.start(honking(2))
    hall.go(lambda: run_status(first) == run_status(second) == "finished")
    assert {services.get_run(run_id=run).run.roles["robot"] for run in (first, second)} == {"robot02"}
    commands = Command.objects.filter(method="honk")
    assert sorted(command.arguments["times"] for command in commands) == [1, 2]


def test_a_method_that_the_description_has_lost_since_is_refused(hall):
    run = hall.start(replace(honking(5), roles={"robot": RoleBinding("robot", "robot01")}))
    hall.go(lambda: run_status(run) == "failed")
    assert services.get_run(run_id=run).run.reason == "TurtleBot 1 cannot honk; it offers no such method."
    assert not Command.objects.filter(method="honk").exists()


DROP_OFF, SHELF = PlaceRef(device="dropOff01"), PlaceRef(device="itemInventory01")


def plan(*instructions, **roles):
    """Return a plan of instructions; each that is no step of its own stands without one."""
    steps = [
        Instruction(do, f"s{number}", number, (f"s{number}",), (f"s{number}",))
        if isinstance(do, Move | Release | Wait)
        else Instruction(do)
        for number, do in enumerate(instructions, 1)
    ]
    return Plan((*steps, Instruction(End())), {name: RoleBinding(name, *how) for name, how in roles.items()})


RELEASING = plan(Move("robot", SHELF), Release("robot"), Move("robot", DROP_OFF), robot=("robot01",))


def codes(run):
    return [event.code for event in services.list_events(run_id=run)]


def test_a_run_that_releases_its_robot_goes_on_with_it_anew_and_the_journal_tells_it(factory):
    run = factory.start(RELEASING)
    factory.go(lambda: run_status(run) == "finished")
    told = [code for code in codes(run) if code.startswith("role_")]
    assert told == ["role_bound", "role_released", "role_bound"]
    texts = [event.text for event in services.list_events(run_id=run)]
    assert "TurtleBot 1 is released from the role “robot”." in texts
    view = services.get_run(run_id=run).run
    assert {name: mark["status"] for name, mark in view.steps.items()} == dict.fromkeys(("s1", "s2", "s3"), "done")


def test_a_released_robot_is_no_robot_of_the_run_any_more(factory):
    run = factory.start(plan(Move("robot", SHELF), Release("robot"), Wait(Constant(30)), robot=("robot01",)))
    factory.go(lambda: "role_released" in codes(run))
    assert services.get_run(run_id=run).run.roles == {}
    other = factory.start(plan(Move("robot", DROP_OFF), robot=("robot01",)))
    factory.go(lambda: run_status(other) == "finished")
    assert run_status(run) == "running"


def test_messages_that_come_twice_release_once(factory):
    factory.deliveries = 2
    run = factory.start(RELEASING)
    factory.go(lambda: run_status(run) == "finished")
    InboxEvent.objects.update(taken_at=None)
    factory.work()
    assert codes(run).count("role_released") == 1
    assert run_status(run) == "finished"


def test_a_race_calls_the_drive_off_and_the_robot_goes_elsewhere(factory):
    race = plan(
        Fork((2, 4), 1, 1),
        Move("robot", SHELF),
        Wait(Constant(1)),
        Join(),
        Move("robot", DROP_OFF),
        Join(),
        robot=("robot01",),
    )
    # behind the Parallel the program goes to the shelf; the End stands behind it
    instructions = (*race.instructions[:2], Instruction(End()), *race.instructions[2:])
    fork = Instruction(Fork((3, 5), 1, 1), "p", 1, ("p",), ("p",))
    run = factory.start(Plan((fork, *instructions[1:]), race.roles))
    factory.go(lambda: run_status(run) == "finished")
    steps = services.get_run(run_id=run).run.steps
    assert {name: mark["status"] for name, mark in steps.items()} == {
        "p": "done", "s2": "done", "s3": "done", "s5": "skipped"
    }  # fmt: skip
    assert "step_cancelled" in codes(run)
