"""The agent: VIPO on one side, the robot's navigation on the other, and the core between them."""

from __future__ import annotations

import json
import logging
import os
import queue
import threading
import time
from abc import ABC, abstractmethod
from pathlib import Path
from typing import Any, Callable

from vipo_agent.config import Config
from vipo_agent.core import OPEN, Ack, Core, Facts, Go, Halt, Pose
from vipo_agent.description import describe
from vipo_agent.enrolment import Enrolment, make_key
from vipo_agent.link import Link
from vipo_agent.messages import Grid, is_number, write, write_grid

log = logging.getLogger("vipo_agent")
TICK_S = 0.1
SILENT_S = 25.0
CHANGED_S = 0.2
PART_EVERY_S = 0.1
MAP_EVERY_S = 10.0
"""A map that grows is sent at most that often: each is sent whole."""
MAP_AGAIN_S = 600.0
"""One that stays as it is is sent that often: what a robot says before it is approved is not kept."""


class CannotStart(Exception):
    """The agent lacks something of the robot or of this machine; the message says what to mend."""


class Navigation(ABC):
    """What a robot's shell does; results go to the agent's `reached` and `failed` with the goal's number."""

    limits_speed = False

    @abstractmethod
    def start(self, agent: Agent) -> None:
        """Connect to the robot and report its pose, battery and map from now on. Raises CannotStart."""

    @abstractmethod
    def go(self, goal: Go) -> None:
        """Drive somewhere, in place of the goal before it."""

    @abstractmethod
    def halt(self) -> None:
        """Give up the goal and stand."""

    @abstractmethod
    def stop(self) -> None:
        """End the connection to the robot."""


class Agent:
    """Everything happens on the thread of `run`; ROS and MQTT only put into the inbox."""

    def __init__(self, config: Config, navigation: Navigation) -> None:
        self._config, self._navigation = config, navigation
        self._inbox: queue.Queue[Callable[[], None]] = queue.Queue(10_000)
        self._path = Path(config.state)
        kept = self._read_kept()
        self._boot = max(int(kept.get("boot", 0)) + 1, int(time.time()))
        facts = Facts(
            config.name, config.speed_m_s, config.capacity, navigation.limits_speed, handling_s=config.handling_s
        )
        self.core = Core(facts, kept)
        self._kept: dict[str, Any] = {}
        self._own_key = str(kept.get("key", ""))
        if not config.password:
            self._own_key = config.password = self._own_key or make_key()
        self._enrolment = Enrolment(config)
        self._link = Link(config, self._boot)
        self._seq = self._map_number = 0
        self._last: dict[str, Any] = {}
        self._said_s = self._map_s = self._part_s = 0.0
        self._grid: Grid | None = None
        self._map_due = False
        self._parts: list[bytes] = []

    def run(self, stopping: threading.Event) -> None:
        """Serve until `stopping` is set; then halt the robot and say goodbye. Raises CannotStart."""
        self._link.told = lambda told: self._put(lambda: self.core.command(told, time.monotonic()))
        self._link.stopped = lambda stop: self._put(lambda: self.core.hold(stop, time.monotonic()))
        self._link.came_in = lambda: self._put(self._introduce)
        self._save()
        self._navigation.start(self)
        self._navigation.halt()  # whatever an agent that was killed has left
        self._link.start()
        try:
            while not stopping.is_set():
                self._take()
                self.core.settle(time.monotonic())
                self._speak()
                self._link.watch(time.monotonic())
                if self._link.is_refused and self._config.join_key:
                    self._enrolment.try_again()
        finally:
            self._navigation.halt()
            self._link.stop()
            self._navigation.stop()

    def moved(self, pose: Pose) -> None:
        """Take in where the robot is; from any thread, as the four below."""
        if all(map(is_number, pose)):
            self._put(lambda: self.core.moved(pose, time.monotonic()))

    def reached(self, number: int) -> None:
        """Take in that a goal was reached."""
        self._put(lambda: self.core.reached(number, time.monotonic()))

    def failed(self, number: int, why: str) -> None:
        """Take in that the navigation gave up a goal."""
        self._put(lambda: self.core.failed(number, why, time.monotonic()))

    def charged(self, percent: float) -> None:
        """Take in the battery's charge."""
        if is_number(percent):
            self._put(lambda: setattr(self.core, "battery", min(100.0, max(0.0, percent))))

    def mapped(self, grid: Grid) -> None:
        """Take in the robot's map."""
        self._put(lambda: self._take_map(grid))

    def _take_map(self, grid: Grid) -> None:
        self._map_due = self._map_due or grid != self._grid
        self._grid = grid

    def _put(self, act: Callable[[], None]) -> None:
        try:
            self._inbox.put_nowait(act)
        except queue.Full:
            log.warning("Too much comes in at once; something was left out.")

    def _take(self) -> None:
        """Wait a moment for what comes in, and deal with all of it."""
        try:
            self._inbox.get(timeout=TICK_S)()
            while True:
                self._inbox.get_nowait()()
        except queue.Empty:
            return

    def _introduce(self) -> None:
        self._link.say_online(describe(self._config))
        self._last = {}
        self._map_due = self._grid is not None

    def _speak(self) -> None:
        """Keep what is to outlive a crash; then drive, answer what has begun, say the state, answer what is over."""
        out, self.core.out = self.core.out, []
        self._save()
        over: list[Ack] = []
        for item in out:
            if isinstance(item, Go):
                self._navigation.go(item)
            elif isinstance(item, Halt):
                self._navigation.halt()
            elif item.status in OPEN:
                self._answer(item)
            else:
                over.append(item)
        self._report(at_once=bool(over))
        for ack in over:
            self._answer(ack)
        self._send_map()

    def _answer(self, ack: Ack) -> None:
        self._link.say("ack", write({"id": ack.command, "st": ack.status, "why": ack.why}))

    def _report(self, *, at_once: bool) -> None:
        state, now = self.core.look(), time.monotonic()
        silent_s = now - self._said_s
        is_due = silent_s >= SILENT_S or (state != self._last and (at_once or silent_s >= CHANGED_S or not self._last))
        if is_due and self._link.is_connected:
            self._seq += 1
            self._last, self._said_s = state, now
            self._link.say("state", write({"boot": self._boot, "seq": self._seq, **state}), retain=True)

    def _send_map(self) -> None:
        """Send the next part of the map; slowly, for the server drops what a device says too fast."""
        now = time.monotonic()
        if self._grid is None or not self._link.is_connected or now - self._part_s < PART_EVERY_S:
            return
        since_s = now - self._map_s if self._map_s else MAP_AGAIN_S
        if not self._parts and since_s >= (MAP_EVERY_S if self._map_due else MAP_AGAIN_S):
            self._map_due, self._map_s = False, now
            self._map_number += 1
            self._parts = list(write_grid(self._grid, self._boot, self._map_number))
        if self._parts:
            self._part_s = now
            self._link.say("map", self._parts.pop(0))

    def _save(self) -> None:
        kept = {"boot": self._boot, "key": self._own_key, **self.core.keep()}
        if kept != self._kept:
            self._kept = json.loads(json.dumps(kept))
            try:
                write_kept(self._path, kept)
            except OSError as error:
                raise CannotStart(f"state: {self._path} cannot be written: {error.strerror}.") from None

    def _read_kept(self) -> dict[str, Any]:
        try:
            kept = json.loads(self._path.read_text(encoding="utf-8"))
        except FileNotFoundError:
            return {}
        except (OSError, ValueError) as error:
            log.warning("%s cannot be read (%s); the robot begins without a load.", self._path, error)
            return {}
        return kept if isinstance(kept, dict) else {}


def write_kept(path: Path, kept: dict[str, Any]) -> None:
    """Write the file in one piece, and onto the disk: robots are switched off without warning."""
    path.parent.mkdir(parents=True, exist_ok=True)
    draft = path.with_suffix(".new")
    draft.touch(mode=0o600)
    with draft.open("w", encoding="utf-8") as file:
        json.dump(kept, file)
        file.flush()
        os.fsync(file.fileno())
    os.replace(str(draft), str(path))  # noqa: PTH105 - the atomic rename is what matters here
