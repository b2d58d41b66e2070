"""The second factor of a person: an authenticator app's secret, and the codes for when it is lost."""

from __future__ import annotations

from django.db import models

from registry.models.people import User


class SecondFactor(models.Model):
    """What an authenticator app makes codes from, encrypted; it counts once `confirmed_at` is set.

    `last_step` is the step of 30 s whose code was taken last: none before or at it is taken again.
    """

    user = models.OneToOneField(User, on_delete=models.CASCADE, related_name="second_factor")
    secret = models.CharField(max_length=255)
    confirmed_at = models.DateTimeField(null=True)
    last_step = models.BigIntegerField(default=0)

    def __str__(self) -> str:
        return f"of {self.user_id}"


class RecoveryCode(models.Model):
    """A code that stands in for the app once; its keyed hash alone is kept."""

    user = models.ForeignKey(User, on_delete=models.CASCADE, related_name="recovery_codes")
    code_hash = models.CharField(max_length=64)
    used_at = models.DateTimeField(null=True)

    class Meta:
        """A person has each once."""

        constraints = [models.UniqueConstraint(fields=["user", "code_hash"], name="recovery_code_once")]

    def __str__(self) -> str:
        return f"of {self.user_id}"
