"""The twin: a live simulated world whose devices speak MQTT as real ones do.

The main thread owns the world (physics wants one thread); network threads only put messages into a queue.
"""

from __future__ import annotations

import logging
import threading
import time
from collections.abc import Callable, Mapping, Sequence
from contextlib import suppress
from dataclasses import dataclass, field
from pathlib import Path
from queue import Empty, SimpleQueue

from registry.floorplan.plan import with_devices
from simulation.laser import Mapper
from simulation.services import DriverName, make_world
from simulation.site_facts import NothingToSimulate, SiteFacts, SiteUnread
from simulation.twin_memory import TwinMemory, read_memory, snapshot, write_memory
from simulation.virtual_device import Appearance, VirtualDevice, look_at
from simulation.world import DELIVERY_S, Ack, Obstacle, Scene, World
from vipo_device.kit.connection import (
    CommandReceived,
    ConnectionEvent,
    ConnectionMaker,
    IntroductionDue,
    StopChanged,
    leave,
)

log = logging.getLogger(__name__)
TICK_S = 0.05
RESTING_S = 0.2
SLICE_S = 0.25
"""More than `RESTING_S`: a world that rests must not fall behind, it would hurry through the next job."""
PATIENCE_S = 3.0
SAVE_EVERY_S = 3.0
REFRESH_EVERY_S = 5.0
LOOK_EVERY_S = 1.0
"""How often it is looked what people have put on the floor: a robot drives about a metre meanwhile."""
WARN_EVERY_S = 60.0


@dataclass(frozen=True, slots=True)
class TwinPlan:
    """Which site, which of its devices speak, which of them are pending yet, how fast, and where memory is kept.

    `paces` say by device and method how many times as long as it should something takes (a fault on purpose),
    `refresh` reads the site anew, `obstacles` what people have put on its floor (both may raise SiteUnread), `beat` is
    called each time that the twin's loop comes round.
    """

    facts: SiteFacts
    speaking: frozenset[str]
    memory_path: Path
    pending: frozenset[str] = frozenset()
    speed: float = 1.0
    driver: DriverName = "physics"
    paces: Mapping[str, Mapping[str, float]] = field(default_factory=dict)
    refresh: Callable[[], SiteFacts] | None = None
    obstacles: Callable[[], Sequence[Obstacle]] = tuple
    beat: Callable[[], None] = lambda: None


class Twin:
    """A site's simulated world and the virtual devices in it."""

    def __init__(self, plan: TwinPlan, make_connection: ConnectionMaker) -> None:
        self._plan, self._facts, self._make_connection = plan, plan.facts, make_connection
        self._inbox: SimpleQueue[ConnectionEvent] = SimpleQueue()
        self._memory = memory = read_memory(plan.memory_path)
        self._boots = {**memory.boots, **{name: memory.next_boot(name) for name in plan.speaking}}
        self._world: World = self._make_world(memory)
        self._obstacles: Sequence[Obstacle] = ()
        self._held = False
        self._devices = {
            d.description.id: VirtualDevice(d, plan.facts.slug, self._boots[d.description.id], self._inbox.put)
            for d in plan.facts.devices
            if d.description.id in plan.speaking
        }
        self._mappers: dict[str, Mapper] = {}
        self._mappers = self._make_mappers()
        self._lag_s = self._warned_s = 0.0
        self._saved_under_way: Mapping[str, object] = {}

    def run(self, stopping: threading.Event) -> None:
        """Live until `stopping` is set; then say that all go offline, and remember."""
        self._save()
        for device in self._devices.values():
            device.connect(self._make_connection)
        try:
            self._live(stopping)
        finally:
            self._save()
            leave(device.connection for device in self._devices.values())
            self._world.close()

    def _live(self, stopping: threading.Event) -> None:
        now = saved = refreshed = time.monotonic()
        looked = now - LOOK_EVERY_S
        while not stopping.is_set():
            self._plan.beat()
            messages = self._take_in()
            last, now = now, time.monotonic()
            if now - looked >= LOOK_EVERY_S:
                looked = now
                self._look_for_obstacles()
            self._pass_time(now - last, now)  # before what has come is begun: it takes its whole time from here on
            for message in messages:
                self._hear(message)
            if now - saved >= SAVE_EVERY_S or self._world.under_way() != self._saved_under_way:
                saved = now
                self._save()
            self._send_maps(now)
            if now - refreshed >= REFRESH_EVERY_S:
                refreshed = now
                self._refresh()

    def _take_in(self) -> list[ConnectionEvent]:
        """Wait for a message for a moment, and return all that have come."""
        resting = not any(self._world.busy().values())
        messages: list[ConnectionEvent] = []
        try:
            messages.append(self._inbox.get(timeout=RESTING_S if resting else TICK_S))
            while True:
                messages.append(self._inbox.get_nowait())
        except Empty:
            return messages

    def _hear(self, message: ConnectionEvent) -> None:
        match message:
            case CommandReceived(device=device, command=command):
                self._world.command(device, command.method, command.arguments, command.id)
            case IntroductionDue(device=device):
                self._devices[device].introduce()
                if device in self._mappers:
                    self._mappers[device].repeat()
            case StopChanged(active=active) if active != self._held:
                self._held = active
                self._world.hold(active=active)
                log.warning("The site's stop is %s.", "on: everything stands still" if active else "reset")

    def _pass_time(self, real_s: float, now_s: float) -> None:
        """Let as much virtual time pass as is due; what cannot be made up is left out, and the log says so."""
        speed = self._plan.speed
        self._lag_s += real_s * speed
        step = min(self._lag_s, SLICE_S * max(1.0, speed))
        events = self._world.advance(step)
        self._lag_s -= step
        if self._lag_s > PATIENCE_S * max(1.0, speed):
            self._warn_of_lag(now_s)
            self._lag_s = 0.0
        self._speak([e for e in events if isinstance(e, Ack)], now_s)

    def _warn_of_lag(self, now_s: float) -> None:
        """Say at most once a minute that time was left out, if anybody was busy and so has lost it."""
        if now_s - self._warned_s >= WARN_EVERY_S and any(self._world.busy().values()):
            self._warned_s = now_s
            log.warning(
                "The simulated world cannot keep up: it is %.1f s behind, and leaves them out. Lower the speed (%g).",
                self._lag_s / self._plan.speed,
                self._plan.speed,
            )

    def _speak(self, acks: list[Ack], now_s: float) -> None:
        """Say states, then answers: who hears that a command is done must already know what came of it."""
        begun = [ack for ack in acks if not ack.is_final]
        is_over = len(begun) < len(acks)
        if is_over:
            self._save()  # before anybody hears of it: what was answered is never done again after a crash
        for ack in begun:
            self._answer(ack)
        for name, seen in self._appearances().items():
            self._devices[name].report(seen, now_s, at_once=is_over)
        for ack in acks:
            if ack not in begun:
                self._answer(ack)

    def _answer(self, ack: Ack) -> None:
        device = self._devices.get(ack.device)
        if device is not None:
            device.answer(ack)

    def _send_maps(self, now_s: float) -> None:
        """Let each robot look round and send the map of what it has seen."""
        robots = self._world.robots()
        for name, mapper in self._mappers.items():
            if self._devices[name].is_introduced:
                self._devices[name].send_map(mapper.next_messages(robots[name].pose, now_s))

    def _make_mappers(self) -> dict[str, Mapper]:
        """Return a map-maker for each robot; to its laser, machines are obstacles like walls."""
        described = [device.description for device in self._facts.devices]
        floor = with_devices(self._facts.grid, described)
        robots = [d.id for d in described if d.kind == "robot" and d.id in self._devices]
        sent = {name: mapper.number for name, mapper in self._mappers.items()}
        return {name: Mapper(floor, self._boots[name], sent.get(name, 0)) for name in robots}

    def _appearances(self) -> dict[str, Appearance]:
        speaking = [d.description for d in self._facts.devices if d.description.id in self._devices]
        return look_at(self._world, speaking)

    def _look_for_obstacles(self) -> None:
        with suppress(SiteUnread):  # what stood there stays until the database is back
            self._obstacles = self._plan.obstacles()
        self._world.put_in_the_way(self._obstacles)

    def _refresh(self) -> None:
        """Take over a new map or machines that people moved, as soon as nobody is busy."""
        if self._plan.refresh is None or any(self._world.busy().values()):
            return
        try:
            facts = self._plan.refresh()
        except (NothingToSimulate, SiteUnread):  # all are taken out; the world stays as it is until one comes back
            return
        if facts == self._facts:
            return
        memory = self._remember()
        self._world.close()
        self._facts = facts
        self._world = self._make_world(memory)
        self._world.hold(active=self._held)
        self._mappers = self._make_mappers()
        log.info("The map or the place of a machine has changed; the simulated world was built anew.")

    def _make_world(self, memory: TwinMemory) -> World:
        scene = memory.put_into(make_scene(self._plan, self._facts))
        return make_world(scene=scene, driver=self._plan.driver)

    def _save(self) -> None:
        memory = self._remember()
        self._saved_under_way = self._world.under_way()
        write_memory(self._plan.memory_path, memory)

    def _remember(self) -> TwinMemory:
        self._memory = snapshot(self._world, self._boots).over(self._memory)
        return self._memory


def make_scene(plan: TwinPlan, facts: SiteFacts) -> Scene:
    """Return the scene of a twin: its own devices, and the bodies of machines that others speak for."""
    devices = [d.description for d in facts.devices]
    here = [d for d in devices if d.kind == "machine" or d.id in plan.speaking]
    return Scene(facts.grid, here, delivery_s=DELIVERY_S, bodiless=plan.pending, paces=plan.paces)
