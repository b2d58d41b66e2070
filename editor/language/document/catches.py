"""The catches of a Try in the document: `catch` with its `kinds`, and as many more as a Try says, each numbered.

Each catch is there by a parameter of its own, so what two people do to different catches goes together: two who add
one at once have both added the same, and one who changes another catch undoes nothing.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Final

MOST_CATCHES: Final = 8
FIRST_CATCH: Final = "catch"
KINDS_OF: Final[Mapping[str, str]] = {FIRST_CATCH: "kinds"} | {
    f"catch{number}": f"kinds{number}" for number in range(2, MOST_CATCHES + 1)
}
"""The branches of all catches that a Try can have, in the order in which they are tried, with their parameters."""
_NUMBERED: Final = [(branch, kinds) for branch, kinds in KINDS_OF.items() if branch != FIRST_CATCH]
_LISTS: Final = (list, tuple)


def catches_of(params: Mapping[str, object]) -> tuple[str, ...]:
    """Return the branches of the catches that a Try has: the first unless it says no, others that have a list."""
    first = () if params.get(FIRST_CATCH) is False else (FIRST_CATCH,)
    return (*first, *[each for each, kinds in _NUMBERED if isinstance(params.get(kinds), _LISTS)])


def params_of_catches(caught: Mapping[str, Sequence[str]]) -> dict[str, object]:
    """Return the parameters of a Try with these catches: branch → kinds."""
    said: dict[str, object] = {KINDS_OF[branch]: list(kinds) for branch, kinds in caught.items()}
    return said if FIRST_CATCH in caught else {**said, FIRST_CATCH: False}


def with_known_branches(drawn: Mapping[str, object], raw: Mapping[str, object]) -> dict[str, object]:
    """Return the parameters of a Try whose catches are numbered one by one, with the branches that it has had."""
    kinds = [value for name in KINDS_OF.values() if isinstance(value := drawn.get(name), list)]
    return params_of_catches(dict(zip(branches_for(catches_of(raw), len(kinds)), kinds, strict=True)))


def branches_for(known: Sequence[str], count: int) -> tuple[str, ...]:
    """Return the branches for so many catches of a Try that had these: its own, then the next ones."""
    every = tuple(KINDS_OF)
    if len(known) >= count:
        return tuple(known[:count])
    behind = every[every.index(known[-1]) + 1 :] if known else every
    missing = count - len(known)
    return (*known, *behind[:missing]) if len(behind) >= missing else every[:count]
