"""A stand-in by itself: it begins where its device was, answers as a device does, and knows what changes hands."""

from __future__ import annotations

import json
from dataclasses import replace
from pathlib import Path
from typing import Any

import pytest

from simulation.services import make_world
from simulation.stand_ins.hand_overs import HandOver, HandOvers, hand_over_of, stock_for
from simulation.stand_ins.shared_connection import SharedConnection
from simulation.stand_ins.stand_in import StandIn, StandInFacts
from simulation.world import Obstacle, Scene, World
from tests.unit.simulation.stage_set import scene
from vipo_device.protocol.description import Description, Pose
from vipo_device.protocol.messages import AckMessage, DeviceCommand

TICK_S = 0.05
ROBOT, STORE, OVEN = "robot", "shelf", "oven"


def kinematic(of: Scene) -> World:
    return make_world(scene=of, driver="kinematic")


class Broker:
    """What stand-ins speak to: keeps all that is said."""

    def __init__(self) -> None:
        self.connected = True
        self.said: list[tuple[str, Any]] = []

    def publish(self, topic: str, payload: bytes, *, qos: int = 1, retain: bool = False) -> None:
        assert not retain, f"{topic} is kept for who comes later"
        self.said.append((topic, json.loads(payload)))

    def answers(self, command: str) -> list[str]:
        return [body["st"] for topic, body in self.said if topic.endswith("/up/ack") and body["id"] == command]

    def state(self) -> Any:
        return [body for topic, body in self.said if topic.endswith("/up/state")][-1]


class Stage:
    """A stand-in, its broker, and time."""

    def __init__(
        self, device: str, folder: Path, boot: int = -1, readings: dict[str, Any] | None = None, at: Pose | None = None
    ) -> None:
        descriptions = {d.id: d for d in scene().devices}
        machines = [d for d in descriptions.values() if d.kind == "machine" and d.id != device]
        own = descriptions[device] if at is None else replace(descriptions[device], pose=at)
        self.facts = StandInFacts("hall", own, machines, readings or {}, boot, boot + 1)
        self.broker, self.now, self.device = Broker(), 100.0, device
        self.connection = SharedConnection(self.broker)
        self.stand_in = StandIn(self.facts, self.connection, kinematic, folder / f"{device}.json", 1.0)
        self.stand_in.connect(self.now)
        self.handed: list[HandOver] = []

    def tell(self, method: str, command: str, **arguments: object) -> None:
        body = json.dumps({"id": command, "v": arguments, "ttl_s": 60}).encode()
        self.connection.hear(f"vipo/v1/sim/{self.device}/down/{method}", body, retained=False)

    def pass_time(self, seconds: float) -> None:
        for _ in range(round(seconds / TICK_S)):
            self.now += TICK_S
            self.handed += self.stand_in.advance(self.now)


def test_it_says_that_it_is_there_and_how_it_is(tmp_path: Path) -> None:
    stage = Stage(OVEN, tmp_path, boot=6)
    stage.pass_time(0.2)
    assert stage.broker.said[0] == (f"vipo/v1/sim/{OVEN}/up/presence", {"s": "online", "boot": 7})
    assert (stage.broker.state()["boot"], stage.broker.state()["done"]) == (7, True)
    stage.stand_in.leave()
    assert stage.broker.said[-1] == (f"vipo/v1/sim/{OVEN}/up/presence", {"s": "offline", "boot": 7})
    count = len(stage.broker.said)
    stage.tell("curePaint", "late", time=1)
    assert len(stage.broker.said) == count


def test_it_heeds_the_stop(tmp_path: Path) -> None:
    stage = Stage(OVEN, tmp_path)
    stage.tell("curePaint", "c1", time=1)
    stage.connection.hear("vipo/v1/site/hall/stop", b'{"active": true}', retained=True)
    stage.pass_time(120)
    assert stage.broker.answers("c1") == ["ACCEPTED", "RUNNING"]
    stage.connection.hear("vipo/v1/site/hall/stop", b'{"active": false}', retained=True)
    stage.pass_time(120)
    assert stage.broker.answers("c1")[-1] == "DONE"


def test_what_it_has_answered_it_answers_again_after_a_restart_and_does_nothing_twice(tmp_path: Path) -> None:
    first = Stage(OVEN, tmp_path)
    first.tell("curePaint", "c1", time=1)
    first.pass_time(70)
    assert first.broker.answers("c1")[-1] == "DONE"
    again = Stage(OVEN, tmp_path, boot=first.facts.begins)
    again.tell("curePaint", "c1", time=1)
    again.pass_time(0.2)
    assert again.broker.answers("c1") == ["DONE"]


def test_what_another_process_has_played_since_counts_and_not_its_own_file(tmp_path: Path) -> None:
    first = Stage(OVEN, tmp_path)
    first.tell("curePaint", "c1", time=1)
    first.pass_time(70)
    again = Stage(OVEN, tmp_path, boot=first.facts.begins + 5)
    again.tell("curePaint", "c1", time=1)
    again.pass_time(0.2)
    assert again.broker.answers("c1") == ["ACCEPTED", "RUNNING"]


def test_a_simulated_robot_fetches_what_the_machine_has_and_no_more(tmp_path: Path) -> None:
    stage = Stage(ROBOT, tmp_path, at=Pose(3.0, 6.15))
    stage.stand_in.see_stock(STORE, {"box": 1})
    stage.tell("pick", "p1", device=STORE, object="box", value=1)
    stage.pass_time(20)
    assert (stage.broker.answers("p1")[-1], stage.handed) == ("DONE", [HandOver(STORE, "box", -1)])
    stage.tell("pick", "p2", device=STORE, object="box", value=1)
    stage.pass_time(20)
    assert stage.broker.answers("p2")[-1] in ("FAILED", "REJECTED")
    assert len(stage.handed) == 1
    stage.stand_in.see_stock("nowhere", {"box": 1})  # a machine of which it knows nothing changes nothing


@pytest.mark.parametrize(("stands", "charges"), [(None, True), (Pose(6.0, 4.0), False)])
def test_a_simulated_robot_charges_at_its_home_and_not_where_it_began(
    tmp_path: Path, stands: Pose | None, charges: bool
) -> None:
    stage = Stage(ROBOT, tmp_path, readings={"battery": 50})
    facts = replace(stage.facts, stands=stands)
    stand_in = StandIn(facts, stage.connection, kinematic, tmp_path / "other.json", 60.0)
    stand_in.connect(0.0)
    for second in range(1, 4):
        stand_in.advance(float(second))
    battery = stage.broker.state()["props"]["battery"]
    assert (battery > 51) is charges, battery


def test_a_simulated_machine_learns_what_robots_take_and_bring(tmp_path: Path) -> None:
    stage = Stage(STORE, tmp_path, readings={"stock": 3})
    stage.stand_in.take_over(HandOver(STORE, "box", -2))
    assert stage.stand_in.stock == {"box": 1}
    stage.stand_in.take_over(HandOver(STORE, "box", -2))
    assert not stage.stand_in.stock
    stage.pass_time(0.2)
    assert stage.broker.state()["props"]["stock"] == 0


@pytest.mark.parametrize(
    ("method", "arguments", "handed"),
    [
        ("pick", {"device": STORE, "object": "box", "value": 2}, HandOver(STORE, "box", -2)),
        ("drop", {"device": OVEN, "object": "box", "value": 1}, HandOver(OVEN, "box", 1)),
        ("drop", {"object": "box", "value": 1}, None),
        ("drop", {"device": 7, "object": "box", "value": 1}, None),
        ("pick", {"device": STORE, "object": None, "value": "many"}, None),
        ("move", {"device": STORE, "object": "box", "value": 1}, None),
    ],
)
def test_what_changes_hands(method: str, arguments: dict[str, object], handed: HandOver | None) -> None:
    assert hand_over_of(DeviceCommand("c", method, arguments)) == handed


def test_a_real_machine_that_shows_nothing_is_taken_to_have_what_is_asked_for() -> None:
    described: dict[str, Description] = {d.id: d for d in scene().devices}
    store = described[STORE]
    assert stock_for(store, {"stock": 5}, HandOver(STORE, "box", -1)) == {"box": 5}
    assert stock_for(store, {}, HandOver(STORE, "box", -2)) == {"box": 2}
    assert stock_for(store, {}, HandOver(STORE, "box", 2)) == {}


def test_an_order_that_is_asked_for_again_changes_hands_once() -> None:
    orders, told = HandOvers(), DeviceCommand("c1", "pick", {"device": STORE, "object": "box", "value": 1})
    assert orders.note(ROBOT, told) == HandOver(STORE, "box", -1)
    assert orders.take(ROBOT, AckMessage("c1", "RUNNING")) is None
    assert orders.take("another", AckMessage("c1", "DONE")) is None
    assert orders.take(ROBOT, AckMessage("c1", "DONE")) == HandOver(STORE, "box", -1)
    orders.note(ROBOT, told)
    assert orders.take(ROBOT, AckMessage("c1", "DONE")) is None
    orders.note(ROBOT, DeviceCommand("c2", "pick", told.arguments))
    assert orders.take(ROBOT, AckMessage("c2", "FAILED")) is None


def test_what_robots_have_taken_outlives_a_restart(tmp_path: Path) -> None:
    first = Stage(STORE, tmp_path, readings={"stock": 3})
    first.pass_time(0.2)
    first.stand_in.take_over(HandOver(STORE, "box", -2))
    again = Stage(STORE, tmp_path, boot=first.facts.begins, readings={"stock": 3})
    assert again.stand_in.stock == {"box": 1}


def test_a_robot_stops_before_what_people_put_on_the_floor_also_when_it_was_begun_anew(tmp_path: Path) -> None:
    stage = Stage(ROBOT, tmp_path, at=Pose(2.0, 4.0))
    stage.stand_in.put_in_the_way([Obstacle(5.0, 4.0, 0.5)])
    stage.stand_in.change(replace(stage.facts, machines=stage.facts.machines[:1]))
    stage.tell("move", "go", path=[[8.0, 4.0]])
    stage.pass_time(30)
    assert stage.broker.answers("go")[-1] == "FAILED"
    assert stage.broker.state()["loc"][0] == pytest.approx(5.0 - 0.25 - 0.18 - 0.4, abs=0.1)
    stage.stand_in.put_in_the_way([])
    stage.tell("move", "on", path=[[8.0, 4.0]])
    stage.pass_time(30)
    assert stage.broker.answers("on")[-1] == "DONE"
