"""The embedded mode: everything in one process group, on a bare machine, with nothing but Python.

The main thread runs Daphne; the broker, the Celery workers of runs and of rehearsals, the gateway and the ticker are
threads; the pretend world (PyBullet) and the firmware (MicroPython) are child processes, started again when they die,
and so is each rehearsal.
"""

from __future__ import annotations

import argparse
import errno
import json
import logging
import os
import shutil
import signal
import socket
import subprocess
import sys
import threading
import time
from collections.abc import Callable
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from celery.signals import worker_shutting_down
from daphne.server import Server  # installs Twisted's asyncio reactor, so it comes before anything that uses one
from django.core.exceptions import ImproperlyConfigured

from vipo_device.protocol.errors import VipoError

log = logging.getLogger(__name__)
HOST = "127.0.0.1"
WEB_PORT = 8000
MQTT_PORT = 1883
MIB = 1024 * 1024
STOP_LIMIT_S = 10.0


class CannotStart(Exception):
    """The demo cannot start; the message says why and what to do."""


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


def port_is_free(port: int) -> bool:
    """Tell whether nothing listens on the port of this machine."""
    with socket.socket() as probe:
        probe.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
        try:
            probe.bind((HOST, port))
        except OSError as error:
            if error.errno in {errno.EADDRINUSE, errno.EACCES}:
                return False
            raise
        return True


def any_free_port() -> int:
    """Return a port that nothing listens on."""
    with socket.socket() as probe:
        probe.bind((HOST, 0))
        return int(probe.getsockname()[1])


def read_arguments(arguments: list[str]) -> argparse.Namespace:
    """Read the command line; the Makefile passes PORT, RESET and SPEED on."""
    parser = argparse.ArgumentParser(prog="make demo", description="Run VIPO with the painting factory.")
    parser.add_argument("--port", type=int, default=os.environ.get("PORT") or str(WEB_PORT))
    parser.add_argument("--reset", action="store_true", default=os.environ.get("RESET") == "1")
    parser.add_argument("--speed", type=float, default=os.environ.get("SPEED") or "1")
    return parser.parse_args(arguments)


def check_arguments(options: argparse.Namespace) -> None:
    """Refuse what cannot work, before anything is touched."""
    if not 1 <= options.port <= 65535:
        raise CannotStart(f"PORT={options.port} is not a port; choose a number from 1 to 65535.")
    if not 0.1 <= options.speed <= 50:
        raise CannotStart(f"SPEED={options.speed:g} is outside 0.1 to 50; 1 is real time.")
    if not port_is_free(options.port):
        raise CannotStart(
            f"Port {options.port} of this machine is in use. Stop what uses it, or choose another one: "
            f"make demo PORT={any_free_port()}"
        )


def set_environment(options: argparse.Namespace) -> None:
    """Say to the settings what this start is; child processes inherit it."""
    mqtt_port = int(os.environ.get("VIPO_MQTT_PORT", 0)) or (MQTT_PORT if port_is_free(MQTT_PORT) else any_free_port())
    os.environ.update(
        VIPO_MODE="embedded",
        VIPO_DEMO="1",
        VIPO_MQTT_PORT=str(mqtt_port),
        VIPO_SPEED=str(options.speed),
        DJANGO_SETTINGS_MODULE="vipo_site.settings",
        PYTHONUNBUFFERED="1",
    )


def reset_state(folder: Path) -> None:
    """Forget everything; the database of a demo that still runs is not touched, for its port is in use."""
    for name in ("vipo.sqlite3", "vipo.sqlite3-wal", "vipo.sqlite3-shm", "demo-accounts.json"):
        (folder / name).unlink(missing_ok=True)
    for name in ("twin", "secrets", "broker", "firmware"):
        shutil.rmtree(folder / name, ignore_errors=True)


def prepare_database() -> None:
    """Bring the database up to date and fill in the painting factory."""
    from django.core.management import call_command

    call_command("migrate", verbosity=0, interactive=False)
    call_command("seed_demo", verbosity=0)
    from editor import services as editor

    editor.seed_programs(site="painting-factory")
    editor.seed_library(site="painting-factory")


def start_workers() -> list[Part]:
    """Run Celery's workers in a thread each; their messages stay in this process."""
    from django.conf import settings

    from vipo_site.celery import app, make_app

    # An application for each, since what a worker listens to is kept with its application.
    rehearsing = make_app()
    rehearsing.conf.broker_transport_options = {"polling_interval": 0.1}
    return [
        _start_worker("runs", app, "runs", 4),
        _start_worker("rehearsals", rehearsing, "rehearsals,upkeep", settings.CELERY_WORKER_CONCURRENCY),
    ]


def _start_worker(name: str, app: Any, queues: str, threads: int) -> Part:
    """Run one worker with so many threads."""
    from execution.services import leave
    from vipo_site.celery import begin_to_beat, say_goodbye

    worker: Any = app.WorkController(
        queues=queues,
        hostname=f"{name}@demo",
        pool_cls="threads",
        concurrency=threads,
        without_mingle=True,
        without_gossip=True,
        without_heartbeat=True,
        ready_callback=begin_to_beat,
    )
    thread = threading.Thread(target=worker.start, name=name, daemon=True)
    thread.start()

    def stop() -> None:
        worker_shutting_down.send(sender=name)
        leave()
        worker.stop()
        thread.join(4)
        say_goodbye()

    return Part(name, stop)


def start_loop(name: str, run: Callable[[threading.Event], None]) -> Part:
    """Run a part that watches an event in a thread of its own; when it fails, the demo says so and ends."""
    stopping = threading.Event()

    def guarded() -> None:
        try:
            run(stopping)
        except Exception:  # a part's edge: a demo without it would look alive and do nothing
            log.exception("%s failed", name)
            os.kill(os.getpid(), signal.SIGTERM)

    thread = threading.Thread(target=guarded, name=name, daemon=True)
    thread.start()

    def stop() -> None:
        stopping.set()
        thread.join(4)

    return Part(name, stop)


def start_broker() -> Part:
    """Run the MQTT broker in a thread."""
    from vipo_site.embedded_broker.server import start_broker as start

    handle = start(port=int(os.environ["VIPO_MQTT_PORT"]), host=HOST)
    return Part("broker", handle.stop)


def start_children(state: Path, speed: float) -> list[Part]:
    """Start the pretend world, and the firmware on MicroPython."""
    from django.conf import settings

    twin_command = [
        *(sys.executable, str(settings.BASE_DIR / "manage.py"), "twin", "--site", "painting-factory"),
        *("--speed", str(speed), "--except", "paintMixer02"),
    ]
    children = (Child("twin", lambda: twin_command), Child("firmware", lambda: find_firmware(state, speed)))
    for child in children:
        child.start()
    return [Part(child.name, child.stop) for child in children]


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


def greet(options: argparse.Namespace, state: Path) -> None:
    """Say where the demo is and who can sign in."""
    from django.conf import settings

    accounts = json.loads((state / "demo-accounts.json").read_text())
    lines = [f"  {a['role']:<7} {a['email']:<22} {a['password']}" for a in accounts]
    pace = "" if options.speed == 1 else f" (simulated devices at {options.speed:g} times real time)"
    say(
        f"\nVIPO is ready: http://{HOST}:{options.port}{pace}\n\nSign in as\n" + "\n".join(lines) + "\n\n"
        f"Devices join at mqtt://{HOST}:{settings.VIPO_MQTT['port']}. Ctrl-C stops everything; "
        f"`make demo RESET=1` begins anew.\n"
    )


def start_parts(options: argparse.Namespace, state: Path) -> list[Part]:
    """Start all parts but the web server, and return them in the order of their start."""
    from django.conf import settings

    from execution.gateway.gateway import Gateway
    from execution.services import run_ticker
    from registry.services import Heart

    parts = [start_broker(), *start_workers()]
    gateway, ticker = Heart("gateway", settings.VIPO_GATEWAY), Heart("ticker")
    parts += [Part(name, heart.start().stop) for name, heart in (("gateway", gateway), ("ticker", ticker))]
    parts.append(start_loop("gateway", lambda stopping: Gateway(settings, gateway).run_forever(stopping)))
    parts.append(start_loop("ticker", lambda stopping: run_ticker(stopping=stopping, heart=ticker)))
    return parts + start_children(state, options.speed)


def serve(options: argparse.Namespace, state: Path) -> None:
    """Run the web server until a signal ends it."""
    from twisted.internet import reactor

    from vipo_site.asgi import application

    reactor.addSystemEventTrigger("before", "shutdown", limit_stopping)
    Server(
        application,
        endpoints=[f"tcp:port={options.port}:interface={HOST}"],
        websocket_max_message_size=16 * MIB,
        websocket_max_frame_size=16 * MIB,
        application_close_timeout=2,
        ready_callable=lambda: greet(options, state),
        server_name="vipo",
        verbosity=0,
    ).run()


def limit_stopping() -> None:
    """End the process for good when stopping takes too long: nothing in it is worth waiting for.

    What was saved is in the database, commands are sent again by their ids, and child processes die with their parent.
    """
    limit = threading.Timer(STOP_LIMIT_S, os._exit, (0,))
    limit.daemon = True
    limit.start()


def run(options: argparse.Namespace) -> None:
    """Set up, run until stopped, stop."""
    check_arguments(options)
    set_environment(options)
    import django
    from django.conf import settings

    state = Path(os.environ.get("VIPO_STATE_DIR", "var")).resolve()
    if options.reset:
        reset_state(state)
    state.mkdir(parents=True, exist_ok=True)
    django.setup()
    say("Preparing the painting factory …")
    prepare_database()
    parts: list[Part] = []
    try:
        parts = start_parts(options, Path(settings.VIPO_STATE_DIR))
        serve(options, Path(settings.VIPO_STATE_DIR))
    finally:
        say("Stopping …")
        limit_stopping()
        for part in reversed(parts):
            part.stop()
    # Idle threads of Celery's pool and of asgiref would hold the interpreter's own end up.
    sys.stdout.flush()
    os._exit(0)


def main() -> None:
    """Run the demo; exit with 1 and a sentence when it cannot start."""
    # A shell without job control starts background commands with Ctrl-C ignored; the demo wants it all the same.
    for number in (signal.SIGINT, signal.SIGTERM):
        signal.signal(number, signal.default_int_handler)
    try:
        run(read_arguments(sys.argv[1:]))
    except CannotStart as error:
        sys.exit(str(error))
    except VipoError as error:
        sys.exit(error.detail)
    except ImproperlyConfigured as error:
        sys.exit(str(error))
    except KeyboardInterrupt:
        sys.exit(130)


if __name__ == "__main__":
    main()
