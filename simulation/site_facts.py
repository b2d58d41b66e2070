"""What the twin of a site is made from: its map, and the devices that are virtual there."""

from __future__ import annotations

from dataclasses import dataclass, replace

from registry import services as registry
from registry.floorplan.plan import Grid
from vipo_device.descriptions.reader import read_description, write_description
from vipo_device.protocol.description import Description, Pose
from vipo_device.protocol.errors import VipoError


class NothingToSimulate(VipoError):
    """A site without virtual devices."""

    code = "nothing_to_simulate"
    status = 404


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


def read_site_facts(slug: str) -> SiteFacts:
    """Return a site from the database; the demo's devices come from its files, machines stand where people put them.

    Raises VipoError when there is no such site, NoMap when it has no map, NothingToSimulate when no approved
    device of it is a simulated one.
    """
    known = registry.list_devices(site=slug)
    grid = registry.get_map(site=slug).grid
    if slug == registry.DEMO_SITE:
        devices = demo_facts().devices
    else:
        simulated = [d.canonical for d in known if d.canonical.simulated and d.lifecycle == "approved"]
        devices = tuple(DescribedDevice(d, write_description(d).encode()) for d in simulated)
    if not devices:
        raise NothingToSimulate(f"The site {slug} has no simulated devices; there is nothing for a twin to do.")
    placed = {d.id: d.pose for d in known if d.kind == "machine"}
    return SiteFacts(slug, grid, tuple(_placed(device, placed.get(device.description.id)) for device in devices))


def _placed(device: DescribedDevice, pose: Pose | None) -> DescribedDevice:
    return device if pose is None else replace(device, description=replace(device.description, pose=pose))
