"""How the connectors' devices come to VIPO's broker: by the settings, the environment and the site's files of keys."""

from __future__ import annotations

import logging
import os
import re
from argparse import ArgumentParser
from collections.abc import Callable
from functools import cache
from pathlib import Path
from typing import Any

from django.conf import settings
from django.core.management.base import CommandError

from vipo_device.kit.connection import ConnectionMaker
from vipo_device.kit.enrolment import device_connections
from vipo_device.kit.keyring import KeyRing
from vipo_device.protocol.messages import fit_device_id

log = logging.getLogger(__name__)
NameDevice = Callable[[str], str]
"""Gives a device its id at the site by the one that its own world would have it called."""
_PREFIX = re.compile(r"[A-Za-z0-9_.-]{0,48}")


def connections(site: str, secrets: Path, world: str) -> ConnectionMaker:
    """Return what connects the devices of another world to VIPO's listener for devices."""
    broker: dict[str, Any] = settings.VIPO_MQTT
    port = int(os.environ.get("VIPO_MQTT_DEVICE_PORT", broker["port"]))
    ring = _key_ring(site, secrets, world)
    return device_connections(site, {**broker, "port": port}, ring, read_enrolment_key(secrets))


def read_enrolment_key(secrets: Path) -> str:
    """Return the key by which the site's devices enrol, empty where there is none."""
    path = secrets / "join"
    return os.environ.get("VIPO_JOIN_KEY", "") or (path.read_text().strip() if path.exists() else "")


def add_prefix(parser: ArgumentParser, setting: str) -> None:
    """Let the command line, or else a setting of the environment, say with what the devices' ids begin."""
    parser.add_argument(
        "--prefix",
        default=os.environ.get(setting) or None,
        help="what new devices' ids begin with (the site's short name and a dot; nothing at the default site)",
    )


def device_names(site: str, secrets: Path, world: str, prefix: str | None) -> NameDevice:
    """Return what gives devices their ids: `prefix` before that of their world; None is what the site's rule asks for.

    Several sites share a server, and all but one of them take new ids only that begin with their own name. A device
    that has a key under an id without the prefix is there already, and keeps that id: a file of keys that cannot be
    read any more goes on to say what it said last. Raises CommandError, also where one cannot be read to begin with.
    """
    begin = ("" if site == settings.VIPO_DEFAULT_SITE else f"{site}.") if prefix is None else prefix
    if not _PREFIX.fullmatch(begin):
        raise CommandError("--prefix must be at most 48 letters, digits, '_', '.' and '-'.")
    if not begin:
        return str
    ring = _key_ring(site, secrets, world)
    try:
        known = ring.devices()
    except ValueError as error:
        raise CommandError(f"{error} Mend it: it says which devices keep their ids.") from error

    @cache
    def name(plain: str) -> str:
        nonlocal known
        try:
            known |= ring.devices()
        except ValueError as error:
            log.warning("%s What it said last tells which devices keep their ids.", error)
        return plain if plain in known else fit_device_id(begin + plain, plain)

    return name


def _key_ring(site: str, secrets: Path, world: str) -> KeyRing:
    return KeyRing(secrets / "devices.json", secrets / f"{world}-{site}.json")
