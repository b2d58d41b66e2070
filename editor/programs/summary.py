"""The summary of a program that lists show, from its document and what the checks found. Pure."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

from editor.language import Compiled


@dataclass(frozen=True, slots=True)
class Summary:
    """What lists show: the kinds of its steps, the devices and places that it names, and its errors and warnings.

    `sources` are the functions of the library that it has taken in, each with the number of a version.
    """

    kinds: tuple[str, ...]
    devices: tuple[str, ...]
    places: tuple[str, ...]
    sources: tuple[tuple[str, int], ...]
    errors: int
    warnings: int


def summary_of(document: Mapping[str, Any], compiled: Compiled) -> Summary:
    """Return what lists show of a checked document."""
    severities = [diagnostic.severity for diagnostic in compiled.diagnostics]
    steps = [step for step in document["steps"].values() if isinstance(step, dict)]
    named = names_in(document)
    return Summary(
        kinds=tuple(sorted({str(step["kind"]) for step in steps if isinstance(step.get("kind"), str)})),
        devices=tuple(sorted(named.devices)),
        places=tuple(sorted(named.places)),
        sources=tuple(sorted(_sources(document))),
        errors=severities.count("error"),
        warnings=severities.count("warning"),
    )


@dataclass(frozen=True, slots=True)
class Named:
    """The ids of what a document names of its site."""

    devices: frozenset[str]
    places: frozenset[str]


def names_in(document: Mapping[str, Any]) -> Named:
    """Return the devices and places that a document names, wherever they stand."""
    devices: list[Any] = []
    places: list[Any] = []
    waiting: list[Any] = [document.get(name) for name in ("steps", "roles", "parameters", "functions")]
    for value in waiting:  # grows while it is gone through
        if isinstance(value, dict):
            devices.append(value.get("device"))
            places.append(value.get("place"))  # a step's own `place` is a list
            if isinstance(value.get("property"), list):
                devices += value["property"][:1]
            waiting += [each for each in value.values() if isinstance(each, _HOLD_MORE)]
        elif isinstance(value, list):
            waiting += [each for each in value if isinstance(each, _HOLD_MORE)]
    return Named(_texts(devices), _texts(places))


def _texts(found: list[Any]) -> frozenset[str]:
    return frozenset(name for name in found if isinstance(name, str))


_HOLD_MORE = (dict, list)
"""What of plain JSON something else can stand in."""


def _sources(document: Mapping[str, Any]) -> set[tuple[str, int]]:
    functions = document.get("functions", {}).values()
    sources = [f.get("source") for f in functions if isinstance(f, dict)]
    return {(str(s["library"]), _number(s.get("version"))) for s in sources if isinstance(s, dict) and "library" in s}


def _number(version: object) -> int:
    return version if isinstance(version, int) and not isinstance(version, bool) else 0
