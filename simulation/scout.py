"""A simulated robot that maps a floor which nobody has given it, when it is told to `explore`, and drives on it then.

It is a device of its own, in a process of its own, and says nothing that a real robot could not: it joins, waits to be
approved, tells where it believes to be, and sends what it has seen on `up/map` while it explores. Moves are driven by
where it believes to be: its wheels slip, and its lidar tells it how far they did.
"""

from __future__ import annotations

import logging
import threading
import time
from collections.abc import Callable, Mapping, Sequence
from contextlib import suppress
from dataclasses import dataclass, replace
from pathlib import Path
from queue import Empty, SimpleQueue

from registry.floorplan.map_message import write_grid
from simulation.actors import InitialState, Motion
from simulation.actors.actor import Emit
from simulation.actors.robot import Robot, Surroundings
from simulation.mapping.survey import TICK_S, Expedition, NoRoom, SurveyPlan
from simulation.site_facts import DescribedDevice, SiteUnread
from simulation.twin_memory import TwinMemory, read_memory, write_memory
from simulation.virtual_device import Appearance, VirtualDevice
from simulation.world import Ack, Obstacle, WorldEvent
from vipo_device.descriptions.reader import write_description
from vipo_device.kit.connection import (
    CommandReceived,
    ConnectionEvent,
    ConnectionMaker,
    IntroductionDue,
    StopChanged,
    leave,
)
from vipo_device.protocol.description import Description, MethodSpec, ParameterSpec, Pose, Size
from vipo_device.protocol.messages import EXPLORE, AckMessage, down_topic

log = logging.getLogger(__name__)
LOOP_S = 0.05
SLICE_S = 1.0
SEND_EVERY_S = 10.0
SAVE_EVERY_S = 1.0
LOOK_EVERY_S = 1.0


@dataclass(frozen=True, slots=True)
class ScoutPlan:
    """Who maps which floor at which site, how many times faster than real, and which start of it this is."""

    device: str
    name: str
    site: str
    survey: SurveyPlan
    speed: float = 1.0
    boot: int = 1
    memory_path: Path | None = None
    """Where it is kept over a restart where the robot stands and what it has answered; None keeps nothing."""
    obstacles: Callable[[], Sequence[Obstacle]] = tuple
    """What people have put on the floor; may raise SiteUnread."""


def describe_scout(plan: ScoutPlan, start: Pose) -> Description:
    """Return how the robot describes itself."""
    robot = plan.survey.robot
    return Description(
        id=plan.device,
        name=plan.name,
        kind="robot",
        device_class="turtlebot",
        pose=start,
        size=Size(2 * robot.radius_m, 2 * robot.radius_m, 0.2),
        description="Maps a floor with its lidar, and drives on it.",
        site=plan.site,
        simulated=True,
        radius_m=robot.radius_m,
        speed_m_s=robot.speed_m_s,
        methods=(
            MethodSpec(
                "move", down_topic(plan.device, "move"), "location", "Move", (ParameterSpec("path", "location"),)
            ),
            MethodSpec(EXPLORE, down_topic(plan.device, EXPLORE), "signal", "Explore"),
        ),
    )


class ScoutActor(Robot):
    """What the robot does with commands: it explores, or drives where it is told to on the map that it has made.

    Exploring that was cancelled or has failed goes on with its map; after one that is done it begins a new one.
    """

    def __init__(
        self, description: Description, emit: Emit, survey: SurveyPlan, remembered: Sequence[Ack] = ()
    ) -> None:
        answers = tuple(AckMessage(ack.command, ack.status, ack.why, ack.result) for ack in remembered)
        grid = survey.grid
        left, low = grid.origin_x_m, grid.origin_y_m
        bounds = (left, low, left + grid.width * grid.resolution_m, low + grid.height * grid.resolution_m)
        super().__init__(description, emit, InitialState(remembered=answers), Surroundings({}, bounds))
        self._plan = replace(survey, start=survey.start or description.pose)
        self.expedition = Expedition(self._plan)
        self._exploring = ""
        self._obstacles: Sequence[Obstacle] = ()

    @property
    def explores(self) -> bool:
        """True while the robot drives where it likes."""
        return bool(self._exploring)

    @property
    def busy(self) -> bool:
        """True while the robot explores, or has been told to drive."""
        return self.explores or super().busy

    def _take_on(self, t_s: float, method: str, arguments: Mapping[str, object], command: str) -> str:
        if self.explores:
            already = " already" if method == EXPLORE else ""
            return f"{self.description.name} explores{already}. Wait until it is done, or cancel that."
        if method != EXPLORE:
            self.stands_at(self._motion())
            return super()._take_on(t_s, method, arguments, command)
        if self.busy:
            return f"{self.description.name} drives. Wait until it stands, or cancel that."
        if not self.expedition.go_on():
            self._begin_anew()
        self._exploring = command
        self._say(t_s, AckMessage(command, "ACCEPTED"))
        self._say(t_s, AckMessage(command, "RUNNING"))
        return ""

    def _begin_anew(self) -> None:
        """Make a new map in the old one's coordinates: a heading that is off by a degree would turn all of it."""
        believed = self.expedition.look_round()
        self._plan = replace(self._plan, seed=self._plan.seed + 1, start=self.expedition.pose)
        self.expedition = Expedition(self._plan, believed)
        self.expedition.put_in_the_way(self._obstacles)

    def put_in_the_way(self, obstacles: Sequence[Obstacle]) -> None:
        """Let things stand on the floor, in place of those that stood there."""
        self._obstacles = tuple(obstacles)
        self.expedition.put_in_the_way(self._obstacles)

    def _cancel(self, t_s: float, command: str) -> None:
        if not self.explores:
            super()._cancel(t_s, command)
        elif command in {"", self._exploring}:
            ended, self._exploring = self._exploring, ""
            self._say(t_s, AckMessage(ended, "CANCELED", "The robot stands where it is, and keeps its map."))

    def advance(self, t_s: float) -> None:
        """Let a tick pass at `t_s`."""
        if not self.explores:
            self._be_steered(t_s)
        elif not self.frozen:
            self.expedition.tick()
            if self.expedition.is_over:
                ended, self._exploring = self._exploring, ""
                self._say_over(t_s, ended)

    def _say_over(self, t_s: float, command: str) -> None:
        """Answer DONE for a map that is whole, and FAILED with what to do for another one."""
        name, maker = self.description.name, self.expedition.maker
        if maker.is_whole:
            self._say_done(t_s, command)
        elif maker.is_barred:
            why = f"{name} did not get through a narrow place behind which there is more to see. Drive it out of there"
            self._say(t_s, AckMessage(command, "FAILED", f"{why}, or make room, and let it explore again."))
        else:
            why = f"The time was over before {name} had seen all that it can reach. Drive it to what is left"
            self._say(t_s, AckMessage(command, "FAILED", f"{why}, and let it explore again."))

    def _be_steered(self, t_s: float) -> None:
        """Drive along what was released, by where the robot believes to be."""
        if self.resting:
            return
        expedition = self.expedition
        expedition.drive(*self.control(self._motion(), t_s, TICK_S))
        self.stands_before = "something stands in its way" if expedition.stands_before else ""

    def _motion(self) -> Motion:
        """Return where the robot believes to be."""
        believed = self.expedition.maker.pose
        return Motion(believed.x, believed.y, believed.theta)


class Scout:
    """The robot and its connection. The thread that runs it owns it; the network's puts messages into a queue."""

    def __init__(self, plan: ScoutPlan, make_connection: ConnectionMaker) -> None:
        self._plan, self._make_connection = plan, make_connection
        start = plan.survey.start or Expedition(plan.survey).pose
        description = describe_scout(plan, start)
        self._events: list[WorldEvent] = []
        self._memory = TwinMemory() if plan.memory_path is None else read_memory(plan.memory_path)
        self._actor = self._make_actor(description, start)
        self._inbox: SimpleQueue[ConnectionEvent] = SimpleQueue()
        source = DescribedDevice(description, write_description(description).encode())
        self._device = VirtualDevice(source, plan.site, plan.boot, self._inbox.put)
        self._ticks = self._maps = self._sent_scans = 0
        self._repeats_map = self._explored = False
        self._due_s, self._sent_s, self._saved_s = 0.0, -SEND_EVERY_S, 0.0

    def _make_actor(self, description: Description, start: Pose) -> ScoutActor:
        """Let the robot stand where it stood, or at its start where the floor has become another one."""
        name, survey = self._plan.device, self._plan.survey
        stood, answered = self._memory.poses.get(name), self._memory.remembered.get(name, ())
        if stood is not None:
            try:
                return ScoutActor(description, self._events.append, replace(survey, start=stood), answered)
            except NoRoom as error:
                log.warning("%s It begins at its start.", error)
        return ScoutActor(description, self._events.append, replace(survey, start=start), answered)

    def run(self, stopping: threading.Event) -> None:
        """Live until `stopping` is set; then say that it goes offline."""
        self._device.connect(self._make_connection)
        try:
            now = time.monotonic()
            looked = now - LOOK_EVERY_S
            while not stopping.is_set():
                self._take_in()
                last, now = now, time.monotonic()
                if now - looked >= LOOK_EVERY_S:
                    looked = now
                    with suppress(SiteUnread):  # what stood there stays until the database is back
                        self._actor.put_in_the_way(self._plan.obstacles())
                self._pass_time(now - last)
                self._speak(now)
        finally:
            self._save()
            leave([self._device.connection])

    def _take_in(self) -> None:
        """Wait for a message for a moment, and carry out all that have come."""
        try:
            self._hear(self._inbox.get(timeout=LOOP_S))
            while True:
                self._hear(self._inbox.get_nowait())
        except Empty:
            return

    def _hear(self, message: ConnectionEvent) -> None:
        match message:
            case CommandReceived(command=command):
                self._actor.command(self._time_s, command.method, command.arguments, command.id)
            case IntroductionDue():
                self._device.introduce()
                self._repeats_map = self._maps > 0  # whoever listens now may not know it
            case StopChanged(active=active):
                self._actor.held = active

    @property
    def _time_s(self) -> float:
        return self._ticks * TICK_S

    def _pass_time(self, real_s: float) -> None:
        """Let as much virtual time pass as is due; what cannot be made up is left out."""
        self._due_s = min(self._due_s + real_s * self._plan.speed, SLICE_S)
        while self._due_s >= TICK_S:
            self._due_s -= TICK_S
            self._ticks += 1
            self._actor.advance(self._time_s)

    def _speak(self, now_s: float) -> None:
        """Send the map, say the state, then the answers: who hears that it is done must already have the map."""
        acks = [event for event in self._events if isinstance(event, Ack)]
        self._events.clear()
        is_over = any(ack.is_final for ack in acks)
        if is_over or now_s - self._saved_s >= SAVE_EVERY_S:
            self._saved_s = now_s
            self._save()  # before anybody hears of it: what was answered is not done again after a crash
        self._send_map(now_s, at_once=is_over and self._explored)
        self._explored = self._actor.explores
        pose = self._actor.expedition.maker.pose
        shown = Pose(round(pose.x, 3), round(pose.y, 3), 0.0, round(pose.theta, 3))
        self._device.report(Appearance(not self._actor.busy, shown, {}), now_s, at_once=is_over)
        for ack in acks:
            self._device.answer(ack)

    def _save(self) -> None:
        """Keep where the robot really stands, and its answers, if they are others than before."""
        name, actor = self._plan.device, self._actor
        answers = [Ack(0.0, name, a.command, a.status, a.why, a.result) for a in actor.ledger.over()]
        memory = TwinMemory(poses={name: actor.expedition.pose}, remembered={name: answers})
        if self._plan.memory_path is not None and memory != self._memory:
            self._memory = memory
            write_memory(self._plan.memory_path, memory)

    def _send_map(self, now_s: float, *, at_once: bool) -> None:
        """Send the map while it grows; one that a restart began anew, and that moves add to, is nobody's business."""
        maker = self._actor.expedition.maker
        grows = (self._actor.explores or at_once) and maker.matches not in {0, self._sent_scans}
        is_due = at_once or now_s - self._sent_s >= SEND_EVERY_S
        if not is_due or not (grows or self._repeats_map) or not self._device.is_introduced:
            return
        self._maps += 1
        self._repeats_map = False
        self._sent_s, self._sent_scans = now_s, maker.matches
        self._device.send_map(write_grid(maker.grid(), self._plan.boot, self._maps))
