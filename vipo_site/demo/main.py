"""The embedded mode: everything in one process group, on a bare machine, with nothing but Python.

The main thread runs Daphne; the broker, the Celery workers of runs and of rehearsals, the gateway and the ticker are
threads; the simulated world (PyBullet) and the firmware (MicroPython) are child processes, started again when they die,
and so is each rehearsal.
"""

from __future__ import annotations

import argparse
import json
import logging
import os
import shutil
import signal
import sys
import threading
from collections.abc import Callable
from pathlib import Path
from typing import Any

from celery.signals import worker_shutting_down
from daphne.server import Server  # installs Twisted's asyncio reactor, so it comes before anything that uses one
from django.core.exceptions import ImproperlyConfigured

from vipo_device.protocol.errors import VipoError
from vipo_site.demo.broker import any_free_port, port_is_free, start_broker
from vipo_site.demo.children import HOST, Part, say, start_children
from vipo_site.http import MOST_MESSAGE_BYTES

log = logging.getLogger(__name__)
WEB_PORT = 8000
MQTT_PORT = 1883
STOP_LIMIT_S = 10.0
EMPTY = "empty"


class CannotStart(Exception):
    """The demo cannot start; the message says why and what to do."""


def read_arguments(arguments: list[str]) -> argparse.Namespace:
    """Read the command line; the Makefile passes PORT, RESET, SPEED, FLOOR and PACE on."""
    parser = argparse.ArgumentParser(prog="make demo", description="Run VIPO with the painting factory.")
    parser.add_argument("--port", type=int, default=os.environ.get("PORT") or str(WEB_PORT))
    parser.add_argument("--reset", action="store_true", default=os.environ.get("RESET") == "1")
    parser.add_argument("--speed", type=float, default=os.environ.get("SPEED") or "1")
    parser.add_argument(
        "--floor", default=os.environ.get("FLOOR") or "", help="empty: begin with one nobody has mapped"
    )
    parser.add_argument(
        "--pace", default=os.environ.get("PACE") or "", metavar="DEVICE.METHOD=TIMES",
        help="simulated devices that take so many times as long as they should; several with commas between",
    )  # fmt: skip
    return parser.parse_args(arguments)


def check_arguments(options: argparse.Namespace) -> None:
    """Refuse what cannot work, before anything is touched."""
    if not 1 <= options.port <= 65535:
        raise CannotStart(f"PORT={options.port} is not a port; choose a number from 1 to 65535.")
    if not 0.1 <= options.speed <= 50:
        raise CannotStart(f"SPEED={options.speed:g} is outside 0.1 to 50; 1 is real time.")
    if options.floor not in {"", EMPTY}:
        raise CannotStart(f"FLOOR={options.floor} is not known; FLOOR={EMPTY} adds a site that nobody has mapped.")
    if not port_is_free(options.port):
        raise CannotStart(
            f"Port {options.port} of this machine is in use. Stop what uses it, or choose another one: "
            f"make demo PORT={any_free_port()}"
        )


def set_environment(options: argparse.Namespace) -> None:
    """Say to the settings what this start is; child processes inherit it."""
    asked = int(os.environ.get("VIPO_MQTT_PORT", 0))
    options.any_mqtt_port = not asked
    mqtt_port = asked or (MQTT_PORT if port_is_free(MQTT_PORT) else any_free_port())
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
    for name in ("twin", "stand-ins", "secrets", "broker", "firmware"):
        shutil.rmtree(folder / name, ignore_errors=True)


def prepare_database(floor: str) -> None:
    """Bring the database up to date, fill in the painting factory, and make the empty site if it is asked for."""
    from django.core.management import call_command

    call_command("migrate", verbosity=0, interactive=False)
    call_command("seed_demo", verbosity=0, empty_floor=floor == EMPTY)
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


def greet(options: argparse.Namespace, state: Path) -> None:
    """Say where the demo is and who can sign in."""
    from django.conf import settings

    from registry import services as registry

    accounts = json.loads((state / "demo-accounts.json").read_text())
    lines = [f"  {a['role']:<7} {a['email']:<22} {a['password']}" for a in accounts]
    pace = "" if options.speed == 1 else f" (simulated devices at {options.speed:g} times real time)"
    workshop = registry.find_workshop() if options.floor == EMPTY else None
    empty = (
        f"A site whose floor nobody has mapped: http://{HOST}:{options.port}/sites/{workshop.site}\n\n"
        if workshop
        else ""
    )
    say(
        f"\nVIPO is ready: http://{HOST}:{options.port}{pace}\n\nSign in as\n" + "\n".join(lines) + "\n\n"
        f"{empty}Devices join at mqtt://{HOST}:{settings.VIPO_MQTT['port']}. Ctrl-C stops everything; "
        f"`make demo RESET=1` begins anew.\n"
    )


def start_parts(options: argparse.Namespace, state: Path) -> list[Part]:
    """Start all parts but the web server, and return them in the order of their start."""
    from django.conf import settings

    from execution.gateway.gateway import Gateway
    from execution.mirror.mirror import Mirror
    from execution.services import run_ticker
    from execution.stand_ins.stand_ins import StandIns
    from registry.services import HeartbeatWriter

    parts = [start_broker(any_port=options.any_mqtt_port), *start_workers()]
    gateway = HeartbeatWriter("gateway", settings.VIPO_GATEWAY)
    ticker, mirror, stand_ins = HeartbeatWriter("ticker"), HeartbeatWriter("mirror"), HeartbeatWriter("stand-ins")
    heartbeats = (("gateway", gateway), ("ticker", ticker), ("mirror", mirror), ("stand-ins", stand_ins))
    parts += [Part(name, heartbeat.start().stop) for name, heartbeat in heartbeats]
    parts.append(start_loop("gateway", lambda stopping: Gateway(settings, gateway).run_forever(stopping)))
    parts.append(start_loop("ticker", lambda stopping: run_ticker(stopping=stopping, heartbeat=ticker)))
    parts.append(start_loop("mirror", Mirror(settings, mirror, speed=options.speed).run_forever))
    parts.append(start_loop("stand-ins", StandIns(settings, stand_ins, speed=options.speed).run_forever))
    return parts + start_children(state, options.speed, options.pace)


def serve(options: argparse.Namespace, state: Path) -> None:
    """Run the web server until a signal ends it."""
    from twisted.internet import reactor

    from vipo_site.asgi import application

    reactor.addSystemEventTrigger("before", "shutdown", limit_stopping)
    Server(
        application,
        endpoints=[f"tcp:port={options.port}:interface={HOST}"],
        websocket_max_message_size=MOST_MESSAGE_BYTES,
        websocket_max_frame_size=MOST_MESSAGE_BYTES,
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
    prepare_database(options.floor)
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
