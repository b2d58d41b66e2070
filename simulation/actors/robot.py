"""A simulated robot: it drives along what was released to it, picks up, puts down, and runs its battery flat."""

from __future__ import annotations

from collections import deque
from collections.abc import Mapping
from dataclasses import dataclass
from math import hypot

from simulation.actors.actor import Actor, Emit, InitialState
from simulation.actors.follower import Follower, Motion
from simulation.actors.machine import Machine
from simulation.proximity import body_of
from vipo_device.kit.arguments import counted_object, read_move, why_astray
from vipo_device.protocol.arguments import is_number
from vipo_device.protocol.batteries import says_charge
from vipo_device.protocol.description import Description, Scalar
from vipo_device.protocol.messages import AckMessage

DEFAULT_RADIUS_M = 0.18
ARM_M = 0.5
DOCKED_M = 0.3
Bounds = tuple[float, float, float, float]


@dataclass(slots=True)
class Task:
    """A command in the robot's queue."""

    command: str
    method: str
    arguments: Mapping[str, object]
    points: tuple[tuple[float, float], ...] = ()
    theta: float | None = None
    speed_m_s: float | None = None
    left_s: float = 0.0
    begun: bool = False
    handed: bool = False


@dataclass(frozen=True, slots=True)
class Surroundings:
    """What a robot finds: the machines, and the map's edges (x1, y1, x2, y2) in metres."""

    machines: Mapping[str, Machine]
    bounds: Bounds


class Robot(Actor):
    """Commands queue up; moves that follow one another are driven without stopping between them."""

    def __init__(self, description: Description, emit: Emit, initial: InitialState, surroundings: Surroundings) -> None:
        super().__init__(description, emit, initial)
        self.carrying = {k: v for k, v in (initial.holds or {}).items() if v > 0}
        self.radius_m = description.radius_m or max(description.size.x, description.size.y) / 2 or DEFAULT_RADIUS_M
        self.touches = ""
        self.stands_before = ""
        self._says_charge = says_charge(description)
        known = initial.readings.get("battery")
        self.battery = float(known) if self._says_charge and is_number(known) else 100.0
        self._machines, self._bounds = surroundings.machines, surroundings.bounds
        self._tasks: deque[Task] = deque()
        self.speed_m_s = (description.speed_m_s or self.behaviour.speed_m_s) / self.paces.get("move", 1.0)
        self._follower = Follower(self.speed_m_s)
        self._at = Motion(description.pose.x, description.pose.y, description.pose.theta)
        self._start_readings()

    @property
    def busy(self) -> bool:
        """True while commands are under way."""
        return bool(self._tasks)

    @property
    def resting(self) -> bool:
        """True when the robot stands and has nothing to do."""
        return not self._tasks and self._follower.idle and not self.awaits_time

    @property
    def load(self) -> int:
        """How many objects it carries."""
        return sum(self.carrying.values())

    def stands_at(self, motion: Motion) -> None:
        """Tell the robot where it is, before it is first steered."""
        self._at = motion

    def control(self, motion: Motion, t_s: float, dt_s: float) -> tuple[float, float]:
        """Decide how fast to drive (m/s) and turn (rad/s) in the next `dt_s`; handle objects when it is time."""
        self._at = motion
        self.notice_faults(t_s)
        if self.is_flat and self._tasks and not self.frozen:
            self._stop_flat(t_s)
        if self.frozen or not self._tasks:
            return self._follower.brake(dt_s)
        task = self._tasks[0]
        self._begin(t_s, task)
        if task.points:
            return self._drive(motion, t_s, dt_s)
        targets = self._follower.brake(dt_s)
        if self._follower.idle:
            self._handle(t_s, dt_s, task)
        return targets

    def use_battery(self, t_s: float, dt_s: float, *, driving: bool) -> None:
        """Drain the battery, or charge it where the robot is at home."""
        home = self.description.pose
        docked = not driving and hypot(self._at.x - home.x, self._at.y - home.y) < DOCKED_M
        how = self.behaviour
        percent_h = 100 / how.charging_h if docked else -100 / (how.driving_h if driving else how.standing_h)
        self.battery = min(100.0, max(0.0, self.battery + percent_h / 3600 * dt_s))
        self._show_charge(t_s)

    def notice_faults(self, t_s: float) -> None:
        """Let faults begin and end; what falls down is gone, and a battery that falls so low is so low."""
        super().notice_faults(t_s)
        fallen = self.troubles.spend("battery")
        if fallen is not None and is_number(fallen.value):
            self.battery = min(self.battery, float(fallen.value))
            self._show_charge(t_s)
        if self.carrying and self.troubles.spend("drops") is not None:
            self.carrying = {}
            self.read(t_s, "load", self._load_shown())

    def change_battery(self, t_s: float) -> None:
        """Put a full battery in, as people do with a robot that stands."""
        self.battery = 100.0
        self._show_charge(t_s)

    @property
    def is_flat(self) -> bool:
        """True when a robot that says how full its battery is has nothing left."""
        return self.battery <= 0 and self._says_charge

    def _show_charge(self, t_s: float) -> None:
        """Show how full the battery is, where the robot says that: volts, words and yes or no stay as they are."""
        if self._says_charge:
            self.read(t_s, "battery", round(self.battery))

    def _begin(self, t_s: float, task: Task) -> None:
        if not task.begun:
            task.begun = True
            self._say(t_s, AckMessage(task.command, "RUNNING"))

    def _drive(self, motion: Motion, t_s: float, dt_s: float) -> tuple[float, float]:
        self._hand_over_moves()
        speed, turn, reached = self._follower.steer(motion, dt_s)
        for command in reached:
            self._reached(t_s, command)
        if self._follower.stuck:
            self._give_up(t_s)
            return 0.0, 0.0
        return speed, turn

    def _hand_over_moves(self) -> None:
        """Give the follower all moves at the head of the queue, so that it need not stop between them."""
        for task in self._tasks:
            if not task.points:
                return
            if not task.handed:
                task.handed = True
                self._follower.add(list(task.points), task.command, task.theta, task.speed_m_s)

    def _reached(self, t_s: float, command: str) -> None:
        if not self._tasks or self._tasks[0].command != command:
            return
        task = self._tasks.popleft()
        self._begin(t_s, task)
        if not self._say_done(t_s, command):
            self._end_moves(t_s, "The way before it failed.")

    def _give_up(self, t_s: float) -> None:
        task = self._tasks.popleft()
        what = f"{self.description.name} cannot go on"
        if self.touches:
            why = f"{what}: it touches {self.touches}."
        else:
            why = f"{what}: {self.stands_before}." if self.stands_before else f"{what}."
        self._say(t_s, AckMessage(task.command, "FAILED", why))
        self._end_moves(t_s, "The way before it failed.")

    def _stop_flat(self, t_s: float) -> None:
        """Fail all that is under way: the robot stands where it is until somebody charges it."""
        self._follower.clear()
        ended, self._tasks = list(self._tasks), deque()
        for task in ended:
            self._say(t_s, AckMessage(task.command, "FAILED", self._why_flat()))

    def _why_flat(self) -> str:
        return f"The battery of {self.description.name} is empty; charge it."

    def _end_moves(self, t_s: float, why: str) -> None:
        """Cancel all queued moves: without the way before them they would lead through walls."""
        self._follower.clear()
        ended = [t for t in self._tasks if t.points]
        self._tasks = deque(t for t in self._tasks if not t.points)
        for task in ended:
            self._say(t_s, AckMessage(task.command, "CANCELED", why))

    def _handle(self, t_s: float, dt_s: float, task: Task) -> None:
        """Spend time on a pick, a drop or another method; at its end objects change hands."""
        if task.left_s > 0 and (why := self._refusal_of_handling(task.method, task.arguments)):
            self._tasks.popleft()
            self._say(t_s, AckMessage(task.command, "FAILED", why))
            return
        task.left_s -= dt_s
        if task.left_s > 1e-9:
            return
        self._tasks.popleft()
        if self._say_done(t_s, task.command):
            self._hand_objects(t_s, task)

    def _refusal_of_handling(self, method: str, arguments: Mapping[str, object]) -> str:
        if method not in {"pick", "drop"}:
            return ""
        goods = counted_object(arguments)
        if isinstance(goods, str):
            return goods
        machine = self._machine_at_hand(arguments)
        if isinstance(machine, str):
            return machine
        return self._refusal_of_goods(method, machine, *goods)

    def _refusal_of_goods(self, method: str, machine: Machine, name: str, count: int) -> str:
        capacity = self.description.capacity  # 0: it does not say
        if method == "pick" and 0 < capacity < self.load + count:
            room = capacity - self.load
            return f"{self.description.name} is full: it carries {self.load} and has room for {room}, not {count}."
        if method == "pick":
            return machine.refusal_to_give(name, count)
        if self.carrying.get(name, 0) < count:
            return f"{self.description.name} carries {self.carrying.get(name, 0)} {name}, not {count}."
        return machine.refusal_to_take(name, count)

    def _machine_at_hand(self, arguments: Mapping[str, object]) -> Machine | str:
        """Return the machine that is meant, or the nearest one in reach when none is named; a text says why not."""
        named = arguments.get("device")
        if isinstance(named, str) and named:
            machine = self._machines.get(named)
            if machine is None:
                return f"There is no machine {named} here."
            away_m = self._reach_to(machine)
            if away_m > ARM_M:
                return f"{self.description.name} is not at {machine.description.name}: it is {away_m:.1f} m away."
            return machine
        reachable = [(away, m.description.id) for m in self._machines.values() if (away := self._reach_to(m)) <= ARM_M]
        return self._machines[min(reachable)[1]] if reachable else f"{self.description.name} stands at no machine."

    def _reach_to(self, machine: Machine) -> float:
        return body_of(machine.description).distance_m(self._at.x, self._at.y) - self.radius_m

    def _hand_objects(self, t_s: float, task: Task) -> None:
        if task.method not in {"pick", "drop"}:
            return
        goods, machine = counted_object(task.arguments), self._machine_at_hand(task.arguments)
        assert isinstance(goods, tuple)
        assert isinstance(machine, Machine)
        name, count = goods
        change = count if task.method == "pick" else -count
        machine.change_stock(t_s, name, -change)
        self.carrying[name] = self.carrying.get(name, 0) + change
        self.carrying = {k: v for k, v in self.carrying.items() if v > 0}
        self.read(t_s, "load", self._load_shown())

    def _take_on(self, t_s: float, method: str, arguments: Mapping[str, object], command: str) -> str:
        if self.is_flat:
            return self._why_flat()
        task = self._task(method, arguments, command)
        if isinstance(task, str):
            return task
        if not self._tasks and (why := self._refusal_of_handling(method, arguments)):
            return why
        self._tasks.append(task)
        self._say(t_s, AckMessage(command, "ACCEPTED"))
        return ""

    def _task(self, method: str, arguments: Mapping[str, object], command: str) -> Task | str:
        if method == "move":
            return self._move(arguments, command)
        if method in {"pick", "drop"}:
            goods = counted_object(arguments)
            return (
                goods
                if isinstance(goods, str)
                else Task(command, method, dict(arguments), left_s=self._lasts_s(method, None, arguments))
            )
        lasts_s = self._lasts_s(method, self.description.method(method), arguments)
        return Task(command, method, dict(arguments), left_s=lasts_s)

    def _move(self, arguments: Mapping[str, object], command: str) -> Task | str:
        move = read_move(arguments)
        if isinstance(move, str):
            return move
        ends = [task.points[-1] for task in self._tasks if task.points]
        if why := why_astray(self.description.name, move.begin, ends[-1] if ends else (self._at.x, self._at.y)):
            return why
        x1, y1, x2, y2 = self._bounds
        if not all(x1 <= x <= x2 and y1 <= y <= y2 for x, y in move.path):
            return "The path leaves the map."
        return Task(command, "move", {}, move.path, move.theta, move.speed_m_s)

    def _cancel(self, t_s: float, command: str) -> None:
        """End a command; a move takes the moves after it along."""
        ended = [t for t in self._tasks if command in {"", t.command}]
        if any(t.points for t in ended):
            self._cancel_moves_from(t_s, command)
        for task in [t for t in ended if t in self._tasks]:
            self._tasks.remove(task)
            self._say(t_s, AckMessage(task.command, "CANCELED", f"{task.method} was cancelled."))

    def _cancel_moves_from(self, t_s: float, command: str) -> None:
        order = [t.command for t in self._tasks]
        first = order.index(command) if command else 0
        kept = [t for t in self._tasks if order.index(t.command) < first or not t.points]
        ended = [t for t in self._tasks if t not in kept]
        self._tasks = deque(kept)
        before = [t.command for t in kept if t.handed]
        self._follower.drop_after(before[-1]) if before else self._follower.clear()
        for task in ended:
            why = "move was cancelled." if task.command == command else "The way before it was cancelled."
            self._say(t_s, AckMessage(task.command, "CANCELED", why))

    def _load_shown(self) -> Scalar:
        """Return the load as text (`box:1,can:2`), or as a number where the robot describes it so."""
        spec = self.description.property("load")
        if spec is not None and spec.type == "number":
            return self.load
        return ",".join(f"{name}:{count}" for name, count in sorted(self.carrying.items()))

    def _start_readings(self) -> None:
        """Set the readings that follow from the robot's state, before anyone listens."""
        values: dict[str, Scalar] = {"load": self._load_shown()}
        if self._says_charge:
            values["battery"] = round(self.battery)
        self.readings.update({name: value for name, value in values.items() if name in self.readings})
