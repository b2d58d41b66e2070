"""Runs that were really carried out are decided today as they were then, and who changes a decision is told."""

from __future__ import annotations

import gzip
import io
import json
from pathlib import Path
from typing import Any

import pytest

from execution.archive.history_file import Header, Row, UnreadableHistory, read_sections, write_section
from execution.engine.replayed import ReplayedRun, replay_runs
from tests.cases.histories import FOLDER, decisions_of
from tests.kit.command_line import run_vipo

FILES = sorted(FOLDER.glob("*.jsonl.gz"))
KEPT: dict[str, list[str]] = json.loads((FOLDER / "decisions.json").read_text())


def rows_of(file: Path) -> tuple[Header, list[Row]]:
    with file.open("rb") as archive:
        found = list(read_sections(archive))
    return found[0][0], [row for _, row in found if row is not None]


def replayed(header: Header, rows: list[Row]) -> ReplayedRun:
    out = io.BytesIO()
    write_section(out, header, rows)
    (run,) = replay_runs(io.BytesIO(out.getvalue()))
    return run


def changed(rows: list[Row], name: str, **more: Any) -> list[Row]:
    return [row | more if row["row"] == name else row for row in rows]


@pytest.mark.parametrize("file", FILES, ids=lambda file: file.name.partition(".")[0])
def test_a_kept_run_is_decided_as_it_was_and_ends_as_it_ended(file: Path) -> None:
    assert decisions_of(file) == KEPT[file.name]
    assert replayed(*rows_of(file)).is_same


def test_each_history_has_its_decisions_and_they_are_of_several_ends() -> None:
    assert sorted(KEPT) == [file.name for file in FILES]
    assert {name.partition(".")[0].rpartition("-")[2] for name in KEPT} >= {"finished", "cancelled"}
    assert sum(map(len, KEPT.values())) > 80


def test_an_input_that_is_left_out_is_another_end(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    header, rows = rows_of(FILES[0])
    last = max(row["seq"] for row in rows if row["row"] == "input")
    shorter = [row for row in rows if row["row"] != "input" or row["seq"] != last]
    run = replayed(header, shorter)
    assert (run.is_known, run.is_same) == (True, False)
    path = tmp_path / "shorter.jsonl.gz"
    with path.open("wb") as out:
        write_section(out, header, shorter)
    code, told, _ = run_vipo(capsys, "history", str(path), "--replay")
    assert (code, told.count("ends in another state than the one that was kept")) == (1, 1)
    code, told, _ = run_vipo(capsys, "history", str(FILES[0]), "--replay")
    assert (code, told.count("ends as it was kept")) == (0, 1)


def test_a_run_from_before_inputs_were_kept_is_not_said_to_differ() -> None:
    header, rows = rows_of(FILES[0])
    run = replayed(header, [row for row in rows if row["row"] != "input"])
    assert (run.is_known, run.decisions) == (False, ())


@pytest.mark.parametrize(
    "broken", [{"plan": {}}, {"plan": 7}, {"entry": "x"}, {"state": {"pc": []}}, {"parameters": None}]
)
def test_a_run_that_cannot_be_carried_out_is_said(broken: dict[str, Any]) -> None:
    header, rows = rows_of(FILES[0])
    with pytest.raises(UnreadableHistory, match=f"The run {header.id} cannot be carried out again"):
        replayed(header, changed(rows, "run", **broken))


def test_rows_without_a_run_are_no_run() -> None:
    header, rows = rows_of(FILES[0])
    out = io.BytesIO()
    write_section(out, header, [row for row in rows if row["row"] != "run"])
    assert list(replay_runs(io.BytesIO(out.getvalue()))) == []
    assert gzip.decompress(out.getvalue()).count(b"\n") > 2
