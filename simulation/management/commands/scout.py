"""`manage.py scout --site SLUG --map M.yaml`: give a site a simulated robot that can map a floor."""

from __future__ import annotations

import logging
import time
from argparse import ArgumentParser
from functools import partial
from pathlib import Path
from typing import Any

from django.conf import settings
from django.core.management.base import BaseCommand, CommandError

from registry import services as registry
from registry.floorplan.map_server import read_header, read_map
from registry.floorplan.plan import Grid
from simulation.management.commands.twin import STOP_LIMIT_S, connections
from simulation.mapping.floor import LidarSpec
from simulation.mapping.map_maker import RobotSpec
from simulation.mapping.survey import NoRoom, SurveyPlan
from simulation.scout import Scout, ScoutPlan
from simulation.site_facts import read_obstacles
from simulation.world import MOST_SEED
from vipo_device.kit.shutdown import stop_on_signals
from vipo_device.protocol.description import Pose
from vipo_device.protocol.errors import VipoError

log = logging.getLogger(__name__)


class Command(BaseCommand):
    """Runs until SIGTERM or Ctrl-C."""

    help = "Give a site a simulated robot that can map a floor."
    requires_system_checks = ()  # it serves no pages, and starts a second sooner

    def add_arguments(self, parser: ArgumentParser) -> None:
        """Say what can be chosen."""
        parser.add_argument("--site", required=True, help="the site's short name")
        parser.add_argument("--map", type=Path, required=True, help="the true floor: a map's .yaml file")
        parser.add_argument("--id", default="", help="the robot's id (the site's name and .scout)")
        parser.add_argument("--name", default="Scout", help="the robot's name")
        parser.add_argument("--lidar", type=float, default=8.0, help="how far its lidar sees, in metres (8)")
        parser.add_argument("--start", type=float, nargs=3, metavar=("X", "Y", "THETA"), help="where it stands")
        parser.add_argument("--seed", type=int, default=1, help="noise and slip (1)")
        parser.add_argument("--speed", type=float, default=1.0, help="times real time (1)")

    def handle(self, *_args: Any, **options: Any) -> None:
        """Run the robot."""
        if not 0.1 <= options["speed"] <= 20:
            raise CommandError(f"--speed {options['speed']:g} is outside 0.1 to 20; 1 is real time.")
        if not 2 <= options["lidar"] <= 40:
            raise CommandError(f"--lidar {options['lidar']:g} is out of bounds; choose 2 to 40 metres.")
        if not 0 <= options["seed"] <= MOST_SEED:
            raise CommandError(f"--seed must be a whole number from 0 to {MOST_SEED}.")
        stopping = stop_on_signals(STOP_LIMIT_S)
        try:
            make_scout(options).run(stopping)
        except NoRoom as error:
            raise CommandError(f"{error} Choose another place with --start X Y THETA.") from error
        except VipoError as error:
            raise CommandError(error.detail) from error


def make_scout(options: dict[str, Any]) -> Scout:
    """Return the robot that the command line asks for. It enrols at the site and waits for an admin.

    Raises:
        NoRoom: it does not fit where it shall stand.
        VipoError: there is no such site, or the map cannot be used.
    """
    site: str = options["site"]
    at: list[float] | None = options["start"]
    lidar_m: float = options["lidar"]
    survey = SurveyPlan(
        read_floor(options["map"]),
        options["seed"],
        RobotSpec(range_m=lidar_m),
        LidarSpec(range_m=lidar_m),
        start=None if at is None else Pose(at[0], at[1], 0.0, at[2]),
    )
    device = options["id"] or f"{site}.scout"
    folder = Path(settings.VIPO_STATE_DIR)
    memory_path = folder / "twin" / f"{device}.json"
    plan = ScoutPlan(
        device,
        options["name"],
        site,
        survey,
        options["speed"],
        boot=int(time.time()),
        obstacles=partial(read_obstacles, site),
        memory_path=memory_path,
    )
    key = registry.show_enrolment_key(site=site)
    log.info("%s comes to %s: let it in on the page of the devices, then let it explore.", device, site)
    return Scout(plan, connections(site, key, folder / "secrets"))


def read_floor(path: Path) -> Grid:
    """Return the map of a .yaml file, whose image lies beside it. Raises CommandError, BadMap."""
    try:
        header = path.read_bytes()
        return read_map(header, (path.parent / read_header(header).image).read_bytes())
    except OSError as error:
        raise CommandError(f"{error.filename} cannot be read: {error.strerror}.") from error
