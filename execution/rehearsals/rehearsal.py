"""A rehearsal: run machine, floor and a simulated world in lockstep, in virtual time.

See `execution.rehearsals.child_process` for the process of its own that physics wants.
"""

from __future__ import annotations

import heapq
from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass, field, replace
from typing import Any, Protocol, assert_never

from editor.language.expressions.nodes import AnswerSpec
from editor.language.plan.instructions import Plan
from editor.language.site.surroundings import PlaceFacts, ZoneFacts
from execution.floor_protocol import AskingRun, to_floor, to_machine, to_run
from execution.machine import machine
from execution.machine import messages as r
from execution.machine.at_once import EndsAtOnce
from execution.machine.needs import Facts, clock_fact, needs_of, position_facts
from execution.machine.turn import YIELD_S
from execution.rehearsals.open_commands import OpenCommands
from execution.rehearsals.progress import Progress, has_known_end
from execution.rehearsals.recorder import Recorder
from execution.traffic import floor
from execution.traffic import messages as m
from execution.traffic.admissions import zone_awaited
from execution.traffic.layout import Layout, make_layout
from simulation.services import DriverName, make_world
from simulation.world import Ack, PropertyChanged, Scene, WorldEvent
from vipo_device.protocol.description import Scalar

NAMESPACE = "6f1d7a52-6a0c-4d4e-9a5f-0d6b8f3f7c11"
"""Rehearsals name their commands from this, so that the same input gives the same bytes."""
RUN = "rehearsal"
DRIVING_S = 0.05
THINKING_S = 0.1
"""How often traffic looks at poses while robots drive."""
RESTING_S = 0.5
LIMIT_S = 4 * 3600.0
ACTION_LIMIT = 200_000
DAY_BEGINS_S = 8 * 3600.0
"""A rehearsal begins at eight in the morning."""
REPLY_S = 1.0
"""How long a question is open before the rehearsal answers it."""
LOOK_ROUND_S = 1.0
"""How often a program is told the time and where robots are, if it asks for them."""
Follow = Callable[[Progress], float | None]
"""Told at every step how far a rehearsal is; answers with the seconds that it was given, once they are over."""


class Observer(Protocol):
    """Whoever wants to know of a rehearsal what its record does not have; it changes nothing."""

    def carried(self, thread: int, at: int, to: int) -> None:
        """Take in an instruction that was carried out, and where its thread goes on."""

    def did(self, action: r.Action) -> None:
        """Take in what the run does."""

    def ended(self, stocks: Mapping[str, Mapping[str, int]]) -> None:
        """Take in what each machine holds at the end."""


@dataclass(frozen=True, slots=True)
class Conditions:
    """How a rehearsal is done: the driver of the robots, the program's parameters, and the longest it may take (s).

    `observer` is told what the record does not have. `bodies` is where real robots stand that are simulated for a while
    (`Layout.bodies`).
    """

    driver: DriverName = "physics"
    parameters: Mapping[str, Scalar] = field(default_factory=dict)
    limit_s: float = LIMIT_S
    observer: Observer | None = None
    bodies: tuple[m.FloorZone, ...] = ()


def rehearse(
    plan: Plan,
    scene: Scene,
    *,
    places: Iterable[PlaceFacts] = (),
    zones: Iterable[ZoneFacts] = (),
    conditions: Conditions | None = None,
    follow: Follow | None = None,
) -> dict[str, Any]:
    """Carry the plan out in a world made from the scene; returns the result (`RehearsalResultShape`).

    `zones` are those of the site's floor, besides the program's own. The scene's seed decides all chance. What goes
    wrong is in `errors`; a program that does not end is stopped after `conditions.limit_s` of virtual time, or when
    `follow` says that its time is over.
    """
    conditions = conditions or Conditions()
    world = make_world(scene=scene, driver=conditions.driver)
    try:
        standing = [replace(d, pose=scene.poses.get(d.id, d.pose)) for d in scene.devices]
        layout = replace(make_layout(scene.grid, standing, places, m.site_zones(zones)), bodies=conditions.bodies)
        commands = OpenCommands(world, scene.faults, scene.idless)
        return _Rehearsal(plan, layout, commands, conditions, follow).run()
    finally:
        world.close()


class _Rehearsal:
    """One rehearsal under way."""

    def __init__(
        self, plan: Plan, layout: Layout, commands: OpenCommands, conditions: Conditions, follow: Follow | None
    ) -> None:
        self.observer = observer = conditions.observer
        self.watch = None if observer is None else observer.carried
        self.plan, self.layout, self.commands = plan, layout, commands
        self.world = world = commands.world
        self.limit_s, self.parameters = conditions.limit_s, conditions.parameters
        self.recorder = Recorder(layout, world.readings())
        self.needs = needs_of(plan)
        self.asking = AskingRun(RUN, "this rehearsal", plan.roles, m.floor_zones(RUN, plan.zones))
        self.looked_at = 0.0
        self.replies: list[tuple[float, r.Answered]] = []
        self.admissions: dict[str, tuple[float, m.RobotLetIn]] = {}
        """By robot: when somebody lets it into a zone, who would be asked in a run."""
        self.asked: set[int] = set()
        """The tasks that were asked for at this moment; what ends of them at once too often rests."""
        self.at_once = EndsAtOnce()
        self.resting: list[tuple[float, r.Event]] = []
        self.floor = floor.start(layout, NAMESPACE)
        self.run_events: list[r.Event] = []
        self.floor_events: list[m.Event] = []
        self.timers: list[tuple[float, int]] = []
        self.dropped_timers: set[int] = set()
        self.finished: r.Finished | None = None
        self.actions = 0
        self.follow = follow or (lambda progress: None)
        self.end_known = has_known_end(plan)
        self.steps = {instruction.step for instruction in plan.instructions if instruction.step} or {""}
        self.left: set[str] = set()

    def run(self) -> dict[str, Any]:
        facts: Facts = {(d, n): v for d, values in self.world.readings().items() for n, v in values.items()}
        facts |= self._stations() | self._surroundings()
        for event in self.world.advance(0.0):  # faults that are there from the first moment on
            self.recorder.note_world(event)
        self._report_standing()
        self.state, actions = machine.start(self.plan, self.parameters, facts, watch=self.watch)
        self._do_run(actions)
        self._settle()
        self.recorder.look(0.0, 0.0, self.world.robots(), self.world.busy())
        thought_at = 0.0
        while self.finished is None:
            happened = self._advance()
            now = self.world.time_s
            if happened or now - thought_at >= THINKING_S - 1e-9:
                self._report_poses()
                self._settle()
                thought_at = now
            self._check_limits(now)
        if self.observer is not None:
            self.observer.ended(self.world.stocks())
        return self.recorder.result(self.world.time_s, ok=self.finished.status == "finished")

    def _advance(self) -> bool:
        """Let time pass as far as nothing is missed by it; tell whether something happened."""
        now = self.world.time_s
        driving = any(sent.device in self.floor.robots for sent in self.floor.sent.values())
        dt_s = DRIVING_S if driving else RESTING_S
        if self.timers:
            dt_s = min(dt_s, max(DRIVING_S, self.timers[0][0] - now))
        events = self.world.advance(dt_s)
        self.recorder.look(self.world.time_s, dt_s, self.world.robots(), self.world.busy())
        happened = [self._take(event) for event in events]
        self.commands.send_due()
        if self.world.time_s - self.looked_at >= LOOK_ROUND_S - 1e-9:
            self.looked_at = self.world.time_s
            happened.append(self._look_round())
        happened.append(self._end_rests())
        happened += [self._reply() for due_s, _ in list(self.replies) if due_s <= self.world.time_s + 1e-9]
        happened += [self._let_in(robot) for robot, (due_s, _) in list(self.admissions.items()) if due_s <= now]
        while self.timers and self.timers[0][0] <= self.world.time_s + 1e-9:
            _, timer = heapq.heappop(self.timers)
            if timer not in self.dropped_timers:
                self.run_events.append(r.TimerFired(timer))
                happened.append(True)
        return any(happened)

    def _take(self, event: WorldEvent) -> bool:
        self.recorder.note_world(event)
        match event:
            case Ack(command=command, status=status, why=why, result=result):
                self.commands.answered(event)
                self.floor_events.append(m.CommandAnswered(command, status, why, result))
                return True
            case PropertyChanged(device=device, name=name, value=value) if name in self.needs.properties:
                self.run_events.append(r.Facts({(device, name): value}))
                return True
        return False

    def _reply(self) -> bool:
        self.run_events.append(self.replies.pop(0)[1])
        return True

    def _let_in(self, robot: str) -> bool:
        _, admission = self.admissions.pop(robot)
        zone = zone_awaited(self.layout, self.floor, robot)
        if zone is not None:
            self.recorder.note_admission(self.world.time_s, robot, zone.name)
            self.floor_events.append(admission)
        return zone is not None

    def _stations(self) -> Facts:
        """Return where machines and places are, which never changes."""
        devices = ((d.id, d.pose.x, d.pose.y) for d in self.layout.devices.values())
        places = ((spot.id, spot.x, spot.y) for spot in self.layout.places.values())
        return position_facts((*devices, *places)) if self.needs.positions else {}

    def _surroundings(self) -> Facts:
        """Return the time of day and where robots are, as far as the program asks for them."""
        facts: Facts = clock_fact(DAY_BEGINS_S + self.world.time_s) if self.needs.clock else {}
        if self.needs.positions:
            facts |= position_facts((name, r.pose.x, r.pose.y) for name, r in self.world.robots().items())
        return facts

    def _look_round(self) -> bool:
        news = {key: value for key, value in self._surroundings().items() if self.state.facts.get(key) != value}
        if news:
            self.run_events.append(r.Facts(news))
        return bool(news)

    def _report_standing(self) -> None:
        """Report where the robots are, as in a run: physics has already pushed off the wall who stands too near."""
        for name in self.world.robots():
            pose = self.layout.devices[name].pose
            self.floor_events.append(m.RobotMoved(name, pose.x, pose.y, pose.theta))

    def _report_poses(self) -> None:
        for name, robot in self.world.robots().items():
            self.floor_events.append(m.RobotMoved(name, robot.pose.x, robot.pose.y, robot.pose.theta))

    def _settle(self) -> None:
        """Hand events to and fro between the run and the floor until both are content."""
        self.asked.clear()
        self._step_floor()
        while self.run_events and self.finished is None:
            events, self.run_events = self.run_events, []
            for event in events:
                self.state, actions = machine.step(self.plan, self.state, event, self.watch)
                self._do_run(actions)
            if self.floor_events:
                self._step_floor()

    def _step_floor(self) -> None:
        events, self.floor_events = [*self._reports(), *self.floor_events], []
        now = self.world.time_s
        self.floor, actions = floor.step(self.layout, self.floor, events, now)
        for robot, zone in self.floor.awaiting.items():
            self.admissions.setdefault(robot, (now + REPLY_S, m.RobotLetIn(zone, robot)))
        for action in actions:
            self.recorder.note_floor(now, action)
            if isinstance(action, m.SendCommand):
                self.commands.send(action)
            told = to_run(action)
            event = to_machine(told[1]) if told else None
            if event is not None and not self._rests(event):
                self.run_events.append(event)

    def _rests(self, event: r.Event) -> bool:
        """Put off the end of a task that has ended at once, once too often, as in a run."""
        is_end = isinstance(event, r.TaskDone | r.TaskFailed) and event.task in self.asked
        if not is_end or not self.at_once.is_too_often(RUN, self.world.time_s):
            return False
        self.resting.append((self.world.time_s + YIELD_S, event))
        return True

    def _end_rests(self) -> bool:
        """Tell the run what has rested long enough."""
        due = [event for due_s, event in self.resting if due_s <= self.world.time_s + 1e-9]
        self.resting = self.resting[len(due) :]
        self.run_events += due
        return bool(due)

    def _reports(self) -> list[m.Event]:
        """Return what robots and doors report, where some are chosen by it or pass a door."""
        chosen = any(role.where is not None for role in self.plan.roles.values())
        passed = any(zone.rule == "door" for zone in self.plan.zones)
        return [m.RobotsReport(self.world.readings())] if chosen or passed else []

    def _do_run(self, actions: tuple[r.Action, ...]) -> None:
        now = self.world.time_s
        self.actions += len(actions)
        for action in actions:
            self.recorder.note_run(now, action)
            self._tell_of(action)
            match action:
                case r.Ask() | r.Cancel():
                    self.floor_events.append(to_floor(self.asking, action))
                    self.asked |= {action.task} if isinstance(action, r.Ask) else set()
                case r.SetTimer(timer=timer, seconds=seconds):
                    heapq.heappush(self.timers, (now + seconds, timer))
                case r.CancelTimer(timer=timer):
                    self.dropped_timers.add(timer)
                case r.AskPeople(question=question, answer=spec, step=step):
                    answer = simulated_answer(spec)
                    self.recorder.note_answer(now, step, answer)
                    self.replies.append((now + REPLY_S, r.Answered(question, answer)))
                case r.Finished():
                    self._finish(now, action)
                case r.Tell() | r.CancelQuestion() | r.StepEntered() | r.StepLeft() | r.StepFailed():
                    pass  # the record has it
                case _:
                    assert_never(action)

    def _tell_of(self, action: r.Action) -> None:
        """Tell the world of steps that begin, and who watches of all that the run does."""
        if isinstance(action, r.StepEntered):
            self.world.reach(action.step)
        elif isinstance(action, r.StepLeft):
            self.left.add(action.step)
        if self.observer is not None:
            self.observer.did(action)

    def _finish(self, now: float, action: r.Finished) -> None:
        self.finished = action
        if action.status == "failed" and not self.recorder.errors:
            self.recorder.error(now, "", "failed", action.reason, "step_failed", why=action.reason)

    def _progress(self) -> Progress:
        steps = len(self.steps)
        return Progress(round(self.world.time_s, 2), self.recorder.step_now(), len(self.left), steps, self.end_known)

    def _check_limits(self, now: float) -> None:
        """Stop what would go on for ever."""
        given_s = self.follow(self._progress())
        if self.finished is not None:
            return
        if now >= self.limit_s:
            hours = round(self.limit_s / 3600, 3)
            self._give_up(now, f"after {hours:g} h of simulated time", "too_long", hours=hours)
        elif self.actions > ACTION_LIMIT:
            self._give_up(now, f"after {ACTION_LIMIT} actions", "too_much", actions=ACTION_LIMIT)
        elif given_s is not None:
            minutes, reached = round(given_s / 60, 1), clock_of(now)
            limit = f"after {minutes:g} min, at {reached} of simulated time"
            self._give_up(now, limit, "too_slow", minutes=minutes, reached=reached)

    def _give_up(self, now: float, limit: str, code: str, **args: Scalar) -> None:
        why = f"The program was stopped {limit}; it may never end."
        self.recorder.error(now, self.recorder.step_now(), "timed_out", why, code, **args)
        self.finished = r.Finished("failed", why)


def clock_of(seconds: float) -> str:
    """Return a duration as hours, minutes and seconds, such as 2:05:09."""
    whole = int(seconds)
    return f"{whole // 3600}:{whole // 60 % 60:02}:{whole % 60:02}"


def simulated_answer(spec: AnswerSpec) -> Scalar:
    """Return what a rehearsal answers by itself: yes, the first option, the least number or 1, no text."""
    match spec.type:
        case "boolean":
            return True
        case "choice":
            return spec.options[0] if spec.options else ""
        case "number":
            least = 1.0 if spec.minimum is None else spec.minimum
            return least if spec.maximum is None else min(least, spec.maximum)
    return ""
