"""How long a program takes from its document to a checked plan and a printed script."""

from __future__ import annotations

import json
from collections.abc import Iterator
from pathlib import Path
from typing import Any

from bench.figures import best_ms, figure
from editor.language import Surroundings, compile_document, parse_script, surroundings_from_json
from editor.language.numbering import number_steps
from editor.language.positions import add_moves
from editor.language.printing import print_tree
from editor.language.reading import read_document

SITE = Path(__file__).resolve().parent.parent / "examples" / "painting-factory.json"
LETTERS = "0123456789ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz"
ERRAND = {"source": {"device": "itemInventory01"}, "target": {"device": "dropOff01"}, "object": "box", "quantity": 1}
HOT = {"op": ">", "args": [{"property": ["curingOven01", "temperature"]}, 40]}
KINDS: tuple[tuple[str, dict[str, Any], str], ...] = (
    ("if", {"condition": HOT}, "then"),
    ("pick_and_drop", ERRAND, ""),
    ("operate", {"device": {"device": "curingOven01"}, "method": "curePaint", "args": {"time": 10}}, ""),
    ("wait", {"duration": 5}, ""),
    ("while", {"condition": HOT}, "body"),
    ("wait", {"until": HOT, "timeout_s": 60}, ""),
    ("pick_and_drop", ERRAND, ""),
    ("try", {"kinds": []}, "body"),
    ("move", {"to": {"device": "paintMachine01"}}, ""),
    ("operate", {"device": {"device": "paintMixer01"}, "method": "mixPaint", "args": {"time": 3}}, ""),
)
"""Ten steps of a program: each block holds the steps behind it up to the next block."""


def make_program(count: int) -> dict[str, Any]:
    """Return a sound document of that many steps: errands, machines, conditions, loops and a Try, over and over."""
    steps: dict[str, Any] = {}
    parent, branch = "program", "body"
    for index in range(count):
        kind, params, inner = KINDS[index % len(KINDS)]
        if inner:
            parent, branch = "program", "body"
        steps[f"s{index}"] = {
            "kind": kind,
            "place": [parent, branch, _order(index)],
            "pos": [2 + index % 20, -2 - index % 7],
            "params": {**params},
        }
        if inner:
            parent, branch = f"s{index}", inner
    return {
        "format": 1,
        "start_pos": [0, 0],
        "steps": steps,
        "functions": {},
        "roles": {},
        "parameters": {},
        "zones": {},
    }


def _order(index: int) -> str:
    return "".join(LETTERS[index // 62**power % 62] for power in (2, 1, 0)) + "V"


def measure() -> Iterator[dict[str, object]]:
    site = surroundings_from_json(json.loads(SITE.read_text()))
    yield from measure_thousand(site)
    for count in (10, 100, 500, 1000, 2000, 5000):
        tree = add_moves(read_document(make_program(count)).tree, {})
        numbers = number_steps(tree).numbers
        took = best_ms(lambda tree=tree, numbers=numbers: print_tree(tree, site, numbers))
        yield figure("print a script", took, "ms", steps=count, us_per_step=round(took * 1000 / count, 2))


def measure_thousand(site: Surroundings) -> Iterator[dict[str, object]]:
    document = make_program(1000)
    compiled = compile_document(document, site)
    errors = [d.message for d in compiled.diagnostics if d.severity == "error"]
    assert compiled.plan is not None, errors[:3]
    yield figure("check, print and compile", best_ms(lambda: compile_document(document, site)), "ms", steps=1000)
    yield figure("the same after an edit of one step", best_ms(lambda: compile_document(_edited(document), site)), "ms",
                 steps=1000)  # fmt: skip
    yield figure("read the script back", best_ms(lambda: parse_script(compiled.script, site), 2), "ms", steps=1000)
    yield figure("script", compiled.script.count("\n"), "lines", steps=1000)


def _edited(document: dict[str, Any]) -> dict[str, Any]:
    step = {**document["steps"]["s503"], "params": {"duration": 7}}
    return {**document, "steps": {**document["steps"], "s503": step}}
