"""A board whose power is cut: what it had begun is not done again, and what it had ended is answered as it ended."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

from tests.firmware.rig import (
    OUTPUT,
    PINS,
    UNREADABLE,
    Chip,
    Running,
    configuration,
    flash,
    levels,
    listening,
    running_bus,
    running_chip,
)

CUT = "the power was cut while it was under way; see what it left, then call it again"
NOT_KEPT = "it could not be kept over a power cut: [Errno 2] ENOENT"


@contextmanager
def powered(micropython: str, folder: Path, ear: Any, bus: Any) -> Iterator[tuple[Chip, Running]]:
    """Give the board power; it is cut at the end, with SIGKILL."""
    ear.forget()
    with running_chip(micropython, folder, {}) as chip:
        mixer = Running(ear, bus, chip.process, folder / "console")
        mixer.state(lambda _state: True)
        yield chip, mixer


def test_what_a_power_cut_broke_off_is_not_done_again(micropython: str, tmp_path: Path) -> None:
    ledger = tmp_path / "kept" / "ledger"
    with running_bus("mosquitto", tmp_path) as bus, listening(bus) as ear:
        flash(tmp_path, configuration(bus, tmp_path, pins=PINS, ledger_file=str(ledger)))
        with powered(micropython, tmp_path, ear, bus) as (chip, mixer):
            mixer.tell("mixPaint", "c0", time=1)
            assert mixer.answer("c0", "REJECTED").json["why"] == NOT_KEPT
            assert levels(chip.record, OUTPUT) == [0]
            ledger.parent.mkdir()
            mixer.tell("dispense", "c1", object="can", value=1)
            ended = mixer.answer("c1", "DONE").json
            mixer.tell("mixPaint", "c2", time=30)
            chip.wait(lambda record: levels(record, OUTPUT) == [0, 1, 0, 1])
            kept = ledger.read_bytes()
            mixer.tell("mixPaint", "c3", time=1)
            mixer.tell("pause", "p1", command="c2")
            assert mixer.answer("c3", "REJECTED").json["why"] == "busy with c2"
            mixer.answer("p1", "DONE")
            assert ledger.read_bytes() == kept, "only what is carried out is written"
        done_before = len(chip.record)
        ledger.write_bytes(b"\n".join(UNREADABLE.values())[:2000] + b"\n\n" + kept)
        with powered(micropython, tmp_path, ear, bus) as (chip, mixer):
            mixer.tell("mixPaint", "c2", time=30)
            assert mixer.answer("c2", "FAILED").json == {"id": "c2", "st": "FAILED", "why": CUT}
            mixer.tell("dispense", "c1", object="can", value=1)
            assert mixer.answer("c1", "DONE").json == ended
            assert levels(chip.record[done_before:], OUTPUT) == [0]
            mixer.tell("dispense", "c4", object="can", value=1)
            mixer.answer("c4", "DONE")
            assert mixer.answers("c1") + mixer.answers("c2") == ["DONE", "FAILED"]
            assert "memory" not in chip.console
    assert b'"c2"' in ledger.read_bytes()
