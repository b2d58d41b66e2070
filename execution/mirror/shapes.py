"""The shapes of what is answered about measured paces."""

from __future__ import annotations

from datetime import datetime

from ninja import Schema


class MeasuredShape(Schema):
    """What the copy took for a command, and what the device took."""

    predicted_s: float
    real_s: float


class PaceChangeShape(Schema):
    """A pace that is not what it was: how much longer it takes, in percent (negative: shorter), and both medians."""

    percent: int
    before: float
    now: float


class CalibrationShape(Schema):
    """A pace that is in use for rehearsals and tests; `count` is of how many measurements it was the median."""

    pace: float
    count: int
    at: datetime
    by: str


class MethodPaceShape(Schema):
    """What was measured of a device's method. A pace is what the device took divided by what its copy took.

    `usual` is the median of the newest 30, `band` goes from the 1st to the 99th percentile; both are null where nothing
    was measured. `apart_m` is how far a robot was from its copy at most.
    """

    method: str
    count: int
    usual: float | None
    band: list[float] | None
    change: PaceChangeShape | None
    newest: list[MeasuredShape]
    apart_m: float | None
    last_at: datetime | None
    can_be_taken: bool
    calibrated: CalibrationShape | None


class StepMeasuredShape(MeasuredShape):
    """What a method took in a step of a run, and what the copy took, added up over `count` times."""

    step: str
    device: str
    method: str
    count: int
    apart_m: float | None
