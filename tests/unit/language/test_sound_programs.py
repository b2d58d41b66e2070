from __future__ import annotations

import json
import random
from dataclasses import replace
from typing import Any

from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from editor.language import compile_document, parse_script, plan_from_json, plan_to_json, tree_to_document
from editor.language.plan.instructions import Plan
from execution.machine import machine
from execution.machine import messages as m
from tests.kit.demo_site import factory
from tests.unit.language.sound_programs import sound_documents

quick = settings(max_examples=25, deadline=None, suppress_health_check=list(HealthCheck))
MOST_EVENTS = 150


def without_ids(plan: Plan | None) -> Plan | None:
    """Return a plan without the ids of its steps, which a drawing gives anew."""
    if plan is None:
        return None
    bare = tuple(
        replace(i, step="", enters=("",) * len(i.enters), leaves=("",) * len(i.leaves)) for i in plan.instructions
    )
    return replace(plan, instructions=bare, events=tuple(replace(event, step="") for event in plan.events))


@quick
@given(sound_documents())
def test_a_script_drawn_again_has_the_same_plan(document: dict[str, Any]) -> None:
    compiled = compile_document(document, factory())
    parsed = parse_script(compiled.script, factory())
    assert parsed.tree == compiled.tree, compiled.script
    again = compile_document(tree_to_document(parsed.tree, factory()), factory())
    assert again.script == compiled.script
    assert without_ids(again.plan) == without_ids(compiled.plan)
    if compiled.plan is not None:
        assert plan_from_json(json.loads(json.dumps(plan_to_json(compiled.plan)))) == compiled.plan


@quick
@given(sound_documents(), st.integers(0, 1_000_000))
def test_every_plan_can_be_carried_out_whatever_happens(document: dict[str, Any], seed: int) -> None:
    plan = compile_document(document, factory()).plan
    if plan is None:
        return
    chance = random.Random(seed)
    for entry in (0, *(event.entry for event in plan.events if event.starts == "run")):
        state, actions = machine.start(plan, {}, {("curingOven01", "temperature"): chance.choice([20, 80])}, entry)
        waits: list[m.Action] = []
        for _ in range(MOST_EVENTS):
            waits += [a for a in actions if isinstance(a, m.Ask | m.SetTimer | m.AskPeople)]
            if state.status != "running":
                break
            state, actions = machine.step(plan, state, _something(waits, chance))
        assert state.status in {"running", "finished", "failed"}


def _something(waits: list[m.Action], chance: random.Random) -> m.Event:
    """Return what may happen next: something that is waited for, or another reading."""
    wait = waits.pop(chance.randrange(len(waits))) if waits and chance.random() < 0.8 else None
    match wait:
        case m.SetTimer(timer=timer):
            return m.TimerFired(timer)
        case m.AskPeople(question=question):
            return m.Answered(question, 3)
        case m.Ask(task=task) if chance.random() < 0.3:
            return m.TaskFailed(task, chance.choice(["failed", "blocked"]), "It did not work.")
        case m.Ask(task=task):
            return m.TaskDone(task)
    return m.Facts({("curingOven01", "temperature"): chance.choice([20, 80])})
