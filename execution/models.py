"""What execution keeps: runs, their events and timers, commands, floors, the inbox, rehearsals, stops, archives."""

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


class Run(Archivable):
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
            models.Index(fields=["site", "ended_at"], condition=models.Q(run=None), name="commands_of_no_run"),
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
    """Something that a run or a floor is to take in. `key` is its identity: the same event is never taken in twice."""

    target = models.CharField(max_length=80)
    key = models.CharField(max_length=160, unique=True)
    payload = models.JSONField()
    created_at = models.DateTimeField()
    taken_at = models.DateTimeField(null=True)

    class Meta:
        """Read by target, in order, what is not taken in."""

        indexes = [models.Index(fields=["target", "taken_at", "id"]), models.Index(fields=["taken_at", "created_at"])]

    def __str__(self) -> str:
        return self.key


class Rehearsal(Archivable):
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
            models.Index(fields=["site", "ended_at"], condition=models.Q(archive=None), name="rehearsals_not_archived"),
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
