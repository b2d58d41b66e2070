"""What is kept of runs: rows, journals, timers, inputs and questions, and the programs that start by themselves."""

from __future__ import annotations

import uuid

from django.db import models

from execution.models.archives import Archivable


class Run(Archivable):
    """A program being carried out. It holds all it needs: the document, the plan and the machine's state.

    `not_before` is when it may begin, `deadline` when it should be over; `late` says that people were told that it is
    not. `fence` is the site's when somebody started it or resumed it last: with one from before a stop it stands still.
    `permit` says which approvals let it start, or for which emergency; it is empty where none were demanded. `places`
    are those of the site when it began, by which it goes until it ends; None before, and of runs older than the column.
    """

    class Status(models.TextChoices):
        """The life of a run."""

        PENDING = "pending"
        RUNNING = "running"
        PAUSED = "paused"
        FINISHED = "finished"
        FAILED = "failed"
        CANCELLED = "cancelled"

    class Priority(models.IntegerChoices):
        """Whose tasks find robots first."""

        LOW = -1
        NORMAL = 0
        HIGH = 1

    OPEN = (Status.PENDING, Status.RUNNING, Status.PAUSED)

    id = models.UUIDField(primary_key=True, default=uuid.uuid4)
    site = models.ForeignKey("registry.Site", on_delete=models.CASCADE, related_name="runs")
    number = models.PositiveIntegerField()
    program = models.UUIDField(db_index=True)
    program_name = models.CharField(max_length=200)
    version = models.PositiveIntegerField(default=0)
    status = models.CharField(max_length=10, choices=Status.choices, default=Status.PENDING)
    reason = models.CharField(max_length=500, blank=True)
    parameters = models.JSONField(default=dict)
    document = models.JSONField(default=dict)
    compiled = models.JSONField(default=dict)
    plan = models.JSONField(default=dict)
    state = models.JSONField(null=True)
    places = models.JSONField(null=True)
    epoch = models.PositiveIntegerField(default=0)
    watches = models.BooleanField(default=False)
    steps = models.JSONField(default=dict)
    roles = models.JSONField(default=dict)
    next_seq = models.PositiveIntegerField(default=1)
    inputs_kept = models.PositiveIntegerField(default=0, db_default=0)
    entry = models.PositiveIntegerField(default=0)
    notices = models.JSONField(default=dict)
    started_by = models.CharField(max_length=120, blank=True)
    priority = models.SmallIntegerField(choices=Priority.choices, default=Priority.NORMAL)
    not_before = models.DateTimeField(null=True)
    deadline = models.DateTimeField(null=True)
    late = models.BooleanField(default=False)
    fence = models.BigIntegerField(default=0)
    permit = models.JSONField(default=dict, db_default={})
    created_at = models.DateTimeField()
    started_at = models.DateTimeField(null=True)
    ended_at = models.DateTimeField(null=True)

    class Meta:
        """Runs are counted from 1 at each site."""

        constraints = [models.UniqueConstraint(fields=["site", "number"], name="one_run_per_number")]
        indexes = [
            models.Index(fields=["status"]),
            models.Index(fields=["site", "ended_at"], condition=models.Q(archive=None), name="runs_not_archived"),
        ]

    def __str__(self) -> str:
        return f"run {self.number}"


class RunEvent(models.Model):
    """One line of a run's journal."""

    run = models.ForeignKey(Run, on_delete=models.CASCADE, related_name="events")
    seq = models.PositiveIntegerField()
    at = models.DateTimeField()
    t_s = models.FloatField()
    kind = models.CharField(max_length=20)
    step = models.CharField(max_length=64, blank=True)
    device = models.CharField(max_length=64, blank=True)
    robot = models.CharField(max_length=64, blank=True)
    text = models.CharField(max_length=500)
    code = models.CharField(max_length=40, blank=True)
    args = models.JSONField(default=dict)

    class Meta:
        """In the order in which they were written."""

        constraints = [models.UniqueConstraint(fields=["run", "seq"], name="one_run_event_per_seq")]

    def __str__(self) -> str:
        return self.text


class Timer(models.Model):
    """Something that a run waits for until `due_at`."""

    run = models.ForeignKey(Run, on_delete=models.CASCADE, related_name="timers")
    timer = models.PositiveIntegerField()
    due_at = models.DateTimeField(db_index=True)

    class Meta:
        """A timer is set once."""

        constraints = [models.UniqueConstraint(fields=["run", "timer"], name="one_timer_per_run")]

    def __str__(self) -> str:
        return f"{self.run_id} timer {self.timer}"


class RunInput(models.Model):
    """What one turn gave a run to take in, as `execution.engine.history` reads it; `seq` counts a run's from 1."""

    run = models.ForeignKey(Run, on_delete=models.CASCADE, related_name="inputs")
    seq = models.PositiveIntegerField()
    at = models.DateTimeField()
    taken = models.JSONField()

    class Meta:
        """In the order in which they were taken in."""

        constraints = [models.UniqueConstraint(fields=["run", "seq"], name="one_run_input_per_seq")]

    def __str__(self) -> str:
        return f"{self.run_id} input {self.seq}"


class Question(models.Model):
    """Something that a run asks the people of its site; `number` is what the run calls it."""

    class State(models.TextChoices):
        """The life of a question."""

        OPEN = "open"
        ANSWERED = "answered"
        WITHDRAWN = "withdrawn"

    id = models.UUIDField(primary_key=True, default=uuid.uuid4)
    run = models.ForeignKey(Run, on_delete=models.CASCADE, related_name="questions")
    number = models.PositiveIntegerField()
    step = models.CharField(max_length=64, blank=True)
    text = models.CharField(max_length=500)
    answer = models.JSONField(default=dict)
    state = models.CharField(max_length=10, choices=State.choices, default=State.OPEN)
    value = models.JSONField(null=True)
    asked_at = models.DateTimeField()
    answered_by = models.CharField(max_length=120, blank=True)
    answered_at = models.DateTimeField(null=True)

    class Meta:
        """A run asks each of its questions once."""

        constraints = [models.UniqueConstraint(fields=["run", "number"], name="one_question_per_number")]
        indexes = [models.Index(fields=["state"])]

    def __str__(self) -> str:
        return self.text


class ArmedProgram(models.Model):
    """A program that starts by itself; `truths` remembers by event whether its condition held."""

    program = models.UUIDField(primary_key=True)
    site = models.ForeignKey("registry.Site", on_delete=models.CASCADE, related_name="armed_programs")
    prepared = models.JSONField(default=dict)
    truths = models.JSONField(default=dict)
    epoch = models.PositiveIntegerField(default=0)
    fence = models.BigIntegerField(default=0)
    by = models.CharField(max_length=120)
    at = models.DateTimeField()

    def __str__(self) -> str:
        return f"armed {self.program}"
