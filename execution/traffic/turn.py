"""One event being worked out on the floor: a copy of the state that changes, and the actions so far."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import replace
from math import hypot
from typing import Any
from uuid import UUID, uuid5

from execution.traffic.floor_state import FloorState, FloorTask, Robot, Sent
from execution.traffic.layout import Layout, Node
from execution.traffic.messages import Action, Reason, SendCommand, TaskOver, WaitChanged
from vipo_device.protocol.description import Scalar

TOUCH_M = 0.04
"""Bodies so near to each other count as touching."""


class Turn:
    """The floor while one event is taken in; `close` gives the new state and what is to be done."""

    def __init__(self, layout: Layout, state: FloorState, now: float) -> None:
        self.layout = layout
        self.before = state
        self.now = now
        self.next_seq = state.next_seq
        self.stopped = state.stopped
        self.robots = dict(state.robots)
        self.tasks = {(task.run, task.number): task for task in state.tasks}
        self.sent = dict(state.sent)
        self.calls = dict(state.calls)
        self.stations = dict(state.stations)
        self.paused = set(state.paused)
        self.offline = dict(state.offline)
        self.roles = dict(state.roles)
        self.names = dict(state.names)
        self.zones = dict(state.zones)
        self.locks = dict(state.locks)
        self.passages = state.passages
        self.doors = dict(state.doors)
        self.admissions = {(each.zone, each.robot): each for each in state.admissions}
        self.awaiting: dict[str, str] = {}
        self.readings: Mapping[str, Mapping[str, Scalar]] = {}
        self.waits: dict[tuple[str, int], Reason] = {}
        self.actions: list[Action] = []

    def close(self) -> tuple[FloorState, tuple[Action, ...]]:
        """Return the new state and the actions."""
        state = FloorState(
            namespace=self.before.namespace,
            now=self.now,
            next_seq=self.next_seq,
            stopped=self.stopped,
            robots=self.robots,
            tasks=tuple(self.tasks.values()),
            sent=self.sent,
            calls=self.calls,
            stations=self.stations,
            paused=tuple(sorted(self.paused)),
            offline=self.offline,
            roles=self.roles,
            names=self.names,
            zones=self.zones,
            locks=self.locks,
            passages=self.passages,
            doors=self.doors,
            admissions=tuple(self.admissions.values()),
            awaiting=self.awaiting,
            lattice=self.layout.numbering,
        )
        return state, tuple(self.actions)

    def put(self, robot: Robot, **changes: Any) -> Robot:
        """Change a robot."""
        self.robots[robot.id] = replace(robot, **changes)
        return self.robots[robot.id]

    def put_task(self, task: FloorTask, **changes: Any) -> FloorTask:
        """Change a task."""
        self.tasks[task.run, task.number] = replace(task, **changes)
        return self.tasks[task.run, task.number]

    def send(self, sent: Sent, method: str, arguments: Mapping[str, object], step: str = "") -> str:
        """Send a command and remember it until it is answered; its id is taken from the sequence."""
        command = self.new_command_id()
        self.sent[command] = replace(sent, id=command, at=self.now)
        piece = sent.upto >= 0
        self.actions.append(SendCommand(command, sent.device, method, arguments, sent.run, step, piece))
        return command

    def shift(self, sent: Sent, nodes: int) -> None:
        """Count a piece of path from a node that lies so many behind the one from which it was counted."""
        self.sent[sent.id] = replace(sent, upto=sent.upto - nodes)

    def tell(self, sent: Sent, method: str) -> None:
        """Pause, resume or cancel a command that is under way; the answer is the command's own."""
        arguments = {"command": sent.id}
        self.actions.append(SendCommand(self.new_command_id(), sent.device, method, arguments, sent.run))

    def new_command_id(self) -> str:
        """Return the next id: the same history gives the same ids."""
        self.next_seq += 1
        return str(uuid5(UUID(self.before.namespace), str(self.next_seq)))

    def finish(self, task: FloorTask, kind: str = "", why: str = "", result: Mapping[str, Any] | None = None) -> None:
        """End a task and tell its run."""
        del self.tasks[task.run, task.number]
        self.actions.append(TaskOver(task.run, task.number, kind, why, result or {}))

    def wait(self, task: FloorTask, code: str, text: str, **arguments: str | float) -> None:
        """Say what a task waits for."""
        self.wait_for(task, Reason(code, text, arguments))

    def wait_for(self, task: FloorTask, reason: Reason) -> None:
        """Say what a task waits for."""
        self.waits[task.run, task.number] = reason

    def announce_waits(self) -> None:
        """Tell the runs whose tasks now wait for something else."""
        for key, task in self.tasks.items():
            reason = self.waits.get(key)
            if reason != task.wait:
                self.tasks[key] = replace(task, wait=reason)
                self.actions.append(WaitChanged(task.run, task.number, task.order.step, task.robot, reason))

    def name(self, thing: str) -> str:
        """Return what people call a device or a place."""
        return self.layout.name(thing)

    def node(self, robot: Robot) -> Node:
        """Return the node that a robot is at or passed last."""
        return robot.path[robot.passed]

    def pieces(self, robot: Robot) -> list[Sent]:
        """Return the pieces of path that a robot is driving, in order."""
        return [sent for sent in self.sent.values() if sent.device == robot.id and sent.upto >= 0]

    def is_driving(self, robot: Robot) -> bool:
        """Tell whether a robot has pieces of path under way."""
        return bool(self.pieces(robot))

    def is_acting(self, robot: Robot) -> bool:
        """Tell whether a robot picks, drops or does something else that it should not be disturbed in."""
        return any(sent.device == robot.id and sent.upto < 0 for sent in self.sent.values())

    def task_of(self, robot: Robot) -> FloorTask | None:
        """Return the oldest task that a robot is at."""
        mine = [task for task in self.tasks.values() if task.robot == robot.id]
        return min(mine, key=lambda task: task.seq) if mine else None

    def is_idle(self, robot: Robot) -> bool:
        """Tell whether a robot stands with nothing to do."""
        free = len(robot.path) == robot.passed + 1 and not self.is_driving(robot) and not self.is_acting(robot)
        return free and self.task_of(robot) is None

    def holders(self, entering: str) -> dict[int, str]:
        """Return who holds each cell, or stands so near to it that a robot which is `entering` would touch it there.

        Robots that came to stand too near to each other share out the cells around them; none may enter one that is
        near the other, although it is its own.
        """
        holders = {cell: robot.id for robot in self.robots.values() for cell in robot.held}
        for robot in self.robots.values():
            if robot.id != entering and robot.path and not self.is_driving(robot):
                holders |= dict.fromkeys(self._shared_near(robot), robot.id)
        return holders

    def _shared_near(self, robot: Robot) -> list[int]:
        """Return the cells that a standing robot does not hold though others would touch it there."""
        node = self.node(robot)
        shared = self.layout.needed(node) - set(robot.held) if isinstance(node, str) else frozenset()
        here, near_m = (robot.x, robot.y), 2 * self.layout.ground.radius_m + TOUCH_M
        points = {cell: self.layout.lattice.centre(cell) for cell in shared}
        return [cell for cell, (x, y) in points.items() if hypot(x - here[0], y - here[1]) < near_m]

    def in_order(self) -> Iterator[FloorTask]:
        """Go through the tasks, the oldest first; tasks that end meanwhile are left out."""
        for key in sorted(self.tasks, key=lambda key: self.tasks[key].seq):
            if key in self.tasks:
                yield self.tasks[key]
