"""How a case of tests/cases/outline is put down: steps and their places, and what every reader must make of them."""

from __future__ import annotations

import json
from collections.abc import Mapping, Sequence
from typing import Any

Children = Mapping[tuple[str, str], Sequence[str]]
BODY = ("program", "body")
EVENTS = ("program", "events")


def step(kind: str, *place: object, **params: object) -> dict[str, Any]:
    """Return a step of a document; without a place it is a draft."""
    return {"kind": kind, "place": list(place) or None, "pos": [1, -1], "params": params}


def wait(*place: object) -> dict[str, Any]:
    """Return a step that has no branches."""
    return step("wait", *place)


def loop(*place: object) -> dict[str, Any]:
    """Return a step with one branch."""
    return step("while", *place)


def case(
    what: str,
    steps: Mapping[str, Any],
    children: Children,
    drafts: Sequence[str] = (),
    unknown: Sequence[str] = (),
    functions: Sequence[str] = (),
) -> dict[str, Any]:
    """Return a case: what it shows, the document, and what is to be read from it."""
    definitions = {name: {"name": name, "parameters": []} for name in functions}
    document = {"format": 2, "start_pos": None, "steps": dict(steps), "functions": definitions}
    document |= {"roles": {}, "parameters": {}, "zones": {}}
    branches = sorted([parent, branch, list(ids)] for (parent, branch), ids in children.items() if ids)
    expected = {"children": branches, "drafts": list(drafts), "unknown": list(unknown)}
    return {"what": what, "document": document, "expected": expected}


def text_of(content: Mapping[str, Any]) -> str:
    """Return a case as it stands in its file."""
    return json.dumps(content, indent=1, ensure_ascii=True) + "\n"
