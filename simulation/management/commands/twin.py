"""`manage.py twin --site SLUG`: give a site live virtual devices that speak MQTT as real ones do."""

from __future__ import annotations

import json
import logging
from argparse import ArgumentParser
from collections.abc import Sequence
from functools import partial
from pathlib import Path
from typing import Any

from django.conf import settings
from django.core.management.base import BaseCommand, CommandError

from registry import services as registry
from registry.services import HeartbeatWriter
from simulation.site_facts import DescribedDevice, SiteFacts, read_obstacles, read_site_facts
from simulation.twin import Twin, TwinPlan
from vipo_device.descriptions.reader import read_description
from vipo_device.kit.connection import ConnectionMaker
from vipo_device.kit.enrolment import device_connections
from vipo_device.kit.keyring import RotatingKeyRing
from vipo_device.kit.shutdown import stop_on_signals
from vipo_device.protocol.errors import VipoError

log = logging.getLogger(__name__)
STOP_LIMIT_S = 20
FORMS = frozenset({".ttl", ".nt", ".jsonld", ".json", ".txt"})
"""How files of descriptions end."""


class Command(BaseCommand):
    """Runs until SIGTERM or Ctrl-C."""

    help = "Give a site live virtual devices that speak MQTT as real ones do."
    requires_system_checks = ()  # it serves no pages, and starts a second sooner

    def add_arguments(self, parser: ArgumentParser) -> None:
        """Say what can be chosen."""
        parser.add_argument("--site", default=settings.VIPO_DEFAULT_SITE, help="the site's short name")
        parser.add_argument(
            "--devices", type=Path, metavar="FOLDER", help="descriptions of simulated devices that come besides"
        )
        parser.add_argument("--speed", type=float, default=1.0, help="times real time (1)")
        parser.add_argument("--driver", choices=["physics", "kinematic"], default="physics")
        parser.add_argument(
            "--pace", action="append", default=[], metavar="DEVICE.METHOD=TIMES",
            help="a device that takes so many times as long as it should, to see what VIPO makes of it (repeatable)",
        )  # fmt: skip
        chosen = parser.add_mutually_exclusive_group()
        chosen.add_argument("--only", default="", help="ids with commas between: these devices and no others")
        chosen.add_argument("--except", dest="left_out", default="", help="ids with commas between: not these")

    def handle(self, *_args: Any, **options: Any) -> None:
        """Run the twin."""
        if not 0.1 <= options["speed"] <= 100:
            raise CommandError(f"--speed {options['speed']:g} is outside 0.1 to 100; 1 is real time.")
        stopping = stop_on_signals(STOP_LIMIT_S)
        heartbeat = HeartbeatWriter("twin", f"twin-{options['site']}", liveness_file=settings.VIPO_PULSE).start()
        try:
            make_twin(options, heartbeat).run(stopping)
        except VipoError as error:
            raise CommandError(error.detail) from error
        finally:
            heartbeat.stop()


def make_twin(options: dict[str, Any], heartbeat: HeartbeatWriter) -> Twin:
    """Return the twin that the command line asks for."""
    site: str = options["site"]
    described = read_folder(options["devices"], site) if options["devices"] else ()
    require_own(site, described)
    facts = read_site_facts(site, described)
    folder = Path(settings.VIPO_STATE_DIR)
    passwords = read_passwords(folder / "secrets")
    enrolment_key = find_enrolment_key(site, folder / "secrets")
    wanted = choose_devices(facts, options["only"], options["left_out"])
    speaking = frozenset(name for name in wanted if name in passwords or enrolment_key)
    for name in sorted(wanted - speaking):
        log.warning("%s has no password in secrets/devices.json and there is no enrolment key; it stays away.", name)
    plan = TwinPlan(
        facts=facts,
        speaking=speaking,
        memory_path=folder / "twin" / f"{site}.json",
        pending=frozenset(d.description.id for d in facts.devices) - passwords.keys(),
        speed=options["speed"],
        driver=options["driver"],
        paces=read_paces(facts, options["pace"]),
        refresh=partial(read_site_facts, site, described),
        obstacles=partial(read_obstacles, site),
        beat=heartbeat.beat,
    )
    return Twin(plan, connections(site, enrolment_key, folder / "secrets"))


def read_paces(facts: SiteFacts, said: Sequence[str]) -> dict[str, dict[str, float]]:
    """Read `DEVICE.METHOD=TIMES`, from a tenth to ten times; what is no such thing is refused."""
    paces: dict[str, dict[str, float]] = {}
    methods = {d.description.id: {method.name for method in d.description.methods} for d in facts.devices}
    for text in said:
        name, _, times = text.partition("=")
        device, _, method = name.rpartition(".")
        if method not in methods.get(device, ()):
            raise CommandError(f"--pace {text}: {facts.slug} has no virtual device {device!r} that can {method!r}.")
        try:
            pace = float(times)
        except ValueError:
            pace = 0.0
        if not 0.1 <= pace <= 10:
            raise CommandError(f"--pace {text}: write a number from 0.1 to 10 behind the =.")
        paces.setdefault(device, {})[method] = pace
    return paces


def choose_devices(facts: SiteFacts, only: str, left_out: str) -> frozenset[str]:
    """Return the ids of the devices that shall speak; a name that nobody has is refused."""
    known = frozenset(d.description.id for d in facts.devices)
    named = frozenset(name.strip() for name in (only or left_out).split(",") if name.strip())
    if strangers := sorted(named - known):
        raise CommandError(f"{facts.slug} has no virtual device {strangers[0]}; it has {', '.join(sorted(known))}.")
    return named if only else known - named


def read_folder(folder: Path, site: str) -> tuple[DescribedDevice, ...]:
    """Return the devices that files of a folder describe; what cannot be simulated at the site is refused."""
    if site == registry.DEMO_SITE:
        raise CommandError(f"{site} is the demo's, whose devices are fixed. Bring your own to a site of your own.")
    files = sorted(path for path in folder.glob("*") if path.suffix in FORMS)
    if not files:
        raise CommandError(f"{folder} holds no description ({', '.join(sorted(FORMS))}).")
    found: dict[str, DescribedDevice] = {}
    for path in files:
        device = _read_described(path)
        if device.description.id in found:
            raise CommandError(f"{path}: another file describes {device.description.id}, too; keep one of the two.")
        found[device.description.id] = device
    return tuple(found.values())


def require_own(site: str, described: Sequence[DescribedDevice]) -> None:
    """Refuse devices that cannot be the site's: with such an id and its key they would displace another site's."""
    strangers = registry.list_strange_ids(site=site, ids=[device.description.id for device in described])
    if strangers:
        raise CommandError(
            f"{site} can have no device with the id {', '.join(strangers)}. Several sites share this server; new ids "
            f"at this one begin with “{site}.”. Change it in the device's file, also in topics that contain it: "
            f"{site}.{strangers[0]}."
        )


def _read_described(path: Path) -> DescribedDevice:
    try:
        source = path.read_bytes()
        description = read_description(source)
    except OSError as error:
        raise CommandError(f"{path} cannot be read: {error.strerror}.") from error
    except VipoError as error:
        raise CommandError(f"{path}: {error.detail} Try: vipo describe {path}") from error
    if not description.simulated:
        raise CommandError(f"{path} does not say that {description.id} is simulated. Add: vipo:simulated true")
    return DescribedDevice(description, source)


def read_passwords(folder: Path) -> dict[str, str]:
    """Return the devices' passwords by id."""
    try:
        passwords: dict[str, str] = json.loads((folder / "devices.json").read_text())
    except FileNotFoundError:
        return {}
    except ValueError as error:
        raise CommandError(
            f"secrets/devices.json is not JSON ({error}); `make demo RESET=1` writes a new one."
        ) from None
    return passwords


def find_enrolment_key(site: str, folder: Path) -> str:
    """Return the key by which a site's other devices enrol: the demo's from its file; empty where nobody knows it."""
    if site == registry.DEMO_SITE:
        join = folder / "join"
        return join.read_text().strip() if join.exists() else ""
    try:
        return registry.show_enrolment_key(site=site)
    except VipoError as error:
        log.warning("New devices cannot enrol at %s: %s", site, error.detail)
        return ""


def connections(site: str, enrolment_key: str, secrets: Path) -> ConnectionMaker:
    """Return what connects a device to the broker of the settings; the keys that it is given are kept in `secrets`."""
    ring = RotatingKeyRing(secrets / "devices.json", secrets / "devices-spare.json")
    return device_connections(site, settings.VIPO_MQTT, ring, enrolment_key)
