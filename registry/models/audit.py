"""What was done at a site."""

from __future__ import annotations

from django.db import models

from registry.models.sites import Site


class AuditLine(models.Model):
    """Who did what, when and from where; `facts` are what its sentence names.

    `person_id` is no foreign key: a line stays as it is, whatever becomes of the person. Without a site it is about the
    server, such as a sign-on of somebody whom no site knows, and whoever runs this VIPO server reads it.
    """

    site = models.ForeignKey(Site, on_delete=models.CASCADE, null=True, related_name="+")
    at = models.DateTimeField()
    kind = models.CharField(max_length=12)
    code = models.CharField(max_length=32)
    actor_kind = models.CharField(max_length=8)
    actor = models.CharField(max_length=100, blank=True)
    person_id = models.BigIntegerField(null=True)
    address = models.CharField(max_length=64, blank=True)
    agent = models.CharField(max_length=1000, blank=True)
    facts = models.JSONField(default=dict)

    class Meta:
        """Read by site, or site and kind, the newest first; forgotten by age."""

        indexes = [
            models.Index(fields=["site", "-at"], name="audit_site_at"),
            models.Index(fields=["site", "kind", "-at"], name="audit_site_kind_at"),
            models.Index(fields=["at"], name="audit_at"),
        ]

    def __str__(self) -> str:
        return f"{self.at:%F %T} {self.code}"
