"""All ovens of a game in one process: each with a connection of its own, all with one log of what they did.

Arguments: the broker's port, the log, and the game as JSON. It begins when the standard input says `go`, since a busy
machine takes longer to start a process than a device may be away. A line `cut DEVICE SECONDS` ends a connection without
a goodbye. The log is also what an oven knows after it was killed: which commands it has begun.
"""

from __future__ import annotations

import heapq
import itertools
import json
import sys
import threading
import time
from collections import deque
from collections.abc import Callable
from contextlib import suppress
from pathlib import Path
from random import Random
from typing import Any

from tests.integration.breaking.chaos.hall import PASSWORD, Game, describe
from vipo_device.descriptions.reader import write_description
from vipo_device.kit.connection import CommandReceived, DeviceConnection, IntroductionDue, broker_client
from vipo_device.protocol.description import DeviceState
from vipo_device.protocol.messages import CONTROLS, AckMessage, DeviceCommand
from vipo_device.protocol.mqtt_client import MqttClient, Will

REMEMBERED = 16
TWICE, LATE, OLD = 0.25, 0.15, 0.1
"""The share of answers that are said twice, late (and so behind later ones), and once more after the next command."""
LATE_S, WORK_S = (0.1, 3.0), (0.02, 0.3)
SLOW, SLOW_S = 0.5, (0.15, 0.4)
"""The share of commands that an oven hears late: so long that they are marked as sent before they are answered."""


class Clock:
    """Does things later, one after the other."""

    def __init__(self) -> None:
        self._due: list[tuple[float, int, Callable[[], None]]] = []
        self._changed = threading.Condition()
        self._number = itertools.count()
        threading.Thread(target=self._run, daemon=True).start()

    def after(self, seconds: float, do: Callable[[], None]) -> None:
        with self._changed:
            heapq.heappush(self._due, (time.monotonic() + seconds, next(self._number), do))
            self._changed.notify()

    def _run(self) -> None:
        while True:
            with self._changed:
                while not self._due or self._due[0][0] > time.monotonic():
                    self._changed.wait(self._due[0][0] - time.monotonic() if self._due else None)
                _, _, do = heapq.heappop(self._due)
            do()


class Log:
    """One line for each beginning and each end."""

    def __init__(self, file: Path) -> None:
        self.before = [json.loads(line) for line in file.read_text().splitlines()] if file.exists() else []
        self._file = file.open("a")
        self._lock = threading.Lock()

    def write(self, device: str, command: str, value: int, word: str) -> None:
        with self._lock:
            line = {"at": time.monotonic(), "device": device, "id": command, "value": value, "is": word}
            self._file.write(json.dumps(line) + "\n")
            self._file.flush()


class Oven:
    """Carries out what it is told once, as docs/protocol.md asks, and answers carelessly."""

    def __init__(self, name: str, log: Log, clock: Clock, seed: int) -> None:
        self.name, self._log, self._clock = name, log, clock
        self._chance = Random(f"{seed}:{name}:{time.time()}")
        self._lock = threading.RLock()
        self._known: dict[str, str] = {}
        self._last: deque[AckMessage] = deque(maxlen=4)
        self._busy = ""
        self._description = write_description(describe(name)).encode()
        self._client: MqttClient | None = None
        self.connection = DeviceConnection(name, name.partition(".")[0], int(time.time()), self._hear)

    def start(self, port: int) -> None:
        for line in self._log.before:
            if line["device"] == self.name:
                self._remember(line["id"], "DONE" if line["is"] == "end" else "RUNNING")
                self._busy = line["id"] if line["is"] == "begin" else ""
                if self._busy:
                    left = (line["id"], line["value"])
        if self._busy:  # it lay in the oven while that was without power
            self._clock.after(0.1, lambda: self._end(*left))
        broker = {"host": "127.0.0.1", "port": port, "tls": False, "ca": ""}

        def make(name: str, will: Will) -> MqttClient:
            self._client = broker_client(broker, name, PASSWORD, will)
            return self._client

        self.connection.connect(make)
        self._clock.after(1.0, self._report)

    def cut(self, seconds: float) -> None:
        """End the connection as a cable does, and be refused for so long."""
        assert self._client is not None
        self._client.change_password("not this one")
        with suppress(OSError, AttributeError):
            self._client._paho.socket().shutdown(2)  # type: ignore[union-attr]
        client = self._client
        self._clock.after(seconds, lambda: client.change_password(PASSWORD))

    def _report(self) -> None:
        self.connection.report(self._look, time.monotonic())
        self._clock.after(1.0, self._report)

    def _look(self, boot: int, seq: int) -> DeviceState:
        return DeviceState(boot, seq, not self._busy, None, self._busy, {"temperature": 20.0})

    def _hear(self, event: Any) -> None:
        if isinstance(event, IntroductionDue):
            self.connection.introduce(self._description, online=True)
        elif isinstance(event, CommandReceived):
            late_s = self._chance.uniform(*SLOW_S) if self._chance.random() < SLOW else 0.0
            self._clock.after(late_s, lambda: self._take(event.command))

    def _take(self, command: DeviceCommand) -> None:
        with self._lock:
            self._take_locked(command)

    def _take_locked(self, command: DeviceCommand) -> None:
        if command.method in CONTROLS:  # nothing of a game asks for one, unless it is lost already
            self._answer(command.id, "REJECTED")
            return
        if (known := self._known.get(command.id)) is not None:
            self._answer(command.id, known)
            return
        value = int(command.arguments.get("value", -1))
        self._log.write(self.name, command.id, value, "begin")
        self._remember(command.id, "RUNNING")
        self._busy = command.id
        self._answer(command.id, "ACCEPTED")
        self._answer(command.id, "RUNNING")
        self._clock.after(self._chance.uniform(*WORK_S), lambda: self._end(command.id, value))

    def _end(self, command: str, value: int) -> None:
        with self._lock:
            self._log.write(self.name, command, value, "end")
            self._remember(command, "DONE")
            self._busy = ""
            self._answer(command, "DONE")

    def _remember(self, command: str, status: str) -> None:
        self._known[command] = status
        while len(self._known) > REMEMBERED:
            del self._known[next(iter(self._known))]

    def _answer(self, command: str, status: Any) -> None:
        ack = AckMessage(command, status, "", {})
        for _ in range(2 if self._chance.random() < TWICE else 1):
            self._say(ack)
        if self._last and self._chance.random() < OLD:
            self._say(self._chance.choice(self._last))
        self._last.append(ack)

    def _say(self, ack: AckMessage) -> None:
        if self._chance.random() < LATE:
            self._clock.after(self._chance.uniform(*LATE_S), lambda: self.connection.answer(ack))
        else:
            self.connection.answer(ack)


def main() -> None:
    sys.stdin.readline()
    port, log, clock = int(sys.argv[1]), Log(Path(sys.argv[2])), Clock()
    game = Game(**json.loads(sys.argv[3]))
    ovens = {name: Oven(name, log, clock, game.seed) for name in game.all_devices}
    for oven in ovens.values():
        oven.start(port)
    for line in sys.stdin:
        _, name, seconds = line.split()
        ovens[name].cut(float(seconds))


if __name__ == "__main__":
    main()
