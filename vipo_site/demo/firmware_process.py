"""How to run the firmware as a process of this machine: on MicroPython, or on CPython when that cannot be had."""

from __future__ import annotations

import json
import subprocess
import sys
from collections.abc import Mapping
from dataclasses import astuple
from pathlib import Path
from typing import Any

from django.conf import settings

from registry.services import read_demo_descriptions
from vipo_device.descriptions.reader import read

ROOT = Path(__file__).resolve().parents[2]
FETCH_TIMEOUT_S = 120
NOTICE = "The firmware of {id} runs under CPython, not MicroPython. {why}"


def firmware_command(state_dir: Path, config: Mapping[str, Any]) -> tuple[list[str], str | None]:
    """Return the command that runs the firmware, and a notice when it is not MicroPython.

    `config` has host, port, id, password, and may have speed, driver, site, log (a path); what the device says of
    itself is what its driver declares, at the place of the demo's device of that id.
    The first call on a machine fetches MicroPython, which takes some seconds.
    """
    interpreter, why = find_micropython(state_dir)
    path = write_configuration(state_dir, config)
    notice = None if interpreter else NOTICE.format(id=config["id"], why=why)
    return [interpreter or sys.executable, str(ROOT / "firmware" / "unix_main.py"), str(path)], notice


def find_micropython(state_dir: Path) -> tuple[str | None, str]:
    """Return the path of a MicroPython that runs here, or None and why there is none."""
    script = ROOT / "scripts" / "micropython.sh"
    try:
        # The script is ours and its argument is the setting's folder.
        done = subprocess.run(  # noqa: S603
            ["/bin/sh", str(script), str(state_dir.resolve() / "micropython")],
            capture_output=True,
            text=True,
            timeout=FETCH_TIMEOUT_S,
            check=False,
        )
    except subprocess.TimeoutExpired:
        return None, f"MicroPython was not fetched within {FETCH_TIMEOUT_S} s."
    if done.returncode == 0:
        return done.stdout.strip().splitlines()[-1], ""
    return None, (done.stderr.strip().splitlines() or ["scripts/micropython.sh failed."])[-1]


def write_configuration(state_dir: Path, config: Mapping[str, Any]) -> Path:
    """Write the file that the firmware reads, readable for this user only, and return its path."""
    folder = state_dir.resolve() / "firmware"
    folder.mkdir(parents=True, exist_ok=True)
    device = config["id"]
    complete = {
        "driver": "mixer",
        "site": settings.VIPO_DEFAULT_SITE,
        **place_of(device),
        "boot_file": str(folder / f"{device}.boot"),
        "key_file": str(folder / f"{device}.key"),
        "ledger_file": str(folder / f"{device}.ledger"),
        "log": str(folder / f"{device}.log"),
        **config,
    }
    path = folder / f"{device}.json"
    path.touch(mode=0o600)
    path.write_text(json.dumps(complete, indent=1))
    return path


def place_of(device: str) -> dict[str, Any]:
    """Return what a configuration says of one of the demo's devices: its name, place and size."""
    payload = read_demo_descriptions()[device]
    known = read(payload, device_id=device).description
    return {
        "name": known.name,
        "location": list(astuple(known.pose)),
        "size": list(astuple(known.size)),
        "simulated": known.simulated,
    }
