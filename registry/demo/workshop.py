"""The demo's second site, which begins empty: nobody has its map, and TurtleBot 1 stands on its floor to make it."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

from registry.demo.factory import FOLDER, read_plan
from registry.errors import RegistryError
from registry.models import Site
from registry.sites.members import set_member
from registry.sites.sites import create_site
from vipo_device.protocol.description import Pose

SLUG = "workshop"
NAME = "Workshop"


class WorkshopTaken(RegistryError):
    """The workshop's short name is another site's."""

    code = "workshop_taken"
    status = 409


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
    """Make the site once, without a map, a place or a device; `people` are roles by e-mail address.

    Raises WorkshopTaken: somebody has made a site of that name.
    """
    if find_workshop() is not None:
        return
    if Site.objects.filter(slug=SLUG).exists():
        raise WorkshopTaken(
            f"Somebody has made a site whose short name is {SLUG}, so the demo's cannot be made beside it."
            " RESET=1 begins anew without it; VIPO_STATE_DIR=FOLDER keeps it and begins in another folder."
        )
    create_site(name=NAME, slug=SLUG)
    for email, role in people.items():
        set_member(site=SLUG, email=email, role=role)


def find_workshop() -> Workshop | None:
    """Return the site if the demo has made it, and nobody has taken it away since."""
    if not Site.objects.filter(slug=SLUG, made_by=None).exists():
        return None
    x, y = read_plan(SLUG)["start"]
    return Workshop(SLUG, f"{SLUG}.robot01", "TurtleBot 1", Pose(x, -y), FOLDER / f"{SLUG}.yaml")
