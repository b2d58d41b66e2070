"""The summary of a program that lists show, from its document and what the checks found. Pure."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

from editor.language import Compiled


@dataclass(frozen=True, slots=True)
class Summary:
    """What lists show: the kinds of its steps, the devices that it names, and how many errors and warnings it has.

    `sources` are the functions of the site's library that it has taken in.
    """

    kinds: tuple[str, ...]
    devices: tuple[str, ...]
    sources: tuple[str, ...]
    errors: int
    warnings: int


def summary_of(document: Mapping[str, Any], compiled: Compiled) -> Summary:
    """Return what lists show of a checked document."""
    severities = [diagnostic.severity for diagnostic in compiled.diagnostics]
    steps = [step for step in document["steps"].values() if isinstance(step, dict)]
    return Summary(
        kinds=tuple(sorted({str(step["kind"]) for step in steps if isinstance(step.get("kind"), str)})),
        devices=tuple(sorted(devices_in(document))),
        sources=tuple(sorted(_sources(document))),
        errors=severities.count("error"),
        warnings=severities.count("warning"),
    )


def devices_in(document: Mapping[str, Any]) -> frozenset[str]:
    """Return the ids of the devices that a document names, wherever they stand."""
    named: list[Any] = []
    waiting: list[Any] = [document.get(name) for name in ("steps", "roles", "parameters", "functions")]
    for value in waiting:  # grows while it is gone through
        if isinstance(value, dict):
            if "device" in value:
                named.append(value["device"])
            if "property" in value and isinstance(value["property"], list):
                named += value["property"][:1]
            waiting += [each for each in value.values() if isinstance(each, _HOLD_MORE)]
        elif isinstance(value, list):
            waiting += [each for each in value if isinstance(each, _HOLD_MORE)]
    return frozenset(name for name in named if isinstance(name, str))


_HOLD_MORE = (dict, list)
"""What of plain JSON something else can stand in."""


def _sources(document: Mapping[str, Any]) -> set[str]:
    functions = document.get("functions", {}).values()
    sources = [f.get("source") for f in functions if isinstance(f, dict)]
    return {str(s["library"]) for s in sources if isinstance(s, dict) and "library" in s}
