"""What is kept of rehearsals."""

from __future__ import annotations

import uuid

from django.db import models

from execution.models.archives import Archivable


class Rehearsal(Archivable):
    """A program tried out in a simulated world, or its tests: `kind` says which; tests leave their results elsewhere.

    `person` is whose it is. The worker that carries it out has its `claim`, runs on `machine` and says at `beat_at`, by
    the database's clock, that it goes on; `tries` counts how often it was begun, `course` says how far it is, `asked`
    how it was asked for: version, seed, driver, parameters, faults, `zone_waits` how long robots waited before zones.
    """

    class Status(models.TextChoices):
        """The life of a rehearsal."""

        QUEUED = "queued"
        RUNNING = "running"
        DONE = "done"
        FAILED = "failed"
        CANCELLED = "cancelled"

    class Kind(models.TextChoices):
        """What is carried out."""

        REHEARSAL = "rehearsal"
        TESTS = "tests"

    OPEN = (Status.QUEUED, Status.RUNNING)

    id = models.UUIDField(primary_key=True, default=uuid.uuid4)
    site = models.ForeignKey("registry.Site", on_delete=models.CASCADE, related_name="rehearsals")
    program = models.UUIDField(db_index=True)
    program_name = models.CharField(max_length=200, default="")
    kind = models.CharField(max_length=10, choices=Kind.choices, default=Kind.REHEARSAL, db_default=Kind.REHEARSAL)
    status = models.CharField(max_length=10, choices=Status.choices, default=Status.QUEUED)
    progress = models.FloatField(default=0.0)
    course = models.JSONField(default=dict)
    job = models.JSONField(default=dict)
    asked = models.JSONField(default=dict, db_default={})
    document = models.JSONField(default=dict)
    compiled = models.JSONField(default=dict)
    result = models.JSONField(null=True)
    zone_waits = models.JSONField(default=dict, db_default={})
    reason = models.CharField(max_length=500, blank=True)
    started_by = models.CharField(max_length=120, blank=True)
    person = models.BigIntegerField(null=True)
    claim = models.UUIDField(null=True)
    machine = models.CharField(max_length=255, blank=True, default="")
    tries = models.PositiveSmallIntegerField(default=0)
    created_at = models.DateTimeField()
    began_at = models.DateTimeField(null=True)
    beat_at = models.DateTimeField(null=True)
    ended_at = models.DateTimeField(null=True)

    class Meta:
        """Those that are not over are few among all that were kept."""

        indexes = [
            models.Index(
                fields=["status"], condition=models.Q(status__in=["queued", "running"]), name="rehearsals_not_over"
            ),
            models.Index(fields=["began_at"]),
            models.Index(fields=["site", "ended_at"], condition=models.Q(archive=None), name="rehearsals_not_archived"),
        ]

    def __str__(self) -> str:
        return f"rehearsal of {self.program}"
