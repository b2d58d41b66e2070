"""A program of which a part is missing in the database: shown, mended, and put back as it was."""

from __future__ import annotations

import gzip
import json
from datetime import UTC, datetime
from pathlib import Path
from typing import Any
from uuid import uuid4

import pytest
from asgiref.sync import async_to_sync
from pycrdt import Doc, Map

from editor import services
from editor.documents.shared_document import SharedDocument
from editor.documents.store import Change, append_changes, load_document
from editor.errors import DocumentHole
from editor.models import DocumentUpdate, Snapshot
from editor.rooms.ledger import encode_change
from editor.rooms.stream import RedisStream
from registry import services as registry
from tests.kit.command_line import run_vipo
from tests.kit.servers import Redis, free_port

pytestmark = pytest.mark.django_db
NOW = datetime(2026, 11, 23, tzinfo=UTC)


@pytest.fixture
def author() -> Any:
    return registry.create_user(email="ada@vipo.example", password="a long password", display_name="Ada")


@pytest.fixture
def broken(author: Any) -> str:
    """Return a program of one whole row, and of one that builds on a row that is gone."""
    registry.create_site(slug="hall", name="Hall")
    program = str(services.create_program(site="hall", name="Broken", user=author).id)
    document, parts = Doc(), []
    document.observe(lambda event: parts.append(event.update))
    parameters = document.get("parameters", type=Map)
    for number in range(3):
        parameters[f"p{number}"] = {"name": f"p{number}", "type": "number"}
    append_changes(program, [Change(author.pk, parts[0])], NOW)
    append_changes(program, [Change(author.pk, parts[2])], NOW)
    return program


def parameters_of(program: str) -> list[str]:
    return sorted(services.get_document(program_id=program)["parameters"])


def rows_of(program: str) -> list[tuple[int, int | None, bytes, datetime]]:
    rows = DocumentUpdate.objects.filter(program=program).order_by("seq")
    return [(row.seq, row.author_id, bytes(row.data), row.at) for row in rows]


def test_what_is_left_is_shown_and_nothing_changed(broken: str, capsys: pytest.CaptureFixture[str]) -> None:
    before = rows_of(broken)
    code, out, _ = run_vipo(capsys, "mend-program", broken)
    assert (code, rows_of(broken)) == (1, before)
    first, header, row = out.splitlines()
    assert first == "Broken: 2 of 3 rows fit together: 0 steps, 0 functions."
    assert header.split("  ")[0] == "left out"
    assert row.split()[:4] == ["row", "3", "ada@vipo.example", str(len(before[1][2]))]


def test_a_mended_program_opens_and_every_row_is_in_the_file(
    broken: str, capsys: pytest.CaptureFixture[str], tmp_path: Path
) -> None:
    before = rows_of(broken)
    code, out, _ = run_vipo(capsys, "mend-program", broken, "--apply", "--folder", str(tmp_path))
    assert (code, parameters_of(broken)) == (0, ["p0"])
    (file,) = tmp_path.iterdir()
    assert f"saved in {file}" in out
    head, snapshot, *rows = map(json.loads, gzip.decompress(file.read_bytes()).splitlines())
    assert (head["vipo_rows"], head["program"], snapshot["snapshot"]) == (1, broken, 1)
    assert [(row["row"], row["author"]) for row in rows] == [(seq, who) for seq, who, *_ in before]
    assert list(Snapshot.objects.get(program=broken).authors.values()) == [before[0][1]]


def test_what_was_mended_can_be_put_back_and_later_edits_stay(
    broken: str, author: Any, capsys: pytest.CaptureFixture[str], tmp_path: Path
) -> None:
    before = rows_of(broken)
    run_vipo(capsys, "mend-program", broken, "--apply", "--folder", str(tmp_path))
    (file,) = tmp_path.iterdir()
    later = Doc()
    later.get("parameters", type=Map)["later"] = {"name": "later", "type": "number"}
    append_changes(broken, [Change(author.pk, later.get_update())], NOW)
    code, out, _ = run_vipo(capsys, "mend-program", "--restore", str(file), "--folder", str(tmp_path))
    assert code == 1
    assert "3 of 4 rows fit together" in out
    assert rows_of(broken)[:2] == before
    with pytest.raises(DocumentHole, match="vipo mend-program"):
        services.get_document(program_id=broken)
    run_vipo(capsys, "mend-program", broken, "--apply", "--folder", str(tmp_path))
    assert parameters_of(broken) == ["later", "p0"]


def test_a_row_that_came_before_what_it_builds_on_fits(broken: str, author: Any, tmp_path: Path) -> None:
    document, parts = Doc(), []
    document.observe(lambda event: parts.append(event.update))
    zones = document.get("zones", type=Map)
    zones["a"], zones["b"] = {"name": "a"}, {"name": "b"}
    append_changes(broken, [Change(None, parts[1]), Change(author.pk, parts[0])], NOW)
    assert [row.seq for row in services.show_mending(program_id=broken).left_out] == [3]
    services.mend_program(program_id=broken, folder=tmp_path)
    assert sorted(services.get_document(program_id=broken)["zones"]) == ["a", "b"]


def test_bytes_that_are_no_update_are_left_out(broken: str, tmp_path: Path) -> None:
    DocumentUpdate.objects.filter(program=broken, seq=3).update(data=b"\x01\xff\xff")
    with pytest.raises(DocumentHole, match="cannot be read"):
        services.get_document(program_id=broken)
    services.mend_program(program_id=broken, folder=tmp_path)
    assert parameters_of(broken) == ["p0"]


def test_a_whole_program_is_left_as_it_is(broken: str, capsys: pytest.CaptureFixture[str], tmp_path: Path) -> None:
    DocumentUpdate.objects.filter(program=broken, seq=3).delete()
    before = load_document(broken)
    code, out, _ = run_vipo(capsys, "mend-program", broken, "--apply", "--folder", str(tmp_path))
    assert (code, load_document(broken), list(tmp_path.iterdir())) == (0, before, [])
    assert "nothing was changed" in out


@pytest.mark.parametrize(
    ("asked", "said"), [([str(uuid4())], "no such program"), (["x"], "no such program"), ([], "Name")]
)
def test_what_cannot_be_mended_is_said(asked: list[str], said: str, capsys: pytest.CaptureFixture[str]) -> None:
    code, _, err = run_vipo(capsys, "mend-program", *asked)
    assert code == 2
    assert said in err


def test_a_file_that_is_cut_off_changes_nothing(
    broken: str, capsys: pytest.CaptureFixture[str], tmp_path: Path
) -> None:
    services.mend_program(program_id=broken, folder=tmp_path)
    (file,) = tmp_path.iterdir()
    before = load_document(broken)
    file.write_bytes(file.read_bytes()[:-20])
    code, _, err = run_vipo(capsys, "mend-program", "--restore", str(file), "--folder", str(tmp_path))
    assert (code, load_document(broken)) == (2, before)
    assert "not whole" in err


def test_a_program_with_a_hole_stays_in_the_list(broken: str) -> None:
    (listed,) = services.list_programs(site="hall")
    assert (str(listed.id), listed.name) == (broken, "Broken")


def test_a_hundred_rows_in_the_wrong_order_all_fit(broken: str, author: Any) -> None:
    document, parts = Doc(), []
    document.observe(lambda event: parts.append(event.update))
    zones = document.get("zones", type=Map)
    for number in range(100):
        zones[f"z{number}"] = {"name": str(number)}
    append_changes(broken, [Change(author.pk if n % 2 else None, part) for n, part in enumerate(reversed(parts))], NOW)
    assert [row.seq for row in services.show_mending(program_id=broken).left_out] == [3]
    assert SharedDocument(parts).has_hole(parts) is False


def tell(url: str, program: str, changes: list[Change]) -> None:
    """Put changes into the program's stream, as a web process does before they are rows."""

    async def append() -> None:
        stream = RedisStream(url)
        await stream.append(program, "web", [encode_change(number, each) for number, each in enumerate(changes, 1)])
        await stream.close()

    async_to_sync(append)()


def parts_of(count: int) -> list[bytes]:
    """Return updates of one client, each of which builds on those before."""
    document, parts = Doc(client_id=77), []
    document.observe(lambda event: parts.append(event.update))
    for number in range(count):
        document.get("parameters", type=Map)[f"p{number}"] = {"name": f"p{number}", "type": "number"}
    return parts


@pytest.mark.servers
def test_what_is_told_and_in_no_row_yet_is_shown_and_becomes_a_part_of_the_program(
    author: Any, shared_redis: Redis, settings: Any, capsys: pytest.CaptureFixture[str], tmp_path: Path
) -> None:
    registry.create_site(slug="hall", name="Hall")
    program = str(services.create_program(site="hall", name="Broken", user=author).id)
    parts = parts_of(6)
    append_changes(program, [Change(author.pk, parts[0])], NOW)
    append_changes(program, [Change(author.pk, parts[2])], NOW)
    settings.VIPO_STREAM_URL = shared_redis.url
    tell(shared_redis.url, program, [Change(author.pk, parts[number]) for number in (0, 1, 3, 5)])
    code, out, _ = run_vipo(capsys, "mend-program", program)
    assert (code, out.splitlines()) == (
        0,
        [
            "Broken: 3 of 3 rows fit together: 0 steps, 0 functions.",
            "2 of 3 changes that are in no row yet fit together with them.",
        ],
    )


@pytest.mark.servers
def test_what_is_told_is_kept_where_a_program_is_mended(
    broken: str, author: Any, shared_redis: Redis, settings: Any, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    settings.VIPO_STREAM_URL = shared_redis.url
    tell(shared_redis.url, broken, [Change(author.pk, part) for part in parts_of(2)])
    code, out, _ = run_vipo(capsys, "mend-program", broken, "--apply", "--folder", str(tmp_path))
    assert (code, out.splitlines()[:2]) == (
        0,
        [
            "Broken: 2 of 3 rows fit together: 0 steps, 0 functions.",
            "2 of 2 changes that are in no row yet fit together with them.",
        ],
    )
    assert parameters_of(broken) == ["p0", "p1"]
    assert Snapshot.objects.get(program=broken).authors["77"] == author.pk


@pytest.mark.servers
def test_without_redis_the_rows_are_shown_and_that_more_may_be_missing(
    broken: str, settings: Any, capsys: pytest.CaptureFixture[str]
) -> None:
    settings.VIPO_STREAM_URL = f"redis://127.0.0.1:{free_port()}/0"
    code, out, err = run_vipo(capsys, "mend-program", broken)
    assert (code, out.splitlines()[0]) == (1, "Broken: 2 of 3 rows fit together: 0 steps, 0 functions.")
    assert "Redis does not answer" in err
