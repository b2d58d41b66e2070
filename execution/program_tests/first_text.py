"""The text that a new test begins with: hardly anything, or what the program's last rehearsal was and came to."""

from __future__ import annotations

from collections.abc import Mapping
from math import ceil
from typing import Any
from uuid import UUID

import yaml

from execution.models import ProgramTest, Rehearsal

ROOM = 1.2
"""A test made of a rehearsal lets the program take so many times what it took then."""
EMPTY = {"name": "All goes well", "then": [{"ends": "well"}]}


def first_text(*, program: UUID, of_rehearsal: bool) -> tuple[str, bool]:
    """Return the text of a new test, and whether it is made of a rehearsal: there may be none that came to a result."""
    last = _last_rehearsal(program) if of_rehearsal else None
    told = EMPTY if last is None else _told(last)
    return _written({**told, "name": _free_name(program, str(told["name"]))}), last is not None


def _last_rehearsal(program: UUID) -> Rehearsal | None:
    rows = Rehearsal.objects.filter(program=program, kind=Rehearsal.Kind.REHEARSAL, status=Rehearsal.Status.DONE)
    return rows.filter(archive=None).exclude(result=None).order_by("-ended_at").first()


def _told(row: Rehearsal) -> dict[str, Any]:
    job, result = row.job, row.result or {}
    scene = job["scene"]
    numbers: Mapping[str, str] = row.compiled.get("numbers", {})
    faults = [_named(fault, numbers) for fault in scene.get("faults", {}).get("faults", [])]
    said = {"seed": scene.get("seed"), "parameters": job.get("parameters"), "faults": faults}
    when = {word: value for word, value in said.items() if value}
    if job.get("driver", "physics") == "physics":
        when["driver"] = "physics"
    return {
        "name": "As rehearsed",
        **({"when": when} if when else {}),
        "then": _then(result),
    }


def _named(fault: Mapping[str, Any], numbers: Mapping[str, str]) -> dict[str, Any]:
    """Return a fault with its step by the number that people see."""
    step = fault.get("at_step")
    return {**fault, "at_step": numbers.get(step, step)} if step else dict(fault)


def _then(result: Mapping[str, Any]) -> list[dict[str, Any]]:
    within = {"within_s": ceil(result.get("duration_s", 0.0) * ROOM / 10) * 10}
    if result.get("ok"):
        return [{"ends": "well"}, within]
    errors = result.get("errors", [])
    return [{"fails": errors[-1]["kind"]}] if errors and errors[-1].get("kind") else [within]


def _free_name(program: UUID, name: str) -> str:
    known = set(ProgramTest.objects.filter(program=program).values_list("name", flat=True))
    return next(
        each for number in range(1, len(known) + 2) if (each := f"{name} {number}" if number > 1 else name) not in known
    )


def _written(told: Mapping[str, Any]) -> str:
    return yaml.safe_dump(dict(told), sort_keys=False, allow_unicode=True, default_flow_style=False, width=100)
