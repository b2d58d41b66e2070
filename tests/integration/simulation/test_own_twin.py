"""Simulated devices of a site of one's own: brought as files, let in by people, and live from then on."""

from __future__ import annotations

import json
import threading
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from datetime import UTC, datetime
from pathlib import Path
from typing import Any

import pytest
from django.conf import LazySettings
from django.core.management.base import CommandError

from execution.gateway.gateway import Gateway
from registry import services
from registry.floorplan.plan import Grid
from simulation.management.commands.twin import make_twin, read_folder
from simulation.site_facts import NothingToSimulate
from tests.integration.wire.bus import SITE, Bus
from tests.integration.wire.conftest import bus, database, gateway
from tests.kit.waiting import wait_for

__all__ = ["bus", "database", "gateway"]
SHELF = "hall.shelf01"
TEXT = """@prefix dct: <http://purl.org/dc/terms/> .
@prefix vipo: <urn:vipo:ns#> .
<urn:vipo:device:hall.shelf01> a vipo:Machine ;
    dct:identifier "hall.shelf01" ; dct:title "Shelf" ; vipo:simulated true ;
    vipo:location ( 2.0 2.0 0.0 0.0 ) ; vipo:size ( 0.5 0.5 1.0 ) ; vipo:gives "box" .
"""


class Heartbeat:
    """Where a twin says that it works."""

    beat: Callable[..., None] = staticmethod(lambda *_: None)


def options_for(devices: Path | None) -> dict[str, Any]:
    """Return what the command line says."""
    return {
        "site": SITE, "devices": devices, "only": "", "left_out": "", "speed": 1.0, "driver": "kinematic", "pace": [],
    }  # fmt: skip


@contextmanager
def playing(devices: Path | None) -> Iterator[None]:
    """Run the site's twin as the command line does."""
    twin, stopping = make_twin(options_for(devices), Heartbeat()), threading.Event()  # type: ignore[arg-type]
    thread = threading.Thread(target=twin.run, args=(stopping,))
    thread.start()
    try:
        yield
    finally:
        stopping.set()
        thread.join(20)
        assert not thread.is_alive()


def is_here(lifecycle: str) -> bool:
    device = services.find_device(device_id=SHELF)
    return device is not None and device.online and device.lifecycle == lifecycle


@pytest.mark.servers
@pytest.mark.parametrize("bus", ["amqtt"], indirect=True)
def test_simulated_devices_come_from_files_and_stay_once_they_are_let_in(
    bus: Bus, gateway: Gateway, tmp_path: Path, settings: LazySettings, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("vipo_device.kit.enrolment.PAUSE_S", (0.1, 0.2))
    settings.VIPO_STATE_DIR = tmp_path
    (tmp_path / "secrets").mkdir()
    (tmp_path / "secrets" / "join").write_text("the enrolment key of the demo's site")
    services.save_map(site=SITE, grid=Grid(100, 100, 0.05, 0.0, 0.0, bytes(10_000)))
    folder = tmp_path / "devices"
    folder.mkdir()
    (folder / "shelf.ttl").write_text(TEXT)
    with pytest.raises(NothingToSimulate, match="Bring some with --devices"), playing(None):
        pass
    with playing(folder):
        wait_for("the shelf", lambda: is_here("pending"), 40)
        services.approve_device(site=SITE, device_id=SHELF, by=None, at=datetime.now(UTC))
        wait_for("the shelf that was let in", lambda: is_here("approved"), 40)
    wait_for("its goodbye", lambda: not is_here("approved"))
    with playing(None):
        wait_for("the shelf without its file", lambda: is_here("approved"), 40)


@pytest.mark.parametrize(
    ("site", "files", "why"),
    [
        ("hall", {}, "holds no description"),
        ("hall", {"a.ttl": "no Turtle"}, r"a\.ttl: .+ Try: vipo describe .+a\.ttl"),
        ("hall", {"a.ttl": TEXT.replace("true", "false")}, r"a\.ttl does not say that hall\.shelf01 is simulated\."),
        ("hall", {"a.ttl": TEXT, "b.ttl": TEXT}, r"b\.ttl: another file describes hall\.shelf01, too"),
        ("painting-factory", {"a.ttl": TEXT}, "is the demo's, whose devices are fixed"),
    ],
)
def test_a_folder_that_cannot_be_brought_is_refused(site: str, files: dict[str, str], why: str, tmp_path: Path) -> None:
    for name, text in files.items():
        (tmp_path / name).write_text(text)
    with pytest.raises(CommandError, match=why):
        read_folder(tmp_path, site)


def test_ids_that_another_site_has_or_gives_are_refused_before_anything_connects(
    database: Path, tmp_path: Path, settings: LazySettings
) -> None:
    settings.VIPO_STATE_DIR = tmp_path
    settings.VIPO_DEFAULT_SITE = "factory"
    for name in ("Factory", "Hall"):
        services.create_site(name=name, slug=name.lower())
        services.save_map(site=name.lower(), grid=Grid(100, 100, 0.05, 0.0, 0.0, bytes(10_000)))
    services.expect_device(site="factory", device_id="shelf01", credential="k" * 32)
    (tmp_path / "secrets").mkdir()
    keys = tmp_path / "secrets" / "devices.json"
    keys.write_text(json.dumps({"shelf01": "k" * 32}))
    folder = tmp_path / "devices"
    folder.mkdir()
    (folder / "own.ttl").write_text(TEXT)
    (folder / "copied.ttl").write_text(TEXT.replace("hall.shelf01", "shelf01"))
    (folder / "new.ttl").write_text(TEXT.replace("hall.shelf01", "rack"))
    with pytest.raises(CommandError) as refused:
        make_twin(options_for(folder), Heartbeat())  # type: ignore[arg-type]
    assert str(refused.value) == (
        "hall can have no device with the id rack, shelf01. Several sites share this server; new ids at this one begin "
        "with “hall.”. Change it in the device's file, also in topics that contain it: hall.rack."
    )
    assert json.loads(keys.read_text()) == {"shelf01": "k" * 32}
    for name in ("copied.ttl", "new.ttl"):
        (folder / name).unlink()
    assert make_twin(options_for(folder), Heartbeat())  # type: ignore[arg-type]
