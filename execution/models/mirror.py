"""What is kept of the mirror: what devices took beside their copies, and the paces that people have taken over."""

from __future__ import annotations

from django.conf import settings
from django.db import models


class Measurement(models.Model):
    """What a device took for a command, or for the pieces of one Move, beside what its copy took (seconds).

    `command` is the first of them: what two mirrors measure at once is kept once. `apart_m` is how far a robot and its
    copy were apart at most in that job.
    """

    site = models.ForeignKey("registry.Site", on_delete=models.CASCADE, related_name="+")
    device = models.CharField(max_length=64)
    method = models.CharField(max_length=64)
    command = models.UUIDField(unique=True)
    run = models.UUIDField(null=True, db_index=True)
    step = models.CharField(max_length=64, blank=True)
    real_s = models.FloatField()
    predicted_s = models.FloatField()
    apart_m = models.FloatField(null=True)
    at = models.DateTimeField()

    class Meta:
        """Read by method, the newest first."""

        indexes = [models.Index(fields=["site", "device", "method", "-at"], name="measurements_of_method")]

    def __str__(self) -> str:
        return f"{self.method} of {self.device}: {self.real_s:.1f} s, predicted {self.predicted_s:.1f} s"


class Calibration(models.Model):
    """A measured pace that somebody took over: rehearsals and tests let this method take `pace` times its usual time.

    `count` is of how many measurements it was the median.
    """

    site = models.ForeignKey("registry.Site", on_delete=models.CASCADE, related_name="+")
    device = models.CharField(max_length=64)
    method = models.CharField(max_length=64)
    pace = models.FloatField()
    count = models.PositiveIntegerField()
    at = models.DateTimeField()
    by = models.ForeignKey(settings.AUTH_USER_MODEL, null=True, on_delete=models.SET_NULL, related_name="+")

    class Meta:
        """A method has one."""

        constraints = [models.UniqueConstraint(fields=["site", "device", "method"], name="one_pace_per_method")]

    def __str__(self) -> str:
        return f"{self.method} of {self.device} takes {self.pace:.2f} times as long"
