"""What was set aside because it raised, as admins see it: looked at, tried again, or dropped."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from datetime import datetime
from typing import Any, Literal
from uuid import UUID, uuid4

from django.db import transaction

from execution import database, mailbox
from execution.errors import NotFound, NotPossibleNow
from execution.floor_protocol import ResumeAsked, to_json
from execution.models import DeadLetter, InboxEvent, Run

MOST = 200
SETTLED = "settled"
NOTHING_TO_TELL = frozenset({"start", "step", "plan", "facts", "unreadable"})
"""What stands for something that no message said; its run is tried again by resuming it."""


@dataclass(frozen=True, slots=True)
class DeadLetterView:
    """Something that was set aside: `run` is the one that it concerns, if any; `target` says who was to take it in.

    `state` is open, retried or dropped.
    """

    id: int
    site: str
    run: UUID | None
    run_number: int | None
    run_status: str | None
    target: Literal["run", "floor"]
    event: Mapping[str, Any]
    error: str
    at: datetime
    state: str
    settled_by: str
    settled_at: datetime | None


def list_dead_letters(*, site: str, state: str | None = None) -> tuple[DeadLetterView, ...]:
    """Return what was set aside at a site, the newest first, at most 200 of it.

    The state `settled` is that of all that was retried or dropped; there what was settled last comes first.
    """
    rows = DeadLetter.objects.filter(site__slug=site).select_related("site", "run").order_by("-id")
    rows = rows.defer("run__document", "run__compiled", "run__plan", "run__state", "run__places")
    if state == SETTLED:
        rows = rows.exclude(state=DeadLetter.State.OPEN).order_by("-settled_at", "-id")
    elif state:
        rows = rows.filter(state=state)
    return tuple(_view(row) for row in rows[:MOST])


def site_of_dead_letter(*, letter_id: int) -> str:
    """Return the site where something was set aside; raises NotFound."""
    slug = DeadLetter.objects.filter(id=letter_id).values_list("site__slug", flat=True).first()
    if slug is None:
        raise NotFound("Nothing of that number was set aside.")
    return slug


def retry_dead_letter(*, letter_id: int, by: str) -> DeadLetterView:
    """Give something to its run or floor once more, and let the run go on that was paused for it.

    Raises:
        NotFound: nothing of that number was set aside.
        NotPossibleNow: somebody has retried or dropped it already, or its run is over.
    """
    with transaction.atomic():
        row = _settle(letter_id, DeadLetter.State.RETRIED, by)
        if row.run is not None and row.run.status not in Run.OPEN:
            why = f"Run {row.run.number} is over ({row.run.status}); there is nothing to try again."
            raise NotPossibleNow(why, {"why": "run_over", "run": row.run.number})
        messages = [(row.target, event) for event in _events(row.event)]
        if row.run is not None:
            messages.append((mailbox.run_target(row.run.id), to_json(ResumeAsked(by))))
        now = database.now()
        InboxEvent.objects.bulk_create(
            InboxEvent(
                site=row.site.slug, target=target, key=f"retry:{row.id}:{uuid4()}", payload=event, created_at=now
            )
            for target, event in messages
        )
        mailbox.hint(row.site.slug)
    return _view(row)


def drop_dead_letter(*, letter_id: int, by: str) -> DeadLetterView:
    """Say that something that was set aside is not wanted any more; its run stays as it is. Raises as retrying does."""
    with transaction.atomic():
        return _view(_settle(letter_id, DeadLetter.State.DROPPED, by))


def _settle(letter_id: int, state: DeadLetter.State, by: str) -> DeadLetter:
    """Say what becomes of it; of several people who do so at once one is first."""
    site_of_dead_letter(letter_id=letter_id)
    now = database.now()
    still_open = DeadLetter.objects.filter(id=letter_id, state=DeadLetter.State.OPEN)
    is_mine = still_open.update(state=state, settled_by=by[:120], settled_at=now)
    row = DeadLetter.objects.select_related("site", "run").get(id=letter_id)
    if not is_mine:
        facts = {"why": f"settled_{row.state}", "by": row.settled_by}
        raise NotPossibleNow(f"{row.settled_by} has {row.state} it already.", facts)
    return row


def _events(event: Mapping[str, Any]) -> list[Mapping[str, Any]]:
    """Return the messages of which something that was set aside consists."""
    if event.get("type") == "several":
        return list(event["messages"])
    return [] if event.get("type") in NOTHING_TO_TELL else [event]


def _view(row: DeadLetter) -> DeadLetterView:
    run = row.run
    return DeadLetterView(
        row.id, row.site.slug, row.run_id, run.number if run else None, run.status if run else None,
        "run" if row.target.startswith("run:") else "floor", row.event, row.error, row.at, row.state, row.settled_by,
        row.settled_at,
    )  # fmt: skip
