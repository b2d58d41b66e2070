"""What is kept of commands: the outbox."""

from __future__ import annotations

from django.db import models


class Command(models.Model):
    """A command to a device: written with the state that decided it, sent until it is answered.

    `site_fence` is the site's when a person gave it by hand, None otherwise. With `stand_in` it is told to the device's
    stand-in, not to the device itself.
    """

    class Status(models.TextChoices):
        """The life of a command."""

        PENDING = "pending"
        SENT = "sent"
        ACCEPTED = "accepted"
        RUNNING = "running"
        DONE = "done"
        FAILED = "failed"
        REJECTED = "rejected"
        CANCELLED = "cancelled"
        TIMED_OUT = "timed_out"

    OPEN = (Status.PENDING, Status.SENT, Status.ACCEPTED, Status.RUNNING)

    id = models.UUIDField(primary_key=True)
    site = models.ForeignKey("registry.Site", on_delete=models.CASCADE, related_name="commands")
    position = models.BigIntegerField()
    device = models.CharField(max_length=64)
    method = models.CharField(max_length=64)
    arguments = models.JSONField(default=dict)
    run = models.UUIDField(null=True, db_index=True)
    step = models.CharField(max_length=64, blank=True)
    piece = models.BooleanField(default=False)
    status = models.CharField(max_length=10, choices=Status.choices, default=Status.PENDING)
    why = models.CharField(max_length=500, blank=True)
    result = models.JSONField(default=dict)
    by = models.CharField(max_length=120, blank=True)
    fence = models.PositiveIntegerField(default=0)
    site_fence = models.BigIntegerField(null=True)
    stand_in = models.BooleanField(default=False, db_default=False)
    tries = models.PositiveIntegerField(default=0)
    ttl_s = models.FloatField(default=60.0)
    send_after = models.DateTimeField()
    created_at = models.DateTimeField()
    sent_at = models.DateTimeField(null=True)
    ended_at = models.DateTimeField(null=True)

    class Meta:
        """The outbox is read by what is to be sent next."""

        indexes = [
            models.Index(fields=["status", "send_after"]),
            models.Index(fields=["device", "status"]),
            models.Index(fields=["device", "position"]),
            models.Index(
                fields=["ended_at"],
                condition=models.Q(status__in=["failed", "rejected", "timed_out"]),
                name="commands_gone_wrong",
            ),
            models.Index(
                fields=["device", "method", "ended_at"], condition=models.Q(status="done"), name="commands_done"
            ),
            models.Index(fields=["site", "ended_at"], condition=models.Q(run=None), name="commands_of_no_run"),
        ]

    def __str__(self) -> str:
        return f"{self.method} to {self.device}"
