"""Devices, what happened to them, what their properties were, and the legacy topics that they ask for."""

from __future__ import annotations

from django.db import models

from registry.models.people import User
from registry.models.sites import Site


class Device(models.Model):
    """A robot or machine: who it says it is, what people say of it, and its last word."""

    class Lifecycle(models.TextChoices):
        """Pending devices are seen and can do nothing."""

        PENDING = "pending"
        APPROVED = "approved"
        RETIRED = "retired"

    id = models.CharField(primary_key=True, max_length=64)
    site = models.ForeignKey(Site, on_delete=models.CASCADE, related_name="devices")
    lifecycle = models.CharField(max_length=10, choices=Lifecycle.choices, default=Lifecycle.PENDING)
    credential_hash = models.CharField(max_length=64, blank=True)
    broker_hash = models.CharField(max_length=160, blank=True)
    ends_before = models.DateTimeField(null=True)
    key_told_at = models.DateTimeField(null=True)
    dropped = models.BigIntegerField(default=0)

    description = models.JSONField(null=True)
    description_hash = models.CharField(max_length=64, blank=True)
    source = models.BinaryField(default=b"")
    source_type = models.CharField(max_length=40, blank=True)
    source_hash = models.CharField(max_length=64, blank=True)

    granted = models.JSONField(default=dict)

    name_override = models.CharField(max_length=100, blank=True)
    pose_override = models.JSONField(null=True)

    online = models.BooleanField(default=False)
    presence_boot = models.BigIntegerField(default=-1)
    boot = models.BigIntegerField(default=-1)
    seq = models.BigIntegerField(default=-1)
    done = models.BooleanField(default=True)
    command = models.CharField(max_length=64, blank=True)
    pose = models.JSONField(null=True)
    properties = models.JSONField(default=dict)
    first_seen_at = models.DateTimeField(null=True)
    last_seen_at = models.DateTimeField(null=True)
    stand_in = models.BooleanField(default=False)
    aside = models.JSONField(null=True)

    class Meta:
        """Listed by site; looked through for the ones that fell silent, and for those that are simulated."""

        indexes = [
            models.Index(fields=["site", "lifecycle"]),
            models.Index(fields=["online", "last_seen_at"]),
            models.Index(fields=["site"], condition=models.Q(stand_in=True), name="simulated_devices"),
        ]

    def __str__(self) -> str:
        return self.id

    @property
    def is_locked_out(self) -> bool:
        """Tell whether its key was taken away; what was on its way still then does not bring it back."""
        return not self.stand_in and self.ends_before is not None and not self.credential_hash

    @property
    def is_connected(self) -> bool:
        """Tell whether the device itself is there, whoever speaks for it."""
        return bool((self.aside or {}).get("online")) if self.stand_in else self.online


class DeviceEvent(models.Model):
    """One line of a device's history."""

    device = models.ForeignKey(Device, on_delete=models.CASCADE, related_name="events")
    at = models.DateTimeField()
    kind = models.CharField(max_length=20)
    text = models.CharField(max_length=300)
    code = models.CharField(max_length=30, blank=True)
    args = models.JSONField(default=dict)
    changes = models.JSONField(default=list)
    by = models.ForeignKey(User, null=True, on_delete=models.SET_NULL, related_name="+")

    class Meta:
        """Read newest first."""

        indexes = [models.Index(fields=["device", "-at"])]

    def __str__(self) -> str:
        return self.text


class ThingEvent(models.Model):
    """What became of a device's Thing; `change` is all of a new one, and a merge patch of one that changed."""

    site = models.ForeignKey("registry.Site", on_delete=models.CASCADE, related_name="thing_events")
    device_id = models.CharField(max_length=64)
    kind = models.CharField(max_length=20)
    change = models.JSONField(default=dict)
    at = models.DateTimeField(auto_now_add=True)

    def __str__(self) -> str:
        return f"{self.kind} {self.device_id}"


class Sample(models.Model):
    """What a device's property was within one minute: its least and greatest number, and its last value as JSON.

    `minute` counts from 1970, `seq` is higher the later it was written.
    """

    device = models.ForeignKey(Device, on_delete=models.CASCADE, related_name="samples")
    property = models.CharField(max_length=64)
    minute = models.IntegerField(db_index=True)
    value = models.TextField()
    minimum = models.FloatField(null=True)
    maximum = models.FloatField(null=True)
    at_ms = models.BigIntegerField()
    seq = models.BigIntegerField(db_index=True)

    class Meta:
        """One row for each property and minute."""

        constraints = [models.UniqueConstraint(fields=["device", "property", "minute"], name="one_sample_per_minute")]

    def __str__(self) -> str:
        return f"{self.property} of {self.device_id}: {self.value}"


class SampleClock(models.Model):
    """The one row that numbers samples."""

    next = models.BigIntegerField(default=1)

    def __str__(self) -> str:
        return str(self.next)


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
