"""What others may ask of execution; everything else in this app is its own affair."""

from __future__ import annotations

from execution.clockwork import run_ticker
from execution.devices import record_device_change
from execution.errors import ExecutionError, NotFound, NotPossibleNow, NotReady
from execution.outbox import OutgoingCommand, claim_commands, mark_commands_sent, record_ack, resend_commands
from execution.planning import plan_routes
from execution.programs import Prepared
from execution.rehearsals import get_rehearsal, start_rehearsal
from execution.runs import (
    cancel_run,
    get_run,
    list_events,
    list_runs,
    pause_run,
    resume_run,
    site_of_run,
    start_run,
)
from execution.stops import StopView, is_stopped, list_stops, press_stop, reset_stop
from execution.ticking import tick

__all__ = [
    "ExecutionError",
    "NotFound",
    "NotPossibleNow",
    "NotReady",
    "OutgoingCommand",
    "Prepared",
    "StopView",
    "cancel_run",
    "claim_commands",
    "get_rehearsal",
    "get_run",
    "is_stopped",
    "list_events",
    "list_runs",
    "list_stops",
    "mark_commands_sent",
    "pause_run",
    "plan_routes",
    "press_stop",
    "record_ack",
    "record_device_change",
    "resend_commands",
    "reset_stop",
    "resume_run",
    "run_ticker",
    "site_of_run",
    "start_rehearsal",
    "start_run",
    "tick",
]
