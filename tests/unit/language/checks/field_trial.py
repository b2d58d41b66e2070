"""A right program is carried out by the real machine, with devices that do what they are asked and readings by chance.

The trial knows what every robot carries, and says where a run does what a right program does not.
"""

from __future__ import annotations

import random
from collections import Counter
from dataclasses import dataclass, field

from editor.language import Plan, Surroundings
from editor.language.expressions.nodes import AnswerSpec
from execution.machine import machine
from execution.machine import messages as m
from execution.machine.places import CLOCK, ROLE, X, Y
from vipo_device.protocol.description import Description, PropertySpec, Scalar

MOST_EVENTS = 400
DAY_S = 86_400
EARLY = 0.7
"""How often something else happens before a time is over."""
KINDS = ("refused", "failed", "timed_out", "offline", "blocked")
Wait = m.Ask | m.SetTimer | m.AskPeople


@dataclass
class Trial:
    """One run of a plan; `failing` is how often a way or a call of a machine fails, from 0 to 1."""

    plan: Plan
    site: Surroundings
    chance: random.Random
    failing: float = 0
    carried: dict[str, Counter[str]] = field(default_factory=dict)
    robots: dict[str, str] = field(default_factory=dict)
    """The robot that each role has."""
    news: dict[tuple[str, str], Scalar] = field(default_factory=dict)
    failed: set[str] = field(default_factory=set)
    """Why tasks have failed."""
    wrong: list[str] = field(default_factory=list)

    def run(self) -> tuple[str, str]:
        """Return how the run ended, as the machine says, and why."""
        state, actions = machine.start(self.plan, {}, self._readings(1), 0)
        waits: list[Wait] = []
        for _ in range(MOST_EVENTS):
            waits = self._open(waits, actions)
            if state.status != "running":
                break
            event = self._event(waits)
            if self.news:
                state, actions = machine.step(self.plan, state, m.Facts(dict(self.news)))
                waits = self._open(waits, actions)
                self.news.clear()
            state, actions = machine.step(self.plan, state, event)
        reason = next((each.reason for each in actions if isinstance(each, m.Finished)), "")
        if state.status == "finished":
            self.wrong += [f"{robot} ends with {dict(+held)}" for robot, held in self.carried.items() if +held]
        return state.status, reason

    def _open(self, waits: list[Wait], actions: tuple[m.Action, ...]) -> list[Wait]:
        """Return what is waited for; a task that is called off is as if it had not begun."""
        waits = waits + [each for each in actions if isinstance(each, m.Ask | m.SetTimer | m.AskPeople)]
        tasks = {each.task for each in actions if isinstance(each, m.Cancel)}
        timers = {each.timer for each in actions if isinstance(each, m.CancelTimer)}
        questions = {each.question for each in actions if isinstance(each, m.CancelQuestion)}
        return [
            each
            for each in waits
            if not (isinstance(each, m.Ask) and each.task in tasks)
            and not (isinstance(each, m.SetTimer) and each.timer in timers)
            and not (isinstance(each, m.AskPeople) and each.question in questions)
        ]

    def _event(self, waits: list[Wait]) -> m.Event:
        if not waits or self.chance.random() < 0.3:
            return m.Facts(self._readings(0.4))
        wait = self.chance.choice(waits)
        if isinstance(wait, m.SetTimer) and self.chance.random() < EARLY:
            return m.Facts(self._readings(0.4))
        waits.remove(wait)
        if isinstance(wait, m.SetTimer):
            return m.TimerFired(wait.timer)
        if isinstance(wait, m.AskPeople):
            return m.Answered(wait.question, self._answer(wait.answer))
        if wait.order.kind in {"move", "call", "perform"} and self.chance.random() < self.failing:
            kind = self.chance.choice(KINDS)
            self.failed.add(f"It is {kind}.")
            return m.TaskFailed(wait.task, kind, f"It is {kind}.")
        self._carry_out(wait)
        return m.TaskDone(wait.task)

    def _answer(self, answer: AnswerSpec) -> Scalar:
        least = 0 if answer.minimum is None else answer.minimum
        most = least + 20 if answer.maximum is None else answer.maximum
        match answer.type:
            case "number":
                return min(max(least, round(self.chance.uniform(least, most))), most)
            case "choice":
                return self.chance.choice(answer.options)
            case "text":
                return self.chance.choice(["red", "4711", "Ada"])
        return self.chance.random() < 0.5

    def _readings(self, share: float) -> dict[tuple[str, str], Scalar]:
        """Return new readings of about this share of all properties, and the time of the day."""
        found: dict[tuple[str, str], Scalar] = {(CLOCK, "now"): self.chance.randrange(DAY_S)}
        for key, facts in self.site.devices.items():
            for each in facts.description.properties:
                if self.chance.random() < share:
                    found[key, each.name] = self._reading(each)
            if share == 1:
                found |= {(key, X): facts.description.pose.x, (key, Y): facts.description.pose.y}
            elif facts.description.kind == "robot" and key not in self.robots.values():  # others drive it
                place = self.chance.choice(list(self.site.places.values()))
                found |= {(key, X): place.x, (key, Y): place.y}
        found |= {(key, X): place.x for key, place in self.site.places.items()}
        return found | {(key, Y): place.y for key, place in self.site.places.items()}

    def _reading(self, told: PropertySpec) -> Scalar:
        if told.type == "number":
            least, most = told.minimum or 0, told.maximum or 0
            value = self.chance.choice([least, most, self.chance.uniform(least, most)])
            return value if told.unit not in {"", "NUM"} else round(value)
        return self.chance.choice(told.options) if told.options else told.type != "text" and self.chance.random() < 0.5

    def _carry_out(self, ask: m.Ask) -> None:
        order = ask.order
        robot = self._robot(order.role) if order.role else None
        if order.kind in {"call", "perform"}:
            doer = robot if order.kind == "perform" else self.site.devices[order.target.id].description
            self._call(doer, order.method, order.arguments)
        if robot is None:
            return
        held = self.carried.setdefault(robot.id, Counter())
        if order.kind in {"pick", "drop"}:
            held[order.object] += round(order.quantity) * (1 if order.kind == "pick" else -1)
            if order.quantity < 1 or held[order.object] < 0 or held.total() > robot.capacity:
                self.wrong.append(f"{order.step}: {order.kind} of {order.quantity} leaves {dict(held)}")
        elif order.kind == "release":
            if +held:
                self.wrong.append(f"{order.step}: released with {dict(+held)}")
            self.robots.pop(order.role, None)
        elif order.kind == "move":
            x, y = order.target.point or self._place(order.target.id)
            self.news |= {(robot.id, X): x, (robot.id, Y): y}

    def _place(self, name: str) -> tuple[float, float]:
        place = self.site.places.get(name)
        pose = self.site.devices[name].description.pose if place is None else place
        return (pose.x, pose.y)

    def _robot(self, role: str) -> Description:
        """Return the robot of a role, which it gets if it has none: one that can what the role asks for."""
        if role not in self.robots:
            wanted = self.plan.roles[role]
            free = [
                facts.description
                for key, facts in sorted(self.site.devices.items())
                if (key == wanted.device if wanted.device else key not in self.robots.values())
                and facts.description.kind == "robot"
                and all(facts.description.method(each) for each in wanted.can)
            ]
            self.robots[role] = self.chance.choice(free).id
            self.news[ROLE, role] = self.robots[role]
        return self.site.devices[self.robots[role]].description

    def _call(self, doer: Description | None, name: str, arguments: object) -> None:
        offered = None if doer is None else doer.method(name)
        given = arguments if isinstance(arguments, dict) else {}
        if offered is None or set(given) != {each.name for each in offered.parameters}:
            self.wrong.append(f"{doer and doer.id} cannot {name} with {given}")
            return
        for each in offered.parameters:
            value = given[each.name]
            if isinstance(value, int | float) and each.minimum is not None and each.maximum is not None:
                if not each.minimum - 1e-9 <= value <= each.maximum + 1e-9:
                    self.wrong.append(f"{name}: {each.name} is {value}")
            elif each.options and value not in each.options:
                self.wrong.append(f"{name}: {each.name} is {value}")
