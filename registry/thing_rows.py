"""The rows of what became of Things; apart from the other models, which are many already."""

from __future__ import annotations

from django.db import models


class ThingEvent(models.Model):
    """What became of a device's Thing; `change` is all of a new one, and a merge patch of one that changed."""

    site = models.ForeignKey("registry.Site", on_delete=models.CASCADE, related_name="thing_events")
    device_id = models.CharField(max_length=64)
    kind = models.CharField(max_length=20)
    change = models.JSONField(default=dict)
    at = models.DateTimeField(auto_now_add=True)

    def __str__(self) -> str:
        return f"{self.kind} {self.device_id}"
