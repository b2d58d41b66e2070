"""The tests that stand beside a program: written, read, deleted, brought in as a file and sent as one.

Who writes says which revision they have read, so that nobody's words are overwritten unseen.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from datetime import UTC, datetime, timedelta
from typing import Any
from uuid import UUID

from django.db import IntegrityError, transaction
from django.db.models import F

from editor import services as editor
from execution.errors import BadTest, NotFound, TestChanged, TestNameTaken, TestsFull, TestTagNeeded
from execution.models import ProgramTest
from execution.trials.refusals import cause_of_refusal
from execution.trials.trial_file import read_trial
from execution.trials.trial_texts import put_together, take_apart
from execution.trials.yaml_lines import BadTrialFile
from registry import services as registry

MOST_TESTS = 100
MOST_TEXT = 20_000
"""Characters of one test."""
TOO_LONG = f"A test has at most {MOST_TEXT} characters. Make two of it."


@dataclass(frozen=True, slots=True)
class TestText:
    """A test as it is written; `tag` is another once it is written anew."""

    id: UUID
    name: str
    text: str
    tag: str


def get_test(*, program: UUID, test: UUID) -> TestText:
    """Return a test. Raises NotFound."""
    row = ProgramTest.objects.filter(pk=test, program=program).first()
    if row is None:
        raise NotFound("There is no such test beside this program. It may have been deleted.")
    return TestText(row.pk, row.name, row.text, tag_of(row.revision))


def tag_of(revision: int) -> str:
    """Return the ETag of a revision."""
    return f'"{revision}"'


def find_fault(*, text: str) -> tuple[int, str] | None:
    """Return the line (0: unknown) and why a text is no test; None when it is one."""
    if len(text) > MOST_TEXT:
        return 0, TOO_LONG
    try:
        read_trial(text.encode())
    except BadTrialFile as error:
        return error.line, error.why
    return None


def add_test(*, program: UUID, text: str, user: Any) -> TestText:
    """Add a test. Raises BadTest, TestNameTaken, TestsFull, editor.NoSuchProgram."""
    return add_tests(program=program, texts=[text], user=user)[0]


def import_tests(*, program: UUID, text: str, user: Any) -> list[TestText]:
    """Add all tests of a file, or none. Raises BadTest, TestNameTaken, TestsFull, editor.NoSuchProgram."""
    try:
        texts = take_apart(text.encode())
    except BadTrialFile as error:
        raise _bad(error) from error
    return add_tests(program=program, texts=texts, user=user)


def add_tests(*, program: UUID, texts: Sequence[str], user: Any) -> list[TestText]:
    """Add tests, all or none. Raises BadTest, TestNameTaken, TestsFull, editor.NoSuchProgram."""
    names = [_read(text) for text in texts]
    now = datetime.now(UTC)
    with transaction.atomic():
        editor.lock_program(program_id=program)
        known = list(ProgramTest.objects.filter(program=program).values_list("name", flat=True))
        if taken := sorted(set(names) & set(known)):
            raise _taken(taken[0])
        if len(known) + len(names) > MOST_TESTS:
            raise TestsFull(
                f"A program has at most {MOST_TESTS} tests, and this one has {len(known)}. Delete some first.",
                {"most": MOST_TESTS},
            )
        rows = ProgramTest.objects.bulk_create(
            ProgramTest(
                program_id=program,
                name=name,
                text=text,
                edited_at=now,
                edited_by=user,
                created_at=now + timedelta(microseconds=place),  # they stay in the order of their file
            )
            for place, (name, text) in enumerate(zip(names, texts, strict=True))
        )
        say_changed(program)
    return [TestText(row.pk, row.name, row.text, tag_of(row.revision)) for row in rows]


def write_test(*, program: UUID, test: UUID, text: str, tag: str, user: Any) -> TestText:
    """Write a test anew. Raises NotFound, BadTest, TestTagNeeded, TestChanged, TestNameTaken."""
    name, mine = _read(text), _as_read(program, test, tag)
    columns = {"name": name, "text": text, "edited_at": datetime.now(UTC), "edited_by": user}
    try:
        with transaction.atomic():
            if not mine.update(revision=F("revision") + 1, **columns):
                raise _changed()
            say_changed(program)
    except IntegrityError as error:
        raise _taken(name) from error
    return get_test(program=program, test=test)


def delete_test(*, program: UUID, test: UUID, tag: str) -> None:
    """Delete a test with its results. Raises NotFound, TestTagNeeded, TestChanged."""
    with transaction.atomic():
        if not _as_read(program, test, tag).delete()[0]:
            raise _changed()
        say_changed(program)


def file_of_tests(*, program: UUID, document: str) -> str:
    """Return a program's tests as a file for `vipo test`; `document` is the path of the program's file from there."""
    rows = ProgramTest.objects.filter(program=program).order_by("created_at", "name")
    return put_together(document, list(rows.values_list("text", flat=True)))


def say_changed(program: UUID) -> None:
    """Tell who watches the site, once the transaction is through."""
    site = editor.get_program(program_id=program).site
    message = {"type": "tests", "program": str(program)}
    transaction.on_commit(lambda: registry.publish(site, message))


def _as_read(program: UUID, test: UUID, tag: str) -> Any:
    """Return the row if it is still what was read."""
    known = get_test(program=program, test=test)
    if not tag:
        raise TestTagNeeded("Say in the header If-Match what you have read: the ETag of the test.")
    if tag != known.tag:
        raise _changed()
    return ProgramTest.objects.filter(pk=test, program=program, revision=int(tag.strip('"')))


def _read(text: str) -> str:
    """Return the name of the test in a text."""
    if len(text) > MOST_TEXT:
        raise _bad(BadTrialFile(0, TOO_LONG))
    try:
        return read_trial(text.encode()).name
    except BadTrialFile as error:
        raise _bad(error) from error


def _bad(error: BadTrialFile) -> BadTest:
    where = f"Line {error.line}: " if error.line else ""
    cause = cause_of_refusal(error.why)
    told = {"why": cause["code"], **cause["args"]} if cause else {}
    return BadTest(f"{where}{error.why}", {**told, "line": error.line})


def _taken(name: str) -> TestNameTaken:
    return TestNameTaken(f"A test of this program is called “{name}” already. Give it another name.", {"name": name})


def _changed() -> TestChanged:
    return TestChanged("Somebody has written this test since you read it. Read it again, then write your change of it.")
