"""Screens in a hall that show one site, without anybody who has signed in."""

from __future__ import annotations

from django.db import models

from registry.models.people import User
from registry.models.sites import Site


class WallScreen(models.Model):
    """A way to look at one site for whoever holds its link; of the code in it only a hash of a hash is kept."""

    site = models.ForeignKey(Site, on_delete=models.CASCADE, related_name="wall_screens")
    name = models.CharField(max_length=100)
    key_hash = models.CharField(max_length=64, unique=True)
    made_by = models.ForeignKey(User, null=True, on_delete=models.SET_NULL, related_name="+")
    made_at = models.DateTimeField()
    expires_at = models.DateTimeField()
    seen_at = models.DateTimeField(null=True)

    class Meta:
        """Listed for one site, the newest first."""

        indexes = [models.Index(fields=["site", "-made_at"], name="wall_screen_site_made_at")]

    def __str__(self) -> str:
        return self.name
