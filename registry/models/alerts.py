"""How alerts are kept."""

from __future__ import annotations

from django.db import models
from django.db.models import Q


class DeviceAlert(models.Model):
    """Something about a device that people should know and deal with; its meaning is in registry/alerts/causes.py.

    `last_at` is when it was raised, or its words changed, last; `count` is how often that was.
    """

    device = models.ForeignKey("registry.Device", on_delete=models.CASCADE, related_name="alerts")
    code = models.CharField(max_length=40)
    args = models.JSONField(default=dict)
    count = models.PositiveIntegerField(default=1)
    first_at = models.DateTimeField()
    last_at = models.DateTimeField()
    over_at = models.DateTimeField(null=True)
    seen_at = models.DateTimeField(null=True)
    seen_by = models.ForeignKey("registry.User", null=True, on_delete=models.SET_NULL, related_name="+")

    class Meta:
        """At most one of a code is open at a device."""

        constraints = [
            models.UniqueConstraint(fields=["device", "code"], condition=Q(over_at=None), name="one_open_alert")
        ]
        indexes = [
            models.Index(fields=["device", "-last_at"], name="alert_by_device"),
            models.Index(fields=["over_at"], name="alert_by_end"),
        ]

    def __str__(self) -> str:
        return f"{self.code} of {self.device_id}"
