"""A library function at another version: what it brings in stands for itself, and what it needs no more goes."""

from __future__ import annotations

from itertools import count
from typing import Any

from editor.language import compile_document
from editor.library.updates import with_version
from tests.kit.demo_site import factory
from tests.kit.programs import document, step

F = ("f", "body")
NOW = ("l", 2)


def held(**more: Any) -> dict[str, Any]:
    """Return a definition of a function as a program holds it, of the library's function l."""
    return {"name": "fetch", "parameters": [], "source": {"library": "l", "version": 1}, **more}


def cut(steps: dict[str, Any], **more: Any) -> dict[str, Any]:
    """Return a version of the library's function."""
    return {"id": "f", "function": {"name": "fetch", "parameters": []}, "functions": {}, "steps": steps, **more}


def update(drawn: dict[str, Any], version: dict[str, Any]) -> dict[str, Any]:
    numbers = count()
    return with_version(drawn, version, NOW, lambda: f"n{next(numbers)}")


def errors(drawn: dict[str, Any]) -> list[str]:
    return [each.code for each in compile_document(drawn, factory()).diagnostics if each.severity == "error"]


def carrier(role: str, above: int) -> dict[str, Any]:
    where = {"op": ">", "args": [{"property": [{"role": role}, "battery"]}, above]}
    return {"name": "Carrier", "can": ["move"], "where": where}


def test_a_role_that_names_itself_in_its_condition_does_so_under_its_new_id_too() -> None:
    go = {"go": step("move", F, role="r", to={"device": "dropOff01"})}
    call = step("call", function="f", args={})
    drawn = document({**go, "call": call}, functions={"f": held()}, roles={"r": carrier("r", 50)})
    assert errors(drawn) == []
    after = update(drawn, cut(go, roles={"r": carrier("r", 30)}))
    (role,) = {each["params"]["role"] for each in after["steps"].values() if each["kind"] == "move"}
    assert role != "r"
    assert after["roles"] == {"r": carrier("r", 50), role: carrier(role, 30)}
    assert errors(after) == []
