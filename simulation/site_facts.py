"""What the twin of a site is made from: its map, and the devices that are virtual there."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass, replace

from django.db import DatabaseError, InterfaceError, connection

from registry import services as registry
from registry.floorplan.plan import Grid
from simulation.world import Obstacle
from vipo_device.descriptions.reader import read_description, write_description
from vipo_device.protocol.description import Description, Pose
from vipo_device.protocol.errors import VipoError


class NothingToSimulate(VipoError):
    """A site without virtual devices."""

    code = "nothing_to_simulate"
    status = 404


class SiteUnread(VipoError):
    """A database that cannot be asked at the moment; who asks again later is answered."""

    code = "site_unread"
    status = 503


@dataclass(frozen=True, slots=True)
class DescribedDevice:
    """A simulated device, and the bytes in which it describes itself."""

    description: Description
    source: bytes


@dataclass(frozen=True, slots=True)
class SiteFacts:
    """A site as its twin sees it."""

    slug: str
    grid: Grid
    devices: tuple[DescribedDevice, ...]


def demo_facts() -> SiteFacts:
    """Return the painting factory as its files describe it."""
    sources = registry.read_demo_descriptions().values()
    devices = tuple(DescribedDevice(read_description(source), source) for source in sources)
    return SiteFacts(registry.DEMO_SITE, registry.get_demo_grid(), devices)


def read_site_facts(slug: str, described: tuple[DescribedDevice, ...] = ()) -> SiteFacts:
    """Return a site from the database; the demo's devices come from its files, machines stand where people put them.

    `described` are devices that come besides, known to the site or not; what they say of themselves counts then.

    Raises VipoError when there is no such site, NoMap when it has no map, NothingToSimulate when no approved
    device of it is a simulated one and none is `described`, SiteUnread when the database does not answer.
    """
    with _asking():
        known = registry.list_devices(site=slug)
        grid = registry.get_map(site=slug).grid
    if slug == registry.DEMO_SITE:
        devices = demo_facts().devices
    else:
        told = {device.description.id for device in described}
        simulated = [d.canonical for d in known if d.canonical.simulated and d.lifecycle == "approved"]
        others = (DescribedDevice(d, write_description(d).encode()) for d in simulated if d.id not in told)
        devices = (*described, *others)
    if not devices:
        raise NothingToSimulate(
            f"The site {slug} has no simulated devices; there is nothing for a twin to do. Bring some with --devices."
        )
    placed = {d.id: d.pose for d in known if d.kind == "machine"}
    return SiteFacts(slug, grid, tuple(_placed(device, placed.get(device.description.id)) for device in devices))


def read_obstacles(slug: str) -> tuple[Obstacle, ...]:
    """Return what people have put in the way of a site's simulated robots. Raises SiteUnread."""
    with _asking():
        return tuple(Obstacle(o.x, o.y, o.size_m) for o in registry.list_obstacles(site=slug))


@contextmanager
def _asking() -> Iterator[None]:
    """Turn a database that is away into SiteUnread, and begin anew with the next question."""
    try:
        yield
    except (DatabaseError, InterfaceError) as error:
        connection.close()
        raise SiteUnread(f"The database does not answer: {str(error).strip().splitlines()[0]}") from error


def _placed(device: DescribedDevice, pose: Pose | None) -> DescribedDevice:
    return device if pose is None else replace(device, description=replace(device.description, pose=pose))
