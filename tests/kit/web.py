"""A real server: the whole application in Daphne, on a port of its own, with a database of its own."""

from __future__ import annotations

import json
import os
import subprocess
import sys
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import httpx

from tests.kit.files import ROOT, copy_migrated
from tests.kit.processes.forked import ForkedPython, run_forked
from tests.kit.servers import answers, free_port, wait_ready
from tests.kit.waiting import wait_for


@dataclass
class Web:
    """A running server; `sessions` are cookies by person."""

    folder: Path
    sessions: dict[str, str]
    program: str
    extra: dict[str, str] = field(default_factory=dict)
    port: int = field(default_factory=free_port)
    process: subprocess.Popen[bytes] | None = None

    def start(self) -> None:
        with (self.folder / f"web-{self.port}.log").open("ab") as log:
            self.process = ForkedPython(
                [sys.executable, "-m", "tests.kit.web_process", str(self.port)],
                cwd=ROOT, env=environment(self.folder, self.extra), stdout=log, stderr=log,
            )  # fmt: skip
        wait_ready(lambda: answers(self.port), self.story, self.process)

    def kill(self) -> None:
        assert self.process is not None
        self.process.kill()
        self.process.wait()

    def story(self) -> str:
        return (self.folder / f"web-{self.port}.log").read_text()

    def socket_url(self, program: str | None = None) -> str:
        return f"ws://127.0.0.1:{self.port}/ws/program/{program or self.program}"

    def headers(self, person: str | None) -> dict[str, str]:
        cookie = {"Cookie": f"sessionid={self.sessions[person]}"} if person else {}
        return {"Origin": f"http://127.0.0.1:{self.port}", **cookie}

    @contextmanager
    def client(self, person: str | None) -> Iterator[httpx.Client]:
        """Return an HTTP client of that person, with the token that changes need."""
        cookies = {"sessionid": self.sessions[person]} if person else {}
        with httpx.Client(base_url=f"http://127.0.0.1:{self.port}/api", cookies=cookies, timeout=60) as client:
            client.headers["X-CSRFToken"] = client.get("/me").json()["csrf"]
            yield client

    def new_program(self, name: str = "Another") -> str:
        with self.client("author") as client:
            answer = client.post("/sites/hall/programs", json={"name": name})
        assert answer.status_code == 201, answer.text
        return str(answer.json()["id"])

    def wait_for_document(self, program: str, wanted: dict[str, Any]) -> None:
        """Wait until the steps of the stored document are these."""
        with self.client("viewer") as client:

            def steps() -> Any:
                return client.get(f"/programs/{program}/document").json()["steps"]

            wait_for(f"{wanted}", lambda: steps() == wanted, every_s=0.05, story=lambda: f"there are {steps()}")


def environment(folder: Path, extra: dict[str, str]) -> dict[str, str]:
    return {**os.environ, "VIPO_STATE_DIR": str(folder), "DJANGO_SETTINGS_MODULE": "tests.settings", **extra}


def prepare(folder: Path, extra: dict[str, str]) -> dict[str, Any]:
    """Make what is in the database, and the database itself where it is SQLite's."""
    if "VIPO_DATABASE_URL" not in extra:
        copy_migrated(folder / "vipo.sqlite3")
    prepared: dict[str, Any] = _ask(folder, extra, "prepare")
    return prepared


def make_people(folder: Path, extra: dict[str, str], role: str, count: int) -> list[str]:
    """Make so many more people of the first site; return their sessions."""
    sessions: list[str] = _ask(folder, extra, "people", role, str(count))
    return sessions


def _ask(folder: Path, extra: dict[str, str], *arguments: str) -> Any:
    made = run_forked(
        [sys.executable, "-m", "tests.kit.web_process", *arguments],
        cwd=ROOT, env=environment(folder, extra), capture_output=True, text=True,
    )  # fmt: skip
    assert made.returncode == 0, made.stderr
    return json.loads(made.stdout)
