"""Programs of any length for the measurements: sound, and no two steps quite the same."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

Json = dict[str, Any]
LETTERS = "0123456789ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz"
OVEN, MIXER = {"device": "curingOven01"}, {"device": "paintMixer01"}


def _hot(index: int) -> Json:
    return {"op": ">", "args": [{"property": ["curingOven01", "temperature"]}, 30 + index % 97 / 2]}


def _task(index: int) -> Json:
    source, target = {"device": "itemInventory01"}, {"device": "dropOff01"}
    route = [[3 + index % 41 / 4, -3 - index % 19 / 4]]
    return {"source": source, "target": target, "object": "box", "quantity": 1, "route": route}


def _point(index: int) -> Json:
    return {"to": {"point": [2 + index % 31 / 4, -2 - index % 23 / 4]}}


def _minutes(index: int) -> Json:
    return {"time": 1 + index % 9}


KINDS: tuple[tuple[str, Callable[[int], Json], str], ...] = (
    ("if", lambda index: {"condition": _hot(index)}, "then"),
    ("pick_and_drop", _task, ""),
    ("operate", lambda index: {"device": OVEN, "method": "curePaint", "args": _minutes(index)}, ""),
    ("wait", lambda index: {"duration": 5 + index}, ""),
    ("while", lambda index: {"condition": _hot(index)}, "body"),
    ("wait", lambda index: {"until": _hot(index), "timeout": 60 + index}, ""),
    ("pick_and_drop", _task, ""),
    ("try", lambda index: {"kinds": []}, "body"),
    ("move", _point, ""),
    ("operate", lambda index: {"device": MIXER, "method": "mixPaint", "args": _minutes(index)}, ""),
)
"""Ten steps of a program: each block holds the steps behind it up to the next block."""


def make_program(count: int) -> Json:
    """Return a sound document of that many steps: tasks, machines, conditions, loops and a Try, over and over."""
    steps: Json = {}
    parent, branch = "program", "body"
    for index in range(count):
        kind, params, inner = KINDS[index % len(KINDS)]
        if inner:
            parent, branch = "program", "body"
        place, pos = [parent, branch, _order(index)], [2 + index % 20, -2 - index % 7]
        steps[f"s{index}"] = {"kind": kind, "place": place, "pos": pos, "params": params(index)}
        if inner:
            parent, branch = f"s{index}", inner
    around: Json = {"functions": {}, "roles": {}, "parameters": {}, "zones": {}}
    return {"format": 2, "start_pos": [0, 0], "steps": steps, **around}


def _order(index: int) -> str:
    return "".join(LETTERS[index // 62**power % 62] for power in (2, 1, 0)) + "V"


def with_step(document: Json, name: str, step: Json | None) -> Json:
    """Return the document with one step set or taken away."""
    others = {key: value for key, value in document["steps"].items() if key != name}
    return {**document, "steps": others if step is None else {**others, name: step}}


def make_chosen_machine(count: int) -> Json:
    """Return a program of so many steps at one machine that people choose: what it is told has a unit each time."""
    steps: Json = {}
    for index in range(count):
        args = {"time": {"quantity": [1 + index % 9, "min"]}}
        params = {"device": {"param": "machine"}, "method": "curePaint", "args": args}
        steps[f"o{index}"] = {"kind": "operate", "place": ["program", "body", _order(index)], "params": params}
    machine = {"name": "machine", "type": "device", "default": "curingOven01"}
    return {"format": 2, "start_pos": [0, 0], "steps": steps, "parameters": {"machine": machine}}


def make_functions(count: int, *, chain: bool) -> Json:
    """Return a program of so many functions, each of one step; in a chain each is called by the one before it."""
    functions: Json = {}
    steps: Json = {}
    for number in range(count):
        functions[f"f{number}"] = {"name": f"part {number}", "parameters": []}
        steps[f"w{number}"] = {"kind": "wait", "place": [f"f{number}", "body", "V"], "params": {"duration": 1}}
        caller = f"f{number - 1}" if chain and number else "program"
        order = "W" if chain and number else f"{number:06d}V"
        steps[f"c{number}"] = {"kind": "call", "place": [caller, "body", order], "params": {"function": f"f{number}"}}
    return {"format": 2, "start_pos": [0, 0], "steps": steps, "functions": functions}
