"""Programs for tests at the painting factory: as documents, as plans for the machine, and the runs of them."""

from __future__ import annotations

import json
from typing import Any

from editor.language.expressions.nodes import Constant, PlaceRef
from editor.language.plan.instructions import (
    Call,
    Drop,
    End,
    Instruction,
    LimitBegin,
    Move,
    Pick,
    Plan,
    RoleBinding,
    TryEnd,
)
from execution.machine import machine
from execution.machine import messages as r
from execution.models import Run
from registry.models import Device
from vipo_device.descriptions.reader import hash_of_json

BODY = ("program", "body")


def document(steps: dict[str, Any], **more: Any) -> dict[str, Any]:
    """Return a document of these steps, with nothing besides unless it is named."""
    empty: dict[str, Any] = {"functions": {}, "roles": {}, "parameters": {}, "zones": {}}
    return {"format": 1, "start_pos": [4.6, -0.95], "steps": steps, **empty, **more}


def step(kind: str, parent: tuple[str, str] = BODY, order: str = "1V", **params: Any) -> dict[str, Any]:
    """Return a step below a parent's branch, at a place of the order there."""
    return {"kind": kind, "place": [*parent, order], "pos": [2.2, -5.1], "params": params}


def operate(device: str, method: str, parent: tuple[str, str] = BODY, **args: Any) -> dict[str, Any]:
    """Return a step that tells a device to do something."""
    return step("operate", parent, device={"device": device}, method=method, args=args)


def carry_document() -> dict[str, Any]:
    """Return a program in which any robot carries a box from the shelf to the paint booth."""
    shelf, booth = {"device": "itemInventory01"}, {"device": "paintMachine01"}
    return document(
        {"carry": step("pick_and_drop", role="robot", object="box", quantity=1, source=shelf, target=booth)}
    )


def plan_of(*instructions: Any, events: tuple[Any, ...] = (), **parameters: Any) -> Plan:
    """Return the plan of these instructions; an operation alone stands for its instruction."""
    whole = tuple(i if isinstance(i, Instruction) else Instruction(i) for i in instructions)
    return Plan(whole, {}, parameters, events=events)


def names(actions: Any) -> list[tuple[Any, ...]]:
    """Return each action's name with the step, mission, timer and status that it is about."""
    facts = ("step", "task", "timer", "status")
    return [(type(a).__name__, *(getattr(a, fact) for fact in facts if hasattr(a, fact))) for a in actions]


def reload(state: Any) -> Any:
    """Return the state as it comes back from the database."""
    return machine.from_json(json.loads(json.dumps(machine.to_json(state))))


SITE, OVEN = "painting-factory", "curingOven01"
SHELF, BOOTH = PlaceRef(device="itemInventory01"), PlaceRef(device="paintMachine01")
BOX, ONE = Constant("box"), Constant(1)
ANY = {"robot": RoleBinding("robot", None, ("move", "pick", "drop"))}
CARRY = Plan(
    (
        Instruction(Move("robot", SHELF), "s1", 1),
        Instruction(Call(SHELF, "dispense", {"object": BOX, "value": ONE}, "robot"), "s1", 2),
        Instruction(Pick("robot", SHELF, BOX, ONE), "s1", 2),
        Instruction(Move("robot", BOOTH), "s1", 3),
        Instruction(Drop("robot", BOOTH, BOX, ONE), "s1", 4),
        Instruction(End()),
    ),
    ANY,
)
TASK: dict[str, Any] = {
    "format": 1,
    "start_pos": [0, 0],
    "steps": {
        "s1": {
            "kind": "pick_and_drop",
            "place": ["program", "body", "V"],
            "pos": [3, -6],
            "params": {
                "source": {"device": "itemInventory01"},
                "target": {"device": "paintMachine01"},
                "object": "box",
                "quantity": 1,
            },
        }
    },
    "functions": {},
    "roles": {},
    "parameters": {},
    "zones": {},
}


def run_status(run: str) -> str:
    """Return the status of a run as it is kept."""
    return Run.objects.get(id=run).status


def heat_oven(value: float) -> None:
    """Let the oven have this temperature, in °C."""
    Device.objects.filter(id=OVEN).update(properties={"temperature": value})


def paths_in(value: Any, path: tuple[Any, ...] = ()) -> list[tuple[Any, ...]]:
    """Return the path of the value itself, which is empty, and of every value inside it."""
    inner = value.items() if isinstance(value, dict) else enumerate(value) if isinstance(value, list) else ()
    return [path, *(found for key, each in inner for found in paths_in(each, (*path, key)))]


def limit(step: str = "l", seconds: float = 60) -> Instruction:
    """Return the beginning of a time limit."""
    return Instruction(LimitBegin(Constant(seconds)), step, enters=(step,))


def over(step: str = "l") -> Instruction:
    """Return the end of one."""
    return Instruction(TryEnd(), step, leaves=(step,))


def told(actions: Any) -> list[tuple[Any, ...]]:
    """Return the names of actions, with the texts that people are told."""
    return [
        ("Tell", a.text) if isinstance(a, r.Tell) else name for a, name in zip(actions, names(actions), strict=True)
    ]


def carry(plan: Plan, *events: Any) -> tuple[Any, list[list[tuple[Any, ...]]]]:
    """Carry a plan out, stored and read between all events; return the last state, and the actions of each event."""
    state, actions = machine.start(plan, {})
    done = [actions]
    for event in events:
        state, actions = machine.step(plan, reload(state), event)
        done.append(actions)
    return state, [told(each) for each in done]


def describe_anew(device: str, said: dict[str, Any]) -> None:
    """Let a device be what this description says, as if it had told so itself."""
    Device.objects.filter(pk=device).update(description=said, description_hash=hash_of_json(said))
