"""`manage.py mtconnect --site SLUG --agent URL`: machines of an MTConnect agent become machines of a site."""

from __future__ import annotations

import math
import os
import time
from argparse import ArgumentParser
from pathlib import Path
from typing import Any

from django.conf import settings
from django.core.management.base import BaseCommand, CommandError

from connectors.mtconnect.agent import Agent, read_address
from connectors.mtconnect.connector import Connector, Setting
from connectors.mtconnect.description import Stand
from connectors.mtconnect.starts import count_start
from connectors.settings import add_prefix, connections, device_names
from vipo_device.kit.shutdown import stop_on_signals
from vipo_device.protocol.description import Pose, Size
from vipo_device.protocol.errors import VipoError
from vipo_device.protocol.messages import is_device_id

STOP_LIMIT_S = 8
LEAST_INTERVAL_S, MOST_INTERVAL_S = 0.1, 60.0


class Command(BaseCommand):
    """Runs until SIGTERM or Ctrl-C."""

    help = "Bring in the machines of an MTConnect agent as machines of a site."
    requires_system_checks = ()  # it serves no pages, and starts a second sooner

    def add_arguments(self, parser: ArgumentParser) -> None:
        """Say what can be chosen."""
        parser.add_argument("--site", default=settings.VIPO_DEFAULT_SITE, help="the site's short name")
        add_prefix(parser, "VIPO_MTCONNECT_PREFIX")
        parser.add_argument(
            "--agent",
            default=os.environ.get("VIPO_MTCONNECT_AGENT", ""),
            help="the agent's address: http://name@host:5000/ or https://…; its password is VIPO_MTCONNECT_PASSWORD",
        )
        parser.add_argument("--ca", default="", help="the certificate authority of an https agent (the system's)")
        parser.add_argument("--headers", default="", help="a file of lines `Name: value` that are sent along")
        parser.add_argument("--interval", type=float, default=1.0, help="seconds between two questions (1)")
        parser.add_argument("--place", default="0,0,0", help="where the first machine stands: x,y,theta (0,0,0)")
        parser.add_argument("--size", default="2,2,2", help="how large the machines are, in metres: x,y,z (2,2,2)")

    def handle(self, *_args: Any, **options: Any) -> None:
        """Run the connector."""
        stopping = stop_on_signals(STOP_LIMIT_S)
        try:
            make_connector(options).run(stopping)
        except VipoError as error:
            raise CommandError(error.detail) from error


def make_connector(options: dict[str, Any]) -> Connector:
    """Return the connector that the command line asks for."""
    site, interval_s = options["site"], options["interval"]
    if not is_device_id(site):
        raise CommandError("--site must be a word of letters, digits, '_', '.' and '-'.")
    if not LEAST_INTERVAL_S <= interval_s <= MOST_INTERVAL_S:
        raise CommandError(f"--interval must lie between {LEAST_INTERVAL_S} and {MOST_INTERVAL_S:.0f} seconds.")
    folder = Path(settings.VIPO_STATE_DIR)
    agent, secrets = make_agent(options), folder / "secrets"
    setting = Setting(
        site=site,
        stand=read_stand(options["place"], options["size"]),
        interval_s=interval_s,
        connect=connections(site, secrets, "mtconnect"),
        name_device=device_names(site, secrets, "mtconnect", options["prefix"]),
        boot=count_start(folder / "mtconnect" / f"{site}.json", int(time.time())),
    )
    return Connector(agent, setting)


def make_agent(options: dict[str, Any]) -> Agent:
    """Return the agent that is to be asked."""
    password = os.environ.get("VIPO_MTCONNECT_PASSWORD", "")
    try:
        headers = Path(options["headers"]).read_text() if options["headers"] else ""
        address = read_address(options["agent"], password=password, authority=options["ca"], headers=headers)
    except (OSError, ValueError) as error:
        raise CommandError(f"--agent, --ca or --headers: {error}") from error
    return Agent(address)


def read_stand(place: str, size: str) -> Stand:
    """Read x,y,theta in metres and radians, and x,y,z in metres."""
    try:
        x, y, theta = _numbers(place)
        length, width, height = _numbers(size)
    except ValueError:
        raise CommandError("--place is x,y,theta (metres, radians) and --size x,y,z, with commas between.") from None
    if min(length, width, height) <= 0 or max(length, width, height) > 100 or max(abs(x), abs(y)) > 1e5:
        raise CommandError("--size must be above 0 and at most 100 m, --place at most 100 km from the map's origin.")
    return Stand(Pose(x, y, 0.0, theta), Size(length, width, height))


def _numbers(text: str) -> list[float]:
    found = [float(part) for part in text.split(",")]
    if not all(math.isfinite(number) for number in found):
        raise ValueError(text)
    return found
