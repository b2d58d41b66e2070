"""What is kept of archives, files of what are no longer rows, and what a site sets: for how long it keeps rows."""

from __future__ import annotations

import uuid

from django.db import models


class Archive(models.Model):
    """A file of histories that are no longer rows: below the archive folder, written by `execution.retention`.

    While it is `writing` the file is not to be believed and all of it is still in rows; once it is `whole` it was read
    back, and the rows of it are being deleted. One that was left while it was written is `discarded`: whoever wrote it
    can no longer say that it is whole. Times are those at which the first and the last of it ended.
    """

    class State(models.TextChoices):
        """How far it is."""

        WRITING = "writing"
        DISCARDED = "discarded"
        WHOLE = "whole"
        PRUNED = "pruned"

    id = models.UUIDField(primary_key=True, default=uuid.uuid4)
    site = models.ForeignKey("registry.Site", on_delete=models.CASCADE, related_name="archives")
    kind = models.CharField(max_length=12)
    file = models.CharField(max_length=200, unique=True)
    state = models.CharField(max_length=9, choices=State.choices, default=State.WRITING)
    count = models.PositiveIntegerField(default=0)
    bytes = models.BigIntegerField(default=0)
    first_at = models.DateTimeField(null=True)
    last_at = models.DateTimeField(null=True)
    made_at = models.DateTimeField()
    pruned_at = models.DateTimeField(null=True)

    class Meta:
        """Listed for a site, the newest first; those that are not done are few."""

        indexes = [models.Index(fields=["site", "made_at"])]

    def __str__(self) -> str:
        return self.file


class Keeping(models.Model):
    """For how many days a site keeps what has ended as rows; 0: for ever, None: as the server's settings say.

    `trouble` says why the last archiving did not go through; empty when it did.
    """

    site = models.OneToOneField("registry.Site", on_delete=models.CASCADE, related_name="keeping")
    runs_days = models.PositiveIntegerField(null=True)
    rehearsals_days = models.PositiveIntegerField(null=True)
    calls_days = models.PositiveIntegerField(null=True)
    trouble = models.CharField(max_length=300, blank=True)
    trouble_at = models.DateTimeField(null=True)

    def __str__(self) -> str:
        return f"keeping of {self.site_id}"


class Archivable(models.Model):
    """What may be in an archive: in which, at which byte of it, and how many bytes it takes there.

    Of what is in an archive only a summary stays in the row.
    """

    archive = models.ForeignKey(Archive, null=True, on_delete=models.RESTRICT, related_name="+")
    archive_offset = models.BigIntegerField(default=0)
    archive_bytes = models.BigIntegerField(default=0)

    class Meta:
        """No table of its own."""

        abstract = True
