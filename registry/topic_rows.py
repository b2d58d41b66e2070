"""How the legacy topics are kept that devices ask for."""

from __future__ import annotations

from django.db import models


class TopicClaim(models.Model):
    """A topic outside of `vipo/` that one device asks for, first of all devices; confirmed once an admin has said so.

    The confirmed ones stand in `Device.granted`, too, which is read with every state.
    """

    topic = models.CharField(max_length=200, primary_key=True)
    device = models.ForeignKey("registry.Device", on_delete=models.CASCADE, related_name="claims")
    method = models.CharField(max_length=64)
    asked_at = models.DateTimeField()
    confirmed_at = models.DateTimeField(null=True)
    confirmed_by = models.ForeignKey("registry.User", null=True, on_delete=models.SET_NULL, related_name="+")

    class Meta:
        """A method has one topic, a topic one device: of two that ask at once, the database gives it to one."""

        constraints = [models.UniqueConstraint(fields=["device", "method"], name="one_topic_per_method")]

    def __str__(self) -> str:
        return f"{self.topic} for {self.method} of {self.device_id}"
