"""The guide for devices of any kind, followed literally: its commands in a shell, against the embedded broker."""

from __future__ import annotations

import os
import re
import subprocess
import sys
from collections.abc import Iterator
from contextlib import contextmanager
from datetime import UTC, datetime
from pathlib import Path

import pytest
from django.conf import settings

from execution.gateway.gateway import Gateway
from registry import services
from tests.integration.wire.bus import SITE, Bus
from tests.kit.files import ROOT
from tests.kit.servers import find_program
from tests.kit.waiting import wait_for

LIMIT_S = 120
pytestmark = pytest.mark.servers


@pytest.fixture
def folder(bus: Bus, database: Path, tmp_path: Path) -> Path:
    """A folder with the guide's files, for this broker and site; `vipo` finds the same database."""
    find_program("mosquitto_pub")
    made = tmp_path / "lamp"
    made.mkdir()
    secrets = tmp_path / "secrets"
    secrets.mkdir(exist_ok=True)
    (secrets / "django").write_text(settings.SECRET_KEY)
    page = (ROOT / "docs" / "devices" / "any.md").read_text()
    page = page.replace("1883", str(bus.server_port)).replace("painting-factory", SITE)
    for form, text in re.findall(r"```(\w+)\n(.*?)```", page, re.DOTALL):
        name = re.match(r"# (\S+\.\w+)\n", text)
        if name or form == "turtle":
            (made / (name[1] if name else "lamp.ttl")).write_text(text)
        else:
            with (made / "commands").open("a") as file:
                file.write(text + "\0")
    return made


def shell(folder: Path, commands: str) -> str:
    environment = {
        **os.environ,
        "PATH": f"{Path(sys.executable).parent}:{os.environ['PATH']}",
        "VIPO_STATE_DIR": str(folder.parent),
        "DJANGO_SETTINGS_MODULE": "vipo_site.settings",
    }
    done = subprocess.run(
        ["sh", "-eu", "-c", commands], cwd=folder, env=environment, capture_output=True, text=True, timeout=LIMIT_S
    )
    assert done.returncode == 0, done.stdout + done.stderr
    return done.stdout


@contextmanager
def running(folder: Path, *command: str) -> Iterator[None]:
    process = subprocess.Popen(command, cwd=folder, start_new_session=True)
    try:
        yield
    finally:
        os.killpg(process.pid, 9)
        process.wait()


def level() -> object:
    return services.get_device(site=SITE, device_id="lamp01").readings.get("level")


@pytest.mark.parametrize("bus", ["amqtt"], indirect=True)
def test_the_guide_brings_in_a_lamp(folder: Path, gateway: Gateway) -> None:
    describe, enrol, come_in, call, _ = (folder / "commands").read_text().split("\0")
    assert shell(folder, describe).startswith("lamp.ttl: Turtle. It describes the machine lamp01, “Lamp”")
    assert "takes part at hall from now on.\nIt keeps the key that it came with." in shell(folder, enrol + come_in)
    with running(folder, "sh", "lamp.sh"):
        assert shell(folder, call) == "lamp01: dim is done\n"
        wait_for("the level", lambda: level() == 30)
        # a command that it does not know: it must not say that it has taken the key
        decided = services.rotate_credential(site=SITE, device_id="lamp01", by=None, at=datetime.now(UTC))
        assert not decided.taken
    (folder / "lamp.key").write_text(str(decided.credential))
    with running(folder, sys.executable, "lamp.py"):
        wait_for("the program's first state", lambda: level() == 0)
        assert shell(folder, call) == "lamp01: dim is done, level 30\n"
        wait_for("the level", lambda: level() == 30)
    wait_for("its last will", lambda: not services.get_device(site=SITE, device_id="lamp01").online)
