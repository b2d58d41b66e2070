"""What things are called in the script: Python names made from the names that people gave."""

from __future__ import annotations

import keyword
import re
from collections.abc import Iterable
from functools import lru_cache

ROBOT_METHODS = ("move", "pick", "drop")
CLOSED_FUNCTIONS = ("abs", "count", "distance", "max", "min", "nearest", "now", "point", "quantity", "round")
_OF_THE_TASK = {"new_task", "run", "wait", "parallel", "call", "set", "ask", "notify", "end"}
_KEPT_FREE = {"repeat", "zone", "release", "parameters"}
RESERVED_ATTRIBUTES = frozenset(_OF_THE_TASK | _KEPT_FREE)
RESERVED_LOCALS = frozenset({"self", "ctx", "problem", "range", "_", *CLOSED_FUNCTIONS})
RESERVED_MEMBERS = frozenset({*ROBOT_METHODS, "operate", "read", "location"})

_BETWEEN = re.compile(r"(?<=[a-z0-9])(?=[A-Z])|(?<=[A-Z])(?=[A-Z][a-z])")
_OF_EVENTS = re.compile(r"when_e\d")
_OTHER = re.compile(r"[^A-Za-z0-9]+")


@lru_cache(maxsize=4096)
def snake_case(name: str) -> str:
    """Return a Python name for a name: `curePaint` → `cure_paint`, `Painting Machine` → `painting_machine`."""
    words = _OTHER.sub("_", _BETWEEN.sub("_", name)).strip("_").lower()
    if not words:
        return "unnamed"
    if words[0].isdigit():
        words = f"n{words}"
    if words.startswith("branch_") or _OF_EVENTS.match(words):
        words = f"the_{words}"
    return f"{words}_" if keyword.iskeyword(words) or keyword.issoftkeyword(words) else words


def unique_name(wanted: str, taken: Iterable[str]) -> str:
    """Return the Python name for `wanted` that is not taken yet: the second `Oven` becomes `oven_2`."""
    name, others = snake_case(wanted), frozenset(taken)
    number, free = 2, name
    while free in others:
        free, number = f"{name}_{number}", number + 1
    return free


def attribute_name(wanted: str, taken: Iterable[str]) -> str:
    """Return the name of a value of the whole program, an attribute of the task; a good name stays as it is."""
    others = frozenset(taken) | RESERVED_ATTRIBUTES
    reserved = wanted.startswith("branch_") or _OF_EVENTS.match(wanted)
    if not reserved and wanted not in others and _is_good(wanted):
        return wanted
    return unique_name(wanted, others)


def local_name(wanted: str, taken: Iterable[str]) -> str:
    """Return the name of a parameter or a variable in the script; a good Python name stays as it is."""
    others = {*taken, *RESERVED_LOCALS}
    return wanted if wanted not in others and _is_good(wanted) else unique_name(wanted, others)


def _is_good(name: str) -> bool:
    return name.isascii() and name.isidentifier() and not keyword.iskeyword(name)


def member_name(wanted: str, known: list[str]) -> str | None:
    """Return the script name of a method or property; None where it would not be clear which one is meant."""
    name = snake_case(wanted)
    alike = [other for other in known if snake_case(other) == name]
    return name if alike == [wanted] and name not in RESERVED_MEMBERS else None
