"""Virtual vehicles and the connector, each in a process of its own, between two real brokers."""

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

from tests.bus import Ear, Heard
from tests.integration.connectors.factsheet import FACTSHEET
from tests.servers import ROOT, Mosquitto, answers, find_program, free_port, wait_until

HERE = Path(__file__).parent
MANUFACTURER = "Acme"
PATIENCE_S = 60.0


def install_library() -> None:
    """Install the virtual vehicle's library, as its lock file says, if it is not there."""
    if not (HERE / "node_modules" / "vda-5050-lib").exists():
        npm = [find_program("npm"), "ci", "--no-audit", "--no-fund", "--loglevel=error"]
        subprocess.run(npm, cwd=HERE, check=True)


@contextmanager
def run_plain_broker(folder: Path) -> Iterator[int]:
    """Run the vehicles' broker, which lets anybody in; returns its port."""
    port = free_port()
    root = "user root\n" if os.geteuid() == 0 else ""
    (folder / "vehicles.conf").write_text(f"listener {port} 127.0.0.1\nallow_anonymous true\n{root}")
    log = folder / "vehicles.log"
    with log.open("ab") as out:
        program = find_program("mosquitto", "/usr/sbin/mosquitto")
        process = subprocess.Popen([program, "-c", folder / "vehicles.conf"], stdout=out, stderr=out)
    try:
        wait_until(lambda: answers(port), log.read_text, process)
        yield port
    finally:
        process.terminate()
        process.wait(10)


class VirtualVehicle:
    """A vehicle of vda-5050-lib."""

    def __init__(self, port: int, serial: str, **more: Any) -> None:
        place = {"x": 1.0, "y": 2.0, "speed": 0.5, "timeLapse": 4, "factsheet": FACTSHEET, "tells": True}
        config = {"port": port, "manufacturer": MANUFACTURER, "serial": serial, **place, **more}
        self.process = subprocess.Popen(
            [find_program("node"), HERE / "vehicle.mjs", json.dumps(config)],
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            text=True,
        )
        assert self.process.stdout is not None
        assert self.process.stdout.readline() == "ready\n"

    def tell(self, do: str, **more: Any) -> None:
        assert self.process.stdin is not None
        self.process.stdin.write(json.dumps({"do": do, **more}) + "\n")
        self.process.stdin.flush()

    def kill(self) -> None:
        self.process.kill()
        self.process.wait(10)
        assert self.process.stdin is not None
        assert self.process.stdout is not None
        self.process.stdin.close()
        self.process.stdout.close()


@dataclass
class Connector:
    """The connector's process; started again, it finds what it kept."""

    folder: Path
    vipo: Mosquitto
    vehicles_port: int
    process: subprocess.Popen[bytes] | None = None
    more: dict[str, str] = field(default_factory=dict)

    def start(self) -> None:
        (self.folder / "secrets").mkdir(exist_ok=True)
        (self.folder / "secrets" / "devices.json").write_text(json.dumps(self.vipo.accounts))
        (self.folder / "secrets" / "join").write_text(self.vipo.accounts["join:hall"])
        environment = {
            **os.environ,
            "DJANGO_SETTINGS_MODULE": "vipo_site.settings",
            "VIPO_MODE": "embedded",
            "VIPO_STATE_DIR": str(self.folder),
            "VIPO_MQTT_PORT": str(self.vipo.device_port),
        }
        command = [sys.executable, "manage.py", "vda5050", "--site", "hall"]
        command += ["--broker", f"mqtt://127.0.0.1:{self.vehicles_port}"]
        with self.log.open("ab") as out:
            self.process = subprocess.Popen(command, cwd=ROOT, env=environment, stdout=out, stderr=out)

    @property
    def log(self) -> Path:
        return self.folder / "connector.log"

    def kill(self) -> None:
        assert self.process is not None
        self.process.kill()
        self.process.wait(10)

    def stop(self) -> int:
        assert self.process is not None
        self.process.terminate()
        return self.process.wait(20)


@dataclass
class Server:
    """The server's side of one vehicle's device: tells commands, waits for answers and states."""

    ear: Ear
    device: str

    def tell(self, method: str, command: str, /, **values: Any) -> None:
        body = {"id": command, "v": values, "ttl_s": 30}
        self.ear.say(f"vipo/v1/dev/{self.device}/down/{method}", body)

    def up(self, kind: str) -> str:
        return f"vipo/v1/dev/{self.device}/up/{kind}"

    def wait_ack(self, command: str, *status: str) -> dict[str, Any]:
        def fits(heard: Heard) -> bool:
            if heard.topic != self.up("ack") or heard.json["id"] != command:
                return False
            return heard.json["st"] in (status or ("DONE", "FAILED", "REJECTED", "CANCELED"))

        found: dict[str, Any] = self.ear.wait(fits, PATIENCE_S).json
        return found

    def wait_presence(self, said: str) -> None:
        self.ear.wait(lambda h: h.topic == self.up("presence") and h.json["s"] == said, PATIENCE_S)

    def wait_state(self, **wanted: Any) -> dict[str, Any]:
        def fits(heard: Heard) -> bool:
            if heard.topic != self.up("state"):
                return False
            body = {**heard.json["props"], **heard.json}
            return all(body.get(key) == value for key, value in wanted.items())

        found: dict[str, Any] = self.ear.wait(fits, PATIENCE_S).json
        return found

    def states(self) -> list[dict[str, Any]]:
        return [h.json for h in self.ear.all("/state") if h.topic == self.up("state")]

    def acks(self, command: str) -> list[str]:
        said = [h.json for h in self.ear.all("/ack") if h.topic == self.up("ack")]
        return [body["st"] for body in said if body["id"] == command]
