"""Threads of comments: begun, answered, resolved; each person's own words edited and deleted, and what they have read.

Whoever watches the site is told that a program's comments have changed, and reads them anew.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from datetime import datetime, timedelta
from typing import Any
from uuid import UUID

from django.contrib.auth import get_user_model
from django.db import transaction
from django.db.models import Prefetch

from editor.comments.anchors import Anchor, anchor_to_json, find_missing, is_drawn, stands_in
from editor.comments.mail import note_comment, note_people
from editor.documents.store import get_document
from editor.errors import BadRequest, DocumentHole, EditorError, NoSuchProgram
from editor.models import Comment, CommentThread, Program, ThreadReading
from editor.programs.views import AuthorView, view_author
from registry import services as registry

MOST_THREADS, MOST_IN_THREAD, MOST_COMMENTS = 300, 100, 2000
"""Of a program, of a thread, of a program in all its threads: who looks is sent them all."""
RATE, RATE_OVER = 20, timedelta(minutes=1)
_GONE = "There is no such comment here. It may have been deleted."


class TooManyComments(EditorError):
    """Somebody writes faster than people do."""

    code = "too_many_comments"
    status = 429
    retry_after_s = 60


class CommentsFull(EditorError):
    """There is no room for more: `why` is `threads`, `thread` or `program`, with `most`."""

    code = "comments_full"
    status = 409


class NotTheirs(EditorError):
    """What somebody else has written is theirs to change."""

    code = "not_theirs"
    status = 409


@dataclass(frozen=True, slots=True)
class CommentView:
    """A comment; who wrote it or is mentioned may have left the site since."""

    id: UUID
    author: AuthorView | None
    text: str
    mentions: tuple[AuthorView, ...]
    written_at: datetime
    edited_at: datetime | None


@dataclass(frozen=True, slots=True, kw_only=True)
class ThreadView:
    """A thread with its comments; `unread` counts those of others that the asker has not read.

    `stands` is False where what it is about has been deleted from the program; `label` says what it was called.
    """

    id: UUID
    anchor: Anchor
    label: str
    stands: bool
    started_at: datetime
    resolved_at: datetime | None
    resolved_by: AuthorView | None
    comments: tuple[CommentView, ...]
    unread: int


@dataclass(frozen=True, slots=True)
class Words:
    """What somebody writes: a text and the ids of the members that it mentions; `origin` is where they reached VIPO."""

    text: str
    mentions: tuple[int, ...] = ()
    origin: str = ""


@dataclass(frozen=True, slots=True)
class Moment:
    """A moment of a run, `t_s` seconds after its start; `label` is what people call what happens then."""

    run: UUID
    number: int
    t_s: float
    label: str = ""


def list_threads(*, program: UUID, user: Any) -> tuple[ThreadView, ...]:
    """Return a program's threads, the last written in first, as this person has read them."""
    rows = list(_threads_of(program).order_by("-last_at", "pk"))
    readings = ThreadReading.objects.filter(thread__program=program, person=user)
    read_to = dict(readings.values_list("thread_id", "read_to"))
    document = _read_document(program) if any(is_drawn(row.anchor["kind"]) for row in rows) else {}
    people = _people_in(rows)
    return tuple(_view(row, document, people, user, read_to.get(row.pk)) for row in rows)


def start_thread_at(*, program: UUID, user: Any, moment: Moment, words: Words, now: datetime) -> UUID:
    """Begin a thread about a moment of a run of the program, which the caller knows; return its id.

    Raises NoSuchProgram, BadRequest, TooManyComments, CommentsFull.
    """
    anchor = Anchor(kind="moment", run=str(moment.run), number=moment.number, t_s=moment.t_s)
    return start_thread(program=program, user=user, anchor=anchor, label=moment.label, words=words, now=now).id


def start_thread(*, program: UUID, user: Any, anchor: Anchor, label: str, words: Words, now: datetime) -> ThreadView:
    """Begin a thread. Raises BadRequest, TooManyComments, CommentsFull."""
    if missing := find_missing(anchor):
        raise BadRequest(missing)
    if not stands_in(anchor, _read_document(program)):
        gone = "What this comment is about is not in the program. It may have been deleted: choose again."
        raise BadRequest(gone, {"why": "not_drawn"})
    with _writing(program, user, now) as site:
        if CommentThread.objects.filter(program=program).count() >= MOST_THREADS:
            raise _full("threads", MOST_THREADS, "A program has at most {} threads. Delete some that are resolved.")
        thread = CommentThread.objects.create(
            program_id=program, anchor=anchor_to_json(anchor), label=label, started_at=now, last_at=now
        )
        _write(thread, user, words, now, site)
    return get_thread(program=program, thread=thread.pk, user=user)


def answer_thread(*, program: UUID, thread: UUID, user: Any, words: Words, now: datetime) -> ThreadView:
    """Write an answer into a thread. Raises NoSuchProgram, BadRequest, TooManyComments, CommentsFull."""
    with _writing(program, user, now) as site:
        row = _hold(program, thread)
        if row.comments.count() >= MOST_IN_THREAD:
            raise _full("thread", MOST_IN_THREAD, "A thread has at most {} comments. Begin another one.")
        _write(row, user, words, now, site)
        CommentThread.objects.filter(pk=row.pk).update(last_at=now)
    return get_thread(program=program, thread=thread, user=user)


def get_thread(*, program: UUID, thread: UUID, user: Any) -> ThreadView:
    """Return a thread. Raises NoSuchProgram."""
    row = _find(program, thread)
    reading = ThreadReading.objects.filter(thread=thread, person=user).first()
    return _view(row, _read_document(program), _people_in([row]), user, reading.read_to if reading else None)


def resolve_thread(*, program: UUID, thread: UUID, user: Any, resolved: bool, now: datetime) -> ThreadView:
    """Mark a thread as resolved, or open it again. Raises NoSuchProgram."""
    row = _find(program, thread)
    if (row.resolved_at is not None) != resolved:
        rows = CommentThread.objects.filter(pk=row.pk)
        rows.update(resolved_at=now if resolved else None, resolved_by=user if resolved else None)
        _tell(row.program)
    return get_thread(program=program, thread=thread, user=user)


def mark_read(*, program: UUID, thread: UUID, user: Any, to: datetime) -> None:
    """Note up to when a person has read a thread. Raises NoSuchProgram."""
    with transaction.atomic():
        _hold(program, thread)
        ThreadReading.objects.update_or_create(thread_id=thread, person=user, defaults={"read_to": to})


def change_comment(*, program: UUID, comment: UUID, user: Any, words: Words, now: datetime) -> ThreadView:
    """Let somebody write their own comment anew. Raises NoSuchProgram, NotTheirs, BadRequest."""
    with transaction.atomic():
        row = _hold_comment(program, comment)
        if row.author_id != user.pk:
            raise NotTheirs("Only who wrote a comment changes it. Write an answer.")
        mentions = _checked(words.mentions, row.thread.program.site.slug)
        Comment.objects.filter(pk=row.pk).update(text=words.text, mentions=mentions, edited_at=now)
        note_people(row, set(mentions) - set(row.mentions), words.origin, now)
    _tell(row.thread.program)
    return get_thread(program=program, thread=row.thread_id, user=user)


def delete_comment(*, program: UUID, comment: UUID, user: Any, is_admin: bool) -> None:
    """Delete one's own comment, as an admin any; a thread goes with its last. Raises NoSuchProgram, NotTheirs."""
    with transaction.atomic():
        row = _hold_comment(program, comment)
        if row.author_id != user.pk and not is_admin:
            raise NotTheirs("Only who wrote a comment, or an admin, deletes it. Ask one of them.")
        held = row.thread.program
        if row.author_id != user.pk:
            by = row.author.display_name if row.author else ""
            facts = {"program": held.name, "author": by}
            registry.note_act(site_id=held.site_id, code="comment_deleted", facts=facts)
        row.delete()
        CommentThread.objects.filter(pk=row.thread_id, comments=None).delete()
        _tell(held)


@contextmanager
def _writing(program: UUID, user: Any, now: datetime) -> Iterator[str]:
    """Hold the program for one writer at a time, so that no bound is passed; gives its site, tells who watches."""
    with transaction.atomic():
        held = Program.objects.select_for_update(of=("self",)).select_related("site").filter(pk=program).first()
        if held is None:
            raise NoSuchProgram(_GONE)
        lately = Comment.objects.filter(author=user, written_at__gt=now - RATE_OVER)
        if lately.count() >= RATE:
            detail = f"You have written {RATE} comments within a minute. Go on in a minute."
            raise TooManyComments(detail, {"why": "rate", "most": RATE})
        if Comment.objects.filter(thread__program=program).count() >= MOST_COMMENTS:
            raise _full("program", MOST_COMMENTS, "A program has at most {} comments. Delete some that are resolved.")
        _tell(held)
        yield held.site.slug


def _write(thread: CommentThread, user: Any, words: Words, now: datetime, site: str) -> None:
    mentions = _checked(words.mentions, site)
    made = Comment.objects.create(thread=thread, author=user, text=words.text, mentions=mentions, written_at=now)
    note_comment(made, words.origin)
    ThreadReading.objects.update_or_create(thread=thread, person=user, defaults={"read_to": now})


def _full(why: str, most: int, detail: str) -> CommentsFull:
    return CommentsFull(detail.format(most), {"why": why, "most": most})


def _checked(mentions: Iterable[int], site: str) -> list[int]:
    wanted = sorted(set(mentions))
    known = {person.id for person in registry.list_people(site=site)}
    if not known.issuperset(wanted):
        detail = "Somebody whom this comment mentions is no member of the site. Leave them out."
        raise BadRequest(detail, {"why": "no_member"})
    return wanted


def _tell(program: Program) -> None:
    site, message = program.site.slug, {"type": "comments", "program": str(program.pk)}
    transaction.on_commit(lambda: registry.publish(site, message))


def _threads_of(program: UUID) -> Any:
    comments = Comment.objects.select_related("author").order_by("written_at", "pk")
    rows = CommentThread.objects.filter(program=program).select_related("resolved_by", "program__site")
    return rows.prefetch_related(Prefetch("comments", queryset=comments))


def _find(program: UUID, thread: UUID) -> CommentThread:
    row: CommentThread | None = _threads_of(program).filter(pk=thread).first()
    if row is None:
        raise NoSuchProgram(_GONE)
    return row


def _hold(program: UUID, thread: UUID) -> CommentThread:
    """Return a thread, which nobody else writes in or deletes until the transaction ends. Raises NoSuchProgram."""
    row = CommentThread.objects.select_for_update().filter(program=program, pk=thread).first()
    if row is None:
        raise NoSuchProgram(_GONE)
    return row


def _hold_comment(program: UUID, comment: UUID) -> Comment:
    """Return a comment, holding its thread as `_hold` does. Raises NoSuchProgram."""
    rows = Comment.objects.filter(pk=comment, thread__program=program)
    if (thread := rows.values_list("thread", flat=True).first()) is not None:
        _hold(program, thread)
    row = rows.select_related("author", "thread__program__site").first()
    if row is None:
        raise NoSuchProgram(_GONE)
    return row


def _read_document(program: UUID) -> dict[str, Any]:
    """Return what is drawn; of a program that cannot be read nothing stands, but its comments are there."""
    try:
        return dict(get_document(program_id=program))
    except DocumentHole:
        return {}


def _people_in(rows: Iterable[CommentThread]) -> dict[int, AuthorView]:
    """Return those whom threads mention, also who is no member any more."""
    named = {person for row in rows for comment in row.comments.all() for person in comment.mentions}
    found = get_user_model().objects.filter(pk__in=named) if named else ()
    return {user.pk: view for user in found if (view := view_author(user))}


def _view(
    row: CommentThread, document: dict[str, Any], people: dict[int, AuthorView], user: Any, read_to: datetime | None
) -> ThreadView:
    comments = tuple(_view_comment(each, people) for each in row.comments.all())
    news = [each for each in comments if each.author is None or each.author.id != user.pk]
    anchor = Anchor(**row.anchor)
    return ThreadView(
        id=row.pk,
        anchor=anchor,
        label=row.label,
        stands=stands_in(anchor, document),
        started_at=row.started_at,
        resolved_at=row.resolved_at,
        resolved_by=view_author(row.resolved_by),
        comments=comments,
        unread=sum(read_to is None or each.written_at > read_to for each in news),
    )


def _view_comment(row: Comment, people: dict[int, AuthorView]) -> CommentView:
    mentioned = tuple(people[person] for person in row.mentions if person in people)
    return CommentView(row.pk, view_author(row.author), row.text, mentioned, row.written_at, row.edited_at)
