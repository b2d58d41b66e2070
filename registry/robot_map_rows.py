"""Rows of robots' maps: the newest whole one of each robot, and the parts of the one under way."""

from __future__ import annotations

from django.db import models


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
