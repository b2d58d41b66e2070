"""The commands that run beside a VIPO, where there is none."""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path


def test_without_a_database_it_is_said_what_to_set(tmp_path: Path) -> None:
    environment = {**os.environ, "VIPO_STATE_DIR": str(tmp_path), "VIPO_MODE": "embedded"}
    command = [sys.executable, "-m", "vipo_site.cli", "devices"]
    done = subprocess.run(command, env=environment, capture_output=True, text=True, timeout=120)
    assert (done.returncode, done.stdout) == (2, "")
    assert done.stderr == (
        "VIPO's database cannot be used: no such table: registry_site. Run this with the settings of the VIPO that is "
        f"running (of the demo VIPO_STATE_DIR, which is '{tmp_path}' now), and start that once after an update.\n"
    )
