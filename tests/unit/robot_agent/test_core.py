"""The robot agent's core: commands, poses and results in, goals and answers out."""

from __future__ import annotations

import json
from typing import Any

import pytest

from registry.floorplan.map_message import join_parts, read_grid_part
from tests.unit.robot_agent.agent import (
    BadConfig,
    Core,
    Facts,
    Go,
    Halt,
    Stop,
    Told,
    describe,
    make_config,
    read_command,
    read_stop,
    write_grid,
)
from tests.unit.robot_agent.agent import Grid as RobotGrid
from vipo_device.descriptions.reader import read_description
from vipo_device.protocol.messages import MAX_BYTES


class Bench:
    def __init__(self, **facts: Any) -> None:
        self.core = Core(Facts("Robo", 0.5, **facts))
        self.now_s = 0.0
        self.core.moved((0.0, 0.0, 0.0), 0.0)

    def tell(self, method: str, command: str, /, **arguments: Any) -> None:
        self.core.command(Told(command, method, arguments), self.now_s)

    def at(self, x: float, y: float = 0.0) -> None:
        self.core.moved((x, y, 0.0), self.now_s)

    def out(self) -> list[Any]:
        found, self.core.out = self.core.out, []
        return [
            item if isinstance(item, Go | Halt) else f"{item.command} {item.status} {item.why}".strip()
            for item in found
        ]


def test_points_are_passed_without_stopping_and_only_the_last_one_is_waited_for() -> None:
    bench = Bench()
    bench.tell("move", "a", path=[[1, 0], [2, 0]], theta=1.0)
    assert bench.out() == ["a ACCEPTED", "a RUNNING", Go(1, 1.0, 0.0, 0.0, None)]
    bench.at(0.6)
    assert bench.out() == []
    bench.at(0.7)
    assert bench.out() == [Go(2, 2.0, 0.0, 1.0, None)]
    bench.at(1.95)
    assert bench.out() == []
    bench.core.reached(1, 0.0)
    assert bench.out() == [], "the goal that was replaced says nothing"
    bench.core.reached(2, 0.0)
    assert bench.out() == ["a DONE"]


def test_a_piece_that_comes_in_time_is_driven_on_into() -> None:
    bench = Bench()
    bench.tell("move", "a", path=[[1, 0]])
    bench.tell("move", "b", path=[[1, 1]], **{"from": [1, 0]})
    assert bench.out()[-1] == "b ACCEPTED"
    bench.at(0.9)
    went = bench.out()
    assert went[:2] == ["a DONE", "b RUNNING"]
    assert (went[2].x, went[2].y) == (1.0, 1.0)


def test_a_goal_is_tried_twice() -> None:
    bench = Bench()
    bench.tell("move", "a", path=[[1, 0]])
    bench.tell("move", "b", path=[[2, 0]])
    bench.out()
    bench.core.failed(1, "no plan", 0.0)
    assert bench.out() == [Go(2, 1.0, 0.0, 0.0, None)]
    bench.core.failed(2, "no plan", 0.0)
    assert bench.out() == ["a FAILED no plan", "b CANCELED The way before it failed."]


def test_a_goal_after_a_move_that_was_cancelled_is_tried_twice_too() -> None:
    bench = Bench()
    bench.tell("move", "a", path=[[1, 0]])
    bench.core.failed(1, "a person", 0.0)
    bench.tell("cancel", "c", command="a")
    bench.tell("move", "b", path=[[0, 5]])
    bench.out()
    bench.core.failed(3, "a person", 0.0)
    assert [type(each) for each in bench.out()] == [Go]


def test_a_later_move_that_is_cancelled_gives_the_one_under_way_no_third_try() -> None:
    bench = Bench()
    bench.tell("move", "a", path=[[1, 0]])
    bench.tell("move", "b", path=[[2, 0]])
    bench.core.failed(1, "a person", 0.0)
    bench.tell("cancel", "c", command="b")
    bench.out()
    bench.core.failed(2, "a person", 0.0)
    assert bench.out() == ["a FAILED a person"]


def test_a_pause_halts_and_ends_with_its_command() -> None:
    bench = Bench()
    bench.tell("move", "a", path=[[1, 0]])
    bench.tell("pause", "p", command="a")
    assert bench.out()[-2:] == ["p DONE", Halt()]
    bench.at(0.5)
    assert bench.out() == []
    bench.tell("cancel", "c", command="a")
    bench.tell("move", "b", path=[[1, 0]])
    assert bench.out() == [
        "a CANCELED move was cancelled.",
        "c DONE",
        "b ACCEPTED",
        "b RUNNING",
        Go(2, 1.0, 0.0, 0.0, None),
    ]


def test_a_stop_halts_and_its_reset_drives_on() -> None:
    bench = Bench()
    bench.tell("move", "a", path=[[1, 0]])
    bench.out()
    bench.core.hold(Stop(True), 0.0)
    bench.tell("move", "b", path=[[2, 0]])
    assert bench.out() == [Halt(), "b REJECTED The site is stopped."]
    bench.core.hold(Stop(False), 0.0)
    assert bench.out() == [Go(2, 1.0, 0.0, 0.0, None)]


def test_what_a_stop_has_overtaken_is_neither_done_nor_answered() -> None:
    bench = Bench()
    drive = {"path": [[1, 0]]}
    bench.core.command(Told("a", "move", drive, 5), 0.0)
    bench.core.hold(Stop(True, 7), 0.0)
    bench.out()
    bench.core.hold(Stop(False, 6), 0.0)
    bench.core.command(Told("b", "move", drive, 6), 0.0)
    bench.core.command(Told("r", "resume", {"command": "a"}, 6), 0.0)
    bench.core.command(Told("c", "move", drive, 8), 0.0)
    assert bench.out() == []
    bench.core.command(Told("p", "pause", {"command": "a"}, 8), 0.0)
    assert bench.out() == ["p DONE"]
    bench.core.hold(Stop(False, 8), 0.0)
    bench.core.command(Told("b", "move", drive, 6), 0.0)
    assert bench.out() == []
    bench.core.command(Told("c", "move", drive, 8), 0.0)
    assert bench.out() == ["c ACCEPTED"]


def test_a_fence_is_read_with_suspicion() -> None:
    for said, fence in (("7", 7), ('"7"', None), ("true", None), ("-1", None), ("7.5", None), ("1e400", None)):
        payload = f'{{"id": "a", "v": {{}}, "active": false, "fence": {said}}}'.encode()
        assert read_command("move", payload) == Told("a", "move", {}, fence)
        assert read_stop(payload) == Stop(False, fence)


def test_to_cancel_a_later_piece_lets_the_robot_drive_to_the_end_of_the_one_before() -> None:
    bench = Bench()
    for command, x in (("a", 1), ("b", 2), ("c", 3)):
        bench.tell("move", command, path=[[x, 0]])
    bench.out()
    bench.tell("cancel", "x", command="b")
    assert bench.out() == ["b CANCELED move was cancelled.", "c CANCELED move was cancelled.", "x DONE"]
    bench.core.reached(1, 0.0)
    assert bench.out() == ["a DONE"]


def test_everything_may_be_cancelled_at_once_also_when_there_is_nothing() -> None:
    bench = Bench(capacity=1)
    bench.tell("cancel", "x")
    bench.tell("pick", "p", object="box")
    bench.tell("move", "a", path=[[1, 0]])
    bench.out()
    bench.tell("cancel", "y")
    assert bench.out() == ["p CANCELED pick was cancelled.", "a CANCELED move was cancelled.", "y DONE"]


def test_what_is_cancelled_before_it_came_is_not_carried_out() -> None:
    bench = Bench()
    bench.tell("cancel", "x", command="later")
    bench.tell("move", "later", path=[[1, 0]])
    assert bench.out()[-1] == "later CANCELED It was cancelled before it arrived."


def test_goods_take_time_and_are_counted() -> None:
    bench = Bench(capacity=2, handling_s=2.0)
    bench.tell("pick", "p", object="box", value=2)
    bench.core.settle(1.9)
    assert bench.out() == ["p ACCEPTED", "p RUNNING"]
    bench.core.settle(2.0)
    assert bench.out() == ["p DONE"]
    assert bench.core.look()["props"] == {"load": "box:2"}
    bench.tell("drop", "d", object="can")
    assert bench.out() == ["d REJECTED Robo carries 0 can, not 1."]


def test_the_last_sixteen_answers_and_the_load_outlive_a_restart() -> None:
    bench = Bench(capacity=2, handling_s=0.0)
    bench.tell("pick", "p", object="box")
    for number in range(16):
        bench.tell("fly", f"f{number}")
    kept = json.loads(json.dumps(bench.core.keep()))
    again = Core(Facts("Robo", 0.5, capacity=2), kept)
    assert again.load == {"box": 1}
    again.command(Told("f0", "fly", {}), 0.0)
    assert [item.status for item in again.out] == ["REJECTED"]
    assert len(kept["answers"]) == 16


@pytest.mark.parametrize(
    ("arguments", "why"),
    [
        ({"path": []}, "move needs a path: a list of 1 to 200 points [x, y] in metres."),
        ({"path": [[0, 0]] * 201}, "move needs a path: a list of 1 to 200 points [x, y] in metres."),
        ({"path": [[0, True]]}, "move needs a path: a list of 1 to 200 points [x, y] in metres."),
        ({"path": [[1, 0]], "theta": "north"}, "theta must be a number in radians."),
        ({"path": [[1, 0]], "speed": -1}, "speed must be a number above 0, in metres a second."),
        ({"path": [[1, 0]], "speed": 0.1}, "Robo cannot be told to drive slower than 0.5 m/s."),
        ({"path": [[1, 0]], "from": [3, 0]}, "The way begins 3.0 m from where Robo will be."),
        ({"path": [[1, 0]], "from": "here"}, "from must be a point [x, y] in metres."),
    ],
)
def test_a_move_that_cannot_be_is_rejected(arguments: dict[str, Any], why: str) -> None:
    bench = Bench()
    bench.tell("move", "m", **arguments)
    assert bench.out() == [f"m REJECTED {why}"]


def test_a_robot_that_does_not_know_where_it_is_does_not_move() -> None:
    core = Core(Facts("Robo", 0.5))
    core.command(Told("m", "move", {"path": [[1, 0]]}), 0.0)
    assert [item.why for item in core.out] == ["Robo does not know where it is."]


def test_the_description_is_one_that_vipo_believes() -> None:
    body = {"id": "tb1", "site": "hall", "password": "x", "radius_m": 0.2, "speed_m_s": 0.3, "ros": 1}
    found = read_description(describe(make_config(body)), device_id="tb1")
    assert [m.name for m in found.methods] == ["move"]
    assert (found.name, found.device_class, found.size.x, found.capacity) == ("tb1", "turtlebot", 0.4, 0)


@pytest.mark.parametrize(
    ("changes", "why"),
    [
        ({"id": "a/b"}, "id must be 1 to 64 letters, digits, '_', '.' or '-'."),
        ({"radius_m": 0}, "radius_m must be a number above 0."),
        ({"password": ""}, "password is missing; a new device needs join_key, the site's, instead."),
        ({"ros": 3}, "ros must be 1 or 2."),
        ({"name": "a\nb"}, "name must be printable text of at most 100 characters."),
        ({"capacity": 1.5}, "capacity must be a whole number from 0 to 1000."),
        ({"home": [0, 0]}, "home must be [x, y, theta]: metres and radians."),
    ],
)
def test_a_configuration_that_cannot_be_used_says_what_to_mend(changes: dict[str, Any], why: str) -> None:
    body = {"id": "tb1", "site": "hall", "password": "x", "radius_m": 0.2, "speed_m_s": 0.3, "ros": 1}
    with pytest.raises(BadConfig) as caught:
        make_config({**body, **changes})
    assert str(caught.value) == why
    with pytest.raises(BadConfig, match=r"^'pasword' means nothing here; known are action, "):
        make_config({**body, "pasword": "y"})
    with pytest.raises(BadConfig, match=r"^site is missing\.$"):
        make_config({key: value for key, value in body.items() if key != "site"})


def test_a_map_is_sent_in_parts_below_the_packet_limit() -> None:
    cells = bytes((n * 7919 % 103) if n % 3 else 255 for n in range(40_000))
    messages = list(write_grid(RobotGrid(200, 200, 0.05, (0.0, 0.0, 0.0), cells), 7, 1))
    assert all(len(message) < MAX_BYTES - 1000 for message in messages)
    grid = join_parts([read_grid_part(message) for message in messages])
    assert grid.cells == bytes(cell if cell <= 100 else 255 for cell in cells)
