"""The served form, started by hand: the processes of docker-compose.yml against real servers on free ports."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
from collections.abc import Callable, Iterator
from contextlib import ExitStack, closing, contextmanager
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import httpx

from tests.kit.demo import find_account
from tests.kit.files import ROOT
from tests.kit.servers import Mosquitto, find_program, free_port, run_mosquitto
from tests.kit.sign_in import open_page, sign_in
from tests.kit.waiting import PATIENCE_S, wait_for
from vipo_site.http import MOST_MESSAGE_BYTES

SPEED = 6
WEB = ["-m", "daphne", "-b", "127.0.0.1", "--websocket-max-message-size", str(MOST_MESSAGE_BYTES)]
_CELERY = ["-m", "celery", "-A", "vipo_site", "worker", "--loglevel", "INFO"]
WORKER = [*_CELERY, "-Q", "runs", "--concurrency", "4"]
REHEARSALS = [*_CELERY, "-Q", "rehearsals,upkeep"]


@dataclass
class Served:
    """Running processes by name, and how to start, kill and ask them."""

    folder: Path
    environment: dict[str, str]
    mosquitto: Mosquitto
    web_ports: tuple[int, int]
    processes: dict[str, subprocess.Popen[bytes]] = field(default_factory=dict)

    def start(self, name: str, *arguments: str) -> None:
        with self.log(name).open("ab") as log:
            self.processes[name] = subprocess.Popen(
                [sys.executable, *arguments], cwd=ROOT, env=self.environment, stdout=log, stderr=log
            )

    def manage(self, *arguments: str) -> str:
        done = subprocess.run(
            [sys.executable, "manage.py", *arguments], cwd=ROOT, env=self.environment, capture_output=True, text=True
        )
        assert done.returncode == 0, done.stdout + done.stderr
        return done.stdout

    def log(self, name: str) -> Path:
        return self.folder / f"{name}.log"

    def kill(self, name: str) -> None:
        process = self.processes.pop(name)
        process.kill()
        process.wait()

    def stop_all(self) -> dict[str, int]:
        """End everything as an operator would; return the exit codes."""
        for process in self.processes.values():
            process.send_signal(signal.SIGTERM)
        return {name: wait_or_kill(process) for name, process in self.processes.items()}

    @contextmanager
    def signed_in(self, role: str, web: int = 0) -> Iterator[httpx.Client]:
        """Give a browser's session with one of the web processes."""
        account = find_account(self.folder / "state", role)
        with closing(open_page(f"http://127.0.0.1:{self.web_ports[web]}")) as client:
            yield sign_in(client, account.email, account.password)

    def story(self) -> str:
        """Return the last lines of every log, for a failing test."""
        logs = sorted(self.folder.glob("*.log"))
        return "\n".join(f"--- {log.name}\n{chr(10).join(log.read_text().splitlines()[-15:])}" for log in logs)

    def wait(self, what: str, ready: Callable[[], Any], timeout_s: float = PATIENCE_S) -> Any:
        """Return the first true answer; fail with the processes' logs."""

        def ended() -> str:
            names = [name for name, process in self.processes.items() if process.poll() is not None]
            return f"{names} ended by themselves" if names else ""

        return wait_for(what, ready, timeout_s, every_s=0.2, story=self.story, hopeless=ended)


def wait_or_kill(process: subprocess.Popen[bytes]) -> int:
    try:
        return process.wait(PATIENCE_S)
    except subprocess.TimeoutExpired:
        process.kill()
        return process.wait()


def settings_for(state: Path, database_url: str, redis_url: str, mosquitto: Mosquitto) -> dict[str, str]:
    """Return the environment that docker-compose.yml gives."""
    return served_without_broker(state, database_url, redis_url) | {
        "VIPO_MQTT_HOST": "localhost",
        "VIPO_MQTT_PORT": str(mosquitto.port),
        "VIPO_MQTT_TLS": "1",
        "VIPO_MQTT_CA": mosquitto.authority,
        "VIPO_MQTT_PASSWORD": mosquitto.accounts["server"],
        "VIPO_BROKER_URL": f"mqtts://localhost:{mosquitto.device_port}/",
        "VIPO_DEMO": "1",
        "VIPO_LOG": "INFO",
        "PYTHONUNBUFFERED": "1",
    }


def served_without_broker(state: Path, database_url: str, redis_url: str) -> dict[str, str]:
    """Return what a process of the served product is told that does not speak to a broker."""
    own = {name: value for name, value in os.environ.items() if not name.startswith(("VIPO_", "DJANGO_"))}
    return own | {
        "DJANGO_SETTINGS_MODULE": "vipo_site.settings",
        "VIPO_MODE": "served",
        "VIPO_SECRET_KEY": "a key for this test alone, long enough to be taken",
        "VIPO_HOSTS": "127.0.0.1",
        "VIPO_HTTPS": "0",
        "VIPO_DATABASE_URL": database_url,
        "VIPO_REDIS_URL": redis_url,
        "VIPO_MQTT_HOST": "127.0.0.1",
        "VIPO_MQTT_PASSWORD": "not used here",
        "VIPO_STATE_DIR": str(state),
    }


@contextmanager
def running_served(folder: Path, database_url: str, redis_url: str) -> Iterator[Served]:
    """Start Mosquitto with TLS, prepare the database and the broker's accounts, and start all processes."""
    find_program("mosquitto", "/usr/sbin/mosquitto")
    state = folder / "state"
    state.mkdir()
    with ExitStack() as stack:
        mosquitto = stack.enter_context(run_mosquitto(folder, {"server": "the server's word"}, tls=True))
        environment = settings_for(state, database_url, redis_url, mosquitto)
        served = Served(folder, environment, mosquitto, (free_port(), free_port()))
        served.manage("prepare")
        mosquitto.stop()
        served.manage("broker_accounts", str(folder / "dynamic-security.json"))
        mosquitto.start()
        stack.callback(served.stop_all)
        for number, port in enumerate(served.web_ports, 1):
            served.start(f"web-{number}", *WEB, "-p", str(port), "vipo_site.asgi:application")
        for name in ("worker-1", "worker-2"):
            served.start(name, *WORKER, "-n", f"{name}@%h")
        served.start("rehearsals", *REHEARSALS, "-n", "rehearsals@%h")
        for name in ("gateway", "ticker"):
            served.start(name, "manage.py", name)
        served.start("twin", "manage.py", "twin", "--site", "painting-factory", "--speed", str(SPEED))
        yield served
