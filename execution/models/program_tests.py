"""What is kept of the tests of programs: the tests, each time that they were carried out, and what came of it."""

from __future__ import annotations

import uuid

from django.conf import settings
from django.db import models

from execution.models.rehearsals import Rehearsal


class ProgramTest(models.Model):
    """A test beside a program: its text is one entry of a file of tests, `name` stands in it.

    `revision` counts how often it was written; whoever writes says which one they have read.
    """

    id = models.UUIDField(primary_key=True, default=uuid.uuid4, editable=False)
    program = models.ForeignKey("editor.Program", on_delete=models.CASCADE, related_name="tests")
    name = models.CharField(max_length=500)
    text = models.TextField()
    revision = models.PositiveIntegerField(default=1)
    created_at = models.DateTimeField()
    edited_at = models.DateTimeField()
    edited_by = models.ForeignKey(settings.AUTH_USER_MODEL, null=True, on_delete=models.SET_NULL, related_name="+")

    class Meta:
        """A name stands once in a file of tests."""

        constraints = [models.UniqueConstraint(fields=["program", "name"], name="one_test_per_name")]

    def __str__(self) -> str:
        return self.name


class TrialRun(models.Model):
    """Tests of a program carried out together, on a content that `digest` names; `number` is its version, if it is one.

    `rehearsal` is its place in the queue. `whole` is True where all tests of the program were asked for. `ways` are
    those through the program. What is over has `ended_at`; `reason` says why it came to nothing.

    `seeds` is how many each test was carried out with besides its own. `tries_changes` tells whether it was asked which
    changes of the program no test notices; `changes` is what came of that. `site` names by digests what of the site it
    was carried out on: map, places, zones, and each device. `update` names the function of the library and the version
    of it with which the program was tried before it is taken in; None where it was tried as it is.
    """

    id = models.UUIDField(primary_key=True, default=uuid.uuid4, editable=False)
    program = models.ForeignKey("editor.Program", on_delete=models.CASCADE, related_name="+")
    rehearsal = models.OneToOneField(Rehearsal, null=True, on_delete=models.SET_NULL, related_name="test_run")
    number = models.PositiveIntegerField(null=True)
    digest = models.CharField(max_length=64)
    whole = models.BooleanField(default=False)
    by_itself = models.BooleanField(default=False)
    started_by = models.CharField(max_length=120, blank=True)
    total = models.PositiveIntegerField()
    passed = models.PositiveIntegerField(default=0)
    ways = models.JSONField(default=list)
    update = models.JSONField(null=True)
    seeds = models.PositiveSmallIntegerField(default=0, db_default=0)
    tries_changes = models.BooleanField(default=False, db_default=False)
    changes = models.JSONField(null=True)
    site = models.JSONField(default=dict, db_default={})
    reason = models.CharField(max_length=500, blank=True)
    created_at = models.DateTimeField()
    ended_at = models.DateTimeField(null=True)

    class Meta:
        """Looked up by program, the newest first, and by content."""

        indexes = [
            models.Index(fields=["program", "-created_at"], name="test_runs_of_program"),
            models.Index(fields=["program", "digest"], name="test_runs_of_content"),
        ]

    def __str__(self) -> str:
        return f"tests of {self.program_id}"


class MeantChange(models.Model):
    """A change of a program that no test notices, at a step or of a role, and who has said that it is meant so.

    `mark` is a digest of what the step did then.
    """

    program = models.ForeignKey("editor.Program", on_delete=models.CASCADE, related_name="+")
    step = models.CharField(max_length=100, blank=True)
    code = models.CharField(max_length=40)
    name = models.CharField(max_length=200, blank=True)
    mark = models.CharField(max_length=32)
    at = models.DateTimeField()
    by = models.ForeignKey(settings.AUTH_USER_MODEL, null=True, on_delete=models.SET_NULL, related_name="+")

    class Meta:
        """Each is said once."""

        constraints = [
            models.UniqueConstraint(fields=["program", "step", "code", "name"], name="one_meant_change_each")
        ]

    def __str__(self) -> str:
        return f"{self.code} at {self.step or self.name} of {self.program_id}"


class TrialResult(models.Model):
    """What came of a test in a run of tests; `revision` is that of the test, `detail` what was expected and seen.

    `taken` are the ways through the program that it took, each a step and the name of the way.
    """

    class Status(models.TextChoices):
        """Unusable: the program or the site does not have what it names. Stopped: the time was over before."""

        PASSED = "passed"
        FAILED = "failed"
        UNUSABLE = "unusable"
        STOPPED = "stopped"

    run = models.ForeignKey(TrialRun, on_delete=models.CASCADE, related_name="results")
    test = models.ForeignKey(ProgramTest, on_delete=models.CASCADE, related_name="results")
    digest = models.CharField(max_length=64)
    revision = models.PositiveIntegerField()
    status = models.CharField(max_length=10, choices=Status.choices)
    seed = models.BigIntegerField(default=0)
    duration_s = models.FloatField(default=0.0)
    detail = models.JSONField(default=dict)
    taken = models.JSONField(default=list)
    at = models.DateTimeField()

    class Meta:
        """The newest of each test is looked at."""

        indexes = [models.Index(fields=["test", "-at"], name="results_of_test")]

    def __str__(self) -> str:
        return f"{self.test_id} {self.status}"
