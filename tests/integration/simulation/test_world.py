"""One suite for both worlds: what is true for points that obey must be true for wheels on a floor."""

from __future__ import annotations

import hashlib
import subprocess
import sys
from collections.abc import Iterator
from math import hypot, pi

import pytest

from registry.demo.devices import describe_devices
from registry.demo.factory import make_grid, read_plan
from registry.floorplan.plan import stations
from simulation.services import DriverName, make_world
from simulation.world import Ack, Contact, Fault, Obstacle, PropertyChanged, Scene, World, WorldEvent
from tests.kit.files import ROOT
from tests.unit.simulation.stage_set import MACHINES, ROBOT, hall, robot, scene
from vipo_device.protocol.description import Pose

AT_SHELF, AT_ROLLERS = [3.0, 6.17], [8.0, 1.83]


@pytest.fixture(params=["kinematic", "physics"])
def driver(request: pytest.FixtureRequest) -> DriverName:
    return request.param  # type: ignore[no-any-return]


class Play:
    """A world, and all that happened in it."""

    def __init__(self, scene: Scene, driver: DriverName) -> None:
        self.world: World = make_world(scene=scene, driver=driver)
        self.events: list[WorldEvent] = []

    def tell(self, device: str, method: str, command: str, /, **arguments: object) -> None:
        self.world.command(device, method, arguments, command)

    def wait(self, seconds: float) -> None:
        for _ in range(round(seconds * 10)):
            self.events += self.world.advance(0.1)

    def wait_for(self, command: str, limit_s: float = 60.0) -> Ack:
        until = self.world.time_s + limit_s
        while self.world.time_s < until:
            if found := self.final(command):
                return found[0]
            self.wait(0.1)
        raise AssertionError(f"{command} was not answered within {limit_s} s; the robots are {self.world.robots()}")

    def final(self, command: str) -> list[Ack]:
        acks = [e for e in self.events if isinstance(e, Ack) and e.command == command]
        return [a for a in acks if a.status not in {"ACCEPTED", "RUNNING"}]

    def at(self, name: str = "robot") -> Pose:
        return self.world.robots()[name].pose

    def contacts(self) -> list[Contact]:
        return [e for e in self.events if isinstance(e, Contact)]


@pytest.fixture
def play(driver: DriverName) -> Iterator[Play]:
    play = Play(scene(), driver)
    yield play
    play.world.close()


def test_a_robot_carries_a_box_from_the_shelf_to_the_rollers(play: Play) -> None:
    play.tell("robot", "move", "m1", path=[[3.0, 4.0], AT_SHELF])
    play.tell("robot", "pick", "p", device="shelf", object="box", value=1)
    play.tell("robot", "move", "m2", path=[[3.0, 4.0], [8.0, 4.0], AT_ROLLERS])
    play.tell("robot", "drop", "d", device="rollers", object="box", value=1)
    assert play.wait_for("p").status == "DONE"
    assert play.world.robots()["robot"].carrying == {"box": 1}
    assert play.world.readings()["robot"]["load"] == "box:1"
    assert play.wait_for("d").status == "DONE"
    assert play.world.stocks()["shelf"] == {"box": 23}
    assert play.world.stocks()["rollers"] == {"box": 1}
    assert play.world.readings()["rollers"] == {"freeSlots": 1}
    assert play.world.readings()["robot"]["load"] == ""
    assert hypot(play.at().x - 8.0, play.at().y - 1.83) < 0.03
    assert play.contacts() == []
    assert not any(play.world.busy().values())
    assert {name: len(play.final(name)) for name in ("m1", "p", "m2", "d")} == {"m1": 1, "p": 1, "m2": 1, "d": 1}


def test_driving_takes_as_long_as_the_way_is(play: Play) -> None:
    play.tell("robot", "move", "m", path=[[9.0, 4.0]])
    assert play.wait_for("m").t_s == pytest.approx(6.0 / 0.5 + 0.6, abs=0.5)


def test_pieces_released_while_driving_are_driven_without_stopping(play: Play) -> None:
    play.tell("robot", "move", "a", path=[[4.0, 4.0]])
    play.tell("robot", "move", "b", path=[[5.0, 4.0]])
    slowest = 1.0
    for over, name, x in (("a", "c", 6.0), ("b", "d", 7.0), ("c", "e", 8.0)):
        play.wait_for(over)
        play.tell("robot", "move", name, path=[[x, 4.0]])
        for _ in range(10):
            play.wait(0.1)
            slowest = min(slowest, play.world.robots()["robot"].speed_m_s)
    assert slowest > 0.45


def test_a_robot_stands_at_the_end_of_what_is_released(play: Play) -> None:
    play.tell("robot", "move", "a", path=[[5.0, 4.0]])
    play.wait_for("a")
    play.wait(1)
    before = play.at()
    play.wait(30)
    assert play.at() == before
    assert hypot(before.x - 5.0, before.y - 4.0) < 0.03


def test_a_heading_is_taken(play: Play) -> None:
    play.tell("robot", "move", "a", path=[[4.0, 4.0]], theta=pi / 2)
    assert play.wait_for("a").status == "DONE"
    play.wait(0.5)
    assert play.at().theta == pytest.approx(pi / 2, abs=0.06)


def test_pause_brakes_and_resume_goes_on(play: Play) -> None:
    play.tell("robot", "move", "a", path=[[9.0, 4.0]])
    play.wait(4)
    play.tell("robot", "pause", "p")
    play.wait(2)
    stood = play.at()
    assert stood.x < 5.5
    play.wait(20)
    assert hypot(play.at().x - stood.x, play.at().y - stood.y) < 0.01
    assert play.world.busy()["robot"]
    play.tell("robot", "resume", "r")
    assert play.wait_for("a").status == "DONE"


def test_the_stop_holds_all_and_its_reset_lets_go(play: Play) -> None:
    play.tell("robot", "move", "a", path=[[9.0, 4.0]])
    play.tell("oven", "curePaint", "o", time=1)
    play.wait(3)
    play.world.hold(active=True)
    play.wait(2)
    stood, progress = play.at(), play.world.readings()["oven"]["jobStatus"]
    play.wait(100)
    assert hypot(play.at().x - stood.x, play.at().y - stood.y) < 0.01
    assert play.world.readings()["oven"]["jobStatus"] == progress
    play.world.hold(active=False)
    assert play.wait_for("a").status == "DONE"
    assert play.wait_for("o").status == "DONE"


def test_cancel_of_a_piece_takes_the_ones_after_it_along(play: Play) -> None:
    for name, x in (("a", 5.0), ("b", 6.0), ("c", 7.0)):
        play.tell("robot", "move", name, path=[[x, 4.0]])
    play.wait(2)
    play.tell("robot", "cancel", "x", command="b")
    assert play.wait_for("a").status == "DONE"
    play.wait(3)
    assert [play.final(name)[0].status for name in "bc"] == ["CANCELED", "CANCELED"]
    assert play.final("c")[0].why == "The way before it was cancelled."
    assert hypot(play.at().x - 5.0, play.at().y - 4.0) < 0.05
    assert not play.world.busy()["robot"]


def test_cancel_of_what_is_driven_stops_the_robot_at_once(play: Play) -> None:
    play.tell("robot", "move", "a", path=[[9.0, 4.0]])
    play.wait(4)
    play.tell("robot", "cancel", "x", command="a")
    assert play.wait_for("a").status == "CANCELED"
    stopped = play.at()
    play.wait(5)
    assert hypot(play.at().x - stopped.x, play.at().y - stopped.y) < 0.3
    play.tell("robot", "move", "back", path=[[3.0, 4.0]])
    assert play.wait_for("back").status == "DONE"


@pytest.mark.parametrize(
    ("method", "arguments", "why"),
    [
        ("move", {"path": []}, "move needs a path: a list of [x, y] in metres."),
        ("move", {"path": [[1, "a"]]}, "Each point of a path must be [x, y] in metres."),
        ("move", {"path": [[50.0, 1.0]]}, "The path leaves the map."),
        ("move", {"path": [[4.0, 4.0]], "theta": "north"}, "theta must be a number in radians."),
        ("pick", {"device": "shelf", "object": "box", "value": 1}, "Robot is not at Shelf: it is 2.3 m away."),
        ("pick", {"device": "moon", "object": "box", "value": 1}, "There is no machine moon here."),
        (
            "drop",
            {"device": "shelf", "object": "box", "value": 0},
            "The quantity must be a whole number of at least 1.",
        ),
        ("fly", {}, "Robot cannot fly; it can: move, pick, drop, wave."),
    ],
)
def test_what_cannot_be_done_is_rejected_with_the_reason(method: str, arguments: dict[str, object], why: str) -> None:
    play = Play(scene(), "kinematic")
    play.tell("robot", method, "c", **arguments)
    play.wait(1)
    assert [(a.status, a.why) for a in play.final("c")] == [("REJECTED", why)]
    assert play.at() == Pose(3.0, 4.0)


def test_full_empty_and_wrong_objects_are_refused() -> None:
    start = Pose(3.0, 6.17)
    play = Play(scene(poses={"robot": start}, stocks={"shelf": {"box": 3}}), "kinematic")
    reasons = []
    for i, (method, device, thing, count) in enumerate(
        [
            ("pick", "shelf", "box", 3),
            ("pick", "shelf", "can", 1),
            ("drop", "shelf", "box", 1),
            ("pick", "shelf", "box", 2),
            ("pick", "shelf", "box", 1),
            ("drop", "shelf", "box", 1),
        ]
    ):
        play.tell("robot", method, f"c{i}", device=device, object=thing, value=count)
        reasons.append(play.wait_for(f"c{i}").why)
    assert reasons == [
        "Robot is full: it carries 0 and has room for 2, not 3.",
        "Shelf is empty: it has 0 can, not 1.",
        "Robot carries 0 box, not 1.",
        "",
        "Robot is full: it carries 2 and has room for 0, not 1.",
        "Shelf does not take box; it takes nothing.",
    ]
    assert play.world.stocks()["shelf"] == {"box": 1}


def test_what_was_dropped_at_a_machine_can_be_fetched_again(play: Play) -> None:
    play.world.close()
    play = Play(scene(poses={"robot": Pose(8.0, 6.17)}, carrying={"robot": {"box": 1}}), "kinematic")
    play.tell("robot", "drop", "d", device="oven", object="box", value=1)
    assert play.wait_for("d").status == "DONE"
    play.tell("oven", "curePaint", "o", time=1)
    play.tell("robot", "pick", "early", device="oven", object="box", value=1)
    assert play.wait_for("early").why == "Oven is busy with curePaint."
    assert play.wait_for("o", 70).status == "DONE"
    play.tell("robot", "pick", "p", device="oven", object="box", value=1)
    assert play.wait_for("p").status == "DONE"
    assert play.world.robots()["robot"].carrying == {"box": 1}


def test_a_wall_in_the_way_is_touched_and_the_move_fails(driver: DriverName) -> None:
    blocked = Scene(hall(wall_at_x=6.0), (*MACHINES, ROBOT))
    play = Play(blocked, driver)
    play.tell("robot", "move", "m", path=[[9.0, 4.0]])
    play.tell("robot", "move", "after", path=[[10.0, 4.0]])
    failed = play.wait_for("m")
    assert (failed.status, failed.why) == ("FAILED", "Robot cannot go on: it touches wall.")
    assert play.final("after")[0].status == "CANCELED"
    touched = play.contacts()[0]
    assert (touched.device, touched.other) == ("robot", "wall")
    assert touched.distance_m <= 0
    assert touched.x == pytest.approx(5.9, abs=0.15)
    assert play.at().x < 5.87
    play.world.close()


def test_a_robot_stands_before_what_people_put_in_its_way_and_goes_on_when_it_is_gone(play: Play) -> None:
    play.world.put_in_the_way([Obstacle(6.0, 4.0, 0.5)])
    play.tell("robot", "move", "m", path=[[9.0, 4.0]])
    play.wait(8)
    assert play.at().x == pytest.approx(6.0 - 0.25 - 0.18 - 0.4, abs=0.1)
    play.world.put_in_the_way([])
    assert (play.wait_for("m").status, play.contacts()) == ("DONE", [])


def test_robots_that_meet_touch_and_do_not_drive_through_each_other(driver: DriverName) -> None:
    play = Play(scene(robot("a", 3.0, 4.0), robot("b", 8.0, 4.0, pi)), driver)
    play.tell("a", "move", "ma", path=[[9.0, 4.0]])
    play.tell("b", "move", "mb", path=[[2.0, 4.0]])
    closest = 9.0
    for _ in range(200):
        play.wait(0.1)
        closest = min(closest, hypot(play.at("a").x - play.at("b").x, play.at("a").y - play.at("b").y))
    assert closest > 0.3
    assert {(c.device, c.other) for c in play.contacts() if c.distance_m <= 0} == {("a", "b"), ("b", "a")}
    play.world.close()


def test_a_near_miss_is_told_once_with_its_distance(driver: DriverName) -> None:
    play = Play(scene(robot("a", 3.0, 4.0), robot("b", 6.0, 4.42)), driver)
    play.tell("a", "move", "m", path=[[9.0, 4.0]])
    assert play.wait_for("m").status == "DONE"
    (miss,) = play.contacts()
    assert (miss.device, miss.other) == ("a", "b")
    assert miss.distance_m == pytest.approx(0.06, abs=0.02)
    assert (miss.x, miss.y) == pytest.approx((6.0, 4.21), abs=0.1)
    play.world.close()


def test_a_stopped_robot_stays_and_the_battery_runs_down(driver: DriverName) -> None:
    play = Play(scene(faults=(Fault("robot", "stop", 3.0),)), driver)
    play.tell("robot", "move", "m", path=[[9.0, 4.0]])
    play.wait(300)
    assert play.at().x < 5.0
    assert play.final("m") == []
    assert 97.0 < play.world.robots()["robot"].battery < 100.0
    play.world.close()


def test_deliveries_fill_empty_sources_and_empty_full_sinks() -> None:
    stocks = {"shelf": {"box": 0}, "rollers": {"box": 2}}
    play = Play(scene(stocks=stocks, delivery_s=60.0), "kinematic")
    play.wait(59)
    assert play.world.stocks()["shelf"] == {"box": 0}
    play.wait(3)
    assert play.world.stocks()["shelf"] == {"box": 24}
    assert play.world.stocks()["rollers"] == {}
    changes = {(e.device, e.name, e.value) for e in play.events if isinstance(e, PropertyChanged)}
    assert changes >= {("shelf", "stock", 24), ("rollers", "freeSlots", 2)}


def test_a_world_can_be_taken_up_where_it_was_left(play: Play) -> None:
    play.tell("robot", "move", "m", path=[[3.0, 4.0], AT_SHELF])
    play.tell("robot", "pick", "p", device="shelf", object="box", value=2)
    play.wait_for("p")
    left = play.world
    again = Play(
        scene(
            poses={name: r.pose for name, r in left.robots().items()},
            carrying={name: r.carrying for name, r in left.robots().items()},
            stocks=left.stocks(),
            readings=left.readings(),
            remembered=left.remembered(),
        ),
        "kinematic",
    )
    assert again.at().x == play.at().x
    assert again.at().y == play.at().y
    assert again.at().theta == pytest.approx(play.at().theta)
    assert again.world.readings() == left.readings()
    again.tell("robot", "pick", "p", device="shelf", object="box", value=2)
    again.wait(5)
    assert again.final("p")[0].status == "DONE"
    assert again.world.stocks()["shelf"] == {"box": 22}


def test_bodiless_machines_are_in_nobodys_way(driver: DriverName) -> None:
    play = Play(scene(bodiless=frozenset({"oven"})), driver)
    play.tell("robot", "move", "m", path=[[8.0, 4.0], [8.0, 7.5]])
    assert play.wait_for("m").status == "DONE"
    assert play.contacts() == []
    play.world.close()


def test_a_device_that_is_not_here_stays_silent(play: Play) -> None:
    play.tell("stranger", "move", "m", path=[[1.0, 1.0]])
    play.wait(1)
    assert play.events == []


def test_many_robots_in_the_factory_reach_every_station(driver: DriverName) -> None:
    grid, devices = make_grid(read_plan()), describe_devices()[:-1]
    serve = stations(grid, devices, 0.18)
    play = Play(Scene(grid, devices), driver)
    play.tell("robot02", "move", "out", path=[[17.3, -10.2], [17.3, -8.0], [21.2, -8.0]])
    pose = serve["paintMachine01"]
    play.tell("robot02", "move", "in", path=[[21.2, -5.5], [pose.x, pose.y]], theta=pose.theta)
    assert play.wait_for("in").status == "DONE"
    assert hypot(play.at("robot02").x - pose.x, play.at("robot02").y - pose.y) < 0.03
    assert play.contacts() == []
    play.world.close()


STORY = """
import hashlib, sys
from simulation.services import make_world
from tests.unit.simulation.stage_set import robot, scene
world = make_world(scene=scene(robot("a", 3.0, 4.0), robot("b", 8.0, 4.2, 3.1), seed=3), driver=sys.argv[1])
world.command("a", "move", {"path": [[9.0, 4.0]]}, "m1")
world.command("b", "move", {"path": [[2.0, 4.2], [2.0, 2.0]]}, "m2")
world.command("oven", "curePaint", {"time": 1}, "o")
digest = hashlib.sha256()
for _ in range(700):
    digest.update(repr(world.advance(0.1)).encode())
    digest.update(repr(sorted(world.robots().items())).encode())
print(digest.hexdigest())
"""


def test_two_processes_give_the_same_bytes(driver: DriverName) -> None:
    runs = [
        subprocess.run([sys.executable, "-c", STORY, driver], cwd=ROOT, capture_output=True, text=True, check=True)
        for _ in range(2)
    ]
    assert len(runs[0].stdout.strip()) == hashlib.sha256().digest_size * 2
    assert runs[0].stdout == runs[1].stdout


def test_a_second_world_in_the_same_process_is_the_same_as_the_first(driver: DriverName) -> None:
    stories = []
    for _ in range(2):
        play = Play(scene(seed=5), driver)
        play.tell("robot", "move", "m", path=[[3.0, 4.0], AT_SHELF, [6.0, 4.0]])
        play.wait(20)
        stories.append((play.events, play.world.robots()))
        play.world.close()
    assert stories[0] == stories[1]
