"""Documents in the database: batches, snapshots, and what the services make of them."""

from __future__ import annotations

from datetime import UTC, datetime
from typing import Any
from uuid import uuid4

import pytest
from django.db import connection
from django.test.utils import CaptureQueriesContext
from pycrdt import Doc, Map

from editor import services
from editor.documents.shared_document import SharedDocument, clients_of, empty_document, encode_document
from editor.documents.store import Change, SnapshotDiffers, append_changes, compact_document, load_document
from editor.errors import DocumentHole, NoSuchProgram
from editor.models import DocumentUpdate, Program, Snapshot, Version
from editor.programs.packing import Content, pack
from registry import services as registry
from registry.models import Site

NOW = datetime(2026, 1, 2, 3, 4, tzinfo=UTC)
pytestmark = pytest.mark.django_db


@pytest.fixture
def author() -> Any:
    registry.create_site(name="Hall", slug="hall")
    return registry.create_user(email="ada@vipo.example", password="a long password", display_name="Ada Author")


@pytest.fixture
def program(author: Any) -> str:
    return str(services.create_program(site="hall", name="Carry", user=author).id)


def drawing(name: str) -> bytes:
    return encode_document(
        {
            **empty_document(),
            "steps": {name: {"kind": "wait", "place": ["program", "body", name], "params": {"duration": 1}}},
        }
    )


def steps(program: str) -> list[str]:
    return sorted(SharedDocument(load_document(program).updates).to_json()["steps"])


def test_a_batch_is_appended_with_its_authors(program: str, author: Any) -> None:
    changes = [Change(author.pk, drawing("s1")), Change(None, drawing("s2"))]
    assert append_changes(program, changes, NOW) == range(2, 4)
    assert steps(program) == ["s1", "s2"]
    rows = DocumentUpdate.objects.order_by("seq").values_list("seq", "author_id")
    assert list(rows) == [(2, author.pk), (3, None)]
    kept = Program.objects.get(pk=program)
    assert (kept.edited_at, kept.edited_by_id, kept.last_seq) == (NOW, author.pk, 3)


def test_compacting_keeps_the_document_and_drops_the_rows(program: str, author: Any) -> None:
    append_changes(program, [Change(author.pk, drawing(f"s{number}")) for number in range(9)], NOW)
    before = SharedDocument(load_document(program).updates).digest()
    compact_document(program)
    assert SharedDocument(load_document(program).updates).digest() == before
    assert (DocumentUpdate.objects.count(), Snapshot.objects.get().seq) == (0, 2)
    append_changes(program, [Change(author.pk, drawing("later"))], NOW)
    compact_document(program)
    assert "later" in steps(program)
    assert Snapshot.objects.get().seq == 3


def test_changes_of_one_person_that_follow_each_other_are_one_row(program: str, author: Any) -> None:
    changes = [Change(who, drawing(f"s{number}")) for number, who in enumerate([author.pk] * 3 + [None] + [author.pk])]
    assert append_changes(program, changes, NOW) == range(2, 5)
    assert [author for (author,) in DocumentUpdate.objects.order_by("seq").values_list("author_id")] == [
        author.pk,
        None,
        author.pk,
    ]
    assert steps(program) == ["s0", "s1", "s2", "s3", "s4"]


def test_a_batch_costs_as_many_statements_with_many_rows_as_with_few(program: str) -> None:
    statements = []
    for number in (1, 300, 2):
        for each in range(number):
            append_changes(program, [Change(None, drawing(f"s{number}-{each}"))], NOW)
        with CaptureQueriesContext(connection) as captured:
            append_changes(program, [Change(None, drawing(f"s{number}-last"))], NOW)
        statements.append([query["sql"].split()[0] for query in captured.captured_queries])
    assert statements[0] == statements[1] == statements[2]
    assert [word for word in statements[0] if word not in {"SAVEPOINT", "RELEASE"}] == ["SELECT", "INSERT", "UPDATE"]


def test_whose_a_change_is_outlives_compacting(program: str, author: Any) -> None:
    second = registry.create_user(email="bob@vipo.example", password="a long password", display_name="Bob")
    drawn = drawing("s1"), drawing("s2")
    append_changes(program, [Change(author.pk, drawn[0]), Change(second.pk, drawn[1])], NOW)
    compact_document(program)
    append_changes(program, [Change(author.pk, drawing("s3"))], NOW)
    compact_document(program)
    authors = Snapshot.objects.get().authors
    assert [authors[str(*clients_of(each))] for each in drawn] == [author.pk, second.pk]
    assert sorted(authors.values()) == [author.pk, author.pk, second.pk]


def test_a_document_with_a_hole_is_never_opened_silently(program: str, author: Any) -> None:
    document, parts = Doc(), []
    document.observe(lambda event: parts.append(event.update))
    texts = document.get("parameters", type=Map)
    for number in range(3):
        texts[f"p{number}"] = number
    append_changes(program, [Change(author.pk, parts[0])], NOW)
    append_changes(program, [Change(author.pk, parts[2])], NOW)
    for reads in (services.get_document, services.pin_version):
        with pytest.raises(DocumentHole, match="A part of this program is missing in the database"):
            reads(program_id=program, **({"user": author} if reads is services.pin_version else {}))
    with pytest.raises(DocumentHole):
        compact_document(program)
    assert DocumentUpdate.objects.count() == 2
    append_changes(program, [Change(author.pk, parts[1])], NOW)
    assert services.get_document(program_id=program)["parameters"] == {"p0": 0, "p1": 1, "p2": 2}


def test_a_deletion_of_what_is_missing_is_a_hole(program: str, author: Any) -> None:
    document, parts = Doc(), []
    document.observe(lambda event: parts.append(event.update))
    texts = document.get("parameters", type=Map)
    texts["p"] = 1
    del texts["p"]
    append_changes(program, [Change(author.pk, parts[1])], NOW)
    with pytest.raises(DocumentHole):
        load_document(program).open()


def test_a_snapshot_that_differs_deletes_nothing(program: str, author: Any, monkeypatch: pytest.MonkeyPatch) -> None:
    append_changes(program, [Change(author.pk, drawing("s1"))], NOW)
    monkeypatch.setattr(SharedDocument, "encode", lambda *_: b"\x00\x00")
    with pytest.raises(SnapshotDiffers, match="they are kept"):
        compact_document(program)
    monkeypatch.undo()
    assert steps(program) == ["s1"]
    assert (DocumentUpdate.objects.count(), Snapshot.objects.get().seq) == (1, 1)


def test_a_program_that_is_gone_takes_no_changes(program: str, author: Any) -> None:
    services.delete_program(program_id=program)
    with pytest.raises(NoSuchProgram):
        append_changes(program, [Change(author.pk, drawing("s1"))], NOW)
    with pytest.raises(NoSuchProgram):
        load_document(program)
    with pytest.raises(NoSuchProgram):
        services.get_program(program_id=uuid4())
    assert DocumentUpdate.objects.count() == 0


def test_a_version_is_pinned_once_for_one_document(program: str, author: Any) -> None:
    first = services.pin_version(program_id=program, user=author)
    assert services.pin_version(program_id=program, user=author) == first
    append_changes(program, [Change(author.pk, drawing("s1"))], NOW)
    second = services.pin_version(program_id=program, user=author, message="One wait")
    assert (first.number, second.number, second.message) == (1, 2, "One wait")
    assert services.get_version(version_id=first.id).document == empty_document()
    compiled = services.compile_version(version=second)
    assert compiled.plan is not None
    assert list(second.document["steps"]) == ["s1"]


def test_the_demo_has_its_programs_and_seeding_again_changes_nothing(author: Any) -> None:
    services.seed_programs(site="hall")
    first = [program.id for program in services.list_programs(site="hall")]
    services.seed_programs(site="hall")
    programs = services.list_programs(site="hall")
    assert [program.id for program in programs] == first
    assert [program.name for program in programs] == ["Paint order", "First task"]
    assert {"pick_and_drop", "operate", "while"} <= set(programs[0].kinds)


def test_an_old_program_is_told_in_the_format_of_today(author: Any) -> None:
    old = {"format": 1, "steps": {"w": {"kind": "wait", "place": ["program", "body", "V"], "params": {"seconds": 5}}}}
    program = Program.objects.create(site=Site.objects.get(slug="hall"), name="Old", edited_at=NOW, last_seq=1)
    Snapshot.objects.create(program=program, seq=1, data=encode_document(old))
    document = services.get_document(program_id=program.pk)
    assert (document["format"], document["steps"]["w"]["params"]) == (2, {"duration": 5})
    version = services.pin_version(program_id=program.pk, user=author)
    assert version.document == document
    assert "self.wait(5)" in version.script


def test_a_version_of_a_former_format_is_told_in_the_format_of_today(program: str, author: Any) -> None:
    version = services.pin_version(program_id=program, user=author)
    old = {"format": 1, "steps": {"w": {"kind": "wait", "params": {"seconds": 5}}}}
    Version.objects.filter(pk=version.id).update(content=pack(Content(old, "")), base=None)
    told = services.get_version(version_id=version.id).document
    assert told == {"format": 2, "steps": {"w": {"kind": "wait", "params": {"duration": 5}}}}
