"""A function cut out of a program, with all that it needs to stand alone."""

from __future__ import annotations

from collections.abc import Container, Iterable, Mapping
from typing import Any

from editor.errors import BadRequest
from editor.language.document.format_migrations import FORMAT
from editor.language.document.outline import mapping
from editor.language.reading.well_formed import well_formed
from editor.language.signatures.needs import DEFAULT_ROLE

_NAMED = {"roles": "role", "zones": "zone"}


def cut_out_function(document: Mapping[str, Any], function: str) -> dict[str, Any]:
    """Return a function of a plain document with its steps, the functions that it calls, their roles and zones.

    {function: {name, parameters, …}, id, functions: {id: …} of those called, steps: {id: …}, roles, zones, format}.
    Raises BadRequest.
    """
    document = well_formed(document)
    functions = document["functions"]
    if function not in functions:
        raise BadRequest("The program has no such function. It may have been deleted; reload the page.")
    wanted, steps = Bodies(document["steps"]).reach([function], functions)
    others = {other: functions[other] for other in wanted if other != function}
    named = {root: _named(steps, key, document[root]) for root, key in _NAMED.items()}
    named["roles"].pop(DEFAULT_ROLE, None)  # every program has one of its own
    return {
        "id": function,
        "function": functions[function],
        "functions": others,
        "steps": steps,
        **named,
        "format": FORMAT,
    }


class Bodies:
    """What stands in the functions of a well-formed document, by its steps."""

    def __init__(self, steps: Mapping[str, Any]) -> None:
        self._steps = steps
        self._children: dict[str, list[str]] = {}
        for step, body in steps.items():
            if place := body.get("place"):
                self._children.setdefault(place[0], []).append(step)

    def reach(self, functions: Iterable[str], into: Container[str] = ()) -> tuple[list[str], dict[str, Any]]:
        """Return these functions, with those that they call, one by another, as far as they are in `into`; all steps.

        The functions are in the order in which they are found, the steps are by id.
        """
        found = list(functions)
        left, known, steps = list(found), set(found), dict[str, Any]()
        while left:
            for step in self._children.get(left.pop(), ()):
                if step in steps:
                    continue
                body = steps[step] = self._steps[step]
                left.append(step)
                called = called_by(body)
                if called is not None and called in into and called not in known:
                    known.add(called)
                    found.append(called)
                    left.append(called)
        return found, steps


def called_by(step: Mapping[str, Any]) -> str | None:
    """Return the function that a step calls, if it is a call of one."""
    called = step["params"].get("function") if step["kind"] == "call" else None
    return called if isinstance(called, str) else None


def _named(steps: Mapping[str, Any], key: str, known: Mapping[str, Any]) -> dict[str, Any]:
    """Return those of the roles or zones that some value of the steps names."""
    found: dict[str, Any] = {}
    left: list[object] = [step["params"] for step in steps.values()]
    while left:
        value = left.pop()
        if isinstance(value, Mapping):
            name = value.get(key)
            if isinstance(name, str) and name in known:
                found[name] = known[name]
            left.extend(value.values())
        elif isinstance(value, list):
            left.extend(value)
    return found


def held_by(definition: Mapping[str, Any]) -> set[tuple[str, int]]:
    """Return the library functions that a definition has taken in, each as (id, version)."""
    found = set()
    for function in mapping(definition.get("functions")).values():
        source = mapping(mapping(function).get("source"))
        library, version = source.get("library"), source.get("version")
        if isinstance(library, str) and isinstance(version, int) and not isinstance(version, bool):
            found.add((library, version))
    return found


def made_from(definition: Mapping[str, Any]) -> tuple[str, int] | None:
    """Return the library function, with its version, of which the function itself was a copy."""
    alone = {"functions": {"it": mapping(definition.get("function"))}}
    return next(iter(held_by(alone)), None)
