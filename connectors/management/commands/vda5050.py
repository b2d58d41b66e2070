"""`manage.py vda5050 --site SLUG --broker URL`: vehicles that speak VDA 5050 become robots of a site."""

from __future__ import annotations

import math
import os
import uuid
from argparse import ArgumentParser
from contextlib import suppress
from datetime import UTC, datetime
from pathlib import Path
from typing import Any
from urllib.parse import unquote, urlsplit

from django.conf import settings
from django.core.management.base import BaseCommand, CommandError

from connectors.settings import add_prefix, connections, device_names
from connectors.vda5050.coordinates import Frame
from connectors.vda5050.fleet import Fleet
from connectors.vda5050.vehicle_device import Setting
from vipo_device.kit.shutdown import stop_on_signals
from vipo_device.protocol.errors import VipoError
from vipo_device.protocol.messages import is_device_id
from vipo_device.protocol.mqtt_client import MqttClient
from vipo_device.protocol.sockets import tls_context

STOP_LIMIT_S = 8


class Command(BaseCommand):
    """Runs until SIGTERM or Ctrl-C."""

    help = "Bring in vehicles that speak VDA 5050 as robots of a site."
    requires_system_checks = ()  # it serves no pages, and starts a second sooner

    def add_arguments(self, parser: ArgumentParser) -> None:
        """Say what can be chosen."""
        parser.add_argument("--site", default=settings.VIPO_DEFAULT_SITE, help="the site's short name")
        add_prefix(parser, "VIPO_VDA5050_PREFIX")
        parser.add_argument("--interface", default="uagv", help="the first level of the vehicles' topics (uagv)")
        parser.add_argument(
            "--broker",
            default=os.environ.get("VIPO_VDA5050_BROKER", ""),
            help="the vehicles' broker: mqtt://name@host:1883 or mqtts://…; its password is VIPO_VDA5050_PASSWORD",
        )
        parser.add_argument("--ca", default="", help="the certificate authority of an mqtts broker (the system's)")
        parser.add_argument("--origin", default="0,0,0", help="where the vehicles' map begins in the site's: x,y,theta")
        parser.add_argument("--station-type", default="floor", help="the stationType of picks and drops (floor)")

    def handle(self, *_args: Any, **options: Any) -> None:
        """Run the connector."""
        stopping = stop_on_signals(STOP_LIMIT_S)
        try:
            make_fleet(options).run(stopping)
        except VipoError as error:
            raise CommandError(error.detail) from error


def make_fleet(options: dict[str, Any]) -> Fleet:
    """Return the connector that the command line asks for."""
    site, interface = options["site"], options["interface"]
    if not is_device_id(site) or not is_device_id(interface):
        raise CommandError("--site and --interface must be words of letters, digits, '_', '.' and '-'.")
    folder = Path(settings.VIPO_STATE_DIR)
    setting = Setting(
        site=site,
        frame=read_origin(options["origin"]),
        station_type=options["station_type"],
        folder=folder / "vda5050" / site,
        connect=connections(site, folder / "secrets", "vda5050"),
        name_device=device_names(site, folder / "secrets", "vda5050", options["prefix"]),
        new_id=lambda: uuid.uuid4().hex,
        clock=lambda: datetime.now(UTC),
    )
    return Fleet(vehicle_client(options["broker"], options["ca"], f"vipo-{site}-{interface}"), interface, setting)


def read_origin(text: str) -> Frame:
    """Read x,y,theta in metres and radians."""
    try:
        x, y, theta = (float(part) for part in text.split(","))
    except ValueError:
        x = y = theta = math.nan
    if not all(map(math.isfinite, (x, y, theta))):
        raise CommandError(f"--origin {text!r} is not x,y,theta: metres and radians, with commas between.")
    return Frame(x, y, theta)


def vehicle_client(address: str, authority: str, client_id: str) -> MqttClient:
    """Return the connection to the vehicles' broker."""
    parts, port = urlsplit(address), None
    with suppress(ValueError):
        port = parts.port or (8883 if parts.scheme == "mqtts" else 1883)
    if parts.scheme not in {"mqtt", "mqtts"} or not parts.hostname or port is None:
        raise CommandError(f"--broker {address!r} is not the vehicles' broker; say mqtt://host:1883 or mqtts://host.")
    is_safe = parts.scheme == "mqtts"
    return MqttClient(
        host=parts.hostname,
        port=port,
        username=unquote(parts.username or ""),
        password=os.environ.get("VIPO_VDA5050_PASSWORD", unquote(parts.password or "")),
        client_id=client_id,
        tls=tls_context(authority) if is_safe else None,
    )
