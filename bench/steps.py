"""What the steps of one run take, in a hall with few and with many devices: statements, rows of devices, time at work.

Each hall has a process and an SQLite database of its own.
"""

from __future__ import annotations

import json
import os
import subprocess
import sys
import tempfile
from collections.abc import Iterator

from bench.flow import ROOT

DEVICES = (10, 300)
RUNS = 10


def measure() -> Iterator[dict[str, object]]:
    for devices in DEVICES:
        with tempfile.TemporaryDirectory() as folder:
            environment = {**os.environ, "VIPO_STATE_DIR": folder, "VIPO_LOG": "ERROR", "VIPO_MODE": "embedded"}
            environment["DJANGO_SETTINGS_MODULE"] = "vipo_site.settings"
            command = [sys.executable, "-m", "bench.steps", str(devices)]
            done = subprocess.run(command, cwd=ROOT, env=environment, capture_output=True, text=True)
        if done.returncode:
            raise RuntimeError(done.stderr)
        yield from map(json.loads, done.stdout.splitlines())


def _measure_here(devices: int) -> Iterator[dict[str, object]]:
    import django

    django.setup()
    # Django has to be set up before models can be imported
    from django.core.management import call_command

    from bench.figures import figure
    from bench.hall import carry_out_run, fill_hall

    call_command("migrate", verbosity=0, interactive=False)
    fill_hall(devices)
    timed = [carry_out_run(counting=False) for _ in range(RUNS)]
    for step, count in carry_out_run().items():
        best_ms = min(run[step].cpu_ms for run in timed)
        facts = {"devices": devices, "statements": count.statements, "device_rows": count.device_rows}
        yield figure(step, best_ms, "ms at work", **facts, database="sqlite")


if __name__ == "__main__":
    for found in _measure_here(int(sys.argv[1])):
        print(json.dumps(found))
