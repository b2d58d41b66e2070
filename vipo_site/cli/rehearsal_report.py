"""What `vipo rehearse` says of a rehearsal: on the terminal and as JSON, with steps in the words of the script."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from typing import Any

from editor.language.compiler import Compiled
from vipo_device.protocol.faults import printable

OF_STEPS = ("errors", "steps", "log")
"""What in a result belongs to steps."""


@dataclass(frozen=True, slots=True)
class _Step:
    """A step as a person finds it: its number, and its first line of the script (from 1; 0: none) with its words."""

    number: str = ""
    line: int = 0
    words: str = ""

    def __str__(self) -> str:
        return f"step {self.number}" + (f", line {self.line}, {self.words}" if self.line else "")


def say_result(name: str, compiled: Compiled, result: Mapping[str, Any]) -> Iterator[str]:
    """Yield the lines of the report."""
    steps = _steps_of(compiled)
    minutes, seconds = divmod(round(result["duration_s"]), 60)
    yield f"{name}: {'ends well' if result['ok'] else 'does not end well'} after {minutes} min {seconds} s."
    for error in result["errors"]:
        where = steps.get(error["step"], "the program")
        yield printable(f"error: at {error['t']:.0f} s, {where}: {error['message']}")
    for robot, figures in sorted(result["robots"].items()):
        yield f"{robot}: {figures['distance_m']:.1f} m, busy {figures['busy_s']:.0f} s, waits {figures['wait_s']:.0f} s"
    yield f"Near misses: {len(result['near_misses'])}, collisions: {len(result['collisions'])}."


def result_with_words(compiled: Compiled, result: Mapping[str, Any]) -> dict[str, Any]:
    """Return the result with `number`, `line` and `words` of the step beside each step's id."""
    steps, none = _steps_of(compiled), _Step()

    def told(entry: Mapping[str, Any]) -> dict[str, Any]:
        step = steps.get(entry["step"], none)
        return {**entry, "number": step.number, "line": step.line, "words": step.words}

    return {**result, **{key: [told(entry) for entry in result[key]] for key in OF_STEPS}}


def _steps_of(compiled: Compiled) -> dict[str, _Step]:
    """Return each step that has a number, by its id."""
    lines = compiled.script.splitlines()
    first: dict[str, int] = {}
    for line, step in enumerate(compiled.lines, start=1):
        first.setdefault(step, line)
    found = {}
    for step, number in compiled.numbers.items():
        line = first.get(step, 0)
        found[step] = _Step(number, line, lines[line - 1].strip().removesuffix(":") if line else "")
    return found
