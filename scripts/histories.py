"""Runs of a real site, kept as histories that the tests carry out again: record them, or write their decisions anew.

`python -m scripts.histories --record` starts the demo, runs its programs (each is paused and resumed, one is cancelled)
and writes each run as an archive into tests/cases/histories/. Without `--record` only decisions.json is written anew,
which is meant for a change of the machine that shall decide something else: the difference is for review.
"""

from __future__ import annotations

import argparse
import json
import os
import subprocess
import sys
import tempfile
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import httpx

from tests.cases.histories import FOLDER, decisions_of
from tests.kit.demo import Demo, running_demo
from tests.kit.files import ROOT
from tests.kit.waiting import wait_for

PROGRAMS = (
    *("parallel-by-two-robots", "try-and-catch", "while-and-if", "wait-for-a-time-and-a-condition"),
    *("function-with-a-parameter", "pick-drop-and-moves", "operators-and-brackets"),
)
"""Of tests/fixtures/programs, beside those that the demo has."""
LONG = "Paint order"
SITE, DEVICES = "/api/sites/painting-factory", 10
RUN_LIMIT_S = 900.0
OVER = {"finished", "failed", "cancelled"}
WRITE = """
import os
from datetime import UTC, datetime
from pathlib import Path
from execution.archive.history_file import Header, write_section
from execution.archive.rows import lines_of_run
from execution.models import Run
for run in Run.objects.select_related("site").order_by("number"):
    name = f"{run.number:02}-{run.program_name.lower().replace(' ', '-')}-{run.status}.jsonl.gz"
    with (Path(os.environ["HISTORIES"]) / name).open("wb") as file:
        header = Header("run", run.site.slug, str(run.id), datetime.now(UTC).isoformat())
        write_section(file, header, lines_of_run(run))
"""


def main() -> None:
    """Do what the command line asks for."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--record", action="store_true", help="run the demo's programs and keep their histories")
    if parser.parse_args().record:
        with tempfile.TemporaryDirectory() as folder, running_demo(Path(folder), 20) as demo:
            carry_out(demo)
            write_histories(demo)
    decisions = {file.name: decisions_of(file) for file in sorted(FOLDER.glob("*.jsonl.gz"))}
    (FOLDER / "decisions.json").write_text(json.dumps(decisions, indent=1) + "\n")
    print(f"{len(decisions)} runs, {sum(map(len, decisions.values()))} decisions")  # noqa: T201 - a command speaks so


def carry_out(demo: Demo) -> None:
    """Run all programs that nothing speaks against, one after the other."""
    with signed_in(demo) as client:
        wait_for("the devices", lambda: are_here(client), 120)
        for name in PROGRAMS:
            make_program(client, name)
        programs = sorted(client.get(f"{SITE}/programs").json(), key=lambda program: program["name"] != LONG)
        long = next(program["id"] for program in programs if program["name"] == LONG)
        for program in programs:
            answer = client.post(f"/api/programs/{program['id']}/runs", json={})
            if answer.status_code != 202:
                continue
            run = answer.json()["id"]
            wait_for("its start", lambda run=run: state_of(client, run) != "pending", 60)
            if client.post(f"/api/runs/{run}/pause").is_success:  # a short one is over
                client.post(f"/api/runs/{run}/resume").raise_for_status()
            wait_for("its end", lambda run=run: state_of(client, run) in OVER, RUN_LIMIT_S)
        last = client.post(f"/api/programs/{long}/runs", json={}).json()["id"]
        wait_for("its start", lambda: state_of(client, last) == "running", 60)
        client.post(f"/api/runs/{last}/cancel").raise_for_status()
        wait_for("its end", lambda: state_of(client, last) in OVER, RUN_LIMIT_S)


def make_program(client: httpx.Client, name: str) -> None:
    """Make a program of a fixture."""
    made = client.post(f"{SITE}/programs", json={"name": name}).raise_for_status().json()["id"]
    document = json.loads((ROOT / "tests/fixtures/programs" / f"{name}.json").read_text())["document"]
    path = f"/api/programs/{made}/document"
    tag = client.get(path).raise_for_status().headers["ETag"]
    client.put(path, json=document, headers={"If-Match": tag}).raise_for_status()


@contextmanager
def signed_in(demo: Demo) -> Iterator[httpx.Client]:
    """Give a client that an author has signed in with."""
    account = demo.account("author")
    with httpx.Client(base_url=demo.url, timeout=30) as client:
        client.headers["X-CSRFToken"] = client.get("/api/me").json()["csrf"]
        answer = client.post("/api/sign-in", json={"email": account.email, "password": account.password})
        client.headers["X-CSRFToken"] = answer.raise_for_status().json()["csrf"]
        yield client


def are_here(client: httpx.Client) -> bool:
    """Tell whether every device of the demo is idle."""
    return sum(device["status"] == "idle" for device in client.get(f"{SITE}/devices").json()) >= DEVICES


def state_of(client: httpx.Client, run: Any) -> str:
    """Return how a run is."""
    return str(client.get(f"/api/runs/{run}").json()["status"])


def write_histories(demo: Demo) -> None:
    """Write all runs of the demo as archives in place of those of before."""
    for old in FOLDER.glob("*.jsonl.gz"):
        old.unlink()
    command = [sys.executable, "manage.py", "shell", "--verbosity", "0", "-c", WRITE]
    environment = {**os.environ, "VIPO_STATE_DIR": str(demo.state), "HISTORIES": str(FOLDER)}
    environment.pop("DJANGO_SETTINGS_MODULE", None)
    subprocess.run(command, cwd=ROOT, env=environment, check=True)  # noqa: S603 - our own program


if __name__ == "__main__":
    main()
