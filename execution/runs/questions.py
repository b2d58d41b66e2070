"""Questions that runs ask people: who may answer what, and that one answer counts."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import asdict
from datetime import UTC, datetime
from typing import Any
from uuid import UUID

from django.db import transaction

from execution import mailbox
from execution.archive.rows import read_questions
from execution.errors import AlreadyAnswered, AnswerNotFitting, NotFound, NotPossibleNow
from execution.floor_protocol import QuestionAnswered
from execution.machine.messages import AskPeople
from execution.models import Question, Run
from execution.views import QuestionView, question_to_json, view_question
from registry import services as registry
from vipo_device.protocol.description import Scalar
from vipo_device.protocol.texts import find_unfit

LONGEST_ANSWER = 500


def list_questions(*, site: str, run_id: UUID | str | None = None) -> tuple[QuestionView, ...]:
    """Return the open questions of a site, the oldest first; of one run all questions."""
    rows = Question.objects.select_related("run", "run__site").filter(run__site__slug=site).order_by("asked_at")
    rows = rows.filter(run_id=run_id) if run_id else rows.filter(state=Question.State.OPEN)
    found = list(rows.defer("run__plan", "run__state", "run__document", "run__compiled", "run__places"))
    if run_id:
        runs = Run.objects.select_related("site", "archive").defer("plan", "state", "places", "document", "compiled")
        archived = runs.filter(id=run_id, site__slug=site).exclude(archive=None).first()
        found = read_questions(archived) if archived is not None else found
    return tuple(view_question(row) for row in found)


def site_of_question(*, question_id: UUID | str) -> str:
    """Return the site of a question; raises NotFound."""
    row = Question.objects.select_related("run__site").filter(id=question_id).first()
    if row is None:
        raise NotFound("There is no such question. Its run may have been deleted.")
    return row.run.site.slug


def answer_question(*, question_id: UUID | str, value: Any, by: str) -> QuestionView:
    """Answer a question; of several people who do so at once exactly one is first.

    Raises:
        AlreadyAnswered: somebody was quicker; the detail says who.
        AnswerNotFitting: the value is not what was asked for.
        NotPossibleNow: the question was withdrawn.
    """
    with transaction.atomic():
        row = Question.objects.select_related("run", "run__site").filter(id=question_id).first()
        if row is None:
            raise NotFound("There is no such question. Its run may have been deleted.")
        fitting = fit_answer(row.answer, value)
        now = datetime.now(UTC)
        still_open = Question.objects.filter(id=row.id, state=Question.State.OPEN)
        if not still_open.update(state="answered", value=fitting, answered_by=by, answered_at=now):
            row.refresh_from_db()
            _refuse(row)
        row.refresh_from_db()
        answered = QuestionAnswered(row.number, fitting, by, row.step)
        mailbox.post_to_run(row.run.site.slug, row.run_id, [(f"reply:{row.id}", answered)])
        publish(row)
    return view_question(row)


def _refuse(row: Question) -> None:
    if row.state == Question.State.ANSWERED:
        raise AlreadyAnswered(f"{row.answered_by} has answered already: {in_short(row.value)}.")
    raise NotPossibleNow("The question is not asked any more: the run has gone on without an answer, or is over.")


def fit_answer(answer: Mapping[str, Any], value: Any) -> Scalar:
    """Return the value as the answer that was asked for; raises AnswerNotFitting."""
    match answer["type"]:
        case "boolean":
            if isinstance(value, bool):
                return value
            raise AnswerNotFitting("Answer yes or no.")
        case "number":
            return _fit_number(answer, value)
        case "choice":
            if isinstance(value, str) and value in answer["options"]:
                return value
            raise AnswerNotFitting(f"Choose one of: {', '.join(answer['options'])}.")
    if isinstance(value, str) and not find_unfit(value) and len(value.strip()) <= LONGEST_ANSWER:
        return value.strip()
    raise AnswerNotFitting(f"Answer with a text of at most {LONGEST_ANSWER} characters.")


def _fit_number(answer: Mapping[str, Any], value: Any) -> Scalar:
    if isinstance(value, bool) or not isinstance(value, int | float) or not abs(value) <= 1e15:
        raise AnswerNotFitting("Answer with a number.")
    lowest, highest = answer["minimum"], answer["maximum"]
    if lowest is not None and value < lowest:
        raise AnswerNotFitting(f"The number must be at least {in_short(lowest)}.")
    if highest is not None and value > highest:
        raise AnswerNotFitting(f"The number must be at most {in_short(highest)}.")
    return value


def in_short(value: object) -> str:
    """Return an answer as people read it."""
    if isinstance(value, bool):
        return "yes" if value else "no"
    return f"{value:.15g}" if isinstance(value, int | float) else str(value)


def ask(run: Run, action: AskPeople, now: datetime) -> None:
    """Put a question to the people of the run's site; within the step that asks it."""
    row = Question.objects.create(
        run=run, number=action.question, step=action.step, text=action.text, answer=asdict(action.answer), asked_at=now
    )
    publish(row)


def withdraw(run: Run, number: int) -> None:
    """Take a question back that nobody has answered."""
    row = Question.objects.filter(run=run, number=number, state=Question.State.OPEN).first()
    if row is not None and Question.objects.filter(id=row.id, state=Question.State.OPEN).update(state="withdrawn"):
        row.state, row.run = Question.State.WITHDRAWN, run
        publish(row)


def withdraw_all(run: Run) -> None:
    """Take back whatever a run asks that is over."""
    for number in Question.objects.filter(run=run, state=Question.State.OPEN).values_list("number", flat=True):
        withdraw(run, number)


def publish(row: Question) -> None:
    """Show a question as it is now to whoever watches the site, once the transaction is through."""
    message = {"type": "question", "question": question_to_json(view_question(row))}
    slug = row.run.site.slug
    transaction.on_commit(lambda: registry.publish(slug, message))
