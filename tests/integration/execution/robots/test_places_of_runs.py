"""Runs go by the places that there were when they began, whoever changes the map meanwhile.

Each turn here takes the site over and reads its floor anew, as another worker would.
"""

from __future__ import annotations

import json
from collections.abc import Callable
from datetime import UTC, datetime, timedelta
from importlib import import_module
from math import hypot
from typing import Any

import pytest
from django.apps import apps

from editor.language.expressions.nodes import Constant, Located, Operation, PlaceRef
from editor.language.plan.instructions import End, Instruction, Move, Plan, RoleBinding, Wait
from execution import services
from execution.engine import drive
from execution.models import Command, FloorState, Run, RunEvent
from registry.maps.places import PlaceChange, add_place, change_place, remove_place
from tests.integration.execution.conftest import SITE
from tests.kit.programs import run_status

pytestmark = pytest.mark.django_db(transaction=True)
BAY, ELSEWHERE, FAR = (10.0, -8.0), (6.0, -8.0), (14.0, -8.0)


def put(at: tuple[float, float], kind: str = "point") -> None:
    add_place(site=SITE, place_id="bay", place=PlaceChange(name="Bay 1", kind=kind, x=at[0], y=at[1], theta=1.5))


def moved() -> None:
    change_place(site=SITE, place_id="bay", place=PlaceChange(x=ELSEWHERE[0], y=ELSEWHERE[1]))


def removed() -> None:
    remove_place(site=SITE, place_id="bay")


def added_anew() -> None:
    removed()
    put(ELSEWHERE)


@pytest.fixture
def shop(factory: Any) -> Any:
    put(BAY)
    return factory


def move(place: PlaceRef, step: str) -> Instruction:
    return Instruction(Move("robot", place), step, 1, (step,), (step,))


def going(*instructions: Instruction) -> Plan:
    """Return a program that does this, then goes to the bay."""
    to_bay = move(PlaceRef(place="bay"), "s1")
    role = RoleBinding("robot", "robot01", ("move",))
    return Plan((*instructions, to_bay, Instruction(End())), {"robot": role})


def at(shop: Any) -> tuple[float, float]:
    pose = shop.world.robots()["robot01"].pose
    return pose.x, pose.y


def is_at(shop: Any, point: tuple[float, float]) -> bool:
    return hypot(at(shop)[0] - point[0], at(shop)[1] - point[1]) < 0.05


def facts(run: str) -> list[Any]:
    return list((Run.objects.get(id=run).state or {})["facts"])


def floor() -> dict[str, Any]:
    return FloorState.objects.get().state or {}


def is_on_its_way(shop: Any) -> Callable[[], bool]:
    home = at(shop)
    return lambda: hypot(at(shop)[0] - home[0], at(shop)[1] - home[1]) > 2


def end(shop: Any, run: str) -> tuple[str, str]:
    """Go on until the run is over; return what became of it. What the process knows is forgotten every five seconds."""
    while run_status(run) in Run.OPEN:
        drive.forget_all()
        for _ in range(10):
            shop.work()
            shop.send()
            shop.pass_time(0.5)
            shop.work_once()
    row = Run.objects.get(id=run)
    return row.status, row.reason


CHANGES = pytest.mark.parametrize("change", [removed, moved, added_anew])


@CHANGES
def test_a_run_under_way_goes_where_its_place_was_and_runs_that_begin_later_where_it_is(
    shop: Any, change: Callable[[], None]
) -> None:
    run = shop.start(going())
    shop.go(is_on_its_way(shop))
    change()
    assert end(shop, run) == ("finished", "")
    assert is_at(shop, BAY)
    later = shop.start(going())
    if change is removed:
        status, why = end(shop, later)
        assert (status, "There is no device or place called “bay”" in why) == ("failed", True)
    else:
        assert end(shop, later) == ("finished", "")
        assert is_at(shop, ELSEWHERE)


@CHANGES
def test_a_run_that_waits_and_is_paused_meanwhile_goes_where_its_place_was(
    shop: Any, change: Callable[[], None]
) -> None:
    run = shop.start(going(Instruction(Wait(Constant(60)), "w", 1)))
    shop.work()
    change()
    services.pause_run(run_id=run, by="Ada")
    shop.go(lambda: run_status(run) == "paused")
    shop.pass_time(100)
    drive.forget_all()
    services.resume_run(run_id=run, by="Ada")
    assert end(shop, run) == ("finished", "")
    assert is_at(shop, BAY)


def test_a_run_comes_back_to_a_place_that_was_removed_while_its_robot_stood_there(shop: Any) -> None:
    there, away = PlaceRef(place="bay"), PlaceRef(point=FAR)
    run = shop.start(going(move(there, "first"), Instruction(Wait(Constant(20)), "w", 1), move(away, "away")))
    shop.go(lambda: is_at(shop, BAY))
    removed()
    shop.go(lambda: is_at(shop, FAR))
    assert end(shop, run) == ("finished", "")
    assert is_at(shop, BAY)


def test_a_run_that_was_planned_goes_where_its_place_is_when_it_begins(shop: Any) -> None:
    at_its_time = datetime.now(UTC) + timedelta(hours=1)
    run = shop.start(going())
    Run.objects.filter(id=run).update(not_before=at_its_time)
    shop.work()
    moved()
    Run.objects.filter(id=run).update(not_before=datetime.now(UTC) - timedelta(seconds=1))
    shop.go(is_on_its_way(shop))
    removed()
    assert end(shop, run) == ("finished", "")
    assert is_at(shop, ELSEWHERE)


@CHANGES
def test_what_a_run_works_out_of_a_place_is_of_where_it_was(shop: Any, change: Callable[[], None]) -> None:
    here, bay = Constant("itemInventory01"), Located(place="bay")
    wait = Instruction(Wait(Constant(60)), "w", 1)
    far = Operation("distance", (here, bay))
    plan = Plan((wait, Instruction(Wait(far), "far", 2), Instruction(End())))
    run = shop.start(plan)
    shop.work()
    before = facts(run)
    change()
    drive.forget_all()
    assert end(shop, run) == ("finished", "")
    of_bay = [fact for fact in before if fact[0] == "bay"]
    assert of_bay == [["bay", "$x", BAY[0]], ["bay", "$y", BAY[1]]]
    assert [fact for fact in facts(run) if fact[0] == "bay"] == of_bay


def test_a_run_goes_to_a_dock_that_was_removed_and_its_robot_faces_as_it_would_have(shop: Any) -> None:
    removed()
    put(BAY, "dock")
    run = shop.start(going())
    shop.go(is_on_its_way(shop))
    removed()
    assert end(shop, run) == ("finished", "")
    last = Command.objects.filter(run=run, method="move").order_by("-position").first()
    assert last is not None
    assert (last.arguments["path"][-1], last.arguments["theta"]) == ([*BAY], 1.5)


def test_a_run_of_the_version_before_goes_by_the_places_that_there_are(shop: Any) -> None:
    """It has none of its own: a process of that version began it beside this one."""
    run = shop.start(going(Instruction(Wait(Constant(10)), "w", 1)))
    shop.work()
    Run.objects.filter(id=run).update(places=None)
    drive.forget_all()
    moved()
    assert end(shop, run) == ("finished", "")
    assert is_at(shop, ELSEWHERE)


def test_runs_that_have_begun_before_the_update_keep_the_places_that_there_were_then(shop: Any) -> None:
    begun, over, planned = (shop.start(going(Instruction(Wait(Constant(1000)), "w", 1))) for _ in range(3))
    Run.objects.filter(id=planned).update(not_before=datetime.now(UTC) + timedelta(days=1))
    shop.work()
    kept = Run.objects.get(id=begun).places
    Run.objects.update(places=None)
    Run.objects.filter(id=over).update(status="finished")
    import_module("execution.migrations.0020_places_of_runs").keep_places(apps, None)
    found = {str(row.id): row.places for row in Run.objects.all()}
    assert found == {begun: kept, over: None, planned: None}
    assert kept is not None
    assert kept[0] == {"id": "bay", "name": "Bay 1", "kind": "point", "x": 10.0, "y": -8.0, "theta": 1.5}


def test_the_floor_is_kept_as_before_where_a_run_goes_to_a_place_that_was_moved(shop: Any) -> None:
    run = shop.start(going())
    shop.go(is_on_its_way(shop))
    before = floor()
    moved()
    shop.go(lambda: "@10.000,-8.000" in json.dumps(floor()))
    assert floor().keys() == before.keys()
    assert end(shop, run) == ("finished", "")
    assert not RunEvent.objects.filter(run=run, code="failed").exists()
