"""Documents into which somebody wrote what has no business there: sound ones, changed in any root and at any depth."""

from __future__ import annotations

import copy
import json
import random
from collections.abc import Iterator
from pathlib import Path
from typing import Any

ROOT = Path(__file__).resolve().parents[2]
_FILES = (*sorted((ROOT / "examples").glob("*.json")), *sorted((ROOT / "tests" / "cases").glob("c*/*.json")))
ROOTS = ("steps", "functions", "roles", "parameters", "zones", "meta")
KEYS = (
    "k",
    "name",
    "kind",
    "params",
    "place",
    "pos",
    "variable",
    "args",
    "branches",
    "robot",
    "__proto__",
    "0",
    "x" * 300,
)


def _nested(value: Any, times: int, *, is_list: bool) -> Any:
    for _ in range(times):
        value = [value] if is_list else {"op": "+", "args": [value, 1]}
    return value


ODD: tuple[Any, ...] = (
    *("zzz", "", "left", "program", "robot", "é\u202e", "\0", "__proto__", True, False, None),
    *(7, -1, 1.5, 1e300, -1e300, 10**18, 2**53, 0.1, -0.0),
    *([], {}, [[]], [None], [{}], [1, 2, 3], ["a"], {"r": []}, {"": {}}, {"a\0b": 1}, ["x"] * 30),
    *([[1, 2], [3]], [[1e15, 0], [1, 1]], [1e15, 0], [True, False], ["program", "body"], ["program", "body", "a", 1]),
    *(
        [[], [], []],
        [{"name": []}],
        [{"name": {}, "type": 3}],
        [{"name": "n"}, 7],
        {"type": []},
        {"type": {}, "unit": []},
    ),
    *({"library": []}, {"library": "x", "version": []}, {"kind": []}, {"kind": "wait", "params": []}, {"points": "x"}),
    *(
        {"device": []},
        {"device": {}},
        {"role": {}},
        {"place": []},
        {"param": []},
        {"at": []},
        {"zone": []},
        {"list": []},
    ),
    *({"op": "+", "args": "x"}, {"op": [], "args": []}, {"op": {}, "args": [1]}, {"op": "+", "args": [[], {}]}),
    *({"quantity": "x"}, {"quantity": [1, []]}, {"quantity": [[], "MIN"]}, {"quantity": [1]}, {"point": [1]}),
    *({"point": ["a", "b"]}, {"point": [1e15, 0]}, {"property": []}, {"property": [[], {}]}, {"property": ["d", {}]}),
    *(_nested([], 50, is_list=True), _nested(1, 50, is_list=False)),
)


def sound_documents() -> list[dict[str, Any]]:
    """Return the documents of all examples and cases of the language."""
    found = (json.loads(path.read_text(encoding="utf-8")) for path in _FILES)
    documents = (content.get("document", content) for content in found)
    return [document for document in documents if isinstance(document.get("steps"), dict)]


def make_odd(document: dict[str, Any], chance: random.Random) -> dict[str, Any]:
    """Return the document with one to four odd values somewhere in it."""
    changed = copy.deepcopy(document)
    for _ in range(chance.choice((1, 1, 1, 2, 4))):
        odd = copy.deepcopy(chance.choice(ODD))
        holder = chance.choice(list(_holders(changed)))
        if chance.random() < 0.2:
            holder = changed.setdefault(chance.choice(ROOTS), {})
        if isinstance(holder, list) and holder:
            holder[chance.randrange(len(holder))] = odd
        elif isinstance(holder, dict):
            holder[chance.choice((*holder, *holder, *KEYS))] = odd
    return changed


def _holders(value: Any) -> Iterator[Any]:
    """Yield each object and list in a value."""
    if isinstance(value, dict | list):
        yield value
        for inner in value.values() if isinstance(value, dict) else value:
            yield from _holders(inner)
