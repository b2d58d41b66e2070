"""A thousand devices on one gateway: states taken in, kept and fanned out; descriptions; a new device; a command.

Everything is real: Mosquitto, PostgreSQL, Redis, and the gateway as a process of its own, whose processor time counts.
Beside it the same flow into a bare paho loop that only reads the JSON, and into Node-RED.
"""

from __future__ import annotations

import json
import subprocess
import sys
import tempfile
import threading
import time
from collections.abc import Iterator
from contextlib import ExitStack, contextmanager
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import psycopg
import redis

from bench.figures import figure, share
from bench.flow import ROOT, Flow, cpu_seconds
from bench.peers.subjects import bare_loop, node_red
from tests.kit.served import settings_for
from tests.kit.servers import run_mosquitto, run_postgres, run_redis

DEVICES, ROUNDS = 1000, 20
PACES = (1000.0, 6000.0)
PASSWORD = "the server's word"
WAIT_S = 120


@dataclass(frozen=True)
class World:
    """Running servers, and a database with a thousand approved devices."""

    environment: dict[str, str]
    mqtt_port: int
    postgres_url: str
    redis_url: str

    def run(self, *arguments: str) -> list[dict[str, Any]]:
        """Run a part of bench.devices_inside in a process with VIPO's settings, and return what it says."""
        command = [sys.executable, "-m", "bench.devices_inside", *arguments]
        done = subprocess.run(command, cwd=ROOT, env=self.environment, capture_output=True, text=True)
        if done.returncode:
            raise RuntimeError(done.stderr)
        return [json.loads(line) for line in done.stdout.splitlines()]

    @contextmanager
    def gateway(self) -> Iterator[subprocess.Popen[bytes]]:
        """Run a gateway, and wait until it has announced itself."""
        with (
            redis.Redis.from_url(self.redis_url) as _,
            subprocess.Popen([sys.executable, "manage.py", "gateway"], cwd=ROOT, env=self.environment) as process,
        ):
            try:
                time.sleep(5)
                yield process
            finally:
                process.terminate()

    def ask(self, sql: str) -> int:
        """Return the number that a query gives."""
        with psycopg.connect(self.postgres_url) as connection:
            row = connection.execute(sql.encode()).fetchone()
        return int(row[0]) if row and row[0] is not None else 0

    def kept(self) -> int:
        """Return how often a device's row was written so far; PostgreSQL counts a little behind."""
        time.sleep(2)
        return self.ask("SELECT n_tup_upd FROM pg_stat_user_tables WHERE relname = 'registry_device'")

    def wait_last(self, seq: int) -> None:
        """Wait until every device's last state is in the database."""
        deadline = time.monotonic() + WAIT_S
        while self.ask(f"SELECT count(*) FROM registry_device WHERE seq = {seq}") < DEVICES:
            if time.monotonic() > deadline:
                raise RuntimeError("The gateway did not take everything in.")
            time.sleep(0.1)


class Ear:
    """Counts the messages that a browser's process would get for the site."""

    def __init__(self, url: str) -> None:
        self._channel = redis.Redis.from_url(url).pubsub(ignore_subscribe_messages=True)
        self._channel.psubscribe("vipo:live:*")
        self.count = 0
        self._open = True
        threading.Thread(target=self._hear, daemon=True).start()

    def _hear(self) -> None:
        while self._open:
            if self._channel.get_message(timeout=0.5):
                self.count += 1

    def close(self) -> int:
        """Stop, and return the count."""
        self._open = False
        return self.count


def measure() -> Iterator[dict[str, object]]:
    with tempfile.TemporaryDirectory() as name, _servers(Path(name)) as world:
        for said in world.run("describe", str(DEVICES)):
            yield figure(said["what"], said["rate"], "per second and core", devices=DEVICES)
        for number, pace in enumerate(PACES):
            yield _measure_states(world, pace, first=1 + number * ROUNDS)
        yield from _measure_delays(world)
    for peer in (bare_loop, node_red):
        yield _measure_peer(peer)


@contextmanager
def _servers(folder: Path) -> Iterator[World]:
    with ExitStack() as stack:
        postgres = stack.enter_context(run_postgres(folder, keep_durable=True))
        bus = stack.enter_context(run_redis(folder))
        mosquitto = stack.enter_context(run_mosquitto(folder, {"server": PASSWORD}))
        (folder / "state").mkdir()
        environment = settings_for(folder / "state", postgres.url, bus.url, mosquitto)
        environment |= {"VIPO_MQTT_TLS": "0", "VIPO_LOG": "WARNING", "VIPO_DEFAULT_SITE": "hall"}
        environment["DJANGO_SETTINGS_MODULE"] = "vipo_site.settings"
        world = World(environment, mosquitto.port, postgres.url, bus.url)
        world.run("fill", str(DEVICES))
        yield world


def _measure_states(world: World, pace: float, first: int) -> dict[str, object]:
    """Let every device say its state `ROUNDS` times, `pace` messages a second in all."""
    with world.gateway() as process:
        ear, before, began = Ear(world.redis_url), world.kept(), cpu_seconds(process.pid)
        flow = Flow(world.mqtt_port, PASSWORD, DEVICES, ROUNDS, pace, first)
        seconds = flow.send()
        world.wait_last(flow.last)
        spent, fanned_out = cpu_seconds(process.pid) - began, ear.close()
    sent = DEVICES * ROUNDS
    facts = {"messages": sent, "offered_per_s": round(sent / seconds), "kept": world.kept() - before}
    return figure("states taken in", sent / spent, "per second and core", **facts, fanned_out=fanned_out)


def _measure_delays(world: World) -> Iterator[dict[str, object]]:
    """From a stranger's description to the message that browsers get, and from a command's row to the device."""
    with world.gateway():
        for said in world.run("delays", str(world.mqtt_port), PASSWORD):
            for name, quantile in (("p50", 0.5), ("p95", 0.95)):
                facts = {"tries": len(said["ms"]), "database": "durable"}
                yield figure(f"{said['what']}, {name}", share(said["ms"], quantile), "ms", **facts)


def _measure_peer(peer: Any) -> dict[str, object]:
    """Give a peer the same flow; it only reads the JSON, keeps the last of each device in memory and passes it on."""
    with ExitStack() as stack:
        folder = Path(stack.enter_context(tempfile.TemporaryDirectory()))
        mosquitto = stack.enter_context(run_mosquitto(folder, {"server": PASSWORD}))
        running = stack.enter_context(peer(folder, mosquitto.port, PASSWORD))
        if running.missing:
            return {"what": f"states taken in by {running.name}", "skipped": running.missing}
        began = cpu_seconds(running.pid)
        seconds = Flow(mosquitto.port, PASSWORD, DEVICES, ROUNDS, PACES[-1]).send()
        seen = running.wait_seen(DEVICES * ROUNDS, WAIT_S)
        spent = cpu_seconds(running.pid) - began
    facts = {"messages": seen, "offered_per_s": round(DEVICES * ROUNDS / seconds), "version": running.version}
    return figure(f"states taken in by {running.name}", seen / spent, "per second and core", **facts)
