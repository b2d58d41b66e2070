"""What things are called in the script: Python names made from the names that people gave."""

from __future__ import annotations

import keyword
import re
from collections import Counter
from collections.abc import Iterable
from collections.abc import Set as AbstractSet
from functools import lru_cache
from itertools import pairwise
from unicodedata import normalize

from editor.language.constructs.script_form import CALLS, OF_THE_FLEET, RELEASE

ROBOT_METHODS = tuple(call.method for call in CALLS.values() if call.role and call.method not in OF_THE_FLEET)
CLOSED_FUNCTIONS = (
    "abs",
    "count",
    "distance",
    "len",
    "max",
    "min",
    "nearest",
    "now",
    "nth",
    "point",
    "quantity",
    "round",
)
_OF_THE_TASK = {
    "new_task",
    "run",
    "parallel",
    "call",
    "set",
    *(call.method for call in CALLS.values() if call.role is None),
}
_KEPT_FREE = {"repeat", "zone", RELEASE, "parameters"}
RESERVED_ATTRIBUTES = frozenset(_OF_THE_TASK | _KEPT_FREE)
RESERVED_LOCALS = frozenset({"self", "ctx", "problem", "range", "needed", "_", *CLOSED_FUNCTIONS})
RESERVED_MEMBERS = frozenset({*ROBOT_METHODS, "operate", "read", "location"})

_OF_EVENTS = re.compile(r"when_e\d")
_BETWEEN_WORDS = re.compile(r"_+")


def same_name(name: str) -> str:
    """Return a name as Python reads it: of letters that are written in several ways, one way (NFKC)."""
    return name if name.isascii() else normalize("NFKC", name)


@lru_cache(maxsize=32768)
def snake_case(name: str) -> str:
    """Return a Python name for a name: `curePaint` → `cure_paint`, `Über Nacht lüften` → `über_nacht_lüften`."""
    words = same_name(_split(same_name(name)).lower())
    words = _BETWEEN_WORDS.sub("_", "".join(map(_in_name, words))).strip("_")
    if not words:
        return "unnamed"
    if not words.isidentifier():
        words = same_name(f"n{words}")
    if words.startswith("branch_") or _OF_EVENTS.match(words):
        words = f"the_{words}"
    return f"{words}_" if keyword.iskeyword(words) or keyword.issoftkeyword(words) else words


def _split(name: str) -> str:
    """Return a name with `_` where a word begins with a capital: `curePaint`, `RFIDReader`."""
    written = name[:1]
    for (before, letter), after in zip(pairwise(name), f"{name[2:]} ", strict=False):
        begins = letter.isupper() and (before.islower() or before.isdigit() or (before.isupper() and after.islower()))
        written += f"_{letter}" if begins else letter
    return written


def _in_name(letter: str) -> str:
    return letter if f"a{letter}".isidentifier() else "_"


def unique_name(wanted: str, taken: Iterable[str]) -> str:
    """Return the Python name for `wanted` that is not taken yet: the second `Oven` becomes `oven_2`."""
    return _numbered(snake_case(wanted), taken if isinstance(taken, set | frozenset) else frozenset(taken))


def _numbered(name: str, taken: AbstractSet[str]) -> str:
    """Return a name, with the first number at its end that makes it one of its own."""
    number, free, stem = 2, name, name.rstrip("_")
    while free in taken:
        free, number = f"{stem}_{number}", number + 1
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
    return name.isidentifier() and same_name(name) == name and not keyword.iskeyword(name)


def member_name(wanted: str, known: list[str]) -> str | None:
    """Return the script name of a method or property; None where it would not be clear which one is meant."""
    name = snake_case(wanted)
    alike = [other for other in known if snake_case(other) == name]
    return name if alike == [wanted] and name not in RESERVED_MEMBERS else None


def member_names(wanted: Iterable[str]) -> dict[str, str]:
    """Return methods or properties by their script names, those that have one."""
    known = list(wanted)
    alike = Counter(map(snake_case, known))
    named = ((snake_case(name), name) for name in known)
    return {short: name for short, name in named if alike[short] == 1 and short not in RESERVED_MEMBERS}
