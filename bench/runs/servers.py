"""The servers of `bench.runs` and our own processes, as they are served."""

from __future__ import annotations

import json
import os
import subprocess
import sys
import tempfile
from collections.abc import Iterator
from contextlib import ExitStack
from pathlib import Path

from bench.flow import ROOT
from tests.kit.served import WORKER, served_without_broker
from tests.kit.servers import Mosquitto, Postgres, run_mosquitto, run_postgres, run_redis

PASSWORD = "the server's word"


def measure_on_servers() -> Iterator[dict[str, object]]:
    """Yield the figures that the load generator finds."""
    with tempfile.TemporaryDirectory() as name, ExitStack() as stack:
        folder = Path(name)
        folder.chmod(0o755)
        postgres = stack.enter_context(run_postgres(folder, keep_durable=True))
        redis = stack.enter_context(run_redis(folder))
        mosquitto = stack.enter_context(run_mosquitto(folder, {"server": PASSWORD}))
        environment = _environment(folder, postgres, redis.url, mosquitto)
        _run(environment, "manage.py", "migrate", "-v0", "--skip-checks")
        _run(environment, "-m", "bench.runs.load_generator", "fill")
        ours = {part: _start(stack, folder, environment, part, *command) for part, command in _PARTS.items()}
        assert postgres.process is not None
        pids = {**ours, "postgres": postgres.process.pid, "redis": redis.process.pid}
        story = _run(environment, "-m", "bench.runs.load_generator", "measure", json.dumps(pids))
        yield from map(json.loads, story.splitlines())


_PARTS = {
    "worker": (*WORKER, "--loglevel", "ERROR"),
    "gateway": ("manage.py", "gateway"),
    "ticker": ("manage.py", "ticker"),
}


def _environment(folder: Path, postgres: Postgres, redis: str, mosquitto: Mosquitto) -> dict[str, str]:
    state = folder / "state"
    state.mkdir()
    return served_without_broker(state, postgres.url, redis) | {
        "VIPO_MQTT_PORT": str(mosquitto.port),
        "VIPO_MQTT_TLS": "0",
        "VIPO_MQTT_PASSWORD": PASSWORD,
        "VIPO_LOG": os.environ.get("VIPO_LOG", "ERROR"),
        "PYTHONPATH": str(ROOT),
    }


def _run(environment: dict[str, str], *arguments: str) -> str:
    done = subprocess.run([sys.executable, *arguments], cwd=ROOT, env=environment, capture_output=True, text=True)
    if done.returncode:
        raise RuntimeError(done.stdout + done.stderr)
    return done.stdout


def _start(stack: ExitStack, folder: Path, environment: dict[str, str], part: str, *command: str) -> int:
    log = stack.enter_context((folder / f"{part}.log").open("wb"))
    process = subprocess.Popen([sys.executable, *command], cwd=ROOT, env=environment, stdout=log, stderr=log)
    stack.callback(process.wait)
    stack.callback(process.terminate)
    return process.pid
