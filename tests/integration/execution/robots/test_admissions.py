"""Robots that wait to be let into a zone of the floor: who sees it, who may let them in, and that one visit is one.

Each turn here takes the site over and reads its floor anew, as another worker would.
"""

from __future__ import annotations

from dataclasses import asdict
from typing import Any

import pytest

from editor.language.expressions.nodes import PlaceRef
from editor.language.plan.instructions import End, Instruction, Move, Plan, RoleBinding
from execution import services
from execution.floor import fold
from execution.floor.admissions import list_awaited
from execution.models import FloorState
from registry import services as registry
from registry.maps.zones import ZoneChange, add_zone
from registry.models import AuditLine
from tests.integration.execution.conftest import SITE
from tests.kit import demo_floor
from tests.kit.programs import run_status
from tests.kit.sign_in import below_role, from_role, join_and_sign_in, post_json

pytestmark = pytest.mark.django_db(transaction=True)
AWAITED = f"/api/sites/{SITE}/admissions"
LET_IN = f"/api/sites/{SITE}/zones/shelf/admissions"


def going() -> Plan:
    move = Instruction(Move("robot", PlaceRef(device="paintInventory01")), "s1", 1, ("s1",), ("s1",))
    return Plan((move, Instruction(End())), {"robot": RoleBinding("robot", "robot01", ("move",))})


def make_zone() -> None:
    shelf = next(d.pose for d in demo_floor.devices() if d.id == "paintInventory01")
    corners = [(shelf.x + x, shelf.y + y) for x, y in ((-1.5, -1.5), (1.5, -1.5), (1.5, 1.5), (-1.5, 1.5))]
    add_zone(site=SITE, zone_id="shelf", zone=ZoneChange(name="The shelf", rule="release", points=corners))


@pytest.fixture
def waiting(factory: Any) -> Any:
    """The factory with a robot of a run that waits before the zone round the shelf."""
    make_zone()
    factory.run = factory.start(going())
    factory.go(lambda: bool((FloorState.objects.get().state or {}).get("awaiting")))
    return factory


def shown() -> Any:
    return [asdict(each) for each in list_awaited(site=SITE)]


def test_a_robot_waits_is_let_in_and_its_run_ends(waiting: Any) -> None:
    robot = next(d.name for d in demo_floor.devices() if d.id == "robot01")
    assert shown() == [
        {"zone": "shelf", "zone_name": "The shelf", "robot": "robot01", "robot_name": robot, "run": waiting.run}
    ]
    step = services.get_run(run_id=waiting.run).run.steps["s1"]
    assert step["status"] == "waiting"
    assert step["why"] == {"code": "not_let_in", "args": {"robot": "robot01", "zone": "The shelf", "zone_id": "shelf"}}
    operator = join_and_sign_in("operator", SITE)
    assert operator.get(AWAITED).json() == shown()
    answer = post_json(operator, LET_IN, {"robot": "robot01"})
    assert answer.status_code == 204
    waiting.go(lambda: run_status(waiting.run) == "finished")
    assert shown() == []
    line = AuditLine.objects.get(code="robot_let_in")
    assert (line.kind, line.facts) == ("runs", {"robot": robot, "zone": "The shelf"})
    again = post_json(operator, LET_IN, {"robot": "robot01"})
    assert again.status_code == 409
    assert again.json()["args"] == {"why": "not_waiting", "robot": robot, "zone": "The shelf"}
    assert again.json()["detail"].startswith(f"{robot} does not wait before The shelf. ")


@pytest.mark.parametrize("role", below_role("operator"))
def test_who_may_not_run_programs_sees_who_waits_and_lets_nobody_in(waiting: Any, role: str) -> None:
    client = join_and_sign_in(role, SITE)
    assert len(client.get(AWAITED).json()) == 1
    assert post_json(client, LET_IN, {"robot": "robot01"}).status_code == 403
    waiting.work()
    assert len(shown()) == 1


@pytest.mark.parametrize("role", from_role("operator"))
def test_who_may_run_programs_lets_robots_in(waiting: Any, role: str) -> None:
    assert post_json(join_and_sign_in(role, SITE), LET_IN, {"robot": "robot01"}).status_code == 204


def test_strangers_learn_nothing_and_let_nobody_in(waiting: Any) -> None:
    stranger = join_and_sign_in("stranger", SITE)
    assert stranger.get(AWAITED).status_code == 404
    assert post_json(stranger, LET_IN, {"robot": "robot01"}).status_code == 404
    waiting.work()
    assert len(shown()) == 1


@pytest.mark.parametrize(
    ("path", "body", "status"),
    [
        (LET_IN, {"robot": "robot02"}, 409),
        (LET_IN, {"robot": "nobody"}, 409),
        (LET_IN, {"robot": ""}, 409),
        (LET_IN, {}, 422),
        (LET_IN, {"robot": ["robot01"]}, 422),
        (LET_IN, {"robot": "robot01", "for": "ever"}, 422),
        (LET_IN.replace("shelf", "gone"), {"robot": "robot01"}, 404),
    ],
)
def test_what_cannot_be_is_refused(waiting: Any, path: str, body: dict[str, Any], status: int) -> None:
    assert post_json(join_and_sign_in("operator", SITE), path, body).status_code == status
    waiting.work()
    assert len(shown()) == 1


def test_a_run_that_is_cancelled_waits_no_more(waiting: Any) -> None:
    services.cancel_run(run_id=waiting.run, by="Ada")
    waiting.go(lambda: run_status(waiting.run) == "cancelled")
    waiting.go(lambda: shown() == [])


def test_a_site_without_a_floor_has_nobody_waiting(factory: Any) -> None:
    assert shown() == []


def test_browsers_hear_where_a_robot_is_about_to_drive_and_that_it_waits(
    factory: Any, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(fold, "TRAFFIC_EVERY_S", 0.0)  # time passes faster here than for browsers
    heard: list[dict[str, Any]] = []
    end = registry.listen(lambda site, message: heard.append(dict(message)))
    try:
        make_zone()
        factory.start(going())
        factory.go(lambda: bool(shown()))
    finally:
        end()
    told = [
        message["robots"]["robot01"]
        for message in heard
        if message["type"] == "traffic" and "robot01" in message["robots"]
    ]
    assert any(len(robot["route"]) > 2 and robot["why"] is None for robot in told)
    assert told[-1]["why"]["code"] == "not_let_in"
