"""A run's history as it was kept, carried out once more: the same inputs give the same states and decisions; pure."""

from __future__ import annotations

import json
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

from editor.language.plan.instructions import Plan
from execution.floor_protocol import run_message_from_json, to_machine
from execution.machine import machine
from execution.machine import messages as r
from execution.machine.state import RunState
from vipo_device.protocol.description import Scalar


@dataclass(frozen=True, slots=True)
class History:
    """What a run was begun with, and what each of its turns took in, oldest first."""

    plan: Plan
    parameters: Mapping[str, Scalar]
    entry: int
    turns: Sequence[Sequence[Mapping[str, Any]]]


@dataclass(frozen=True, slots=True)
class Decision:
    """What the machine made of one input: what is to be done, and the state after it as JSON text."""

    actions: tuple[r.Action, ...]
    state: str


def replay(history: History) -> tuple[Decision, ...]:
    """Return the decisions of a run, one for each input; raises ValueError for a history without its beginning."""
    return tuple(_decide(history, (taken for turn in history.turns for taken in turn)))


def _decide(history: History, inputs: Iterable[Mapping[str, Any]]) -> Iterator[Decision]:
    state: RunState | None = None
    for taken in inputs:
        if "start" in taken:
            facts = _facts(taken["start"])
            state, actions = machine.start(history.plan, history.parameters, facts, history.entry)
        elif state is None:
            raise ValueError("The history does not have how the run began.")
        else:
            state, actions = machine.step(history.plan, state, _event(taken))
        yield Decision(actions, json.dumps(machine.to_json(state)))


def _event(taken: Mapping[str, Any]) -> r.Event:
    if "facts" in taken:
        return r.Facts(_facts(taken["facts"]))
    event = to_machine(run_message_from_json(taken["told"]))
    if event is None:
        raise ValueError(f"The machine is not told of {taken['told']!r}.")
    return event


def _facts(listed: Iterable[Sequence[Any]]) -> dict[tuple[str, str], Scalar]:
    return {(thing, name): value for thing, name, value in listed}
