"""node-wot, the W3C's client of the Web of Things, set upon a running VIPO."""

from __future__ import annotations

import json
import os
import subprocess
import time
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
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


@dataclass(frozen=True)
class Observer:
    """node-wot as it observes over MQTT; `said` grows."""

    process: subprocess.Popen[str]
    out: Path

    def said(self, name: str) -> list[Any]:
        """Return what it has told under a name so far."""
        written = self.out.read_text().rpartition("\n")[0]  # the last line may still be under way
        lines = [json.loads(line) for line in written.splitlines() if line.startswith("{")]
        return [line[name] for line in lines if name in line]

    def wait(self, name: str) -> Any:
        """Return what it tells under a name first."""

        def ended() -> str:
            return "" if self.process.poll() is None else f"node ended with {self.process.returncode}"

        return wait_for(name, lambda: self.said(name), every_s=0.05, story=self.out.read_text, hopeless=ended)[0]

    def try_what_is_not_allowed(self) -> None:
        """Let the library under it come in by the same account, in its place, and try."""
        assert self.process.stdin
        self.process.stdin.write("now\n")
        self.process.stdin.flush()


def make_broker_token(admin: httpx.Client) -> dict[str, Any]:
    """Make a token that opens the broker, and return what its person is told."""
    admin.headers["X-CSRFToken"] = admin.get("/api/me").json()["csrf"]
    asked = {"name": "Dashboard", "scopes": ["read", "broker"], "days": 1}
    made: dict[str, Any] = admin.post(f"/api/sites/{SITE}/tokens", json=asked).json()
    return made


@contextmanager
def observing(address: str, made: dict[str, Any], folder: Path, authority: str = "") -> Iterator[Observer]:
    """Let node-wot observe the mixer at the broker, with a token as its person was told it."""
    install_packages(HERE)
    asked = {"address": address, "token": made["token"], "username": made["broker"]["username"]}
    wanted = json.dumps({**asked, "title": "Paint Mixer A", "property": "jobStatus"})
    out = folder / "observer.log"
    trust = {"NODE_EXTRA_CA_CERTS": authority} if authority else {}
    with out.open("w") as log:
        process = subprocess.Popen(
            [find_program("node"), "observer.mjs", wanted], cwd=HERE, env={**os.environ, **trust},
            stdin=subprocess.PIPE, stdout=log, stderr=log, text=True,
        )  # fmt: skip
        try:
            yield Observer(process, out)
        finally:
            process.kill()
            process.communicate()


def check_observer(admin: httpx.Client, address: str, folder: Path, authority: str = "") -> None:
    """Hold what node-wot hears over MQTT, and may do there, against what it must; then revoke its token."""
    made = make_broker_token(admin)
    with observing(address, made, folder, authority) as seen:
        seen.wait("observing")
        call = {"method": "mixPaint", "arguments": {"time": 1}}
        asked = admin.post(f"/api/sites/{SITE}/things/paintMixer01/actions/mixPaint", json=call["arguments"])
        assert asked.status_code in (200, 202), asked.text
        wait_for("values", lambda: any(0 < value <= 100 for value in seen.said("observed")), story=seen.out.read_text)
        assert all(isinstance(value, int | float) for value in seen.said("observed"))
        assert seen.said("error") == []
        seen.try_what_is_not_allowed()
        seen.wait("tried")
        assert [is_granted for _, is_granted in seen.said("granted")] == [False, False, False, True]
        time.sleep(1)
        assert seen.said("echo") == [], seen.out.read_text()
        since = time.time()
        assert admin.delete(f"/api/sites/{SITE}/tokens/{made['id']}").status_code == 204
        # how soon is held by tests/integration/wire/dashboards/test_ends.py
        wait_for("the end", lambda: [at for at in seen.said("closed") if at > since], story=seen.out.read_text)
        wait_for("the refusal", lambda: seen.said("refused"), story=seen.out.read_text)
