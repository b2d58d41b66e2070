"""The firmware's client on MicroPython, 112 kB of heap: 70,000 messages at QoS 1, past the end of the packet ids."""

from __future__ import annotations

import json
import subprocess
import tempfile
from collections.abc import Iterator
from pathlib import Path

from bench.figures import figure
from tests.firmware.rig import FIRMWARE, HEAP
from tests.kit.files import ROOT
from tests.kit.mqtt import Ear
from tests.kit.servers import run_mosquitto
from tests.kit.waiting import wait_for
from vipo_site.demo.firmware_process import find_micropython

COUNT = 70_000
LIMIT_S = 600


def measure() -> Iterator[dict[str, object]]:
    micropython, why = find_micropython(ROOT / "var")
    if micropython is None:
        yield {"what": "firmware's soak", "skipped": why}
        return
    with (
        tempfile.TemporaryDirectory() as folder,
        run_mosquitto(Path(folder), {"server": "secret", "soak": "soaked"}) as mosquitto,
        Ear(mosquitto.port, "secret", "vipo/v1/dev/soak/up/ack") as ear,
    ):
        told = run_soak(micropython, mosquitto.device_port)
        wait_for("every message", lambda: len(ear.heard) >= COUNT, LIMIT_S)
        heard = [int(message.payload) for message in ear.heard]
    in_order = heard == list(range(COUNT))
    yield figure("firmware: messages acknowledged", COUNT / told["seconds"], "1/s", in_order=in_order, **told)


def run_soak(micropython: str, port: int) -> dict[str, float]:
    """Send the messages and return what the program says of it."""
    done = subprocess.run(
        [micropython, *HEAP, str(ROOT / "tests" / "firmware" / "soak.py"), str(port), str(COUNT), "1"],
        env={"MICROPYPATH": f"{FIRMWARE / 'lib'}:.frozen", "PATH": "/usr/bin:/bin"},
        capture_output=True,
        text=True,
        timeout=LIMIT_S,
        check=True,
    )
    told: dict[str, float] = json.loads(done.stdout)
    return told
