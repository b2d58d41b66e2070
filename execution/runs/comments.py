"""Comments on moments of a run, which stand among those of its program."""

from __future__ import annotations

from typing import Any
from uuid import UUID

from django.utils import timezone

from editor import services as editor
from execution.errors import NotFound
from execution.runs.runs import find_span
from execution.shapes import CommentOnRun


def begin_thread(*, run_id: UUID, user: Any, body: CommentOnRun, origin: str) -> dict[str, Any]:
    """Begin a thread about a moment of a run; return its id and the program's.

    Raises:
        NotFound: there is no such run, or its program has been deleted.
        BadRequest, TooManyComments, CommentsFull: as for all comments.
    """
    now = timezone.now()
    span = find_span(run_id=run_id, now=now)
    try:
        thread = editor.start_thread_at(
            program=span.program,
            user=user,
            moment=editor.Moment(run_id, span.number, round(min(body.t_s, span.seconds), 1), body.label),
            words=editor.Words(body.text, tuple(body.mentions), origin),
            now=now,
        )
    except editor.NoSuchProgram as error:
        raise NotFound("The program of this run has been deleted, and its comments with it.") from error
    return {"thread": thread, "program": span.program}
