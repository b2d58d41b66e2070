"""A floor with a door between west and east that takes two seconds; it checks who drives through it."""

from dataclasses import replace

from execution.machine.floor_task import Target, TaskOrder
from execution.machine.places import lies_in
from execution.traffic import messages as m
from execution.traffic.layout import make_layout
from tests.kit import demo_floor
from tests.unit.execution.traffic.simulated_floor import PretendFloor
from vipo_device.protocol.description import Description, MethodSpec, Pose, PropertySpec, Size

PASSAGE = ((9.0, -9.0), (10.0, -9.0), (10.0, -5.0), (9.0, -5.0))
WEST, EAST = (3.0, -8.0), (18.0, -8.0)
TAKES_S = 2.0


def door_device(opens="open", closes="close", reading="state"):
    methods = tuple(MethodSpec(name, f"vipo/v1/dev/door02/down/{name}") for name in (opens, closes) if name)
    spec = PropertySpec(reading, "text", options=("closed", "moving", "open"))
    pose, size = Pose(0.3, -0.3), Size(0.1, 0.1, 0.1)
    told = (spec,) if reading else ()
    return Description("door02", "Door 2", "machine", "gate", pose, size, properties=told, methods=methods)


class WithDoor(PretendFloor):
    """A floor with a door between west and east that takes two seconds; it checks who drives through it."""

    def __init__(self, poses, device=None):
        self.device = device or door_device()
        self.is_open, self.is_broken, self.ids, self.stays_shut, self.line = False, "", {}, False, []
        plain = demo_floor.layout()
        layout = make_layout(plain.ground.grid, [*plain.devices.values(), self.device], demo_floor.places())
        super().__init__(layout, poses)

    def take(self, command):
        if command.device != "door02":
            super().take(command)
            return
        self.sent.append(command)
        self.line.append(command.method)
        self.ids[command.id] = command.method
        if command.method not in {"pause", "resume", "cancel"} and "door02" not in self.deaf:
            self.works.append((self.now + TAKES_S, command.id))

    def tell(self, *events):
        answered = [event for event in events if isinstance(event, m.CommandAnswered) and event.command in self.ids]
        events = [event for event in events if event not in answered]
        for event in answered:
            events.append(replace(event, status=self.is_broken, why="Motor fault") if self.is_broken else event)
            if not self.is_broken and not self.stays_shut:
                self.is_open = self.ids[event.command].lower().startswith(("open", "raise"))
        reading = {"door02": {"state": "open" if self.is_open else "closed"}}
        told = [m.RobotsReport(reading)] if self.device.properties else []
        return super().tell(*told, *events)

    def pass_time(self, dt_s=0.1):
        actions = super().pass_time(dt_s)
        for name, at in self.at.items():
            assert self.is_open or not lies_in(at, PASSAGE) or name in self.may_be_shut_in, f"{name} in a shut door"
        return actions

    may_be_shut_in = frozenset()

    def inside(self, name):
        return lies_in(self.at[name], PASSAGE)

    def door(self):
        return self.state.doors["door02"]


ZONES = (m.FloorZone("p/z", "Door", "door", PASSAGE, door="door02"),)


def go(floor, goal, run="r", task=1, robot="robot01", zones=ZONES):
    order = TaskOrder("move", Target("", goal), "robot", step=f"{run}-step")
    floor.tell(m.TaskAsked(run, task, order, robot, ("move",), run, zones))


def call(floor, method, run="r", task=9, step="door"):
    order = TaskOrder("call", Target("door02"), method=method, step=step)
    floor.tell(m.TaskAsked(run, task, order, "", (), run, ZONES))


def over(floor, run="r", task=1):
    return lambda: (run, task) in floor.over


def reasons(floor):
    return [wait.reason.code for wait in floor.waits if wait.reason]
