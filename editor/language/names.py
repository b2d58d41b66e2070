"""What things are called in the script: Python names made from the names that people gave."""

from __future__ import annotations

import keyword
import re
from collections.abc import Iterable
from functools import lru_cache

ROBOT_METHODS = ("move", "pick", "drop")
CLOSED_FUNCTIONS = ("abs", "max", "min", "round")
_OF_THE_TASK = {"new_task", "run", "wait", "parallel", "call"}
_OF_ISSUES_TO_COME = {"repeat", "notify", "ask", "zone", "release", "parameters"}
RESERVED_ATTRIBUTES = frozenset(_OF_THE_TASK | _OF_ISSUES_TO_COME)
RESERVED_LOCALS = frozenset({"self", "ctx", "problem", "range", *CLOSED_FUNCTIONS})
RESERVED_MEMBERS = frozenset({*ROBOT_METHODS, "operate", "read", "location"})

_BETWEEN = re.compile(r"(?<=[a-z0-9])(?=[A-Z])|(?<=[A-Z])(?=[A-Z][a-z])")
_OTHER = re.compile(r"[^A-Za-z0-9]+")


@lru_cache(maxsize=4096)
def snake_case(name: str) -> str:
    """Return a Python name for a name: `curePaint` → `cure_paint`, `Painting Machine` → `painting_machine`."""
    words = _OTHER.sub("_", _BETWEEN.sub("_", name)).strip("_").lower()
    if not words:
        return "unnamed"
    if words[0].isdigit():
        words = f"n{words}"
    if words.startswith("branch_"):
        words = f"the_{words}"
    return f"{words}_" if keyword.iskeyword(words) or keyword.issoftkeyword(words) else words


def unique_name(wanted: str, taken: Iterable[str]) -> str:
    """Return the Python name for `wanted` that is not taken yet: the second `Oven` becomes `oven_2`."""
    name, others = snake_case(wanted), frozenset(taken)
    number, free = 2, name
    while free in others:
        free, number = f"{name}_{number}", number + 1
    return free


def local_name(wanted: str, taken: Iterable[str]) -> str:
    """Return a parameter's name in the script; a good Python name stays as it is."""
    others = {*taken, *RESERVED_LOCALS}
    if wanted.isascii() and wanted.isidentifier() and not keyword.iskeyword(wanted) and wanted not in others:
        return wanted
    return unique_name(wanted, others)
