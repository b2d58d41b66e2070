"""Virtual vehicles and the connector, each in a process of its own, between two real brokers."""

from __future__ import annotations

import json
import os
import subprocess
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

from tests.integration.connectors.connector_process import ConnectorProcess
from tests.integration.connectors.factsheet import FACTSHEET
from tests.kit.node_packages import install_packages
from tests.kit.servers import Mosquitto, answers, find_program, free_port, wait_ready

HERE = Path(__file__).parent
MANUFACTURER = "Acme"


def install_library() -> None:
    """Install the virtual vehicle's library, as its lock file says, if it is not there."""
    install_packages(HERE)


@contextmanager
def run_plain_broker(folder: Path) -> Iterator[int]:
    """Run the vehicles' broker, which lets anybody in; returns its port."""
    port = free_port()
    root = "user root\n" if os.geteuid() == 0 else ""
    (folder / "vehicles.conf").write_text(
        f"listener {port} 127.0.0.1\nallow_anonymous true\nset_tcp_nodelay true\n{root}"
    )
    log = folder / "vehicles.log"
    with log.open("ab") as out:
        program = find_program("mosquitto", "/usr/sbin/mosquitto")
        process = subprocess.Popen([program, "-c", folder / "vehicles.conf"], stdout=out, stderr=out)
    try:
        wait_ready(lambda: answers(port), log.read_text, process)
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


class Connector(ConnectorProcess):
    """The connector of the vehicles; started again, it finds what it kept."""

    def __init__(self, folder: Path, vipo: Mosquitto, vehicles_port: int) -> None:
        super().__init__(folder, vipo, ("vda5050", "--broker", f"mqtt://127.0.0.1:{vehicles_port}"))
        self.vehicles_port = vehicles_port

    def start(self) -> None:
        super().start({"join": self.vipo.accounts["join:hall"]})
