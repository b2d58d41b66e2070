"""The servers under measurement, each started as its own documentation says; ours in one process and in two."""

from __future__ import annotations

import os
import subprocess
import sys
from collections.abc import Callable, Iterator
from contextlib import ExitStack, contextmanager
from dataclasses import dataclass, field
from pathlib import Path

from bench.blockly import PEERS
from tests.kit.files import ROOT
from tests.kit.served import served_without_broker
from tests.kit.servers import answers, find_program, free_port, run_postgres, run_redis
from tests.kit.waiting import wait_for
from tests.kit.web import Web, environment, make_people, prepare

AUTHORS, VIEWERS = 30, 60


@dataclass
class Server:
    """A running server; `people` are sessions, those who may draw first. `webs` are our processes, if it is ours."""

    name: str
    ports: list[int]
    path: str
    processes: Callable[[], list[int]]
    people: list[str] = field(default_factory=list)
    webs: list[Web] = field(default_factory=list)

    def new_room(self, name: str) -> str:
        """Return the name of an empty room."""
        return self.webs[0].new_program(name) if self.webs else name

    def cpu_s(self) -> float:
        """Return the time that its processes have been at work."""
        return sum(_cpu_s(process) for process in self.processes())

    def memory_mb(self) -> float:
        """Return what its processes hold in memory."""
        pages = (int(Path(f"/proc/{process}/statm").read_text().split()[1]) for process in self.processes())
        return sum(pages) * os.sysconf("SC_PAGE_SIZE") / 1e6


def _cpu_s(process: int) -> float:
    fields = Path(f"/proc/{process}/stat").read_text().rpartition(")")[2].split()
    return (int(fields[11]) + int(fields[12])) / os.sysconf("SC_CLK_TCK")


@contextmanager
def ours(folder: Path, count: int) -> Iterator[Server]:
    """Run one web process with SQLite, as the demo does, or several over PostgreSQL and Redis."""
    with ExitStack() as stack:
        extra: dict[str, str] = {}
        if count > 1:
            postgres, redis = stack.enter_context(run_postgres(folder)), stack.enter_context(run_redis(folder))
            told = served_without_broker(folder, postgres.url, redis.url)
            extra = {name: value for name, value in told.items() if name.startswith("VIPO_")}
            migrate = [sys.executable, "manage.py", "migrate", "--verbosity", "0"]
            subprocess.run(migrate, check=True, cwd=ROOT, env=environment(folder, extra))
        made = prepare(folder, extra)
        people = make_people(folder, extra, "author", AUTHORS) + make_people(folder, extra, "viewer", VIEWERS)
        webs = [Web(folder, **made, extra=extra) for _ in range(count)]
        for web in webs:
            web.start()
            stack.callback(web.kill)
        yield Server(
            "VIPO" if count == 1 else f"VIPO, {count} processes",
            [web.port for web in webs], "/ws/program", lambda: [_id(web.process) for web in webs], people, webs,
        )  # fmt: skip


def _id(process: subprocess.Popen[bytes] | None) -> int:
    assert process is not None
    return process.pid


@contextmanager
def peer(name: str) -> Iterator[Server]:
    """Run `@y/websocket-server` or `@hocuspocus/server`, without storing anything."""
    port = free_port()
    own = {"HOST": "127.0.0.1", "PORT": str(port)}
    script = "node_modules/@y/websocket-server/src/server.js" if name == "y-websocket" else "hocuspocus.mjs"
    with subprocess.Popen(
        [find_program("node"), PEERS / script], cwd=PEERS, env={**os.environ, **own}, stdout=subprocess.DEVNULL
    ) as process:
        try:
            wait_for(f"{name} to answer", lambda: answers(port))
            yield Server(name, [port], "", lambda: [process.pid])
        finally:
            process.kill()
