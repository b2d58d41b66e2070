"""What execution keeps: runs, their events, timers and inputs, commands, floors, inboxes, leases, rehearsals, stops."""

from __future__ import annotations

import uuid

from django.db import models


class Run(models.Model):
    """A program being carried out. It holds all it needs: the document, the plan and the machine's state.

    `not_before` is when it may begin, `deadline` when it should be over; `late` says that people were told that it is
    not. `fence` is the site's when somebody started it or resumed it last: with one from before a stop it stands still.
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
    created_at = models.DateTimeField()
    started_at = models.DateTimeField(null=True)
    ended_at = models.DateTimeField(null=True)

    class Meta:
        """Runs are counted from 1 at each site."""

        constraints = [models.UniqueConstraint(fields=["site", "number"], name="one_run_per_number")]
        indexes = [models.Index(fields=["status"])]

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


class Command(models.Model):
    """A command to a device: written with the state that decided it, sent until it is answered.

    `site_fence` is the site's when a person gave it by hand, None otherwise.
    """

    class Status(models.TextChoices):
        """The life of a command."""

        PENDING = "pending"
        SENT = "sent"
        ACCEPTED = "accepted"
        RUNNING = "running"
        DONE = "done"
        FAILED = "failed"
        REJECTED = "rejected"
        CANCELLED = "cancelled"
        TIMED_OUT = "timed_out"

    OPEN = (Status.PENDING, Status.SENT, Status.ACCEPTED, Status.RUNNING)

    id = models.UUIDField(primary_key=True)
    site = models.ForeignKey("registry.Site", on_delete=models.CASCADE, related_name="commands")
    position = models.BigIntegerField()
    device = models.CharField(max_length=64)
    method = models.CharField(max_length=64)
    arguments = models.JSONField(default=dict)
    run = models.UUIDField(null=True, db_index=True)
    step = models.CharField(max_length=64, blank=True)
    piece = models.BooleanField(default=False)
    status = models.CharField(max_length=10, choices=Status.choices, default=Status.PENDING)
    why = models.CharField(max_length=500, blank=True)
    result = models.JSONField(default=dict)
    by = models.CharField(max_length=120, blank=True)
    fence = models.PositiveIntegerField(default=0)
    site_fence = models.BigIntegerField(null=True)
    tries = models.PositiveIntegerField(default=0)
    ttl_s = models.FloatField(default=60.0)
    send_after = models.DateTimeField()
    created_at = models.DateTimeField()
    sent_at = models.DateTimeField(null=True)
    ended_at = models.DateTimeField(null=True)

    class Meta:
        """The outbox is read by what is to be sent next."""

        indexes = [
            models.Index(fields=["status", "send_after"]),
            models.Index(fields=["device", "status"]),
            models.Index(fields=["device", "position"]),
            models.Index(
                fields=["ended_at"],
                condition=models.Q(status__in=["failed", "rejected", "timed_out"]),
                name="commands_gone_wrong",
            ),
        ]

    def __str__(self) -> str:
        return f"{self.method} to {self.device}"


class FloorState(models.Model):
    """The floor of a site between two events."""

    site = models.OneToOneField("registry.Site", on_delete=models.CASCADE, related_name="floor_state")
    namespace = models.UUIDField(default=uuid.uuid4)
    state = models.JSONField(null=True)
    epoch = models.PositiveIntegerField(default=0)
    active = models.BooleanField(default=False)
    commands = models.BigIntegerField(default=0)

    def __str__(self) -> str:
        return f"floor of {self.site_id}"


class InboxEvent(models.Model):
    """Something that a run or a floor is to take in. `key` is its identity: the same event is never taken in twice.

    `site` is the site's slug, by whose owner it is read.
    """

    site = models.CharField(max_length=64, default="", db_default="")
    target = models.CharField(max_length=80)
    key = models.CharField(max_length=160, unique=True)
    payload = models.JSONField()
    created_at = models.DateTimeField()
    taken_at = models.DateTimeField(null=True)

    class Meta:
        """Read by site, in order, what is not taken in; a target's own are looked for by what waits."""

        indexes = [
            models.Index(fields=["site", "id"], condition=models.Q(taken_at=None), name="inbox_that_waits"),
            models.Index(fields=["taken_at", "created_at"]),
        ]

    def __str__(self) -> str:
        return self.key


class Rehearsal(models.Model):
    """A program tried out in a pretend world.

    `person` is whose it is. The worker that carries it out has its `claim`, runs on `machine` and says at `beat_at`, by
    the database's clock, that it goes on; `tries` counts how often it was begun, `course` says how far it is.
    """

    class Status(models.TextChoices):
        """The life of a rehearsal."""

        QUEUED = "queued"
        RUNNING = "running"
        DONE = "done"
        FAILED = "failed"
        CANCELLED = "cancelled"

    OPEN = (Status.QUEUED, Status.RUNNING)

    id = models.UUIDField(primary_key=True, default=uuid.uuid4)
    site = models.ForeignKey("registry.Site", on_delete=models.CASCADE, related_name="rehearsals")
    program = models.UUIDField(db_index=True)
    program_name = models.CharField(max_length=200, default="")
    status = models.CharField(max_length=10, choices=Status.choices, default=Status.QUEUED)
    progress = models.FloatField(default=0.0)
    course = models.JSONField(default=dict)
    job = models.JSONField(default=dict)
    document = models.JSONField(default=dict)
    compiled = models.JSONField(default=dict)
    result = models.JSONField(null=True)
    reason = models.CharField(max_length=500, blank=True)
    started_by = models.CharField(max_length=120, blank=True)
    person = models.BigIntegerField(null=True)
    claim = models.UUIDField(null=True)
    machine = models.CharField(max_length=255, blank=True, default="")
    tries = models.PositiveSmallIntegerField(default=0)
    created_at = models.DateTimeField()
    began_at = models.DateTimeField(null=True)
    beat_at = models.DateTimeField(null=True)
    ended_at = models.DateTimeField(null=True)

    class Meta:
        """Those that are not over are few among all that were kept."""

        indexes = [
            models.Index(
                fields=["status"], condition=models.Q(status__in=["queued", "running"]), name="rehearsals_not_over"
            ),
            models.Index(fields=["began_at"]),
        ]

    def __str__(self) -> str:
        return f"rehearsal of {self.program}"


class SiteStop(models.Model):
    """The latched stop of a site.

    `fence` is raised whenever it is pressed or reset, and told to devices with each command and each stop; `pressed` is
    what it became when the stop was pressed last. It is changed by single statements outside of transactions, so that
    no process that is frozen holds its row.
    """

    site = models.OneToOneField("registry.Site", on_delete=models.CASCADE, related_name="stop_latch")
    active = models.BooleanField(default=False)
    by = models.CharField(max_length=120, blank=True)
    at = models.DateTimeField(null=True)
    fence = models.BigIntegerField(default=0)
    pressed = models.BigIntegerField(default=0)

    def __str__(self) -> str:
        return f"stop of {self.site_id}"


class StopFollowed(models.Model):
    """How far runs, floor and armed programs of a site have been told of its stop: up to which fence."""

    site = models.OneToOneField("registry.Site", on_delete=models.CASCADE, related_name="stop_followed")
    fence = models.BigIntegerField(default=0)

    def __str__(self) -> str:
        return f"stop of {self.site_id} followed to {self.fence}"


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


class Lease(models.Model):
    """Who does a job that only one process may do, and until when."""

    name = models.CharField(primary_key=True, max_length=40)
    holder = models.CharField(max_length=80)
    until = models.DateTimeField()

    def __str__(self) -> str:
        return f"{self.name}: {self.holder}"


class SiteLease(models.Model):
    """Which process carries the runs of a site out, and until when by the database's clock.

    `epoch` grows with each owner that is another than the one before; nothing is written for a site under an older one.
    """

    site = models.OneToOneField("registry.Site", on_delete=models.CASCADE, related_name="run_lease")
    owner = models.CharField(max_length=120, blank=True)
    epoch = models.PositiveIntegerField(default=1)
    expires_at = models.DateTimeField()

    def __str__(self) -> str:
        return f"site {self.site_id}: {self.owner}"


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


class DeadLetter(models.Model):
    """Something that raised when it was taken in; `run` is None where it concerned the floor alone."""

    class State(models.TextChoices):
        """What became of it."""

        OPEN = "open"
        RETRIED = "retried"
        DROPPED = "dropped"

    site = models.ForeignKey("registry.Site", on_delete=models.CASCADE, related_name="dead_letters")
    run = models.ForeignKey(Run, null=True, on_delete=models.CASCADE, related_name="dead_letters")
    target = models.CharField(max_length=80)
    event = models.JSONField()
    error = models.CharField(max_length=1000)
    at = models.DateTimeField()
    state = models.CharField(max_length=10, choices=State.choices, default=State.OPEN)
    settled_by = models.CharField(max_length=120, blank=True)
    settled_at = models.DateTimeField(null=True)

    class Meta:
        """Listed by site."""

        indexes = [models.Index(fields=["site", "state"])]

    def __str__(self) -> str:
        return self.error
