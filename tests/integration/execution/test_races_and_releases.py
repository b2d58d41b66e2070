"""Races and releases in runs with a database: killed and taken up at every step, told in the journal, done once."""

import pytest

from editor.language.expressions.nodes import Constant, PlaceRef
from editor.language.plan.instructions import End, Fork, Instruction, Join, Move, Plan, Release, RoleBinding, Wait
from execution import services
from execution.models import InboxEvent
from tests.kit.programs import run_status

pytestmark = pytest.mark.django_db(transaction=True)
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
