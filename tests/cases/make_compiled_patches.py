"""Write tests/cases/compiled_patches.json: a form before, what a browser is told, and what it must show after.

The forms are the compiler's, of one program that is edited: `python -m tests.cases.make_compiled_patches`.
"""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

from editor.documents.shared_document import empty_document
from editor.language.compiler import compile_document, compiled_to_json
from editor.programs.compiled_patch import make_patch
from tests.kit.demo_site import factory

FILE = Path(__file__).parent / "compiled_patches.json"
Json = dict[str, Any]


def step(kind: str, place: list[str] | None, **params: object) -> Json:
    return {"kind": kind, "place": place, "pos": [0, 0], "params": params}


FIRST: Json = {
    "a": step("wait", ["program", "body", "a"], duration=5),
    "b": step("repeat", ["program", "body", "b"], times=3),
    "c": step("wait", ["b", "body", "c"], duration=6),
    "d": step("wait", ["b", "body", "d"], duration=7),
    "e": step("wait", ["program", "body", "e"], duration=8),
}
WALKS: dict[str, Json] = {
    "a value": {**FIRST, "d": step("wait", ["b", "body", "d"], duration=9)},
    "a step before all others": {**FIRST, "n": step("wait", ["program", "body", "0"], duration=1)},
    "a step in a loop": {**FIRST, "n": step("wait", ["b", "body", "cz"], duration=1)},
    "a step that becomes a draft": {**FIRST, "d": step("wait", None, duration=7)},
    "a step elsewhere": {**FIRST, "a": step("wait", ["program", "body", "z"], duration=5)},
    "the first fault": {**FIRST, "e": step("wait", ["program", "body", "e"])},
    "nothing left": {},
}


def make_cases() -> list[Json]:
    """Return a case for the way to each program, and one for the way back."""
    first = _form(FIRST, 1)
    cases: list[Json] = []
    for revision, (name, steps) in enumerate(WALKS.items(), start=2):
        other = _form(steps, revision)
        back = {**first, "revision": revision + 100}
        cases.append({"name": name, "before": first, "patch": make_patch(first, other), "after": other})
        cases.append({"name": f"{name}, undone", "before": other, "patch": make_patch(other, back), "after": back})
    plain: list[Json] = json.loads(json.dumps(cases))
    return plain


def _form(steps: Json, revision: int) -> Json:
    return compiled_to_json(compile_document({**empty_document(), "steps": steps}, factory()), revision)


if __name__ == "__main__":
    FILE.write_text(json.dumps(make_cases(), indent=1, ensure_ascii=False) + "\n")
