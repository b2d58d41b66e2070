"""Changes of a program that no test notices, and of which an author has said that it is meant so.

That holds for a step as it is: once the step does something else, the change is told again.
"""

from __future__ import annotations

import json
from collections.abc import Mapping
from datetime import UTC, datetime
from hashlib import sha256
from typing import Any, NamedTuple
from uuid import UUID

from django.db import transaction

from editor import services as editor
from execution.errors import NotFound, NotPossibleNow
from execution.models import MeantChange, TrialRun
from execution.program_tests.stored_tests import say_changed

GONE = "No test has missed such a change of this program. Try its changes anew."
OTHERWISE = "The step has been changed since you read this. Look at it, then say it again."


class ChangeKey(NamedTuple):
    """A change of a program: at a step (its id, empty for a role), what is changed, and of which role."""

    step: str
    code: str
    name: str


def set_meant(*, program: UUID, change: ChangeKey, mark: str, meant: bool, user: Any) -> None:
    """Say that it is meant so that no test notices a change, or that it is not.

    `mark` is what `mark_of` said of the step that was read. Raises NoSuchProgram, NotFound, NotPossibleNow.
    """
    # Reading waits until what is drawn just now is stored, which takes the same row: it is read before that is held.
    document = editor.get_document(program_id=program)
    with transaction.atomic():
        editor.lock_program(program_id=program)
        rows = MeantChange.objects.filter(program=program)
        if not meant:
            rows.filter(**change._asdict()).delete()
        else:
            if change not in _unnoticed(program):
                raise NotFound(GONE)
            if not mark or mark != mark_of(change, document):
                raise NotPossibleNow(OTHERWISE)
            said = {"mark": mark, "by": user, "at": datetime.now(UTC)}
            rows.update_or_create(program_id=program, **change._asdict(), defaults=said)
            rows.exclude(step="").exclude(step__in=document["steps"]).delete()
        say_changed(program)


def find_meant(*, program: UUID) -> dict[ChangeKey, MeantChange]:
    """Return the changes of a program that are meant so, whether or not they still hold."""
    rows = MeantChange.objects.filter(program=program).select_related("by")
    return {ChangeKey(row.step, row.code, row.name): row for row in rows}


def mark_of(change: ChangeKey, document: Mapping[str, Any]) -> str:
    """Return a digest of what the step does that is changed, or of who the roles are; where it is drawn is not in it.

    It is empty where the program has no such step any more.
    """
    if not change.step:
        return _digest(document["roles"])
    step = document["steps"].get(change.step)
    return _digest([step.get("kind"), step.get("params")]) if step else ""


def _digest(body: Any) -> str:
    return sha256(json.dumps(body, sort_keys=True).encode()).hexdigest()[:32]


def _unnoticed(program: UUID) -> set[ChangeKey]:
    run = TrialRun.objects.filter(program=program, changes__isnull=False).order_by("-created_at").first()
    found = (run.changes or {}).get("unnoticed", ()) if run else ()
    return {ChangeKey(each["step"], each["code"], each["name"]) for each in found}
