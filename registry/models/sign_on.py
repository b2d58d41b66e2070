"""Single sign-on: which account of a provider is whose here, and the sign-ons that are under way."""

from __future__ import annotations

from django.db import models

from registry.models.invitations import Invitation
from registry.models.people import User


class SignOn(models.Model):
    """A person's account at a provider; the two are one by issuer and subject, never by an address.

    `had_factor` tells whether the provider vouched for a second factor when it was used last.
    """

    user = models.ForeignKey(User, models.CASCADE, related_name="sign_ons")
    provider = models.CharField(max_length=20)
    issuer = models.CharField(max_length=255)
    subject = models.CharField(max_length=255)
    label = models.CharField(max_length=254, blank=True)
    had_factor = models.BooleanField(default=False)
    linked_at = models.DateTimeField()
    used_at = models.DateTimeField(null=True)

    class Meta:
        """One person for each account of a provider, and one account of each issuer for a person."""

        constraints = [
            models.UniqueConstraint(fields=["issuer", "subject"], name="sign_on_of_one_person"),
            models.UniqueConstraint(fields=["user", "issuer"], name="sign_on_once_of_issuer"),
        ]

    def __str__(self) -> str:
        return f"{self.user_id} at {self.issuer}"


class SignOnAttempt(models.Model):
    """A sign-on that somebody has begun; of its state and of its browser's secret hashes alone are kept.

    `link_to` is who wants to be linked, `invitation` the link that they came by. `identity` is what the provider has
    said, kept while a code of the second factor is awaited.
    """

    state_hash = models.CharField(max_length=64, unique=True)
    browser_hash = models.CharField(max_length=64)
    provider = models.CharField(max_length=20)
    network = models.CharField(max_length=64)
    next = models.CharField(max_length=500, blank=True)
    link_to = models.ForeignKey(User, models.CASCADE, null=True, related_name="+")
    invitation = models.ForeignKey(Invitation, models.CASCADE, null=True, related_name="+")
    at = models.DateTimeField()
    used_at = models.DateTimeField(null=True)
    done_at = models.DateTimeField(null=True)
    identity = models.JSONField(null=True)

    class Meta:
        """Counted for a network, forgotten by age."""

        indexes = [
            models.Index(fields=["network", "at"], name="sign_on_attempt_network"),
            models.Index(fields=["at"], name="sign_on_attempt_at"),
        ]

    def __str__(self) -> str:
        return f"{self.provider} at {self.at:%F %T}"
