"""What is written in a thread while it is deleted, in two sessions of one PostgreSQL: one comes first, none fails."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from concurrent.futures import ThreadPoolExecutor
from datetime import UTC, datetime, timedelta
from typing import Any
from uuid import UUID

import pytest
from django.db import connections, transaction
from pytest_django import DjangoDbBlocker

from editor import services as editor
from editor.comments import threads
from editor.comments.anchors import Anchor
from editor.errors import NoSuchProgram
from editor.models import Comment, CommentThread, ThreadReading
from registry import services as registry
from tests.kit.databases import on_database, one_waits
from tests.kit.programs import document, step
from tests.kit.sign_in import add_person, find_person
from tests.kit.waiting import wait_for
from vipo_site.settings import postgres

pytestmark = pytest.mark.servers
NOW = datetime(2026, 11, 21, 12, 0, tzinfo=UTC)
LATER = NOW + timedelta(minutes=1)
Act = Callable[[UUID, threads.ThreadView], object]


@pytest.fixture
def thread(database_url: str, django_db_blocker: DjangoDbBlocker) -> Iterator[tuple[UUID, threads.ThreadView]]:
    """A program on a PostgreSQL, and a thread beside it in which Ann has written once."""
    with django_db_blocker.unblock(), on_database(**postgres(database_url)):
        registry.create_site(name="Hall", slug="hall")
        for name in ("ann", "bob"):
            add_person(name)
            registry.set_member(site="hall", email=find_person(name).email, role="author")
        drawn = document({"a": step("wait", duration=1)})
        program = editor.create_program(site="hall", name="Carry", document=drawn).id
        anchor = Anchor(kind="construct", root="steps", id="a", x=1.0, y=1.0)
        words = threads.Words("Why wait?")
        begun = threads.start_thread(
            program=program, user=find_person("ann"), anchor=anchor, label="", words=words, now=NOW
        )
        yield program, begun


def answer(program: UUID, thread: threads.ThreadView) -> None:
    words = threads.Words("For the paint.")
    threads.answer_thread(program=program, thread=thread.id, user=find_person("bob"), words=words, now=LATER)


def read(program: UUID, thread: threads.ThreadView) -> None:
    threads.mark_read(program=program, thread=thread.id, user=find_person("bob"), to=LATER)


def change(program: UUID, thread: threads.ThreadView) -> None:
    words = threads.Words("Why, Bob?", (find_person("bob").pk,))
    comment = thread.comments[0].id
    threads.change_comment(program=program, comment=comment, user=find_person("ann"), words=words, now=LATER)


def delete(program: UUID, thread: threads.ThreadView) -> None:
    comment = thread.comments[0].id
    threads.delete_comment(program=program, comment=comment, user=find_person("ann"), is_admin=False)


def carry_out(first: Act, then: Act, thread: tuple[UUID, threads.ThreadView]) -> str:
    """Do one thing, and before it holds the other in a session of its own; return how that ended."""

    def do_and_close() -> str:
        try:
            then(*thread)
        except NoSuchProgram:
            return "gone"
        finally:
            connections.close_all()
        return "done"

    with ThreadPoolExecutor(1) as pool:
        with transaction.atomic():
            first(*thread)
            doing = pool.submit(do_and_close)
            wait_for("the other waits", one_waits)
        return doing.result(60)


@pytest.mark.parametrize("act", [answer, read, change, delete], ids=lambda act: act.__name__)
def test_who_writes_while_a_threads_last_comment_is_deleted_is_told_that_it_is_gone(thread: Any, act: Act) -> None:
    assert carry_out(delete, act, thread) == "gone"
    assert (CommentThread.objects.count(), Comment.objects.count(), ThreadReading.objects.count()) == (0, 0, 0)


@pytest.mark.parametrize("act", [answer, read, change], ids=lambda act: act.__name__)
def test_a_deletion_waits_for_what_is_being_written_and_leaves_others_their_answer(thread: Any, act: Act) -> None:
    assert carry_out(act, delete, thread) == "done"
    kept = list(Comment.objects.values_list("text", flat=True))
    assert kept == (["For the paint."] if act is answer else [])
    assert CommentThread.objects.count() == len(kept)
