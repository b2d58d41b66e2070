"""Work on documents that is no check: a web process has the large of it done in a child process, others do it here."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Any, Protocol, TypeVar

Said = TypeVar("Said", covariant=True)
MUCH = 200
"""So many steps; with fewer it costs less than telling a child process of it."""


class DocumentTask(Protocol[Said]):
    """Work on a document that has to do with no check."""

    def done(self) -> Said:
        """Do it, and return what there is to say."""


Doer = Callable[[DocumentTask[Any]], Any]
_doers: list[Doer] = []


def have_done_by(doer: Doer) -> None:
    """Have `doer` do large work from now on; it returns None where it cannot. Not called on an event loop."""
    if doer not in _doers:
        _doers.append(doer)


def do(task: DocumentTask[Said], size: int) -> Said:
    """Do it, in a child process where there is one and it is much: `size` counts steps, or lines of a script."""
    for doer in _doers if size >= MUCH else ():
        said: Said | None = doer(task)
        if said is not None:
            return said
    return task.done()


def size_of(document: Mapping[str, Any]) -> int:
    """Return how many steps a document in its plain form has."""
    steps = document.get("steps")
    return len(steps) if isinstance(steps, Mapping) else 0
