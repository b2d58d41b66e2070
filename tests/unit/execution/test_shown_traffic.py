"""What browsers are shown of the floor: what has changed, not too often, and all of it again for who has come since."""

from __future__ import annotations

from typing import Any

import pytest

from execution.floor import fold
from execution.traffic import messages as m
from registry import services as registry
from tests.unit.execution.traffic.zones.test_site_zones import EAST, WEST, floor_with, go, zone

POSES = {"robot01": WEST}


@pytest.fixture
def told(monkeypatch: pytest.MonkeyPatch) -> list[dict[str, Any]]:
    messages: list[dict[str, Any]] = []
    monkeypatch.setattr(registry, "publish", lambda slug, message: messages.append(message["robots"]))
    monkeypatch.setattr(fold, "_published", {})
    return messages


def test_a_robot_s_path_is_told_as_it_changes_and_no_more_than_five_times_a_second(told: list[Any]) -> None:
    floor = floor_with(poses=POSES)
    go(floor, "r", EAST, "robot01")
    for tick in range(40):
        floor.pass_time()
        fold.publish_traffic("hall", floor.layout, floor.state, tick * 0.1)
    assert set(told[0]) == {"robot01", "robot02", "robot03"}
    assert {name for robots in told[1:] for name in robots} == {"robot01"}
    assert 3 <= len(told) <= 20
    last = told[-1]["robot01"]
    assert last["route"][: len(last["reserved"])] == last["reserved"]
    assert len(last["reserved"]) >= 2
    assert last["route"][-1] == pytest.approx(EAST, abs=0.3)
    assert all(value == round(value, 2) for point in last["route"] for value in point)


def test_who_comes_later_is_told_what_stands_still(told: list[Any]) -> None:
    floor = floor_with(zone("release"), poses=POSES)
    go(floor, "r", EAST, "robot01")
    for tick in range(1200):
        floor.pass_time()
        fold.publish_traffic("hall", floor.layout, floor.state, tick * 0.1)
    whole = [robots for robots in told if len(robots) == 3]
    assert 20 <= len(whole) <= 26  # two minutes, each five seconds
    assert whole[-1]["robot01"]["why"] == {
        "code": "not_let_in",
        "args": {"robot": "robot01", "zone": "The crossing", "zone_id": "z"},
    }


def test_a_robot_of_no_run_says_why_it_waits(told: list[Any]) -> None:
    floor = floor_with(zone("release"), poses=POSES)
    go(floor, "r", EAST, "robot01")
    floor.tell(m.RunOver("r"))
    for tick in range(900):
        floor.pass_time()
        fold.publish_traffic("hall", floor.layout, floor.state, tick * 0.1)
    on_its_way_home = [robots["robot01"]["wait"] for robots in told if "robot01" in robots]
    name = floor.layout.name("robot01")
    assert f"{name} waits to be let into The crossing." in on_its_way_home
