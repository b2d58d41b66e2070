"""The demo's second site, which begins empty: nobody has its map, and TurtleBot 1 stands on its floor to make it."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

from registry.demo.factory import FOLDER, read_plan
from registry.models import Site
from registry.sites.members import set_member
from registry.sites.sites import create_site
from vipo_device.protocol.description import Pose

SLUG = "workshop"
NAME = "Workshop"


@dataclass(frozen=True, slots=True)
class Workshop:
    """The site, its robot's id and name, where the robot begins (m, rad), and the map of the floor as it is.

    The robot's world is made from that map; the site never sees it.
    """

    site: str
    robot: str
    robot_name: str
    start: Pose
    true_floor: Path


def seed_workshop(*, people: dict[str, str]) -> None:
    """Make the site once, without a map, a place or a device; `people` are roles by e-mail address."""
    if find_workshop() is not None:
        return
    create_site(name=NAME, slug=SLUG)
    for email, role in people.items():
        set_member(site=SLUG, email=email, role=role)


def find_workshop() -> Workshop | None:
    """Return the site if it was made, and not taken away since."""
    if not Site.objects.filter(slug=SLUG).exists():
        return None
    x, y = read_plan(SLUG)["start"]
    return Workshop(SLUG, f"{SLUG}.robot01", "TurtleBot 1", Pose(x, -y), FOLDER / f"{SLUG}.yaml")
