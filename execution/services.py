"""What others may ask of execution; everything else in this app is its own affair."""

from __future__ import annotations

from execution.commands.claim import OutgoingCommand, claim_commands, mark_sent, release_commands
from execution.commands.invocations import action_to_json, find_action, invoke_action
from execution.commands.manual_calls import call_method, cancel_call, expire_calls, get_call, list_open_calls
from execution.commands.outbox import record_ack, resend_commands
from execution.engine.dead_letters import (
    DeadLetterView,
    drop_dead_letter,
    list_dead_letters,
    retry_dead_letter,
    site_of_dead_letter,
)
from execution.engine.drive import leave
from execution.errors import (
    AlreadyAnswered,
    AnswerNotFitting,
    BadArguments,
    BadTerms,
    ExecutionError,
    NotFound,
    NotPossibleNow,
    NotReady,
)
from execution.floor.drawing_paths import plan_routes
from execution.floor.map_change import change_map
from execution.floor.stop_publisher import close_publisher, open_publisher
from execution.floor.stops import StopView, follow_stops, get_stop, is_stopped, list_stops, press_stop, reset_stop
from execution.operations.findings import find_trouble_of_sites
from execution.operations.overview import Overview, QueueView, list_leases, read_overview, read_task_queues
from execution.rehearsals.rehearsals import (
    RecordingForm,
    cancel_rehearsal,
    export_rehearsal,
    get_rehearsal,
    list_open_rehearsals,
    start_rehearsal,
)
from execution.rehearsals.views import RehearsalView
from execution.runs.history import list_events
from execution.runs.programs import Prepared
from execution.runs.questions import answer_question, list_questions, site_of_question
from execution.runs.runs import (
    RunFilter,
    cancel_run,
    get_run,
    list_runs,
    pause_run,
    resume_run,
    site_of_run,
    start_run,
)
from execution.runs.terms import Terms
from execution.runs.triggers import arm_program, disarm_program, list_armed, site_of_armed, start_armed
from execution.ticker.ticker import run_ticker
from execution.views import (
    ArmedView,
    CallView,
    QuestionView,
    RouteView,
    RunEventView,
    RunView,
    WholeRunView,
    call_to_json,
)

__all__ = [
    "AlreadyAnswered",
    "AnswerNotFitting",
    "ArmedView",
    "BadArguments",
    "BadTerms",
    "CallView",
    "DeadLetterView",
    "ExecutionError",
    "NotFound",
    "NotPossibleNow",
    "NotReady",
    "OutgoingCommand",
    "Overview",
    "Prepared",
    "QuestionView",
    "QueueView",
    "RecordingForm",
    "RehearsalView",
    "RouteView",
    "RunEventView",
    "RunFilter",
    "RunView",
    "StopView",
    "Terms",
    "WholeRunView",
    "action_to_json",
    "answer_question",
    "arm_program",
    "call_method",
    "call_to_json",
    "cancel_call",
    "cancel_rehearsal",
    "cancel_run",
    "change_map",
    "claim_commands",
    "close_publisher",
    "disarm_program",
    "drop_dead_letter",
    "expire_calls",
    "export_rehearsal",
    "find_action",
    "find_trouble_of_sites",
    "follow_stops",
    "get_call",
    "get_rehearsal",
    "get_run",
    "get_stop",
    "invoke_action",
    "is_stopped",
    "leave",
    "list_armed",
    "list_dead_letters",
    "list_events",
    "list_leases",
    "list_open_calls",
    "list_open_rehearsals",
    "list_questions",
    "list_runs",
    "list_stops",
    "mark_sent",
    "open_publisher",
    "pause_run",
    "plan_routes",
    "press_stop",
    "read_overview",
    "read_task_queues",
    "record_ack",
    "release_commands",
    "resend_commands",
    "reset_stop",
    "resume_run",
    "retry_dead_letter",
    "run_ticker",
    "site_of_armed",
    "site_of_dead_letter",
    "site_of_question",
    "site_of_run",
    "start_armed",
    "start_rehearsal",
    "start_run",
]
