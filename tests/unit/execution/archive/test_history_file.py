"""The file of an archive: what is written is read, and what is not whole, not ours or hostile is said in a sentence."""

from __future__ import annotations

import gzip
import io
import json
import os
import subprocess
import sys
from pathlib import Path

import pytest

from execution.archive import history_file
from execution.archive.history_file import FORMAT, UPGRADES, Header, Row, read_sections, write_section
from tests.kit.command_line import run_vipo
from tests.kit.files import ROOT

RUN: Row = {
    "row": "run",
    "id": "r1",
    "number": 7,
    "program_name": "Mix\x1b[2J",
    "status": "failed",
    "reason": "It broke",
    "started_at": "2026-01-01T10:00:00+00:00",
    "ended_at": "2026-01-01T10:05:00+00:00",
    "started_by": "Ada",
}
EVENT: Row = {"row": "event", "seq": 1, "t_s": 1.5, "text": "Ada started run 7. ü"}
COMMAND: Row = {"row": "command", "id": "c1", "device": "mixer1", "method": "mix", "arguments": {"colour": "red"},
                "status": "done", "why": "", "sent_at": None}  # fmt: skip
TEXT = (
    "Run 7 of “Mix�[2J” at hall, 2026-01-01T10:00:00+00:00 to 2026-01-01T10:05:00+00:00, failed: It broke, started by "
    "Ada (r1)\n       1.500 s  Ada started run 7. ü\n"
)


def header(key: str = "r1", kind: str = "run") -> Header:
    return Header(kind, "hall", key, "2026-11-23T12:00:00+00:00")


@pytest.fixture
def file(tmp_path: Path) -> Path:
    path = tmp_path / "a.jsonl.gz"
    with path.open("wb") as out:
        write_section(out, header(), [RUN, EVENT])
        write_section(out, header("a1", "calls"), [COMMAND])
    return path


def packed(*lines: object) -> bytes:
    return gzip.compress(b"".join(json.dumps(line).encode() + b"\n" for line in lines))


def test_a_file_has_sections_that_are_read_alone_or_together_also_by_gzip(tmp_path: Path) -> None:
    out = io.BytesIO()
    places = [write_section(out, header(key), [RUN | {"id": key}, EVENT]) for key in ("a", "b", "c")]
    rows = [(head.id, row and row["row"]) for head, row in read_sections(io.BytesIO(out.getvalue()))]
    assert rows == [(key, name) for key in "abc" for name in ("run", "event", None)]
    second = out.getvalue()[places[1].offset : places[1].offset + places[1].bytes]
    assert [row and row.get("id") for _, row in read_sections(io.BytesIO(second))] == ["b", None, None]
    assert len(gzip.decompress(out.getvalue()).splitlines()) == 12


def test_the_command_tells_a_file_to_people_and_to_machines(file: Path, capsys: pytest.CaptureFixture[str]) -> None:
    code, out, err = run_vipo(capsys, "history", str(file))
    assert (code, err) == (0, "")
    assert out == TEXT + "  sent -: mixer1.mix(colour=red) - done\n"
    assert run_vipo(capsys, "history", str(file), "--id", "r1")[1] == TEXT
    code, out, _ = run_vipo(capsys, "history", str(file), "--json")
    assert [json.loads(line) for line in out.splitlines()] == [
        {"site": "hall", "kind": "run", "of": "r1", **RUN},
        {"site": "hall", "kind": "run", "of": "r1", **EVENT},
        {"site": "hall", "kind": "calls", "of": "a1", **COMMAND},
    ]
    code, out, err = run_vipo(capsys, "history", str(file), "--id", "r2")
    assert (code, out, err) == (2, "", f"{file} holds nothing with the id r2.\n")


def test_the_command_needs_no_settings_and_no_database(file: Path) -> None:
    own = {name: value for name, value in os.environ.items() if not name.startswith(("VIPO_", "DJANGO_"))}
    command = [sys.executable, "-m", "vipo_site.cli.main", "history", str(file), "--id", "r1"]
    done = subprocess.run(command, cwd=ROOT, env=own | {"VIPO_MODE": "served"}, capture_output=True, text=True)
    assert (done.returncode, done.stdout, done.stderr) == (0, TEXT, "")


HEAD = {"vipo": "history", "format": 1, "kind": "run", "site": "hall", "id": "r1", "written_at": "2026-11-23"}
END = {"row": "end", "rows": 0}


@pytest.mark.parametrize(
    ("content", "told"),
    [
        (b"", "The file is empty."),
        (b"\x1f\x8b", "The file is damaged, or a part of it is missing"),
        (b"PK\x03\x04 a zip", "It is not compressed as VIPO's archives are"),
        (gzip.compress(b"hello\n"), "A line of the file is not JSON that can be read."),
        (gzip.compress(b"[" * 100_000), "A line of the file is not JSON that can be read."),
        (gzip.compress(b"\xff\xfe\n"), "A line of the file is not JSON that can be read."),
        (packed([]), "A line of the file is not a JSON object."),
        (packed({"row": "run"}), "a section begins without saying what it is"),
        (packed(HEAD | {"format": True}, END), "a section begins without saying what it is"),
        (packed(HEAD | {"format": 2}, END), "It is of format 2, and this VIPO reads up to format 1."),
        (packed(HEAD | {"kind": "bank"}, END), "does not say of which kind and site it is"),
        (packed(HEAD | {"site": 3}, END), "does not say of which kind and site it is"),
        (packed(HEAD), "The file ends within a section"),
        (packed(HEAD, {"a": 1}), "A line of the file does not say what it is."),
        (packed(HEAD, {"row": "run"}, END), "A line of the file does not have what it should have"),
        (packed(HEAD, {"row": "other"}, END), "A section has 1 rows and says that it has 0."),
        (packed(HEAD, END) + b"rest", "It is not compressed as VIPO's archives are"),
        (packed(HEAD, END)[:-5], "The file is damaged, or a part of it is missing"),
    ],
    ids=lambda value: value if isinstance(value, str) else "",
)
def test_what_is_no_archive_is_said_in_one_sentence(
    content: bytes, told: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    path = tmp_path / "x.jsonl.gz"
    path.write_bytes(content)
    code, _, err = run_vipo(capsys, "history", str(path))
    assert (code, err.count("\n")) == (2, 1)
    assert err.startswith(f"{path}: ")
    assert told in err


def test_a_file_that_unpacks_to_too_much_is_given_up(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    path = tmp_path / "bomb.jsonl.gz"
    told = f"{path}: More comes out of the file than VIPO ever writes into one.\n"
    path.write_bytes(gzip.compress(b"0" * (history_file.MOST_LINE_BYTES + 1)))
    assert path.stat().st_size < 100_000
    assert run_vipo(capsys, "history", str(path)) == (2, "", told)
    monkeypatch.setattr(history_file, "MOST_BYTES", 10_000)
    path.write_bytes(packed(HEAD, *[{"row": "other"}] * 1000))
    assert run_vipo(capsys, "history", str(path)) == (2, "", told)


def test_what_is_no_file_is_not_opened(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    os.mkfifo(tmp_path / "pipe")
    for path in (tmp_path, tmp_path / "pipe"):
        assert run_vipo(capsys, "history", str(path)) == (2, "", f"{path} is not a file.\n")
    assert run_vipo(capsys, "history", str(tmp_path / "none")) == (2, "", f"There is no file {tmp_path / 'none'}.\n")


def test_each_former_format_has_a_step_to_the_next() -> None:
    assert sorted(UPGRADES) == list(range(1, FORMAT))
