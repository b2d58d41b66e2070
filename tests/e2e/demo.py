"""The demo as a user starts it, on ports and a state folder of the test's own."""

from __future__ import annotations

import json
import os
import signal
import subprocess
import sys
import time
import urllib.error
import urllib.request
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path

from tests.servers import free_port

ROOT = Path(__file__).resolve().parents[2]
START_LIMIT_S = 120


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
        accounts = json.loads((self.state / "demo-accounts.json").read_text())
        found = next(a for a in accounts if a["role"] == role)
        return Account(found["email"], found["password"])


def wait_until_ready(url: str, process: subprocess.Popen[bytes], log: Path) -> None:
    deadline = time.monotonic() + START_LIMIT_S
    while time.monotonic() < deadline:
        if process.poll() is not None:
            raise AssertionError(f"The demo ended with code {process.returncode}:\n{log.read_text()}")
        try:
            with urllib.request.urlopen(f"{url}/health", timeout=2) as answer:
                if answer.status == 200:
                    return
        except (urllib.error.URLError, ConnectionError, TimeoutError):
            time.sleep(0.2)
    raise AssertionError(f"The demo did not answer within {START_LIMIT_S} s:\n{log.read_text()}")


def stop_process_group(process: subprocess.Popen[bytes]) -> int:
    """Press Ctrl-C, as a person would, and return the exit code."""
    if process.poll() is None:
        os.killpg(process.pid, signal.SIGINT)
        try:
            process.wait(20)
        except subprocess.TimeoutExpired:
            os.killpg(process.pid, signal.SIGKILL)
            process.wait(5)
            raise AssertionError("The demo did not stop within 20 s of Ctrl-C.") from None
    return process.returncode


@contextmanager
def running_demo(state: Path, speed: float = 10) -> Iterator[Demo]:
    """Start the demo, wait until it answers, stop it with Ctrl-C."""
    port = free_port()
    environment = {
        **os.environ,
        "PORT": str(port),
        "SPEED": str(speed),
        "VIPO_STATE_DIR": str(state),
        "VIPO_MQTT_PORT": str(free_port()),
    }
    environment.pop("DJANGO_SETTINGS_MODULE", None)
    log = state / "demo.log"
    state.mkdir(parents=True, exist_ok=True)
    fetched = ROOT / "var" / "micropython"
    if fetched.exists() and not (state / "micropython").exists():
        (state / "micropython").symlink_to(fetched)
    with log.open("wb") as output:
        process = subprocess.Popen(
            [sys.executable, "-m", "vipo_site.demo.main"],
            cwd=ROOT,
            env=environment,
            stdout=output,
            stderr=subprocess.STDOUT,
            start_new_session=True,
        )
        try:
            url = f"http://127.0.0.1:{port}"
            wait_until_ready(url, process, log)
            yield Demo(url, state, process, log)
        finally:
            stop_process_group(process)
