"""The others that get the same flow of states, or carry the same steps out: a bare paho loop, and Node-RED."""

from __future__ import annotations

import json
import shutil
import subprocess
import sys
import time
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path

from tests.kit.servers import free_port

PEERS = Path(__file__).resolve().parent
TOPIC = "vipo/v1/dev/+/up/state"
START_LIMIT_S = 60


@dataclass
class Running:
    """A peer that runs; it writes how many messages it has seen into a file."""

    name: str
    version: str = ""
    pid: int = 0
    counter: Path | None = None
    missing: str = ""

    def seen(self) -> int:
        """Return how many messages it says it has seen; -1 before it is connected."""
        try:
            return int(self.counter.read_text()) if self.counter else -1
        except (OSError, ValueError):
            return -1

    def wait_seen(self, count: int, timeout_s: float) -> int:
        """Wait until it has seen that many, and return how many it has seen."""
        deadline = time.monotonic() + timeout_s
        while self.seen() < count and time.monotonic() < deadline:
            time.sleep(0.1)
        return self.seen()


@contextmanager
def bare_loop(folder: Path, port: int, password: str) -> Iterator[Running]:
    """Run paho with a callback that reads the JSON and keeps it."""
    counter = folder / "seen"
    command = [sys.executable, str(PEERS / "bare_loop.py"), str(port), password, TOPIC, str(counter)]
    with _process(command, Running("a bare paho loop", "paho 2.2", counter=counter)) as running:
        yield running


@contextmanager
def node_red(folder: Path, port: int, password: str, flow: list[dict[str, object]] | None = None) -> Iterator[Running]:
    """Run Node-RED with a flow, by default one that reads the JSON, keeps it and passes it on to a WebSocket.

    Its sockets send at once, as those of ours do; by itself it leaves Nagle's algorithm on.
    """
    running = Running("Node-RED", counter=folder / "seen", missing=what_is_missing("node-red"))
    if running.missing:
        yield running
        return
    running.version = json.loads((PEERS / "node_modules" / "node-red" / "package.json").read_text())["version"]
    (folder / "flows.json").write_text(json.dumps(flow or _flow(folder / "seen", port)))
    (folder / "flows_cred.json").write_text(json.dumps({"broker": {"user": "server", "password": password}}))
    (folder / "settings.js").write_text(
        f"module.exports = {{ uiHost: '127.0.0.1', uiPort: {free_port()}, credentialSecret: false,"
        " httpAdminRoot: false, flowFile: 'flows.json', logging: { console: { level: 'warn' } } };"
    )
    script = PEERS / "node_modules" / "node-red" / "red.js"
    command = [
        "node",
        "--require",
        str(PEERS / "send_at_once.cjs"),
        str(script),
        "--userDir",
        str(folder),
        "--settings",
        str(folder / "settings.js"),
    ]
    with _process(command, running) as started:
        yield started


def what_is_missing(package: str) -> str:
    """Install the peers from npm where they are not yet; return what keeps one from being there."""
    if shutil.which("node") is None or shutil.which("npm") is None:
        return "Node and npm are not installed."
    if (PEERS / "node_modules" / package).exists():
        return ""
    command = ["npm", "ci", "--no-audit", "--no-fund", "--loglevel=error"]
    done = subprocess.run(command, check=False, cwd=PEERS, capture_output=True, text=True)
    return "" if done.returncode == 0 else f"npm could not install it: {done.stderr.strip()[-200:]}"


@contextmanager
def _process(command: list[str], running: Running) -> Iterator[Running]:
    with subprocess.Popen(command, stdout=subprocess.DEVNULL) as process:
        try:
            running.pid = process.pid
            deadline = time.monotonic() + START_LIMIT_S
            while running.seen() < 0:
                if process.poll() is not None or time.monotonic() > deadline:
                    running.missing = f"{running.name} did not start."
                    break
                time.sleep(0.1)
            yield running
        finally:
            process.kill()


def steps_flow(counter: Path, port: int, topics: str, steps: int) -> list[dict[str, object]]:
    """Return a flow that answers each answer of a device with its next command, `steps` times; it keeps nothing."""
    next_one = (
        "const d = msg.topic.split('/')[3]; const t = context.get('t') || {}; const n = t[d] || 0;"
        f" if (n >= {steps}) return null; t[d] = n + 1; context.set('t', t);"
        f" return {{ topic: '{topics}/' + d + '/down/heat',"
        " payload: { id: RED.util.generateId(), v: { value: 1 } } };"
    )
    tab, broker, *_, tick, count, write = _flow(counter, port)
    return [
        tab, broker, tick, count, write,
        {
            "id": "s0", "z": "tab", "type": "mqtt in", "topic": f"{topics}/+/up/ack", "qos": "1", "datatype": "json",
            "broker": "broker", "inputs": 0, "wires": [["s1"]],
        },
        {"id": "s1", "z": "tab", "type": "function", "func": next_one, "outputs": 1, "wires": [["s2"]]},
        {
            "id": "s2", "z": "tab", "type": "mqtt out", "topic": "", "qos": "1", "retain": "false", "broker": "broker",
            "wires": [],
        },
    ]  # fmt: skip


def _flow(counter: Path, port: int) -> list[dict[str, object]]:
    """MQTT in with JSON, each device's last state kept, out to a WebSocket; twice a second the count is written."""
    keep = "const s = context.get('s') || {}; s[msg.topic] = msg.payload; context.set('s', s);"
    count = "flow.set('n', (flow.get('n') || 0) + 1); return msg;"
    return [
        {"id": "tab", "type": "tab", "label": "bench"},
        {
            "id": "broker", "type": "mqtt-broker", "broker": "127.0.0.1", "port": str(port), "clientid": "node-red",
            "autoConnect": True, "usetls": False, "protocolVersion": "4", "keepalive": "60", "cleansession": True,
        },
        {"id": "ws", "type": "websocket-listener", "path": "/ws/states", "wholemsg": "false"},
        {
            "id": "n0", "z": "tab", "type": "mqtt in", "topic": TOPIC, "qos": "1", "datatype": "json",
            "broker": "broker", "inputs": 0, "wires": [["n1"]],
        },
        {"id": "n1", "z": "tab", "type": "function", "func": f"{keep} {count}", "outputs": 1, "wires": [["n2"]]},
        {"id": "n2", "z": "tab", "type": "websocket out", "server": "ws", "client": "", "wires": []},
        {
            "id": "n3", "z": "tab", "type": "inject", "repeat": "0.5", "once": True, "onceDelay": "3",
            "props": [{"p": "payload"}], "payload": "0", "payloadType": "num", "wires": [["n4"]],
        },
        {
            "id": "n4", "z": "tab", "type": "function", "outputs": 1,
            "func": "msg.payload = String(flow.get('n') || 0); return msg;",
            "wires": [["n5"]],
        },
        {
            "id": "n5", "z": "tab", "type": "file", "filename": str(counter), "filenameType": "str",
            "appendNewline": False, "overwriteFile": "true", "encoding": "none", "wires": [[]],
        },
    ]  # fmt: skip
