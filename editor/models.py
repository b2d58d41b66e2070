"""Programs, what was typed into their shared documents, their versions, and the library of functions."""

from __future__ import annotations

import uuid

from django.conf import settings
from django.db import models


class Program(models.Model):
    """A program of a site; its content is the shared document, kept as updates and snapshots."""

    id = models.UUIDField(primary_key=True, default=uuid.uuid4, editable=False)
    site = models.ForeignKey("registry.Site", on_delete=models.CASCADE, related_name="programs")
    name = models.CharField(max_length=120)
    created_at = models.DateTimeField(auto_now_add=True)
    edited_at = models.DateTimeField()
    edited_by = models.ForeignKey(settings.AUTH_USER_MODEL, null=True, on_delete=models.SET_NULL, related_name="+")
    last_seq = models.BigIntegerField(default=0)
    stored_to = models.CharField(max_length=40, blank=True, default="")
    """The entry of the room's stream up to which every change is in the rows."""
    last_version = models.PositiveIntegerField(default=0)
    origin = models.ForeignKey("self", null=True, on_delete=models.SET_NULL, related_name="+")
    origin_version = models.PositiveIntegerField(default=0)
    """The program of another site that it was made from, at which version of that."""
    drawn_by = models.JSONField(default=dict)
    """Who has changed it since its last version: each person's id as text, and the number of their last row."""
    kinds = models.JSONField(default=list)
    devices = models.JSONField(default=list)
    places = models.JSONField(default=list)
    errors = models.PositiveIntegerField(default=0)
    warnings = models.PositiveIntegerField(default=0)
    checked_against = models.CharField(max_length=64, blank=True)

    class Meta:
        """Listed by site, the last edited first."""

        indexes = [models.Index(fields=["site", "-edited_at"])]


class DocumentUpdate(models.Model):
    """One change of a shared document, as its own document told it; `seq` counts up within the program."""

    program = models.ForeignKey(Program, on_delete=models.CASCADE, related_name="updates")
    seq = models.BigIntegerField()
    author = models.ForeignKey(settings.AUTH_USER_MODEL, null=True, on_delete=models.SET_NULL, related_name="+")
    data = models.BinaryField()
    at = models.DateTimeField(auto_now_add=True)

    class Meta:
        """Read in the order in which they were appended."""

        constraints = [models.UniqueConstraint(fields=["program", "seq"], name="one_update_per_seq")]


class Snapshot(models.Model):
    """A whole shared document as one update, holding everything up to `seq`.

    `authors` has for each Yjs client, as text, whose it was: the rows that said so are gone.
    """

    program = models.ForeignKey(Program, on_delete=models.CASCADE, related_name="snapshots")
    seq = models.BigIntegerField()
    data = models.BinaryField()
    authors = models.JSONField(default=dict)
    at = models.DateTimeField(auto_now_add=True)

    class Meta:
        """The one with the highest `seq` holds."""

        constraints = [models.UniqueConstraint(fields=["program", "seq"], name="one_snapshot_per_seq")]


class Version(models.Model):
    """A program as it was when it was pinned; what runs is always a version. Only its name and message may change.

    `author` pinned it, `authors` are the ids of those who had drawn since the version before. `content` is its document
    and script as `editor.programs.packing` packs them: whole, or as the difference to the version `base`, which is
    whole. `cause` says before what it was made by itself, and is empty where somebody made it.
    """

    class Cause(models.TextChoices):
        """Before what a version is made by itself."""

        RUN = "run"
        REHEARSAL = "rehearsal"
        IMPORT = "import"
        RESTORE = "restore"

    id = models.UUIDField(primary_key=True, default=uuid.uuid4, editable=False)
    program = models.ForeignKey(Program, on_delete=models.CASCADE, related_name="versions")
    number = models.PositiveIntegerField()
    author = models.ForeignKey(settings.AUTH_USER_MODEL, null=True, on_delete=models.SET_NULL, related_name="+")
    authors = models.JSONField(default=list)
    name = models.CharField(max_length=80, blank=True, default="")
    message = models.CharField(max_length=300, blank=True)
    cause = models.CharField(max_length=10, blank=True, default="", choices=Cause.choices)
    base = models.ForeignKey("self", null=True, on_delete=models.CASCADE, related_name="+")
    content = models.BinaryField()
    digest = models.CharField(max_length=64)
    created_at = models.DateTimeField(auto_now_add=True)

    class Meta:
        """Numbered from 1 within the program."""

        constraints = [models.UniqueConstraint(fields=["program", "number"], name="one_version_per_number")]


class VersionToTest(models.Model):
    """A version that somebody has named, until whoever carries tests out has taken it."""

    version = models.OneToOneField(Version, on_delete=models.CASCADE, related_name="+")
    asked_at = models.DateTimeField(auto_now_add=True)


class LibraryFunction(models.Model):
    """A function that programs may bring in; its content is in its versions.

    `author` made its first version, and is empty where they are gone. Who sees it may bring it in.
    """

    class Visibility(models.TextChoices):
        """Who sees a function: its author, its site's members, everybody who is signed in."""

        ME = "me"
        SITE = "site"
        EVERYONE = "everyone"

    id = models.UUIDField(primary_key=True, default=uuid.uuid4, editable=False)
    site = models.ForeignKey("registry.Site", on_delete=models.CASCADE, related_name="library")
    name = models.CharField(max_length=120)
    author = models.ForeignKey(settings.AUTH_USER_MODEL, null=True, on_delete=models.SET_NULL, related_name="+")
    visibility = models.CharField(max_length=10, default="site", choices=Visibility.choices)
    description = models.CharField(max_length=500, blank=True)
    last_version = models.PositiveIntegerField(default=0)
    origin = models.ForeignKey("self", null=True, on_delete=models.SET_NULL, related_name="forks")
    origin_version = models.PositiveIntegerField(default=0)
    """What it was made from, at which version of that."""
    found_by = models.TextField(blank=True, default="")
    """All words that it is found by, as `editor.library.words` folds them."""
    demands = models.TextField(default="[]")
    """What its newest version needs of devices, as `editor.language.signatures.fit` writes it."""
    updated_at = models.DateTimeField(auto_now=True)

    class Meta:
        """A name stands for one function at a site; saving under it again makes a new version."""

        constraints = [models.UniqueConstraint(fields=["site", "name"], name="one_library_function_per_name")]
        indexes = [models.Index(fields=["visibility", "name"])]


class LibraryVersion(models.Model):
    """A library function as it was saved; never changed."""

    function = models.ForeignKey(LibraryFunction, on_delete=models.CASCADE, related_name="versions")
    number = models.PositiveIntegerField()
    author = models.ForeignKey(settings.AUTH_USER_MODEL, null=True, on_delete=models.SET_NULL, related_name="+")
    definition = models.JSONField()
    script = models.TextField()
    signature = models.JSONField(default=dict)
    """What it is to who calls it, as `editor.language.site.signature` writes it."""
    created_at = models.DateTimeField(auto_now_add=True)

    class Meta:
        """Numbered from 1 within the function."""

        constraints = [models.UniqueConstraint(fields=["function", "number"], name="one_library_version_per_number")]


class LibraryUse(models.Model):
    """That a program holds a library function, kept up to date when the program is compiled."""

    function = models.ForeignKey(LibraryFunction, on_delete=models.CASCADE, related_name="uses")
    program = models.ForeignKey(Program, on_delete=models.CASCADE, related_name="library_uses")
    versions = models.JSONField(default=list)
    """The numbers of the versions that it holds, in order; empty until it is next checked."""

    class Meta:
        """Counted once for each program."""

        constraints = [models.UniqueConstraint(fields=["function", "program"], name="one_use_per_program")]


class LibraryPart(models.Model):
    """That a version of a library function holds another function of the library, at a version of that."""

    function = models.ForeignKey(LibraryFunction, on_delete=models.CASCADE, related_name="parts")
    number = models.PositiveIntegerField()
    holder = models.ForeignKey(LibraryVersion, on_delete=models.CASCADE, related_name="holds")

    class Meta:
        """Counted once for each version of either."""

        constraints = [
            models.UniqueConstraint(fields=["function", "number", "holder"], name="one_part_per_library_version")
        ]


class CommentThread(models.Model):
    """A talk beside a program's document: about a construct, an arrow, a place of the map, or the whole program.

    `anchor` says about what, as `editor.comments.anchors` reads it; `label` is what that was called when it began, and
    stays where the thing is deleted. `last_at` is when somebody last wrote in it.
    """

    id = models.UUIDField(primary_key=True, default=uuid.uuid4, editable=False)
    program = models.ForeignKey(Program, on_delete=models.CASCADE, related_name="threads")
    anchor = models.JSONField()
    label = models.CharField(max_length=120, blank=True)
    started_at = models.DateTimeField()
    last_at = models.DateTimeField()
    resolved_at = models.DateTimeField(null=True)
    resolved_by = models.ForeignKey(settings.AUTH_USER_MODEL, null=True, on_delete=models.SET_NULL, related_name="+")

    class Meta:
        """Listed by program, the last written in first."""

        indexes = [models.Index(fields=["program", "-last_at"], name="threads_of_program")]


class Comment(models.Model):
    """What a person wrote in a thread; `mentions` are the ids of those whom it calls."""

    id = models.UUIDField(primary_key=True, default=uuid.uuid4, editable=False)
    thread = models.ForeignKey(CommentThread, on_delete=models.CASCADE, related_name="comments")
    author = models.ForeignKey(settings.AUTH_USER_MODEL, null=True, on_delete=models.SET_NULL, related_name="+")
    text = models.TextField()
    mentions = models.JSONField(default=list)
    written_at = models.DateTimeField()
    edited_at = models.DateTimeField(null=True)

    class Meta:
        """Read in the order in which they were written."""

        indexes = [
            models.Index(fields=["thread", "written_at"], name="comments_of_thread"),
            models.Index(fields=["author", "written_at"], name="comments_of_author"),
        ]


class ThreadReading(models.Model):
    """Up to when a person has read a thread."""

    thread = models.ForeignKey(CommentThread, on_delete=models.CASCADE, related_name="readings")
    person = models.ForeignKey(settings.AUTH_USER_MODEL, on_delete=models.CASCADE, related_name="+")
    read_to = models.DateTimeField()

    class Meta:
        """One for each person and thread."""

        constraints = [models.UniqueConstraint(fields=["thread", "person"], name="one_reading_per_person")]


class CommentNotice(models.Model):
    """That somebody is to hear of a comment by e-mail, unless they read it first; gone once it is sent or read.

    `origin` is where the writer reached VIPO, for the link. Who sends takes it at `taken_at`, so that nobody else does.
    """

    comment = models.ForeignKey(Comment, on_delete=models.CASCADE, related_name="notices")
    person = models.ForeignKey(settings.AUTH_USER_MODEL, on_delete=models.CASCADE, related_name="+")
    origin = models.CharField(max_length=300)
    made_at = models.DateTimeField()
    taken_at = models.DateTimeField(null=True)

    class Meta:
        """One for each person and comment; those that wait longest are sent first."""

        constraints = [models.UniqueConstraint(fields=["comment", "person"], name="one_notice_per_person")]
        indexes = [models.Index(fields=["made_at"], name="comment_notices_made")]


class ReviewRule(models.Model):
    """How many approvals a site demands before a program may run on its devices (0: none), and who may give them.

    Its row is also the lock that who starts a run, who approves and who changes the rule take in turn.
    """

    site = models.OneToOneField("registry.Site", on_delete=models.CASCADE, related_name="review_rule")
    approvals = models.PositiveSmallIntegerField(default=0)
    least_role = models.CharField(max_length=10, default="author")


class ReviewEntry(models.Model):
    """One line of what was asked and said about a program's content; never changed. A person's last word counts.

    `digest` is of the document that was looked at, `number` the version in which it was. `name` stays when the person
    is gone.
    """

    class Kind(models.TextChoices):
        """What was said."""

        ASKED = "asked"
        APPROVED = "approved"
        CHANGES = "changes"
        WITHDRAWN = "withdrawn"

    program = models.ForeignKey(Program, on_delete=models.CASCADE, related_name="review_entries")
    number = models.PositiveIntegerField()
    digest = models.CharField(max_length=64)
    kind = models.CharField(max_length=10, choices=Kind.choices)
    person = models.ForeignKey(settings.AUTH_USER_MODEL, null=True, on_delete=models.SET_NULL, related_name="+")
    name = models.CharField(max_length=120)
    note = models.CharField(max_length=500, blank=True)
    at = models.DateTimeField(auto_now_add=True)

    class Meta:
        """Looked up by the content of a program."""

        indexes = [models.Index(fields=["program", "digest"])]
