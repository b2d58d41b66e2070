"""The terms of a run: its priority, when it may begin, and by when it should be over."""

from __future__ import annotations

from dataclasses import dataclass, replace
from datetime import datetime, timedelta

from execution import mailbox
from execution.errors import BadTerms
from execution.floor_protocol import DeadlinePassed
from execution.models import Run

CLOCKS_APART = timedelta(minutes=1)
"""A start that is past by less than this is meant for now: clocks differ, and people take time to press a button."""
FARTHEST = timedelta(days=366)


@dataclass(frozen=True, slots=True)
class Terms:
    """`priority` is low, normal or high; the run waits until `not_before` and should be over by `deadline`."""

    priority: str = "normal"
    not_before: datetime | None = None
    deadline: datetime | None = None


USUAL = Terms()


def fit_terms(terms: Terms, now: datetime) -> Terms:
    """Return the terms as a run keeps them: a start that is meant for now is none.

    Raises:
        BadTerms: the start or the deadline is past, too far off, or the deadline is not after the start.
    """
    start, deadline = terms.not_before, terms.deadline
    if start is not None and start < now - CLOCKS_APART:
        raise BadTerms("The time to begin is past. Choose a later one, or none to begin now.", {"why": "start_past"})
    if deadline is not None and deadline <= now:
        raise BadTerms("The deadline is past. Choose a later one, or none.", {"why": "deadline_past"})
    if any(each is not None and each > now + FARTHEST for each in (start, deadline)):
        raise BadTerms("A run is planned at most a year ahead. Choose an earlier time.", {"why": "too_far"})
    if start is not None and deadline is not None and deadline <= start:
        raise BadTerms("The deadline is before the run may begin. Choose a later one.", {"why": "deadline_first"})
    return replace(terms, not_before=None) if start is not None and start <= now else terms


def call_late(now: datetime) -> None:
    """Tell runs whose deadline has passed; each of them takes it in once."""
    late = Run.objects.filter(status__in=Run.OPEN, late=False, deadline__lte=now)
    for run, site in late.values_list("id", "site__slug"):
        mailbox.post_to_run(site, run, [(f"deadline:{run}", DeadlinePassed())])
