"""The shapes of what became of runs over HTTP."""

from __future__ import annotations

from typing import Annotated, Literal

from ninja import Field, Schema

from execution.shapes import RunStatus
from registry.requests import Asked

MOST_VERSIONS = 200
SeqBefore = Annotated[int | None, Field(ge=1, lt=2**31)]
VersionNumber = Annotated[int, Field(ge=1, lt=2**31)]


class EventsAsked(Asked):
    """Which lines of a journal are asked for: the oldest that fit, or with `newest` the newest."""

    after: int = Field(0, description="Lines with larger numbers.")
    before: SeqBefore = Field(None, description="Lines with smaller numbers.")
    newest: bool = Field(False, description="The newest that fit; the header `Link` names those before them.")
    limit: int = Field(1000, ge=1, le=1000)


class TimelineBar(Schema):
    """What a device did or waited for, for a step, in seconds of the run; `ended_s` is null while it goes on.

    `count` is of how many bars it was joined, because they are too many to be told apart; these may be of several
    steps, of which `step` is the first that failed, or just the first. `pending` counts the commands under way.
    """

    device: str
    step: str
    kind: Literal["work", "wait"]
    started_s: float
    ended_s: float | None
    failed: bool
    count: int
    pending: int


class TimelineShape(Schema):
    """Who worked when in a run, up to the line `seq` of its journal, in about 2,000 bars at most.

    With `steps`, those under way in the order in which they began, and `drives`, for which of them each robot drives,
    one goes on with the journal's later lines. `simulated` are the devices for which a simulated one was told
    something or has answered.
    """

    seq: int
    bars: list[TimelineBar]
    steps: list[str]
    drives: dict[str, str]
    simulated: list[str]


class VersionsAsked(Asked):
    """From which version to which other is asked; of more than 200 only the newest are looked at."""

    oldest: VersionNumber
    newest: VersionNumber


class RunOfVersionShape(Schema):
    """A run, as the versions of its program name it."""

    id: str
    number: int
    status: RunStatus


class VersionRunsShape(Schema):
    """How many runs used a version, and the three newest of them, the newest first."""

    version: int
    count: int
    newest: list[RunOfVersionShape]
