"""node-wot, the W3C's client of the Web of Things, set upon a running VIPO."""

from __future__ import annotations

import json
import subprocess
from pathlib import Path
from typing import Any

import httpx

from tests.kit.node_packages import install_packages
from tests.kit.servers import find_program
from tests.kit.waiting import wait_for

HERE = Path(__file__).parent
SITE = "painting-factory"
FOUND = 10


def make_token(admin: httpx.Client, *scopes: str) -> str:
    """Make a token as its person does, and return its text."""
    admin.headers["X-CSRFToken"] = admin.get("/api/me").json()["csrf"]
    asked = {"name": "node-wot", "scopes": list(scopes), "days": 1}
    answer = admin.post(f"/api/sites/{SITE}/tokens", json=asked)
    assert answer.status_code == 201, answer.text
    return str(answer.json()["token"])


def wait_for_mixer(admin: httpx.Client) -> None:
    """Wait until all approved devices of the factory are there and its mixer has said how it is."""

    def is_there() -> bool:
        mixer = admin.get(f"/api/sites/{SITE}/things/paintMixer01/properties/jobStatus")
        return mixer.status_code == 200 and len(admin.get("/things").json()) >= FOUND

    wait_for("the mixer", is_there, 120, every_s=0.5)


def run_client(address: str, token: str, *, sse: bool, **asked: Any) -> list[dict[str, Any]]:
    """Let the client find the mixer, read it, observe it, and mix; return what it says, in its order."""
    install_packages(HERE)
    wanted = {
        "address": address,
        "token": token,
        "title": "Paint Mixer A",
        "property": "jobStatus",
        "action": "mixPaint",
        "input": {"time": 1},
        "sse": sse,
        **asked,
    }
    done = subprocess.run(
        [find_program("node"), "client.mjs", json.dumps(wanted)], cwd=HERE, capture_output=True, text=True, timeout=120
    )
    assert done.returncode == 0, done.stdout + done.stderr[-2000:]
    return [json.loads(line) for line in done.stdout.splitlines() if line.startswith("{")]


def check_story(said: list[dict[str, Any]]) -> None:
    """Hold what the client said against what it must: found, read, all, observed and answered, refused."""
    told = {name: [line[name] for line in said if name in line] for line in said for name in line}
    assert told.keys() == {"found", "read", "all", "observed", "answer", "refused"}
    (found,) = told["found"]
    assert len(found) == FOUND
    assert "Paint Mixer A" in found
    assert told["read"] == [told["all"][0]["jobStatus"]]
    assert told["all"][0].keys() == {"jobStatus", "temperature"}
    (answer,) = told["answer"]
    assert (answer["status"], answer["output"]) == ("completed", {})
    assert all(isinstance(value, int | float) for value in told["observed"])
    assert any(0 < value <= 100 for value in told["observed"])
    assert told["refused"][0].startswith("Client error")
