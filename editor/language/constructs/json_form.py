"""The records of constructs as the browser has them, and as the page of the document's shape lists them."""

from __future__ import annotations

import json
from collections.abc import Iterator

from editor.language.constructs.record import Construct, Field
from editor.language.constructs.script_form import CALLS, OF_THE_FLEET
from editor.language.constructs.table import CONSTRUCTS

_TYPES = {
    "role": "role",
    "own_robot": '{"role": id}, whose robot does a method of its own where it stands',
    "place": "Place",
    "value": "Value",
    "values": "[Value, …]",
    "variable": "name of a variable",
    "loop_variable": "name",
    "route": "[[x, y], …]",
    "zone": "zone id",
    "answer": "{type: `boolean`/`number`/`text`/`choice`, unit?, minimum?, maximum?, options?}",
    "arguments": "{name: Value or Place}",
    "method": "name",
    "function": "function id",
    "branches": '["a", "b"]',
    "whole": "whole number",
    "text": "text",
    "flag": "false where it does not",
}


def write_constructs() -> str:
    """Return the file from which the editor's screens take what they know of constructs."""
    rows = (json.dumps(_construct(construct), ensure_ascii=False) for construct in CONSTRUCTS.values())
    return "[\n  " + ",\n  ".join(rows) + "\n]\n"


def _construct(construct: Construct) -> dict[str, object]:
    look = construct.look
    calls = [CALLS[form.node].method for form in construct.forms if form.node in CALLS]
    return _present(
        kind=construct.kind,
        icon=look.icon,
        family=look.family,
        shape=look.shape,
        key=look.key,
        rare=look.rare,
        branches=[name for name, _ in construct.branches],
        loops=construct.loops,
        tall=look.tall,
        drives=construct.drives and ("fleet" if any(call in OF_THE_FLEET for call in calls) else "robot"),
        method=calls[0] if calls else "",
        forms=[
            _present(marked_by=form.marked_by, fields=[_field(field) for field in form.fields])
            for form in construct.forms
        ],
    ) | {"key": look.key}


def _field(field: Field) -> dict[str, object]:
    return _present(
        name=field.name,
        type=field.type,
        wanted=field.wanted,
        optional=field.optional,
        choices=list(field.choices),
        numbered=field.numbered,
        explained=field.explained,
        suggested=field.suggested,
        accepts=field.accepts,
    )


def _present(**given: object) -> dict[str, object]:
    return {name: value for name, value in given.items() if value}


def write_table() -> str:
    """Return the kinds of steps with their parameters, as rows of a table."""
    rows = (f"| `{one.kind}` | {', or '.join(filter(None, _forms(one)))} |" for one in CONSTRUCTS.values())
    return "\n".join(["| kind | params |", "| --- | --- |", *(row.replace("|  |", "| |") for row in rows), ""])


def _forms(construct: Construct) -> Iterator[str]:
    for form in construct.forms:
        yield ", ".join(_parameter(field) for field in form.fields)


def _parameter(field: Field) -> str:
    if field.type == "role":
        return "`role`"
    words = "/".join(f"`{choice}`" for choice in field.choices)
    kind = {"choice": words, "choices": f"[] (any) or of {words}"}.get(field.type) or _TYPES[field.type]
    bare = {"time": "seconds", "length": "metres"}.get(field.wanted)
    unit = f" (a bare number is in {bare})" if bare else ""
    more = f", and so optional `{field.name}2` … `{field.name}{field.numbered}`" if field.numbered else ""
    return f"{'optional ' if field.optional else ''}`{field.name}`: {kind}{unit}{more}"
