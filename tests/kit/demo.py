"""The demo as a user starts it, on ports and a state folder of the test's own."""

from __future__ import annotations

import json
import os
import signal
import subprocess
import sys
import urllib.error
import urllib.request
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path

from tests.kit.files import ROOT, copy_migrated, link_micropython
from tests.kit.servers import free_port
from tests.kit.waiting import wait_for

START_LIMIT_S, STOP_LIMIT_S = 120.0, 60.0


@dataclass(frozen=True)
class Account:
    """Who can sign in."""

    email: str
    password: str


@dataclass(frozen=True)
class Demo:
    """A running demo."""

    url: str
    state: Path
    process: subprocess.Popen[bytes]
    log: Path

    def account(self, role: str) -> Account:
        """Return the demo's account of a role, `admin` or `author`."""
        return find_account(self.state, role)


def find_account(state: Path, role: str) -> Account:
    """Return the demo's account of a role, as its state folder has it."""
    accounts = json.loads((state / "demo-accounts.json").read_text())
    found = next(a for a in accounts if a["role"] == role)
    return Account(found["email"], found["password"])


def wait_healthy(url: str, process: subprocess.Popen[bytes], log: Path) -> None:
    """Wait until the demo answers; when it ends before, fail with what it wrote."""

    def is_healthy() -> bool:
        try:
            with urllib.request.urlopen(f"{url}/health", timeout=2) as answer:
                return bool(answer.status == 200)
        except (urllib.error.URLError, ConnectionError, TimeoutError):
            return False

    def ended() -> str:
        return "" if process.poll() is None else f"the demo ended with code {process.returncode}"

    wait_for("the demo's answer", is_healthy, START_LIMIT_S, every_s=0.2, story=log.read_text, hopeless=ended)


def stop_process_group(process: subprocess.Popen[bytes]) -> int:
    """Press Ctrl-C, as a person would, and return the exit code."""
    if process.poll() is None:
        os.killpg(process.pid, signal.SIGINT)
        try:
            process.wait(STOP_LIMIT_S)
        except subprocess.TimeoutExpired:
            os.killpg(process.pid, signal.SIGKILL)
            process.wait(5)
            raise AssertionError(f"The demo did not stop within {STOP_LIMIT_S:g} s of Ctrl-C.") from None
    return process.returncode


@contextmanager
def running_demo(
    state: Path, speed: float = 10, *, from_nothing: bool = False, empty_floor: bool = False, pace: str = ""
) -> Iterator[Demo]:
    """Start the demo, wait until it answers, stop it with Ctrl-C; it finds its tables unless it shall make them."""
    port = free_port()
    environment = {
        **os.environ,
        "PORT": str(port),
        "SPEED": str(speed),
        "FLOOR": "empty" if empty_floor else "",
        "PACE": pace,
        "VIPO_STATE_DIR": str(state),
        "VIPO_MQTT_PORT": str(free_port()),
    }
    environment.pop("DJANGO_SETTINGS_MODULE", None)
    log = state / "demo.log"
    state.mkdir(parents=True, exist_ok=True)
    link_micropython(state)
    if not from_nothing and not (state / "vipo.sqlite3").exists():
        copy_migrated(state / "vipo.sqlite3")
    with log.open("wb") as output:
        process = subprocess.Popen(
            [sys.executable, "-m", "vipo_site.demo"],
            cwd=ROOT,
            env=environment,
            stdout=output,
            stderr=subprocess.STDOUT,
            start_new_session=True,
        )
        try:
            url = f"http://127.0.0.1:{port}"
            wait_healthy(url, process, log)
            yield Demo(url, state, process, log)
        finally:
            stop_process_group(process)
