"""Tokens by which programs ask as a person."""

from __future__ import annotations

from django.db import models

from registry.models.sites import Membership


class ApiToken(models.Model):
    """A program's way in: it asks as a member of one site, and ends with the membership.

    Of the token itself only the SHA-256 of its secret part is kept; that part is random, so that a slow hash would
    add nothing. One that also opens the broker has in `broker_hash` what Mosquitto keeps of it.
    """

    membership = models.ForeignKey(Membership, on_delete=models.CASCADE, related_name="tokens")
    public_id = models.CharField(max_length=16, unique=True)
    secret_hash = models.CharField(max_length=64)
    name = models.CharField(max_length=100)
    scopes = models.CharField(max_length=40)
    created_at = models.DateTimeField()
    expires_at = models.DateTimeField()
    last_used_at = models.DateTimeField(null=True)
    broker_hash = models.CharField(max_length=160, blank=True)

    class Meta:
        """Those that are long over are found by when they ended."""

        indexes = [models.Index(fields=["expires_at"], name="api_token_expires")]

    def __str__(self) -> str:
        return self.public_id
