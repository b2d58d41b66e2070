"""Random edits of a plain document, as people, merges and other programs leave it: sound ones and nonsense."""

from __future__ import annotations

import random
from collections.abc import Callable, Mapping
from typing import Any, Final

Json = dict[str, Any]
STEPS: Final = tuple(f"s{number}" for number in range(14))
KINDS: Final = ("wait", "move", "while", "if", "try", "parallel", "call", "comment", "operate", "of_another_time")
VALUES: Final[tuple[Any, ...]] = (
    None,
    0,
    1,
    1.0,
    True,
    False,
    "box",
    "",
    [1, 2],
    {"param": "n"},
    {"role": "carrier"},
    {"op": "<", "args": [{"property": ["oven", "temperature"]}, 40]},
    {"device": "oven"},
)
FIELDS: Final = ("duration", "until", "condition", "role", "zone", "function", "route", "text", "branches", "args")
BRANCHES: Final = ("body", "then", "else", "catch", "a", "b")
OTHERS: Final = {"functions": "f", "roles": "carrier", "parameters": "n", "zones": "z"}


def empty() -> Json:
    """Return a document of nothing."""
    return {"format": 2, "start_pos": None, "steps": {}, **{root: {} for root in OTHERS}}


def edited(document: Mapping[str, Any], seed: int, count: int) -> Json:
    """Return the document after so many edits; each is chosen by the seed alone."""
    chance, now = random.Random(seed), dict(document)
    for _ in range(count):
        now = chance.choice(_EDITS)(now, chance)
    return now


def _with(document: Json, root: str, key: str, value: object) -> Json:
    return {**document, root: {**document[root], key: value}}


def _add(document: Json, chance: random.Random) -> Json:
    step = {"kind": chance.choice(KINDS), "place": _place(chance), "pos": [1, -1], "params": _params(chance)}
    return _with(document, "steps", chance.choice(STEPS), step)


def _place(chance: random.Random) -> list[str] | None:
    parent = chance.choice(["program", "program", "program", *STEPS, "f0", "f1"])
    return None if chance.random() < 0.1 else [parent, chance.choice(BRANCHES), chance.choice("ABCDEF") + "V"]


def _params(chance: random.Random) -> Json:
    drawn = {chance.choice(FIELDS): chance.choice(VALUES) for _ in range(chance.randrange(4))}
    if chance.random() < 0.3:
        drawn["args"] = {chance.choice("xy"): chance.choice(VALUES)}
    return drawn


def _remove(document: Json, chance: random.Random) -> Json:
    root = chance.choice(["steps", "steps", *OTHERS])
    gone = chance.choice([*document[root]] or [""])
    return {**document, root: {key: value for key, value in document[root].items() if key != gone}}


def _of_step(change: Callable[[Json, random.Random], Json]) -> Callable[[Json, random.Random], Json]:
    def edit(document: Json, chance: random.Random) -> Json:
        known = [key for key, step in document["steps"].items() if isinstance(step, dict) and "params" in step]
        if not known:
            return document
        key = chance.choice(known)
        return _with(document, "steps", key, change(document["steps"][key], chance))

    return edit


def _set_value(step: Json, chance: random.Random) -> Json:
    return {**step, "params": {**step["params"], chance.choice(FIELDS): chance.choice(VALUES)}}


def _drop_value(step: Json, chance: random.Random) -> Json:
    gone = chance.choice([*step["params"]] or [""])
    return {**step, "params": {key: value for key, value in step["params"].items() if key != gone}}


def _set_argument(step: Json, chance: random.Random) -> Json:
    args = step["params"].get("args")
    known = args if isinstance(args, dict) else {}
    return {**step, "params": {**step["params"], "args": {**known, chance.choice("xyz"): chance.choice(VALUES)}}}


def _move(step: Json, chance: random.Random) -> Json:
    return {**step, "place": _place(chance)}


def _shift(step: Json, chance: random.Random) -> Json:
    return {**step, "pos": [chance.randrange(20), -chance.randrange(12)]}


def _define(document: Json, chance: random.Random) -> Json:
    root = chance.choice([*OTHERS])
    return _with(document, root, OTHERS[root] + chance.choice("01"), {"name": chance.choice("abc")})


def _write_nonsense(document: Json, chance: random.Random) -> Json:
    return _with(document, chance.choice(["steps", *OTHERS]), chance.choice(STEPS), chance.choice(VALUES))


def _set_start(document: Json, chance: random.Random) -> Json:
    return {**document, "start_pos": chance.choice([None, [1, 2], [1.0, 2], "here"])}


_EDITS: Final = (
    _add,
    _add,
    _add,
    _remove,
    _of_step(_set_value),
    _of_step(_drop_value),
    _of_step(_set_argument),
    _of_step(_move),
    _of_step(_shift),
    _define,
    _write_nonsense,
    _set_start,
)
