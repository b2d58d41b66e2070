"""The demo's child processes: the simulated world, the firmware, and the robot of the site that begins empty."""

from __future__ import annotations

import json
import logging
import os
import subprocess
import sys
import threading
import time
from collections.abc import Callable
from dataclasses import dataclass, field
from pathlib import Path
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from registry.services import Workshop

log = logging.getLogger(__name__)
HOST = "127.0.0.1"
FASTEST_SCOUT = 20.0


@dataclass(slots=True)
class Part:
    """A part that is stopped when the demo ends; parts stop in the reverse order of their start."""

    name: str
    stop: Callable[[], None]


@dataclass(slots=True)
class Child:
    """A child process that is started again, ever more slowly, when it dies; `find_command` may take its time."""

    name: str
    find_command: Callable[[], list[str]]
    process: subprocess.Popen[bytes] | None = None
    stopping: threading.Event = field(default_factory=threading.Event)
    thread: threading.Thread | None = None

    def start(self) -> None:
        """Start the child and the thread that watches it."""
        self.thread = threading.Thread(target=self._watch, name=f"watch-{self.name}", daemon=True)
        self.thread.start()

    def _watch(self) -> None:
        from registry.services import sigint_blocked

        pause_s = 1.0
        command = self.find_command()
        while not self.stopping.is_set():
            started = time.monotonic()
            # The command is built from this module's own constants and paths.
            wrapped = [sys.executable, "-m", "vipo_site.demo.child", str(os.getpid()), *command]
            with sigint_blocked():
                self.process = subprocess.Popen(wrapped)  # noqa: S603
            code = self.process.wait()
            if self.stopping.is_set():
                return
            pause_s = 1.0 if time.monotonic() - started > 30 else min(pause_s * 2, 30)
            log.warning("%s ended with code %s; it starts again in %.0f s", self.name, code, pause_s)
            self.stopping.wait(pause_s)

    def stop(self) -> None:
        """Ask the child to end, and make it end after 4 s."""
        self.stopping.set()
        if self.process is None or self.process.poll() is not None:
            return
        self.process.terminate()
        try:
            self.process.wait(4)
        except subprocess.TimeoutExpired:
            self.process.kill()


def start_children(state: Path, speed: float, pace: str = "") -> list[Part]:
    """Start the simulated world, the firmware on MicroPython, and the robot of the empty site if there is one."""
    from django.conf import settings

    from registry import services as registry

    twin_command = [
        *(sys.executable, str(settings.BASE_DIR / "manage.py"), "twin", "--site", "painting-factory"),
        *("--speed", str(speed), "--except", "paintMixer02"),
        *(f"--pace={each.strip()}" for each in pace.split(",") if each.strip()),
    ]
    children = [Child("twin", lambda: twin_command), Child("firmware", lambda: find_firmware(state, speed))]
    if workshop := registry.find_workshop():
        children.append(Child("scout", lambda: scout_command(workshop, speed)))
    for child in children:
        child.start()
    return [Part(child.name, child.stop) for child in children]


def scout_command(workshop: Workshop, speed: float) -> list[str]:
    """Return the command of the robot that stands on the floor which nobody has mapped."""
    from django.conf import settings

    start = workshop.start
    return [
        *(sys.executable, str(settings.BASE_DIR / "manage.py"), "scout", "--site", workshop.site),
        *("--map", str(workshop.true_floor), "--start", str(start.x), str(start.y), str(start.theta)),
        *("--id", workshop.robot, "--name", workshop.robot_name, "--speed", str(min(speed, FASTEST_SCOUT))),
    ]


def find_firmware(state: Path, speed: float) -> list[str]:
    """Return the firmware's command; fetches MicroPython the first time, which may take a minute."""
    from django.conf import settings

    from vipo_site.demo.firmware_process import firmware_command

    credentials = json.loads((state / "secrets" / "devices.json").read_text())
    command, notice = firmware_command(
        state,
        {
            "host": HOST,
            "port": settings.VIPO_MQTT["port"],
            "id": "paintMixer02",
            "password": credentials["paintMixer02"],
            "join_key": (state / "secrets" / "join").read_text().strip(),
            "speed": speed,
        },
    )
    if notice:
        say(notice)
    return command


def say(text: str) -> None:
    """Tell the person at the terminal."""
    sys.stdout.write(text + "\n")
    sys.stdout.flush()
