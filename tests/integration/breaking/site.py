"""The painting factory of a running demo, as people, devices and its own database see it."""

from __future__ import annotations

import json
import re
import sqlite3
import subprocess
import sys
from contextlib import closing
from dataclasses import dataclass, field
from functools import cached_property
from typing import Any
from uuid import UUID

import httpx

from tests.kit.demo import Demo
from tests.kit.files import ROOT
from tests.kit.processes.forked import run_forked
from tests.kit.sign_in import open_page, sign_in
from tests.kit.waiting import wait_for

SLUG = "painting-factory"
OVER = ("finished", "failed", "cancelled")
PLANT = """
import json, sys, django
django.setup()
from editor import services
documents = json.load(sys.stdin)
print(json.dumps({n: str(services.create_program(site="painting-factory", name=n, document=d).id)
                  for n, d in documents.items()}))
"""


@dataclass
class Factory:
    """One running demo."""

    demo: Demo
    clients: list[httpx.Client] = field(default_factory=list)

    def stranger(self) -> httpx.Client:
        """A browser that has loaded the page and is not signed in."""
        client = open_page(self.demo.url)
        self.clients.append(client)
        return client

    def signed_in(self, role: str) -> httpx.Client:
        """A browser of the demo's admin or author."""
        account = self.demo.account(role)
        return sign_in(self.stranger(), account.email, account.password)

    @cached_property
    def admin(self) -> httpx.Client:
        return self.signed_in("admin")

    def close(self) -> None:
        for client in self.clients:
            client.close()

    def plant(self, documents: dict[str, Any]) -> dict[str, str]:
        """Write programs into the database; return their ids by name."""
        done = run_forked(
            [sys.executable, "-c", PLANT],
            input=json.dumps(documents).encode(),
            capture_output=True,
            cwd=ROOT,
            env={"VIPO_STATE_DIR": str(self.demo.state), "DJANGO_SETTINGS_MODULE": "vipo_site.settings"},
        )
        assert done.returncode == 0, done.stderr.decode()
        return dict(json.loads(done.stdout))

    def start(self, program: str) -> str:
        answer = self.admin.post(f"/api/programs/{program}/runs", json={})
        assert answer.status_code == 202, answer.text
        return str(answer.json()["id"])

    def run(self, run: str) -> dict[str, Any]:
        return dict(self.admin.get(f"/api/runs/{run}").json())

    def order(self, run: str, word: str, client: httpx.Client | None = None) -> httpx.Response:
        return (client or self.admin).post(f"/api/runs/{run}/{word}")

    def wait_run(self, run: str, *statuses: str, timeout_s: float = 90) -> dict[str, Any]:
        """Return the run once it has one of the statuses; a run that is over otherwise fails the test."""

        def look() -> dict[str, Any] | None:
            view = self.run(run)
            if view["status"] in statuses:
                return view
            assert view["status"] not in OVER, (view["status"], view["reason"], self.journal(run))
            return None

        return dict(wait_for(f"Run {statuses}", look, timeout_s))

    def journal(self, run: str) -> list[str]:
        return [event["text"] for event in self.admin.get(f"/api/runs/{run}/events").json()]

    def device(self, device: str) -> dict[str, Any]:
        return dict(self.admin.get(f"/api/sites/{SLUG}/devices/{device}").json())

    def reading(self, device: str, name: str) -> Any:
        return next(p["value"] for p in self.device(device)["properties"] if p["name"] == name)

    def history(self, device: str) -> list[str]:
        return [line["text"] for line in self.admin.get(f"/api/sites/{SLUG}/devices/{device}/events").json()]

    def poses(self) -> dict[str, tuple[float, float]]:
        devices = self.admin.get(f"/api/sites/{SLUG}/devices").json()
        return {d["id"]: (d["location"]["x"], d["location"]["y"]) for d in devices if d["kind"] == "robot"}

    def commands(self, run: str) -> list[dict[str, Any]]:
        """Return the commands of a run in the order in which they were decided, without pause, resume and cancel."""
        query = "select device, method, status, tries, why from execution_command where run = ? and method not in \
                 ('pause', 'resume', 'cancel') order by position"
        with closing(sqlite3.connect(f"file:{self.demo.state}/vipo.sqlite3?mode=ro", uri=True, timeout=20)) as database:
            rows = database.execute(query, (UUID(run).hex,)).fetchall()
        return [dict(zip(("device", "method", "status", "tries", "why"), row, strict=True)) for row in rows]

    def wait_command(self, run: str, method: str, *statuses: str, timeout_s: float = 60) -> None:
        wait_for(
            f"{method} {statuses}",
            lambda: any(c["method"] == method and c["status"] in statuses for c in self.commands(run)),
            timeout_s,
            every_s=0.03,
        )

    def wait_online(self, *devices: str) -> None:
        def all_there() -> bool:
            views = self.admin.get(f"/api/sites/{SLUG}/devices").json()
            there = {v["id"] for v in views if v["status"] not in ("offline", "pending")}
            return there.issuperset(devices)

        wait_for(f"{devices} online", all_there)

    @property
    def mqtt_port(self) -> int:
        found = re.search(r"mqtt://127\.0\.0\.1:(\d+)", self.demo.log.read_text())
        assert found, "the demo does not say its MQTT port"
        return int(found[1])

    def children(self) -> dict[str, int]:
        """Return the process ids of the demo's twin and firmware."""
        found = {}
        listing = subprocess.run(["ps", "-ewwo", "pid,ppid,args"], capture_output=True, text=True, check=True).stdout
        for line in listing.splitlines()[1:]:
            pid, parent, arguments = line.split(None, 2)
            if int(parent) == self.demo.process.pid:
                found["firmware" if "unix_main" in arguments else "twin"] = int(pid)
        return found


def complaints(log: str) -> list[str]:
    """Return what a person at the terminal should not have to read."""
    return [line for line in log.splitlines() if "Traceback" in line or " ERROR " in line or " CRITICAL " in line]
