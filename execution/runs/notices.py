"""What runs tell people, and how much of it: a loop cannot flood the screens."""

from __future__ import annotations

from datetime import datetime, timedelta
from typing import Any

from execution.machine import messages as r
from execution.models import Run
from execution.runs.journal import Journal

SHOWN_PER_MINUTE = 20
WINDOW = timedelta(minutes=1)


def tell(run: Run, journal: Journal, action: r.Tell) -> None:
    """Show a notice and write it down; beyond the measure it is only counted."""
    count = _count(run, journal)
    if count["shown"] >= SHOWN_PER_MINUTE:
        count["held"] += 1
        return
    count["shown"] += 1
    journal.say("notice", action.text, step=action.step, code="told", level=action.level)
    message = {"type": "notice", "run": str(run.id), "text": action.text, "level": action.level}
    journal.show(message)


def tell_late(run: Run, journal: Journal) -> None:
    """Tell people, once, that a run is not over by its deadline."""
    if run.late:
        return
    run.late = True
    text = f"Run {run.number} ({run.program_name}) should be over by now."
    more: dict[str, Any] = {"number": run.number, "program": run.program_name}
    journal.say("notice", text, code="deadline_passed", level="warning", **more)
    message = {"type": "notice", "run": str(run.id), "text": text, "level": "warning", "code": "deadline_passed"}
    journal.show({**message, "args": more})


def _count(run: Run, journal: Journal) -> dict[str, int]:
    """Return the counts of the running minute; `run.notices` keeps them."""
    since = run.notices.get("since")
    if since is None or journal.now - datetime.fromisoformat(since) >= WINDOW:
        say_held(run, journal)
        run.notices = {"since": journal.now.isoformat(), "shown": 0, "held": 0}
    notices: dict[str, int] = run.notices
    return notices


def say_held(run: Run, journal: Journal) -> None:
    """Write down how many notices of the last minute nobody saw."""
    held = run.notices.get("held", 0)
    if held:
        run.notices = {**run.notices, "held": 0}
        journal.say("notice", f"{held} more notices were not shown.", code="notices_held", count=held)
