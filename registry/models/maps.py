"""Maps of sites with their places and zones, and the maps that robots send."""

from __future__ import annotations

import zlib

from django.db import models
from django.utils import timezone

from registry.models.people import User
from registry.models.sites import Site


class SiteMap(models.Model):
    """One version of a site's occupancy grid; the highest version is the one that holds.

    `frame_since` is when the first of the versions before it was made that lie as it does, without another between.
    """

    site = models.ForeignKey(Site, on_delete=models.CASCADE, related_name="maps")
    version = models.PositiveIntegerField()
    width = models.PositiveIntegerField()
    height = models.PositiveIntegerField()
    resolution_m = models.FloatField()
    origin_x_m = models.FloatField()
    origin_y_m = models.FloatField()
    packed_cells = models.BinaryField()
    source = models.CharField(max_length=200, blank=True)
    by = models.ForeignKey(User, null=True, on_delete=models.SET_NULL, related_name="+")
    created_at = models.DateTimeField(auto_now_add=True)
    frame_since = models.DateTimeField(default=timezone.now)

    class Meta:
        """Versions count up from 1 at each site."""

        constraints = [models.UniqueConstraint(fields=["site", "version"], name="one_map_per_version")]

    def __str__(self) -> str:
        return f"{self.site_id} v{self.version}"

    @property
    def cells(self) -> bytes:
        """The cells, bottom row first: 0 free, 100 occupied, 255 unknown."""
        return zlib.decompress(bytes(self.packed_cells))


class Place(models.Model):
    """A named place on a site's map."""

    class Kind(models.TextChoices):
        """What the place is for."""

        DOCK = "dock"
        ROOM = "room"
        POINT = "point"

    site = models.ForeignKey(Site, on_delete=models.CASCADE, related_name="places")
    key = models.CharField(max_length=64)
    name = models.CharField(max_length=100)
    kind = models.CharField(max_length=10, choices=Kind.choices)
    x = models.FloatField()
    y = models.FloatField()
    theta = models.FloatField(default=0.0)
    label = models.JSONField(null=True)

    class Meta:
        """A place's key is its id in programs."""

        constraints = [models.UniqueConstraint(fields=["site", "key"], name="one_place_per_key")]

    def __str__(self) -> str:
        return self.name


class SiteZone(models.Model):
    """A named polygon on a site's map that concerns all its robots at any time; metres in the map frame."""

    class Rule(models.TextChoices):
        """What the zone asks of robots."""

        KEEP_OUT = "keep_out"
        SLOW = "slow"
        ONE_AT_A_TIME = "one_at_a_time"
        ONE_WAY = "one_way"
        PREFERRED = "preferred"
        RELEASE = "release"

    site = models.ForeignKey(Site, on_delete=models.CASCADE, related_name="zones")
    key = models.CharField(max_length=64)
    name = models.CharField(max_length=100)
    rule = models.CharField(max_length=20, choices=Rule.choices)
    points = models.JSONField()
    speed_m_s = models.FloatField(null=True)
    robots = models.PositiveSmallIntegerField(null=True)
    heading_deg = models.FloatField(null=True)
    open_until = models.DateTimeField(null=True)

    class Meta:
        """A zone's key is its id at the site."""

        constraints = [models.UniqueConstraint(fields=["site", "key"], name="one_zone_per_key")]

    def __str__(self) -> str:
        return self.name


class SimulatedObstacle(models.Model):
    """A round thing that somebody put on a site's floor for its simulated robots to meet; metres in the map frame."""

    site = models.ForeignKey(Site, on_delete=models.CASCADE, related_name="obstacles")
    x = models.FloatField()
    y = models.FloatField()
    size_m = models.FloatField()

    def __str__(self) -> str:
        return f"{self.site_id}: {self.size_m:g} m at ({self.x:g}, {self.y:g})"


class RobotMap(models.Model):
    """The newest whole map that a robot has sent; `version` counts them, `changed_at` is when one differed last."""

    device = models.OneToOneField(
        "registry.Device", on_delete=models.CASCADE, primary_key=True, related_name="robot_map"
    )
    version = models.PositiveIntegerField()
    width = models.PositiveIntegerField()
    height = models.PositiveIntegerField()
    resolution_m = models.FloatField()
    origin_x_m = models.FloatField()
    origin_y_m = models.FloatField()
    packed_cells = models.BinaryField()
    known_cells = models.PositiveIntegerField()
    at = models.DateTimeField()
    changed_at = models.DateTimeField()

    def __str__(self) -> str:
        return f"map {self.version} of {self.device_id}"


class RobotMapDraft(models.Model):
    """The map that a robot sends now, or sent last (`is_over`): what its first part said, and how often maps may come.

    `size` is how many bytes of it wait; `tokens` and `filled_at` are a token bucket of whole maps.
    """

    device = models.OneToOneField(
        "registry.Device", on_delete=models.CASCADE, primary_key=True, related_name="robot_map_draft"
    )
    boot = models.BigIntegerField(default=-1)
    number = models.BigIntegerField(default=-1)
    head = models.JSONField(default=list)
    size = models.PositiveIntegerField(default=0, db_index=True)
    is_over = models.BooleanField(default=True)
    spoken_at = models.DateTimeField()
    tokens = models.FloatField()
    filled_at = models.DateTimeField()

    def __str__(self) -> str:
        return f"map {self.number} of {self.device_id}, boot {self.boot}"


class RobotMapPart(models.Model):
    """A part of a map that is not whole yet; in the database, for the next may come to another gateway."""

    draft = models.ForeignKey(RobotMapDraft, on_delete=models.CASCADE, related_name="rows")
    part = models.PositiveIntegerField()
    packed = models.BinaryField()

    class Meta:
        """Each part counts once."""

        constraints = [models.UniqueConstraint(fields=["draft", "part"], name="one_part_of_a_map")]

    def __str__(self) -> str:
        return f"part {self.part} of {self.draft_id}"
