"""What others may ask of execution; everything else in this app is its own affair."""

from __future__ import annotations

from execution.arming import arm_program, disarm_program, list_armed, start_armed
from execution.calls import call_method, cancel_call, expire_calls, get_call
from execution.claiming import OutgoingCommand, claim_commands, mark_commands_sent
from execution.clockwork import run_ticker
from execution.devices import record_device_change
from execution.done_flag import record_done_flag
from execution.errors import (
    AlreadyAnswered,
    AnswerNotFitting,
    BadArguments,
    ExecutionError,
    NotFound,
    NotPossibleNow,
    NotReady,
)
from execution.outbox import record_ack, resend_commands
from execution.planning import plan_routes
from execution.programs import Prepared
from execution.questions import answer_question, list_questions, site_of_question
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
from execution.site_maps import change_map
from execution.stops import StopView, is_stopped, list_stops, press_stop, reset_stop
from execution.ticking import tick

__all__ = [
    "AlreadyAnswered",
    "AnswerNotFitting",
    "BadArguments",
    "ExecutionError",
    "NotFound",
    "NotPossibleNow",
    "NotReady",
    "OutgoingCommand",
    "Prepared",
    "StopView",
    "answer_question",
    "arm_program",
    "call_method",
    "cancel_call",
    "cancel_run",
    "change_map",
    "claim_commands",
    "disarm_program",
    "expire_calls",
    "get_call",
    "get_rehearsal",
    "get_run",
    "is_stopped",
    "list_armed",
    "list_events",
    "list_questions",
    "list_runs",
    "list_stops",
    "mark_commands_sent",
    "pause_run",
    "plan_routes",
    "press_stop",
    "record_ack",
    "record_device_change",
    "record_done_flag",
    "resend_commands",
    "reset_stop",
    "resume_run",
    "run_ticker",
    "site_of_question",
    "site_of_run",
    "start_armed",
    "start_rehearsal",
    "start_run",
    "tick",
]
