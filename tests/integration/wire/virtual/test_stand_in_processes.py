"""Two processes of stand-ins, of which one is frozen, and then the other killed in the middle of a job."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
import time
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

import pytest

from execution.models import Command, Lease
from execution.stand_ins.switches import simulate_device
from registry import services
from registry.models import Device
from tests.integration.wire.bus import SERVER_WORD, SITE, Bus
from tests.integration.wire.virtual.mixer import MIXER, Mixer, is_over, tell
from tests.kit.processes.forked import ForkedPython
from tests.kit.waiting import wait_for
from vipo_device.protocol.credentials import own_key
from vipo_device.protocol.topics import STAND_INS

pytestmark = [pytest.mark.servers, pytest.mark.parametrize("bus", ["mosquitto"], indirect=True)]


@contextmanager
def process(bus: Bus, folder: Path, speed: int) -> Iterator[subprocess.Popen[bytes]]:
    """Run `manage.py stand_ins` on the test's database and broker."""
    kept = {name: value for name, value in os.environ.items() if not name.startswith(("VIPO_", "DJANGO_"))}
    told = {**kept, "VIPO_STATE_DIR": str(folder), "VIPO_MQTT_PORT": str(bus.server_port)}
    command = [sys.executable, "manage.py", "stand_ins", "--speed", str(speed)]
    with (folder / "stand-ins.log").open("ab") as log:
        running = ForkedPython(command, env=told, stdout=log, stderr=log)
    try:
        yield running
    finally:
        running.send_signal(signal.SIGCONT)
        running.kill()
        running.wait(20)


def holder() -> str:
    return "".join(Lease.objects.filter(name="stand-ins").values_list("holder", flat=True))


def starts() -> int:
    return Device.objects.get(pk=MIXER).boot


def test_one_is_frozen_and_the_other_killed_and_each_command_is_done(bus: Bus, mixer: Mixer, tmp_path: Path) -> None:
    (tmp_path / "secrets").mkdir(exist_ok=True)
    (tmp_path / "secrets" / "mqtt-server").write_text(SERVER_WORD)
    wait_for("the account", lambda: bus.lets_in(STAND_INS, own_key(STAND_INS, SERVER_WORD)))
    with process(bus, tmp_path, 10) as first:
        wait_for("the first", holder, 30)
        simulate_device(site=SITE, device_id=MIXER, simulated=True, by=None)
        wait_for("its word", lambda: services.get_device(site=SITE, device_id=MIXER).online, 30)
        one, began = holder(), starts()
        with process(bus, tmp_path, 10) as second:
            job = tell(stand_in=True, time=1)  # six seconds
            wait_for("the job", lambda: Command.objects.get(pk=job).status == "running")
            first.send_signal(signal.SIGSTOP)
            wait_for("the second", lambda: holder() != one, 40)
            wait_for("its word", lambda: starts() > began, 40)
            first.send_signal(signal.SIGCONT)
            wait_for("the end of the job", lambda: is_over(job), 60)
            other, again = holder(), starts()
            time.sleep(3)
            assert (holder(), starts()) == (other, again), "who wakes gives way"
            job = tell(stand_in=True, time=1)
            wait_for("the next job", lambda: Command.objects.get(pk=job).status == "running")
            second.kill()
            wait_for("the first again", lambda: holder() != other, 40)
            wait_for("the end of the next job", lambda: is_over(job), 60)
    assert mixer.heard == 0
