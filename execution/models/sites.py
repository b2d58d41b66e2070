"""What is kept of each site's floor, its owner, its inboxes, its stop and what was set aside."""

from __future__ import annotations

import uuid

from django.db import models

from execution.models.runs import Run


class FloorState(models.Model):
    """The floor of a site between two events."""

    site = models.OneToOneField("registry.Site", on_delete=models.CASCADE, related_name="floor_state")
    namespace = models.UUIDField(default=uuid.uuid4)
    state = models.JSONField(null=True)
    epoch = models.PositiveIntegerField(default=0)
    active = models.BooleanField(default=False)
    commands = models.BigIntegerField(default=0)

    def __str__(self) -> str:
        return f"floor of {self.site_id}"


class InboxEvent(models.Model):
    """Something that a run or a floor is to take in. `key` is its identity: the same event is never taken in twice.

    `site` is the site's slug, by whose owner it is read.
    """

    site = models.CharField(max_length=64, default="", db_default="")
    target = models.CharField(max_length=80)
    key = models.CharField(max_length=160, unique=True)
    payload = models.JSONField()
    created_at = models.DateTimeField()
    taken_at = models.DateTimeField(null=True)

    class Meta:
        """Read by site, in order, what is not taken in; a target's own are looked for by what waits."""

        indexes = [
            models.Index(fields=["site", "id"], condition=models.Q(taken_at=None), name="inbox_that_waits"),
            models.Index(fields=["taken_at", "created_at"]),
        ]

    def __str__(self) -> str:
        return self.key


class SiteLease(models.Model):
    """Which process carries the runs of a site out, and until when by the database's clock.

    `epoch` grows with each owner that is another than the one before; nothing is written for a site under an older one.
    """

    site = models.OneToOneField("registry.Site", on_delete=models.CASCADE, related_name="run_lease")
    owner = models.CharField(max_length=120, blank=True)
    epoch = models.PositiveIntegerField(default=1)
    expires_at = models.DateTimeField()

    def __str__(self) -> str:
        return f"site {self.site_id}: {self.owner}"


class Lease(models.Model):
    """Who does a job that only one process may do, and until when."""

    name = models.CharField(primary_key=True, max_length=40)
    holder = models.CharField(max_length=80)
    until = models.DateTimeField()

    def __str__(self) -> str:
        return f"{self.name}: {self.holder}"


class SiteStop(models.Model):
    """The latched stop of a site.

    `fence` is raised whenever it is pressed or reset, and told to devices with each command and each stop; `pressed` is
    what it became when the stop was pressed last. It is changed by single statements outside of transactions, so that
    no process that is frozen holds its row.
    """

    site = models.OneToOneField("registry.Site", on_delete=models.CASCADE, related_name="stop_latch")
    active = models.BooleanField(default=False)
    by = models.CharField(max_length=120, blank=True)
    at = models.DateTimeField(null=True)
    fence = models.BigIntegerField(default=0)
    pressed = models.BigIntegerField(default=0)

    def __str__(self) -> str:
        return f"stop of {self.site_id}"


class StopFollowed(models.Model):
    """How far runs, floor and armed programs of a site have been told of its stop: up to which fence."""

    site = models.OneToOneField("registry.Site", on_delete=models.CASCADE, related_name="stop_followed")
    fence = models.BigIntegerField(default=0)

    def __str__(self) -> str:
        return f"stop of {self.site_id} followed to {self.fence}"


class DeadLetter(models.Model):
    """Something that raised when it was taken in; `run` is None where it concerned the floor alone."""

    class State(models.TextChoices):
        """What became of it."""

        OPEN = "open"
        RETRIED = "retried"
        DROPPED = "dropped"

    site = models.ForeignKey("registry.Site", on_delete=models.CASCADE, related_name="dead_letters")
    run = models.ForeignKey(Run, null=True, on_delete=models.CASCADE, related_name="dead_letters")
    target = models.CharField(max_length=80)
    event = models.JSONField()
    error = models.CharField(max_length=1000)
    at = models.DateTimeField()
    state = models.CharField(max_length=10, choices=State.choices, default=State.OPEN)
    settled_by = models.CharField(max_length=120, blank=True)
    settled_at = models.DateTimeField(null=True)

    class Meta:
        """Listed by site."""

        indexes = [models.Index(fields=["site", "state"])]

    def __str__(self) -> str:
        return self.error
