"""The runs of an archive, carried out once more by today's machine from what they took in; without a database."""

from __future__ import annotations

import json
from collections.abc import Iterator
from dataclasses import dataclass, field
from typing import Any, BinaryIO

from editor.language.plan.json_form import plan_from_json
from execution.archive.history_file import Header, Row, UnreadableHistory, read_sections
from execution.engine.history import Decision, History, replay
from execution.machine import machine


@dataclass(frozen=True, slots=True)
class ReplayedRun:
    """A run as it was kept, and what the machine of today makes of its inputs; `kept` is its last state as JSON text.

    A run from before inputs were kept has no decisions, though it has a state.
    """

    header: Header
    row: Row
    decisions: tuple[Decision, ...]
    kept: str

    @property
    def is_known(self) -> bool:
        """Whether its inputs were kept."""
        return bool(self.decisions) or not self.kept

    @property
    def is_same(self) -> bool:
        """Whether it ends in the state that was kept, byte for byte."""
        return (self.decisions[-1].state if self.decisions else "") == self.kept


@dataclass(slots=True)
class _Section:
    run: Row | None = None
    turns: list[tuple[int, Any]] = field(default_factory=list)


def replay_runs(file: BinaryIO) -> Iterator[ReplayedRun]:
    """Yield the runs of an archive, each when all of it has been read.

    Raises:
        UnreadableHistory: the file is not whole, or a run of it is not one.
    """
    section = _Section()
    for header, row in read_sections(file):
        if row is None:
            if section.run is not None:
                yield _replayed(header, section.run, section.turns)
            section = _Section()
        elif row["row"] == "run":
            section.run = row
        elif row["row"] == "input":
            section.turns.append((row["seq"], row["taken"]))


def _replayed(header: Header, run: Row, turns: list[tuple[int, Any]]) -> ReplayedRun:
    try:
        inputs = [taken for _, taken in sorted(turns, key=lambda turn: turn[0])]
        history = History(plan_from_json(run["plan"]), run["parameters"], run["entry"], inputs)
        kept = "" if run["state"] is None else json.dumps(machine.to_json(machine.from_json(run["state"])))
        return ReplayedRun(header, run, replay(history), kept)
    except (KeyError, TypeError, ValueError, AttributeError) as error:
        raise UnreadableHistory(f"The run {header.id} cannot be carried out again: {error!r}.") from error
