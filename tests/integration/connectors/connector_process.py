"""A connector of devices as the product starts it, in a process of its own."""

from __future__ import annotations

import json
import os
import subprocess
import sys
from collections.abc import Mapping
from pathlib import Path
from types import MappingProxyType

from tests.kit.files import ROOT
from tests.kit.processes.forked import ForkedPython
from tests.kit.servers import Mosquitto
from tests.kit.waiting import PATIENCE_S

NOTHING: Mapping[str, str] = MappingProxyType({})


class ConnectorProcess:
    """`manage.py` with these arguments at the site `hall`; started again, it finds what it kept."""

    def __init__(self, folder: Path, vipo: Mosquitto, arguments: tuple[str, ...]) -> None:
        self.folder, self.vipo = folder, vipo
        self._arguments = arguments
        self._process: subprocess.Popen[bytes] | None = None

    def start(self, secrets: Mapping[str, str] = NOTHING) -> None:
        """Start it with the keys of the devices that are known, and these secrets besides."""
        (self.folder / "secrets").mkdir(exist_ok=True)
        for name, word in {"devices.json": json.dumps(self.vipo.accounts), **secrets}.items():
            (self.folder / "secrets" / name).write_text(word)
        environment = {
            **os.environ,
            "DJANGO_SETTINGS_MODULE": "vipo_site.settings",
            "VIPO_MODE": "embedded",
            "VIPO_STATE_DIR": str(self.folder),
            "VIPO_MQTT_PORT": str(self.vipo.device_port),
        }
        name, *more = self._arguments
        command = [sys.executable, "manage.py", name, "--site", "hall", *more]
        with self.log.open("ab") as out:
            self._process = ForkedPython(command, cwd=ROOT, env=environment, stdout=out, stderr=out)

    @property
    def log(self) -> Path:
        return self.folder / "connector.log"

    def kill(self) -> None:
        assert self._process is not None
        self._process.kill()
        self._process.wait(PATIENCE_S)

    def stop(self) -> int:
        assert self._process is not None
        self._process.terminate()
        return self._process.wait(PATIENCE_S)
