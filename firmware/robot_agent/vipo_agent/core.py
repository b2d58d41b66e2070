"""The robot as a device: commands, poses and results of navigation in, goals and answers out.

Knows neither ROS nor MQTT nor a clock; times are seconds of one clock, lengths metres, angles radians.
"""

from __future__ import annotations

from collections import OrderedDict
from dataclasses import dataclass, field
from math import atan2, hypot
from typing import Any, Iterable, NamedTuple, Tuple, Union

from vipo_agent.messages import MAX_WHY, Stop, Told, is_number, read_path

CONTROLS = ("pause", "resume", "cancel")
OPEN = ("ACCEPTED", "RUNNING")
REMEMBERED = 16
ASTRAY_M = 0.6
PASS_M = 0.35
"""How near it has to come to a point of the way before it is sent on to the next one."""
TRIES = 2
"""How often a goal is tried: planners give up when a person crosses their way."""
Pose = Tuple[float, float, float]


class Ack(NamedTuple):
    """An answer to a command."""

    command: str
    status: str
    why: str = ""


class Go(NamedTuple):
    """Drive there; results come back with the number. `speed_m_s` is the most that is allowed, None as usual."""

    number: int
    x: float
    y: float
    theta: float
    speed_m_s: float | None


class Halt(NamedTuple):
    """Give up the goal that is being driven to, and stand."""


Action = Union[Ack, Go, Halt]


@dataclass
class Facts:
    """What is fixed about a robot. `limits_speed`: whether its navigation can be told to drive slower."""

    name: str
    speed_m_s: float
    capacity: int = 0
    limits_speed: bool = False
    handling_s: float = 2.0


@dataclass
class Task:
    """A command that is open."""

    command: str
    method: str
    points: list[tuple[float, float]] = field(default_factory=list)
    theta: float | None = None
    speed_m_s: float | None = None
    goods: tuple[str, int] = ("", 0)
    until_s: float | None = None


class Answers:
    """The last answer to each open command, and to the last 16 that are over."""

    def __init__(self, over: Iterable[Ack] = ()) -> None:
        self._acks: OrderedDict[str, Ack] = OrderedDict((ack.command, ack) for ack in over)

    def find(self, command: str) -> Ack | None:
        """Return the last answer to a command, None when it is new."""
        return self._acks.get(command)

    def note(self, ack: Ack) -> None:
        """Keep an answer; a final one pushes the oldest final one out."""
        self._acks.pop(ack.command, None)
        self._acks[ack.command] = ack
        for oldest in self.over()[:-REMEMBERED]:
            del self._acks[oldest.command]

    def over(self) -> list[Ack]:
        """Return the final answers that are remembered, the oldest first."""
        return [ack for ack in self._acks.values() if ack.status not in OPEN]


class Core:
    """`out` fills with answers and orders to the navigation; whoever carries them out empties it."""

    def __init__(self, facts: Facts, kept: dict[str, Any] | None = None) -> None:
        self.out: list[Action] = []
        self.pose: Pose | None = None
        self.battery: float | None = None
        self._facts = facts
        self._tasks: list[Task] = []
        self._pauses: list[str] = []
        self._stop = Stop(False)
        self._fence = 0
        self._goal: Go | None = None
        self._number = 0
        self._failures = 0
        kept = kept or {}
        self.load: dict[str, int] = {str(k): int(v) for k, v in kept.get("load", {}).items()}
        self._answers = Answers(Ack(*answer) for answer in kept.get("answers", []))

    def keep(self) -> dict[str, Any]:
        """Return what has to outlive a restart: the load, and the answers that are to be repeated."""
        return {"load": self.load, "answers": [list(ack) for ack in self._answers.over()]}

    def look(self) -> dict[str, Any]:
        """Return the state for `up/state`, without boot and seq."""
        load = ",".join(f"{name}:{count}" for name, count in sorted(self.load.items()))
        props: dict[str, Any] = {"load": load} if self._facts.capacity else {}
        if self.battery is not None:
            props["battery"] = round(self.battery)
        state: dict[str, Any] = {"done": not self._tasks, "cmd": self._tasks[0].command if self._tasks else ""}
        if self.pose is not None:
            x, y, theta = self.pose
            state["loc"] = [round(x, 3), round(y, 3), 0.0, round(theta, 3)]
        return {**state, "props": props}

    def command(self, told: Told, now_s: float) -> None:
        """Take in a command; one that is known is answered again, and none that a stop has overtaken."""
        if not self._is_current(told):
            return
        known = self._answers.find(told.command)
        if known is not None:
            self.out.append(known)
        elif told.method in CONTROLS:
            self._control(told)
        else:
            task = self._read(told)
            if isinstance(task, str):
                self._say(told.command, "REJECTED", task)
            else:
                self._tasks.append(task)
                self._say(task.command, "ACCEPTED")
        self.settle(now_s)

    def hold(self, stop: Stop, now_s: float) -> None:
        """Take in the site's stop; one that is older than the last is left out."""
        if stop.fence is not None and stop.fence < (self._stop.fence or 0):
            return
        self._stop = Stop(stop.active, self._stop.fence if stop.fence is None else stop.fence)
        self._fence = max(self._fence, self._stop.fence or 0)
        self.settle(now_s)

    def _is_current(self, told: Told) -> bool:
        """Tell whether a command is to be heard.

        One from before a stop is not, nor one that is newer than the stop that holds the robot: the reset is on its
        way. The server sends again what still holds.
        """
        if told.fence is None:
            return True
        if told.fence < self._fence:
            return False
        self._fence = told.fence
        return told.method in CONTROLS or not self._stop.active or told.fence <= (self._stop.fence or 0)

    def moved(self, pose: Pose, now_s: float) -> None:
        """Take in where the robot is."""
        self.pose = pose
        self.settle(now_s)

    def reached(self, number: int, now_s: float) -> None:
        """Take in that a goal was reached; results of goals that were replaced are ignored."""
        if self._goal is not None and self._goal.number == number:
            self._goal = None
            self._pass_point()
            self.settle(now_s)

    def failed(self, number: int, why: str, now_s: float) -> None:
        """Take in that the navigation gave a goal up; it is tried once more before the command fails."""
        if self._goal is None or self._goal.number != number:
            return
        self._goal = None
        self._failures += 1
        if self._failures >= TRIES:
            self._end(self._tasks[0], "FAILED", why)
            self._end_moves("The way before it failed.")
        self.settle(now_s)

    def settle(self, now_s: float) -> None:
        """Do what is due."""
        if self._is_frozen():
            self._halt()
            return
        while self._tasks:
            head = self._tasks[0]
            if self._answers.find(head.command) == Ack(head.command, "ACCEPTED"):
                self._say(head.command, "RUNNING")
            if head.points:
                if not self._drive():
                    return
            elif not self._handle(head, now_s):
                return
        self._halt()

    def _is_frozen(self) -> bool:
        ids = [task.command for task in self._tasks]
        return self._stop.active or any(not kept or kept in ids for kept in self._pauses)

    def _halt(self) -> None:
        if self._goal is not None:
            self._goal = None
            self.out.append(Halt())

    def _drive(self) -> bool:
        """Send the robot to the next point of its way; True when it has passed one."""
        way = self._way()
        target = way[0]
        if self.pose is not None and len(way) > 1 and self._away_m(target) <= PASS_M:
            self._goal = None
            self._pass_point()
            return True
        if self._goal is None or (self._goal.x, self._goal.y) != target:
            head = self._tasks[0]
            self._number += 1
            self._goal = Go(self._number, target[0], target[1], self._heading(way), head.speed_m_s)
            self.out.append(self._goal)
        return False

    def _way(self) -> list[tuple[float, float]]:
        """Return the points that are left of the moves at the head of the queue."""
        way: list[tuple[float, float]] = []
        for task in self._tasks:
            if not task.points:
                break
            way += task.points
        return way

    def _heading(self, way: list[tuple[float, float]]) -> float:
        head = self._tasks[0]
        if len(head.points) == 1 and head.theta is not None:
            return head.theta
        begin, end = (way[0], way[1]) if len(way) > 1 else (self.pose[:2] if self.pose else way[0], way[0])
        return atan2(end[1] - begin[1], end[0] - begin[0])

    def _away_m(self, point: tuple[float, float]) -> float:
        assert self.pose is not None
        return hypot(point[0] - self.pose[0], point[1] - self.pose[1])

    def _pass_point(self) -> None:
        self._failures = 0
        head = self._tasks[0]
        head.points.pop(0)
        if not head.points:
            self._end(head, "DONE")

    def _handle(self, task: Task, now_s: float) -> bool:
        """Let the time of a pick or drop pass, then count the load; True when it is done."""
        self._halt()
        if task.until_s is None:
            task.until_s = now_s + self._facts.handling_s
        if now_s < task.until_s:
            return False
        name, count = task.goods
        why = self._refusal_of_goods(task.method, name, count)
        if not why:
            change = count if task.method == "pick" else -count
            self.load[name] = self.load.get(name, 0) + change
            self.load = {kept: n for kept, n in self.load.items() if n > 0}
        self._end(task, "FAILED" if why else "DONE", why)
        return True

    def _read(self, told: Told) -> Task | str:
        if self._stop.active:
            return "The site is stopped."
        if told.method == "move":
            return self._read_move(told)
        if told.method in ("pick", "drop") and self._facts.capacity:
            name, count = told.arguments.get("object"), told.arguments.get("value", 1)
            if not isinstance(name, str) or not 0 < len(name) <= 64:
                return "An object must be named."
            if not is_number(count) or count != int(count) or count < 1:
                return "The quantity must be a whole number of at least 1."
            why = "" if self._tasks else self._refusal_of_goods(told.method, name, int(count))
            return why or Task(told.command, told.method, goods=(name, int(count)))
        return f"{self._facts.name} cannot {told.method}."

    def _read_move(self, told: Told) -> Task | str:
        points, theta, speed = read_path(told.arguments.get("path")), told.arguments.get("theta"), None
        if points is None:
            return "move needs a path: a list of 1 to 200 points [x, y] in metres."
        if theta is not None and not is_number(theta):
            return "theta must be a number in radians."
        if told.arguments.get("speed") is not None:
            speed = told.arguments["speed"]
            if not is_number(speed) or speed <= 0:
                return "speed must be a number above 0, in metres a second."
            if speed < self._facts.speed_m_s and not self._facts.limits_speed:
                return f"{self._facts.name} cannot be told to drive slower than {self._facts.speed_m_s:g} m/s."
        why = self._strays(told.arguments.get("from"))
        return why or Task(told.command, "move", points, theta, speed)

    def _strays(self, begin: object) -> str:
        """Return why a way that begins elsewhere is not driven: to get there straight on may lead through walls."""
        if self.pose is None:
            return f"{self._facts.name} does not know where it is."
        if begin is None:
            return ""
        at = read_path([begin])
        if at is None:
            return "from must be a point [x, y] in metres."
        ends = [task.points[-1] for task in self._tasks if task.points]
        here = ends[-1] if ends else self.pose[:2]
        away_m = hypot(at[0][0] - here[0], at[0][1] - here[1])
        return f"The way begins {away_m:.1f} m from where {self._facts.name} will be." if away_m > ASTRAY_M else ""

    def _refusal_of_goods(self, method: str, name: str, count: int) -> str:
        carried = sum(self.load.values())
        if method == "pick" and carried + count > self._facts.capacity:
            return f"{self._facts.name} carries {carried} and has room for {self._facts.capacity}."
        if method == "drop" and self.load.get(name, 0) < count:
            return f"{self._facts.name} carries {self.load.get(name, 0)} {name}, not {count}."
        return ""

    def _control(self, told: Told) -> None:
        named = told.arguments.get("command")
        target = named if isinstance(named, str) else ""
        if told.method == "cancel":
            self._cancel(target)
        elif told.method == "pause":
            self._pauses = [*self._pauses, target][-REMEMBERED:]
        else:
            self._pauses = [kept for kept in self._pauses if target not in ("", kept)]
        self._say(told.command, "DONE")

    def _cancel(self, target: str) -> None:
        """End a command, or all; a move takes the moves behind it along."""
        ids = [task.command for task in self._tasks]
        if target and target not in ids:
            if self._answers.find(target) is None:
                # It may still be on its way here, and must not be carried out when it comes.
                self._say(target, "CANCELED", "It was cancelled before it arrived.")
            return
        at = ids.index(target) if target else 0
        is_move = bool(self._tasks) and bool(self._tasks[at].points)
        for task in self._tasks[at:]:
            if not target or task.command == target or (is_move and task.points):
                self._end(task, "CANCELED", f"{task.method} was cancelled.")

    def _end_moves(self, why: str) -> None:
        for task in [t for t in self._tasks if t.points]:
            self._end(task, "CANCELED", why)

    def _end(self, task: Task, status: str, why: str = "") -> None:
        if task is self._tasks[0]:
            self._failures = 0  # they are of the move under way, which takes them along: the next is tried twice, too
        self._tasks.remove(task)
        self._say(task.command, status, why)

    def _say(self, command: str, status: str, why: str = "") -> None:
        ack = Ack(command, status, why[:MAX_WHY])
        self._answers.note(ack)
        self.out.append(ack)
