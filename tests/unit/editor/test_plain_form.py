"""The plain form of a shared document that is edited: what changed is read anew, and only that."""

from __future__ import annotations

import random
from typing import Any

import pytest
from pycrdt import Array, Doc, Map, Text

from editor.documents.shared_document import BadUpdate, SharedDocument, empty_document, encode_document

VALUES: tuple[Any, ...] = (1, 1.5, True, "box", None, [1, {"param": "n"}], {"op": "<", "args": [1, 2]})
IDS = tuple(f"s{index}" for index in range(6))


def _change(document: Doc[Any], chance: random.Random) -> None:
    steps, name = document.get("steps", type=Map), chance.choice(IDS)
    step = steps.get(name)
    match chance.randrange(6):
        case 0 if step is not None:
            del steps[name]
        case 1 if isinstance(step, Map):
            step["place"] = ["program", "body", chance.choice("abc")]
        case 2 if isinstance(step, Map) and isinstance(step["params"], Map):
            step["params"][chance.choice("xyz")] = chance.choice(VALUES)
        case 3:
            steps[name] = chance.choice([Text("no step"), Array([1, Map({"a": 2})]), 7, {"kind": "wait"}])
        case 4:
            document.get("zones", type=Map)[name] = {"name": name}
        case _:
            steps[name] = Map({"kind": "wait", "place": None, "params": Map({"duration": chance.choice(VALUES)})})


@pytest.mark.parametrize("seed", range(20))
def test_after_every_change_it_is_that_of_the_whole_document(seed: int) -> None:
    chance, shared, theirs = random.Random(seed), SharedDocument(), Doc[Any]()
    for name in ("meta", "steps", "zones"):
        theirs.get(name, type=Map)
    for _ in range(40):
        with theirs.transaction():
            for _ in range(chance.randint(1, 3)):
                _change(theirs, chance)
        shared.apply(theirs.get_update(shared.state()))
        assert shared.to_json() == SharedDocument([shared.encode()]).to_json()


def test_a_step_that_has_not_changed_is_the_same_object() -> None:
    wait = {"kind": "wait", "place": None, "pos": None, "params": {"duration": 5}}
    shared = SharedDocument([encode_document({**empty_document(), "steps": {"a": wait, "b": wait}})])
    before, theirs = shared.to_json()["steps"], Doc[Any]()
    theirs.apply_update(shared.encode())
    theirs.get("steps", type=Map)["b"]["params"]["duration"] = 6
    shared.apply(theirs.get_update(shared.state()))
    after = shared.to_json()["steps"]
    assert after["a"] is before["a"]
    assert (before["b"]["params"], after["b"]["params"]) == ({"duration": 5}, {"duration": 6})


def test_an_update_that_is_none_leaves_it_as_it_was() -> None:
    shared = SharedDocument([encode_document({**empty_document(), "steps": {"a": {"kind": "end", "place": None}}})])
    before = shared.to_json()
    with pytest.raises(BadUpdate):
        shared.apply(b"\xff\xff\xff")
    assert shared.to_json() == before
