"""The commands that run beside a VIPO, where there is none."""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path

from registry.demo.devices import DEVICES

MIXER = DEVICES / "paintMixer02.ttl"


def test_without_a_database_it_is_said_what_to_set(tmp_path: Path) -> None:
    environment = {**os.environ, "VIPO_STATE_DIR": str(tmp_path), "VIPO_MODE": "embedded"}
    command = [sys.executable, "-m", "vipo_site.cli.main", "devices"]
    done = subprocess.run(command, env=environment, capture_output=True, text=True, timeout=120)
    assert (done.returncode, done.stdout) == (2, "")
    assert done.stderr == (
        "VIPO's database cannot be used: no such table: registry_site. Run this with the settings of the VIPO that is "
        f"running (of the demo VIPO_STATE_DIR, which is '{tmp_path}' now), and start that once after an update.\n"
    )


def test_a_setting_that_is_missing_is_named(tmp_path: Path) -> None:
    environment = {**os.environ, "VIPO_STATE_DIR": str(tmp_path), "VIPO_MODE": "served"}
    environment.pop("VIPO_SECRET_KEY", None)
    command = [sys.executable, "-m", "vipo_site.cli.main", "devices"]
    done = subprocess.run(command, env=environment, capture_output=True, text=True, timeout=120)
    told = "VIPO_SECRET_KEY is not set; the served mode needs it (see docs/operations.md).\n"
    assert (done.returncode, done.stdout, done.stderr) == (2, "", told)


def test_whoever_stops_reading_hears_no_complaint() -> None:
    environment = {name: value for name, value in os.environ.items() if name != "PYTHONUNBUFFERED"}
    command = [sys.executable, "-m", "vipo_site.cli.main", "describe", str(MIXER)]
    for reader, code, told in ((os.pipe(), 0, ""), (None, 2, "This cannot be done: No space left on device.\n")):
        out = os.open("/dev/full", os.O_WRONLY) if reader is None else reader[1]
        if reader is not None:
            os.close(reader[0])
        done = subprocess.run(command, env=environment, stdout=out, stderr=subprocess.PIPE, text=True, timeout=120)
        os.close(out)
        assert (done.returncode, done.stderr) == (code, told)
