"""Rows are folded while others append, read and fold, on PostgreSQL, and by processes that are killed in between."""

from __future__ import annotations

import asyncio
import os
import signal
import sys
from collections.abc import Callable, Iterator
from concurrent.futures import ThreadPoolExecutor
from datetime import UTC, datetime
from subprocess import PIPE
from threading import Event
from typing import Any

import pytest
from asgiref.sync import ThreadSensitiveContext, sync_to_async
from django.db import connection, transaction
from pycrdt import Doc, Map
from pytest_django import DjangoDbBlocker

from editor.documents.shared_document import SharedDocument
from editor.documents.store import COMPACT_AFTER_ROWS, Change, append_changes, compact_document, load_document
from editor.documents.tasks import Folded, Folding
from editor.models import DocumentUpdate, Program, Snapshot
from editor.rooms import runner
from editor.rooms.hub import hub_of_this_loop
from editor.rooms.member import Member, Person
from editor.services import create_program
from registry.services import create_site
from tests.kit.databases import on_database
from tests.kit.files import ROOT
from tests.kit.processes.forked import ForkedPython
from tests.kit.served import served_without_broker
from tests.kit.waiting import wait_for
from vipo_site.settings import postgres

pytestmark = pytest.mark.servers
NOW = datetime(2026, 1, 2, 3, 4, tzinfo=UTC)
KILLED = """
import os, signal, sys
import django
django.setup()
from django.db import connection
from editor.documents.store import compact_document

def kill_after(left):
    def kill(execute, *rest):
        nonlocal left
        said, left = execute(*rest), left - 1
        if not left:
            os.kill(os.getpid(), signal.SIGKILL)
        return said
    return kill

for line in sys.stdin:
    if child := os.fork():
        print(os.waitstatus_to_exitcode(os.waitpid(child, 0)[1]), flush=True)
    else:
        with connection.execute_wrapper(kill_after(int(line))):
            os._exit(0 if compact_document(sys.argv[1]) else 1)
"""


class Drawing:
    """Somebody who gives one parameter after the other, each change building on those before."""

    def __init__(self) -> None:
        self._document, self._told, self.count = Doc[Any](), list[bytes](), 0
        self._parameters = self._document.get("parameters", type=Map)
        self._document.observe(lambda event: self._told.append(event.update))

    def store(self, program: str, count: int) -> None:
        """Store so many changes, each as a row."""
        for _ in range(count):
            self._parameters[f"p{self.count}"] = self.count
            append_changes(program, [Change(None, self._told[-1])], NOW)
            self.count += 1


@pytest.fixture
def program(database_url: str, django_db_blocker: DjangoDbBlocker) -> Iterator[str]:
    with django_db_blocker.unblock(), on_database(**postgres(database_url)):
        create_site(name="Hall", slug="hall")
        yield str(create_program(site="hall", name="Carry").id)


@pytest.fixture
def elsewhere() -> Iterator[Callable[..., Any]]:
    """Do something on a connection of its own, begun at once; returns what it came to."""
    with ThreadPoolExecutor(4) as threads:
        yield lambda act, *args: threads.submit(_closing, act, *args)


def _closing(act: Callable[..., Any], *args: Any) -> Any:
    try:
        return act(*args)
    finally:
        connection.close()


def parameters(program: str) -> int:
    """Return how many parameters the rows hold. Raises DocumentHole."""
    kept = load_document(program).open().to_json()["parameters"]
    assert kept == {f"p{number}": number for number in range(len(kept))}
    return len(kept)


def test_rows_that_come_while_others_are_folded_stay_and_do_not_wait(
    program: str, elsewhere: Callable[..., Any]
) -> None:
    drawing = Drawing()
    drawing.store(program, 20)

    def fold(folding: Folding) -> Folded:
        elsewhere(drawing.store, program, 5).result(30)
        return folding.done()

    assert compact_document(program, fold)
    assert parameters(program) == 25
    rows = list(DocumentUpdate.objects.order_by("seq").values_list("seq", flat=True))
    assert (Snapshot.objects.get().seq, rows) == (21, [22, 23, 24, 25, 26])


def test_of_two_who_fold_at_once_the_later_one_changes_nothing(program: str, elsewhere: Callable[..., Any]) -> None:
    drawing = Drawing()
    drawing.store(program, 20)

    def fold(folding: Folding) -> Folded:
        assert elsewhere(compact_document, program).result(30)
        drawing.store(program, 5)
        return folding.done()

    assert not compact_document(program, fold)
    assert (Snapshot.objects.get().seq, DocumentUpdate.objects.count(), parameters(program)) == (21, 5, 25)
    assert compact_document(program)
    assert not compact_document(program)
    assert (Snapshot.objects.get().seq, DocumentUpdate.objects.count(), parameters(program)) == (26, 0, 25)


@pytest.mark.parametrize("statement", [1, 2])
def test_who_reads_while_rows_are_folded_reads_all_of_them(
    program: str, elsewhere: Callable[..., Any], statement: int
) -> None:
    drawing, seen = Drawing(), [0]
    drawing.store(program, 10)
    compact_document(program)
    drawing.store(program, 10)

    def fold_after(execute: Callable[..., Any], *rest: Any) -> Any:
        said = execute(*rest)
        seen[0] += 1
        if seen[0] == statement:
            elsewhere(compact_document, program).result(30)
            elsewhere(drawing.store, program, 1).result(30)
        return said

    with connection.execute_wrapper(fold_after):
        stored = load_document(program)
    kept = len(stored.open().to_json()["parameters"])
    assert (seen[0], kept) == (2, 21 if statement == 1 else 20)
    assert stored.seq == 1 + kept


def test_a_process_that_is_killed_at_any_statement_of_folding_loses_nothing(
    program: str, database_url: str, tmp_path: Any
) -> None:
    drawing, ended = Drawing(), list[int]()
    drawing.store(program, 10)
    environment = {**os.environ, **served_without_broker(tmp_path, database_url, "redis://127.0.0.1:1/0")}
    command = [sys.executable, "-c", KILLED, program]
    with ForkedPython(command, cwd=ROOT, env=environment, stdin=PIPE, stdout=PIPE, text=True) as process:
        assert process.stdin is not None
        assert process.stdout is not None
        while not ended or ended[-1]:
            process.stdin.write(f"{len(ended) + 1}\n")
            process.stdin.flush()
            ended.append(int(process.stdout.readline()))
            drawing.store(program, 1)  # which does not wait for a lock that the dead one left
            assert parameters(program) == drawing.count
        process.stdin.close()
    assert ended == [-signal.SIGKILL] * (len(ended) - 1) + [0]
    assert len(ended) > 6
    assert Snapshot.objects.get().seq == drawing.count


def test_while_rows_are_appended_and_folded_everybody_reads_all_that_was_stored(
    program: str, elsewhere: Callable[..., Any]
) -> None:
    drawing, ended = Drawing(), Event()

    def fold_often() -> int:
        done = 0
        while not ended.is_set():
            done += compact_document(program)
        return done

    def read_often() -> int:
        reads = 0
        while not ended.is_set():
            before = drawing.count
            assert parameters(program) >= before
            reads += 1
        return reads

    others = [elsewhere(act) for act in (fold_often, fold_often, read_often)]
    try:
        drawing.store(program, 60)
    finally:
        ended.set()
    first, second, reads = (other.result(30) for other in others)
    assert min(first + second, reads) > 0  # one of two may come too late each time
    assert parameters(program) == 60
    compact_document(program)
    assert SharedDocument(load_document(program).updates).to_json()["parameters"]["p59"] == 59
    assert Program.objects.get(pk=program).last_seq == Snapshot.objects.get().seq == 61


def test_a_room_that_opens_with_many_rows_folds_them_and_holds_all(program: str) -> None:
    drawing = Drawing()
    with transaction.atomic():
        drawing.store(program, COMPACT_AFTER_ROWS)
    asyncio.run(_look_at(program))
    assert (Snapshot.objects.get().seq, DocumentUpdate.objects.count()) == (COMPACT_AFTER_ROWS + 1, 0)
    assert parameters(program) == COMPACT_AFTER_ROWS


REFUSE = """
CREATE FUNCTION refuse_snapshot() RETURNS trigger LANGUAGE plpgsql AS
$$ BEGIN RAISE disk_full USING MESSAGE = 'no room is left'; END $$;
CREATE TRIGGER refuse_snapshots BEFORE INSERT ON editor_snapshot FOR EACH ROW EXECUTE FUNCTION refuse_snapshot();
"""
ACCEPT = "DROP FUNCTION refuse_snapshot CASCADE"


def test_rows_that_could_not_be_folded_are_folded_when_the_database_takes_them(
    program: str, monkeypatch: pytest.MonkeyPatch, caplog: pytest.LogCaptureFixture
) -> None:
    monkeypatch.setattr(runner, "FOLD_AGAIN_AFTER_S", 0.3)
    with transaction.atomic():
        Drawing().store(program, COMPACT_AFTER_ROWS)
    with connection.cursor() as cursor:
        cursor.execute(REFUSE)
        with ThreadPoolExecutor(1) as pool:
            looking = pool.submit(asyncio.run, _look_at(program))
            try:
                wait_for("a refusal", lambda: "was not compacted" in caplog.text)
                assert DocumentUpdate.objects.count() >= COMPACT_AFTER_ROWS
            finally:
                cursor.execute(ACCEPT)
            looking.result(60)
    assert (Snapshot.objects.count(), DocumentUpdate.objects.count()) == (1, 0)
    assert parameters(program) == COMPACT_AFTER_ROWS


async def _look_at(program: str) -> None:
    """Open a program's room as whoever may only look, draw nothing, and stay until there are no rows.

    Threads are its own: those that all tests share would go on with this test's database.
    """
    async with ThreadSensitiveContext():
        hub = hub_of_this_loop()
        try:
            room = await hub.enter(program, Member(Person(1, "B", "B"), can_write=False, wake=lambda: None))
            assert len(room.document.to_json()["parameters"]) == COMPACT_AFTER_ROWS
            async with asyncio.timeout(60):
                while await sync_to_async(DocumentUpdate.objects.count)():  # noqa: ASYNC110 - another thread's doing
                    await asyncio.sleep(0.05)
        finally:
            await hub.close()
            await sync_to_async(lambda: connection.close())()
