"""Invitations to a site by link."""

from __future__ import annotations

from django.db import models

from registry.models.people import User
from registry.models.sites import Site


class Invitation(models.Model):
    """A way in for whoever holds its link; of the code in it only the SHA-256 is kept.

    `uses` is how many people may come by it, `email` whom it was sent to, if anybody.
    """

    site = models.ForeignKey(Site, on_delete=models.CASCADE, related_name="invitations")
    role = models.CharField(max_length=10)
    code_hash = models.CharField(max_length=64, unique=True)
    email = models.CharField(max_length=254, blank=True)
    made_by = models.ForeignKey(User, null=True, on_delete=models.SET_NULL, related_name="+")
    made_at = models.DateTimeField()
    expires_at = models.DateTimeField()
    uses = models.PositiveSmallIntegerField()
    used = models.PositiveSmallIntegerField(default=0)
    revoked_at = models.DateTimeField(null=True)

    class Meta:
        """Listed for one site, the newest first."""

        indexes = [models.Index(fields=["site", "-made_at"], name="invitation_site_made_at")]

    def __str__(self) -> str:
        return f"{self.role} of {self.site_id}"
