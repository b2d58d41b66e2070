"""Comments by e-mail: what somebody has not read within ten minutes comes to them once, gathered in one message."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from datetime import datetime, timedelta

from django.db.models import QuerySet

from editor.models import Comment, CommentNotice, ThreadReading
from registry import services as registry

GATHERED_FOR = timedelta(minutes=10)
"""So long who is called has to read it on the screen, and what comes in meanwhile goes into the same message."""
MOST_COMMENTS, MOST_LETTERS = 30, 400
"""In one message, and of one comment."""


def note_comment(comment: Comment, origin: str) -> None:
    """Note whom a new comment is for: those it mentions and those who have written in its thread, without its writer.

    In the caller's transaction. Nothing is noted where the server sends no mail.
    """
    talking = set(comment.thread.comments.exclude(author=None).values_list("author", flat=True))
    note_people(comment, talking | set(comment.mentions), origin, comment.written_at)


def note_people(comment: Comment, people: Iterable[int], origin: str, at: datetime) -> None:
    """Note that a comment is for these people since a moment, as where it was changed and mentions them now."""
    if not registry.can_mail():
        return
    rows = [
        CommentNotice(comment=comment, person_id=person, origin=origin, made_at=at)
        for person in sorted(set(people) - {comment.author_id})
    ]
    CommentNotice.objects.bulk_create(rows, ignore_conflicts=True)


def _list_rows() -> QuerySet[CommentNotice]:
    return CommentNotice.objects.select_related("comment__author", "comment__thread__program__site")


def _write_letter(rows: Sequence[CommentNotice], person: int) -> tuple[str, str] | None:
    told = _worth_telling(rows, person)
    return (_subject(len(told)), _text(told)) if told else None


COMMENT_MAIL = registry.MailQueue(list_rows=_list_rows, waits=GATHERED_FOR, write_letter=_write_letter)
"""What somebody has not read comes to them, in one message."""


def _worth_telling(rows: Sequence[CommentNotice], person: int) -> list[CommentNotice]:
    """Return what this person has not read, at sites of which they are a member."""
    threads = {row.comment.thread_id for row in rows}
    read = dict(ThreadReading.objects.filter(person=person, thread__in=threads).values_list("thread_id", "read_to"))
    sites = {row.comment.thread.program.site.slug for row in rows}
    mine = {site for site in sites if person in {member.id for member in registry.list_people(site=site)}}
    return [
        row
        for row in rows
        if row.comment.thread.program.site.slug in mine
        and not (row.comment.thread_id in read and read[row.comment.thread_id] >= row.made_at)
    ]


def _subject(count: int) -> str:
    if count == 1:
        return "1 comment, 1 Kommentar (VIPO)"
    return f"{count} comments, {count} Kommentare (VIPO)"


_HEAD = """Comments that you have not read yet.
Kommentare, die Sie noch nicht gelesen haben.
"""
_FOOT = """
---
You get this because somebody mentioned you or wrote where you had written. Your account has a switch for it:
Sie erhalten dies, weil Sie erwähnt wurden oder dort geschrieben haben. In Ihrem Konto gibt es dafür einen Schalter:
{origin}account
"""


def _text(rows: Sequence[CommentNotice]) -> str:
    shown, left = rows[:MOST_COMMENTS], len(rows) - MOST_COMMENTS
    parts = [_HEAD]
    program = None
    for row in shown:
        thread = row.comment.thread
        if thread.program_id != program:
            program = thread.program_id
            parts += ["", f"{thread.program.name} ({thread.program.site.name})", f"{row.origin}programs/{program}", ""]
        parts += [*_lines_of(row.comment, thread.label), ""]
    if left > 0:
        parts.append(f"+ {left}")
    return "\n".join([*parts, _FOOT.format(origin=rows[-1].origin)])


def _lines_of(comment: Comment, label: str) -> Iterable[str]:
    by = comment.author.display_name if comment.author else "?"
    yield ", ".join(each for each in (by, f"{comment.written_at:%Y-%m-%d %H:%M} UTC", label) if each)
    text = comment.text if len(comment.text) <= MOST_LETTERS else f"{comment.text[:MOST_LETTERS]}…"
    yield from (f"  {line}" for line in text.splitlines())
