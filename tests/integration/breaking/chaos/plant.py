"""The servers and processes of a game, all real; what ends is started again, as a served site does it."""

from __future__ import annotations

import json
import signal
import subprocess
import sys
from collections.abc import Iterator
from contextlib import ExitStack, contextmanager, suppress
from dataclasses import asdict, dataclass, field
from pathlib import Path
from typing import Any

import psycopg

from tests.integration.breaking.chaos.clocks import shifted
from tests.integration.breaking.chaos.hall import PASSWORD, Game
from tests.kit.files import ROOT
from tests.kit.served import WORKER, served_without_broker
from tests.kit.servers import Mosquitto, Postgres, Redis, run_mosquitto, run_postgres, run_redis

HERE = "tests.integration.breaking.chaos"
SPARE = "spare"
"""The ovens' next process, which waits for its turn."""
CLOCKS_S = {"worker-2": 60, "gateway-2": -60, "load": 60}
"""Whose clock is wrong by how much."""


@dataclass
class Plant:
    """What runs; `faults` is the folder of armed points."""

    game: Game
    folder: Path
    postgres: Postgres
    redis: Redis
    mosquitto: Mosquitto
    parts: dict[str, list[str]]
    processes: dict[str, subprocess.Popen[bytes]] = field(default_factory=dict)
    restarts: dict[str, int] = field(default_factory=dict)
    wanted: int = 0
    _lines: list[dict[str, Any]] = field(default_factory=list)
    _read: int = 0

    @property
    def faults(self) -> Path:
        return self.folder / "faults"

    @property
    def log(self) -> Path:
        return self.folder / "devices.jsonl"

    def environment(self, name: str) -> dict[str, str]:
        told = served_without_broker(self.folder / "state", self.postgres.url, self.redis.url) | {
            "VIPO_MQTT_PORT": str(self.mosquitto.port),
            "VIPO_MQTT_TLS": "0",
            "VIPO_MQTT_PASSWORD": PASSWORD,
            "VIPO_GATEWAY": name,
            "VIPO_FAULTS": str(self.faults),
            "VIPO_LOG": "INFO",
            "PYTHONPATH": str(ROOT),
        }
        return told | (shifted(self.folder, CLOCKS_S[name]) if name in CLOCKS_S else {})

    def start(self, name: str) -> None:
        if name in self.processes:
            _close(self.processes[name])
        if name == "devices":
            self.processes[name] = self.processes.pop(SPARE) if SPARE in self.processes else self._begin(name)
            self.tell(name, "go")
            self.processes[SPARE] = self._begin(name)
            return
        self.processes[name] = self._begin(name)
        if name == "load" and self.wanted:
            self.allow(self.wanted)

    def _begin(self, name: str) -> subprocess.Popen[bytes]:
        with (self.folder / f"{name}.log").open("ab") as out:
            return subprocess.Popen(
                [sys.executable, *self.parts[name]], cwd=ROOT, env=self.environment(name), stdin=subprocess.PIPE,
                stdout=out, stderr=out,
            )  # fmt: skip

    def supervise(self) -> None:
        """Start again what has ended, but for the load that is through."""
        for name, process in list(self.processes.items()):
            code = process.poll()
            if code is not None and name != SPARE and not (name == "load" and code == 0):
                self.restarts[name] = self.restarts.get(name, 0) + 1
                self.start(name)

    def tell(self, name: str, line: str) -> None:
        pipe = self.processes[name].stdin
        assert pipe is not None
        with suppress(BrokenPipeError):
            pipe.write(f"{line}\n".encode())
            pipe.flush()

    def allow(self, runs: int) -> None:
        """Let so many runs have been started."""
        self.wanted = runs
        self.tell("load", str(runs))

    def allow_more(self) -> None:
        """Let one more run be started, if there is one and all that may have been is done."""
        ended = len({line["value"] for line in self.read_log() if line["is"] == "end"})
        if ended >= self.wanted * self.game.commands and self.wanted < self.game.runs:
            self.allow(self.wanted + 1)

    def signal(self, name: str, number: int) -> None:
        self.processes[name].send_signal(number)

    def is_frozen(self, name: str) -> bool:
        with suppress(OSError):
            return Path(f"/proc/{self.processes[name].pid}/stat").read_text().rpartition(")")[2].split()[0] == "T"
        return False

    def owner(self) -> str | None:
        """Return a worker that owns a site now."""
        pids = {process.pid: name for name, process in self.processes.items()}
        rows = self.ask("SELECT owner FROM execution_sitelease WHERE expires_at > now()")
        found = [pids.get(int(owner.split(":")[1])) for (owner,) in rows if owner]
        return next((name for name in found if name), None)

    def ask(self, sql: str) -> list[tuple[Any, ...]]:
        with psycopg.connect(self.postgres.url) as connection:
            return connection.execute(sql.encode()).fetchall()

    def read_log(self) -> list[dict[str, Any]]:
        """Return what the devices have done so far; it is read on from where it was read last."""
        if self.log.exists():
            with self.log.open("rb") as file:
                file.seek(self._read)
                whole, end, _ = file.read().rpartition(b"\n")
            self._read += len(whole) + len(end)
            self._lines += [json.loads(line) for line in whole.splitlines()]
        return self._lines

    def statuses(self) -> dict[int, str]:
        """Return the status of each run, with its reason; one that stands twice in the database says so."""
        found: dict[int, str] = {}
        for name, status, reason in self.ask("SELECT program_name, status, reason FROM execution_run"):
            run = int(name.removeprefix("Run "))
            said = f"{status}: {reason}" if reason else status
            found[run] = f"there twice: {found[run]}, {said}" if run in found else said
        return found

    def story(self) -> str:
        """Return the last lines of each process's log."""
        logs = sorted(self.folder.glob("*.log"))
        return "\n".join(f"--- {log.name}\n" + "\n".join(log.read_text().splitlines()[-20:]) for log in logs)


@contextmanager
def running_plant(folder: Path, game: Game) -> Iterator[Plant]:
    """Start everything for a game."""
    for part in ("state", "faults"):
        (folder / part).mkdir()
    with ExitStack() as stack:
        plant = Plant(
            game,
            folder,
            stack.enter_context(run_postgres(folder, keep_durable=True)),
            stack.enter_context(run_redis(folder)),
            stack.enter_context(run_mosquitto(folder, dict.fromkeys(("server", *game.all_devices), PASSWORD))),
            {},
        )
        told = json.dumps(asdict(game))
        load = ["-m", f"{HERE}.load", told]
        done = subprocess.run(
            [sys.executable, *load, "fill"], cwd=ROOT, env=plant.environment("setup"), capture_output=True, text=True
        )
        assert done.returncode == 0, done.stderr
        plant.parts = {
            "devices": ["-m", f"{HERE}.devices", str(plant.mosquitto.device_port), str(plant.log), told],
            **{name: [*WORKER, "-n", f"{name}@%h"] for name in ("worker-1", "worker-2")},
            **{name: ["manage.py", "gateway"] for name in ("gateway-1", "gateway-2")},
            "ticker": ["manage.py", "ticker"],
            "load": load,
        }
        stack.callback(_end, plant)
        for name in plant.parts:
            plant.start(name)
        yield plant


def _end(plant: Plant) -> None:
    for process in plant.processes.values():
        with suppress(ProcessLookupError):
            process.send_signal(signal.SIGCONT)
        process.kill()
    for process in plant.processes.values():
        process.wait()
        _close(process)


def _close(process: subprocess.Popen[bytes]) -> None:
    """Close the way to a process that has ended; what was not read by then is nobody's."""
    assert process.stdin is not None
    with suppress(BrokenPipeError):
        process.stdin.close()
