"""What VIPO's processes say of themselves."""

from __future__ import annotations

import uuid

from django.db import models


class Heartbeat(models.Model):
    """A process that works, or did lately. All times are of the database's clock, whatever the process's own says.

    `clock_apart_s` is how far the process's clock is ahead of the database's. No column that a beat writes is indexed,
    so that PostgreSQL writes each of them into the page where the row lies already.
    """

    id = models.UUIDField(primary_key=True, default=uuid.uuid4)
    kind = models.CharField(max_length=20)
    name = models.CharField(max_length=120)
    machine = models.CharField(max_length=120)
    process = models.PositiveIntegerField()
    version = models.CharField(max_length=40)
    activity = models.CharField(max_length=20, blank=True)
    since = models.DateTimeField()
    at = models.DateTimeField()
    ended_at = models.DateTimeField(null=True)
    clock_apart_s = models.FloatField(null=True)
    counters = models.JSONField(default=dict)

    def __str__(self) -> str:
        return f"{self.kind} {self.name}"
