"""A device and its copy side by side: what both take is measured, and nothing that goes wrong is measured wrongly."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from typing import Any

import pytest

from simulation.mirror.device_copy import DeviceCopy, Job
from simulation.services import make_world
from simulation.world import Ack, Scene, World
from tests.unit.simulation.stage_set import scene
from vipo_device.protocol.description import DeviceState, Pose
from vipo_device.protocol.messages import AckMessage, DeviceCommand

TICK_S = 0.05


def kinematic(of: Scene) -> World:
    return make_world(scene=of, driver="kinematic")


class Floor:
    """Real devices (a world with paces of its own, `speed` times real time), and the copy of one of them."""

    def __init__(self, device: str, paces: Mapping[str, float] | None = None, speed: float = 1.0) -> None:
        stage = scene()
        self.device, self.speed, self.now = device, speed, 100.0
        self.real = kinematic(replace(stage, paces={device: paces or {}}))
        descriptions = {d.id: d for d in stage.devices}
        machines = [d for d in stage.devices if d.kind == "machine"]
        self.copy = DeviceCopy(descriptions[device], machines, kinematic, speed)
        self.jobs: list[Job] = []
        self.is_heard = True
        self.tell()

    def give(self, method: str, arguments: dict[str, Any], command: str) -> None:
        self.real.command(self.device, method, arguments, command)
        self.copy.hear_command(self.now, DeviceCommand(command, method, arguments))

    def tell(self) -> None:
        """Let the device say how it is."""
        robots = self.real.robots()
        pose = robots[self.device].pose if self.device in robots else None
        readings = self.real.readings()[self.device]
        self.copy.hear_state(self.now, DeviceState(1, 1, True, pose, "", readings))

    def pass_time(self, seconds: float) -> None:
        for tick in range(round(seconds * self.speed / TICK_S)):
            self.now += TICK_S / self.speed
            for event in self.real.advance(TICK_S):
                if isinstance(event, Ack) and event.device == self.device and self.is_heard:
                    self.copy.hear_answer(self.now, AckMessage(event.command, event.status, event.why))
            if tick % 5 == 0:
                self.tell()
            self.copy.advance(self.now)
            job = self.copy.take_job()
            if job is not None:
                self.jobs.append(job)


def move(*points: tuple[float, float]) -> dict[str, Any]:
    return {"path": [list(point) for point in points]}


def pace_of(job: Job) -> float:
    return sum(m.real_s for m in job.measured) / sum(m.predicted_s for m in job.measured)


def test_a_device_that_is_as_described_takes_what_its_copy_takes() -> None:
    floor = Floor("bench")
    floor.give("cool", {"time": 6}, "c1")
    floor.pass_time(10)
    (job,) = floor.jobs
    assert [m.command for m in job.measured] == ["c1"]
    assert job.measured[0].predicted_s == pytest.approx(6, abs=0.2)
    assert pace_of(job) == pytest.approx(1, abs=0.03)
    assert not floor.copy.is_at_work


def test_a_slower_machine_is_measured_as_much_slower() -> None:
    floor = Floor("bench", {"cool": 1.2})
    for number in range(3):
        floor.give("cool", {"time": 6}, f"c{number}")
        floor.pass_time(10)
    assert [pace_of(job) for job in floor.jobs] == pytest.approx([1.2] * 3, abs=0.03)


@pytest.mark.parametrize("speed", [1.0, 5.0])
def test_a_robot_that_is_given_its_path_in_pieces_is_measured_over_all_of_it(speed: float) -> None:
    floor = Floor("robot", {"move": 1.2}, speed)
    floor.give("move", move((4.0, 3.0)), "c1")
    floor.pass_time(1 / speed)
    floor.give("move", move((4.0, 3.0), (6.0, 3.0)), "c2")
    floor.give("move", move((6.0, 3.0), (8.0, 3.0)), "c3")
    floor.pass_time(40 / speed)
    (job,) = floor.jobs
    assert [m.command for m in job.measured] == ["c1", "c2", "c3"]
    assert pace_of(job) == pytest.approx(1.2, abs=0.06)
    assert job.apart_m is not None
    assert 0.5 < job.apart_m < 3  # the copy arrives first


def test_each_job_begins_where_the_device_is() -> None:
    floor = Floor("robot", {"move": 1.5})
    floor.give("move", move((4.0, 3.0)), "c1")
    floor.pass_time(20)
    floor.give("move", move((4.0, 3.0), (8.0, 3.0)), "c2")
    real = floor.real.robots()["robot"].pose
    copy = floor.copy.pose
    assert copy is not None
    assert (copy.x, copy.y) == pytest.approx((real.x, real.y), abs=0.01)


def test_a_stop_holds_both_and_is_no_slowdown() -> None:
    floor = Floor("bench")
    floor.give("cool", {"time": 6}, "c1")
    floor.pass_time(2)
    floor.real.hold(active=True)
    floor.copy.hold(floor.now, active=True)
    floor.pass_time(30)
    floor.real.hold(active=False)
    floor.copy.hold(floor.now, active=False)
    floor.pass_time(6)
    (job,) = floor.jobs
    assert pace_of(job) == pytest.approx(1, abs=0.03)


@pytest.mark.parametrize("status", ["FAILED", "CANCELED", "REJECTED"])
def test_what_came_to_nothing_is_not_measured(status: Any) -> None:
    floor = Floor("bench")
    floor.is_heard = False
    floor.give("cool", {"time": 6}, "c1")
    floor.copy.hear_answer(floor.now, AckMessage("c1", "RUNNING"))
    floor.pass_time(1)
    floor.copy.hear_answer(floor.now, AckMessage("c1", status, "It broke down."))
    floor.pass_time(1)
    assert [job.measured for job in floor.jobs] == [()]
    assert not floor.copy.is_at_work


def test_a_device_that_never_answers_costs_nothing_for_ever() -> None:
    floor = Floor("bench")
    floor.is_heard = False
    floor.give("cool", {"time": 6}, "c1")
    floor.pass_time(1)
    floor.copy.advance(floor.now + 5 * 3600)
    assert floor.copy.take_job() is None
    assert not floor.copy.is_at_work


def test_a_flood_of_commands_is_given_up_on() -> None:
    floor = Floor("robot")
    floor.is_heard = False
    for number in range(500):
        floor.copy.hear_command(floor.now, DeviceCommand(f"c{number}", "wave", {}))
    assert floor.copy.take_job() is None
    assert not floor.copy.is_at_work


def test_what_is_repeated_or_strange_is_passed_over() -> None:
    floor = Floor("bench")
    floor.copy.hear_answer(floor.now, AckMessage("never-told", "DONE"))
    floor.copy.hear_command(floor.now, DeviceCommand("p1", "pause", {}))
    assert not floor.copy.is_at_work
    floor.give("cool", {"time": 6}, "c1")
    floor.copy.hear_command(floor.now, DeviceCommand("c1", "cool", {"time": 6}))
    floor.pass_time(10)
    floor.copy.hear_answer(floor.now, AckMessage("c1", "DONE"))
    (job,) = floor.jobs
    assert len(job.measured) == 1


def test_who_says_at_once_that_all_its_pieces_run_is_measured_as_if_one_ran_after_the_other() -> None:
    floor = Floor("robot")
    floor.is_heard = False
    floor.give("move", move((5.0, 4.0)), "c1")
    floor.give("move", move((5.0, 4.0), (7.0, 4.0)), "c2")
    for command in ("c1", "c2"):
        floor.copy.hear_answer(floor.now, AckMessage(command, "RUNNING"))
    began = floor.now
    for command in ("c1", "c2"):
        floor.pass_time(6)
        floor.copy.hear_answer(floor.now, AckMessage(command, "DONE"))
    floor.pass_time(1)
    (job,) = floor.jobs
    assert [m.real_s for m in job.measured] == pytest.approx([6, 6], abs=0.1)
    assert sum(m.real_s for m in job.measured) == pytest.approx(floor.now - 1 - began, abs=0.1)


@pytest.mark.parametrize("said", ["box:1", " box = 1 ", "box:1,can:0"])
def test_a_robot_that_carries_something_puts_it_down_as_its_copy_does(said: str) -> None:
    floor = Floor("robot")
    at_rollers = Pose(8.0, 1.85, 0.0)
    floor.copy.hear_state(floor.now, DeviceState(1, 1, True, at_rollers, "", {"load": said}))
    drop = {"device": "rollers", "object": "box", "value": 1}
    floor.copy.hear_command(floor.now, DeviceCommand("d1", "drop", drop))
    floor.copy.hear_answer(floor.now, AckMessage("d1", "RUNNING"))
    floor.copy.hear_answer(floor.now + 2, AckMessage("d1", "DONE"))
    job = floor.copy.take_job()
    assert job is not None
    assert [m.command for m in job.measured] == ["d1"]
