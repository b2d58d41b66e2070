"""Requests that shall be carried out once, however often they are sent."""

from __future__ import annotations

from django.db import models


class KeyedRequest(models.Model):
    """A request with an Idempotency-Key: under way, or with the answer that it was given.

    `owner` is the person, and the token if one was shown. `status` is 0 while it is under way. `needs` are the site,
    role and scope of each right that it required; None where that was not kept.
    """

    owner = models.CharField(max_length=48)
    key = models.CharField(max_length=255)
    fingerprint = models.CharField(max_length=64)
    begun_at = models.DateTimeField()
    status = models.PositiveSmallIntegerField(default=0)
    headers = models.JSONField(default=dict)
    body = models.BinaryField(null=True)
    needs = models.JSONField(null=True)

    class Meta:
        """The first request with a key is the only one; which are old is found by when they began."""

        constraints = [models.UniqueConstraint(fields=["owner", "key"], name="one_request_per_key")]
        indexes = [models.Index(fields=["begun_at"], name="keyed_request_begun")]

    def __str__(self) -> str:
        return f"{self.owner} {self.key[:40]}"
