"""Maps as people bring them, a header with its image or both in one archive; few are read or compared at once."""

from __future__ import annotations

from collections.abc import Callable
from contextlib import AbstractContextManager
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, TypeVar

from django.core.files.uploadedfile import UploadedFile
from django.db import transaction

from registry.bounds.slots import Claim, Slots
from registry.errors import RegistryError
from registry.floorplan.comparison import MapDifference
from registry.floorplan.map_archive import open_archive
from registry.floorplan.map_server import MAX_IMAGE_BYTES, MAX_YAML_BYTES, BadMap, read_map
from registry.floorplan.plan import Grid
from registry.maps.site_maps import RobotMapChange, compare_robot_map, compare_with_site, save_map
from registry.models import User
from registry.sites.quota import lock_site_quota, require_site_quota
from registry.sites.sites import checked_name, create_site, get_site
from registry.sites.views import SiteView

READING_PATIENCE_S = 5.0
reading_slots = Slots(in_all=2, of_site=2, of_person=1, most_waiting=1)
"""Maps that are read at once."""
COMPARING_PATIENCE_S = 15.0
comparing_slots = Slots(in_all=1, of_site=1, of_person=1, most_waiting=1)
"""Maps that are held against a site's at once: two of the largest have no room beside each other."""
Made = TypeVar("Made")
if TYPE_CHECKING:
    Upload = UploadedFile[Any]


class TooManyUploads(RegistryError):
    """This process reads as many maps as it may, in all or of this person."""

    code = "too_many_uploads"
    status = 429


@dataclass(frozen=True, slots=True)
class MapFiles:
    """The files of one map; an archive stands for both others."""

    yaml: Upload | None = None
    image: Upload | None = None
    archive: Upload | None = None

    @property
    def are_none(self) -> bool:
        """Whether nothing was sent."""
        return not (self.yaml or self.image or self.archive)


def create_site_from_map(*, name: str, files: MapFiles, admin: User) -> SiteView:
    """Make a site, from a ROS map if there are files of one; nothing is made when that cannot be read.

    Raises BadMap, BadName, SiteNameTaken, MayNotCreateSites, SiteQuotaReached, TooManyUploads.
    """
    require_site_quota(admin)
    checked_name(name, admin)
    grid = None if files.are_none else read_upload(files=files, by=admin)
    with transaction.atomic():
        lock_site_quota(admin)
        view = create_site(name=name, admin=admin)
        if grid is not None:
            save_map(site=view.slug, grid=grid, source="upload", by=admin)
    return get_site(site=view.slug, role=view.role)


def read_upload(*, files: MapFiles, by: User) -> Grid:
    """Return the grid of a map that somebody brings. Raises BadMap, TooManyUploads."""
    return in_turn(by, lambda: _read(files))


def look_at_upload(*, site: str, files: MapFiles, by: User) -> tuple[Grid, int, MapDifference]:
    """Return a map that somebody brings, the version of the site's (0: none), and what would change.

    Raises BadMap, TooManyUploads, NotAMember.
    """

    grid = read_upload(files=files, by=by)
    with _comparing(site, by):
        present, difference = compare_with_site(site=site, grid=grid)
    return grid, present.version if present else 0, difference


def look_at_robot_map(*, site: str, device_id: str, by: User) -> RobotMapChange:
    """Return what changes from the site's map to the robot's, and which maps these are.

    Raises NoSuchDevice, NoRobotMap, TooManyUploads.
    """
    with _comparing(site, by):
        return compare_robot_map(site=site, device_id=device_id)


def _comparing(site: str, by: User) -> AbstractContextManager[None]:
    refusal = TooManyUploads("Other maps are being compared, yours or others'. Try again in a moment.")
    return comparing_slots.held(Claim(by.pk, site), refusal, patience_s=COMPARING_PATIENCE_S)


def in_turn(by: User, work: Callable[[], Made]) -> Made:
    """Do what costs much, two at once in this process and one of a person. Raises TooManyUploads."""
    refusal = TooManyUploads("Other maps are being read, yours or others'. Try again in a moment.")
    with reading_slots.held(Claim(by.pk), refusal, patience_s=READING_PATIENCE_S):
        return work()


def _read(files: MapFiles) -> Grid:
    if files.archive is not None:
        return read_map(*open_archive(_take(files.archive, MAX_IMAGE_BYTES, "The .zip file")))
    if files.yaml is None:
        raise BadMap("The map's .yaml file is missing. Choose it together with its image, or one .zip file of both.")
    image = None if files.image is None else _take(files.image, MAX_IMAGE_BYTES, "The map's image")
    return read_map(_take(files.yaml, MAX_YAML_BYTES, "The .yaml file"), image)


def _take(file: Upload, most: int, what: str) -> bytes:
    if (file.size or 0) > most:
        raise BadMap(f"{what} has {file.size} bytes; {most} is the most. Choose the map's own files.")
    return bytes(file.read())
