"""Sites and who belongs to them."""

from __future__ import annotations

from django.db import models

from registry.models.people import User


class Site(models.Model):
    """A place with its map, its devices and its members."""

    slug = models.SlugField(max_length=64, unique=True)
    name = models.CharField(max_length=100)
    join_key_hash = models.CharField(max_length=64, blank=True)
    join_broker_hash = models.CharField(max_length=160, blank=True)
    join_key_sealed = models.CharField(max_length=500, blank=True)
    join_key_at = models.DateTimeField(null=True)
    stop_active = models.BooleanField(default=False)
    stop_by = models.CharField(max_length=100, blank=True)
    stop_at = models.DateTimeField(null=True)
    second_factor_from = models.CharField(max_length=10, blank=True, default="")
    """The least role of which the site demands a second factor, empty for none."""
    made_by = models.ForeignKey(User, null=True, on_delete=models.SET_NULL, related_name="+")
    created_at = models.DateTimeField(auto_now_add=True)

    def __str__(self) -> str:
        return self.slug


class Membership(models.Model):
    """What a person may do at a site, until `ends_at` if that is set.

    `seen_at` is when a page of theirs last showed the site, to the minute; `came_by` is the link that they joined by.
    """

    class Role(models.TextChoices):
        """Each role may do all that the ones before it may."""

        VIEWER = "viewer"
        COMMENTER = "commenter"
        OPERATOR = "operator"
        AUTHOR = "author"
        ADMIN = "admin"

    user = models.ForeignKey(User, on_delete=models.CASCADE, related_name="memberships")
    site = models.ForeignKey(Site, on_delete=models.CASCADE, related_name="memberships")
    role = models.CharField(max_length=10, choices=Role.choices)
    joined_at = models.DateTimeField(null=True)
    ends_at = models.DateTimeField(null=True)
    seen_at = models.DateTimeField(null=True)
    came_by = models.ForeignKey("Invitation", null=True, on_delete=models.SET_NULL, related_name="came")

    class Meta:
        """One role for each person at each site."""

        constraints = [models.UniqueConstraint(fields=["user", "site"], name="one_role_per_member")]

    def __str__(self) -> str:
        return f"{self.user_id} is {self.role} of {self.site_id}"
