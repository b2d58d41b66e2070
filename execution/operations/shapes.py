"""What the API says of processes, queues and what is overdue."""

from __future__ import annotations

from typing import Annotated, Any, Literal

from ninja import Schema

from registry.requests import Unchecked
from registry.services import ProcessKind


class FindingShape(Schema):
    """Something that is wrong with VIPO itself now; `text` is the English sentence of code and `args`."""

    code: Literal[
        "no_gateway", "no_worker", "no_ticker", "process_silent", "clock_apart", "archive_failed", "set_aside"
    ]
    severity: Literal["warning", "error"]
    text: str
    args: Annotated[Any, Unchecked(dict[str, Any])]


class QueueShape(Schema):
    """How many wait in a queue, and for how many seconds the first of them has; null for nobody, and where unknown."""

    name: str
    waiting: int
    oldest_s: float | None


class OverdueShape(Schema):
    """A command to which its device has said nothing for `waits_s`; without `run` it is a person's call."""

    id: str
    device: str
    method: str
    status: Literal["pending", "sent"]
    tries: int
    run: str | None
    number: int | None
    waits_s: float


class OperationsShape(Schema):
    """What waits at a site now: `overdue` has those that have waited longest, `overdue_count` says how many are."""

    queues: list[QueueShape]
    runs: dict[Literal["pending", "running", "paused"], int]
    overdue_count: int
    overdue: list[OverdueShape]
    open_alerts: int


class ProcessShape(Schema):
    """A process of VIPO as its last heartbeat told, `age_s` seconds ago; `clock_apart_s` is its clock's distance."""

    id: str
    kind: ProcessKind
    name: str
    machine: str
    process: int
    version: str
    activity: Literal["", "works", "broker_away", "leads", "stands_by"]
    state: Literal["beats", "silent", "ended"]
    since: str
    age_s: float
    clock_apart_s: float | None


class LeaseShape(Schema):
    """Who does a job that only one process may do; `held_s` is how much longer it is theirs, below 0 afterwards."""

    job: str
    holder: str
    held_s: float


class ProcessesShape(Schema):
    """All processes, who leads, and what waits at all sites together."""

    processes: list[ProcessShape]
    leases: list[LeaseShape]
    queues: list[QueueShape]
