"""What a child process already has of a program, and so what a job must bring it. No I/O."""

from __future__ import annotations

import itertools
import pickle
import time
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from typing import Any

from editor.compiling.workbench import Found, Job
from editor.documents.shared_document import SharedDocument
from editor.language.site.surroundings import FloorFacts, Surroundings

Form = Mapping[str, Any]
MOST_PROGRAMS, MOST_FLOORS = 30, 6
"""Of so many programs and maps a process keeps what it found; what was used least is forgotten."""


@dataclass(frozen=True, slots=True)
class Wanted:
    """A check that is wanted. `document` and `forms` are asked for when it begins.

    `forms` returns the way to the present form from the one of a revision that is given, or from nothing: patches, or
    the form itself, in their order; empty where there is none, or it is there.
    """

    program: str
    document: Callable[[], SharedDocument]
    surroundings: Surroundings
    revision: Callable[[], int | None]
    forms: Callable[[Sequence[int]], Sequence[Form]]


@dataclass(slots=True)
class KnownProgram:
    """What a child process has of one program."""

    document: SharedDocument
    state: bytes
    surroundings: Surroundings
    revisions: tuple[int, ...]


@dataclass(slots=True)
class ChildKnowledge:
    """What one child process has."""

    programs: dict[str, KnownProgram] = field(default_factory=dict)
    _floors: dict[int, FloorFacts] = field(default_factory=dict)
    _numbers: itertools.count[int] = field(default_factory=lambda: itertools.count(1))
    _forgotten: list[str] = field(default_factory=list)

    def forget(self, program: str) -> None:
        """Have a program forgotten with the next job."""
        if self.programs.pop(program, None) is not None:
            self._forgotten.append(program)

    def job(self, wanted: Wanted) -> Job:
        """Return what to send, as of now."""
        document, known = wanted.document(), self.programs.pop(wanted.program, None)
        if known is not None and known.document is not document:
            known = None  # it was built anew since pieces had come in a wrong order
        while len(self.programs) >= MOST_PROGRAMS:
            self.forget(next(iter(self.programs)))
        number, new_floor = self._floor(wanted.surroundings.floor)
        around = wanted.surroundings
        forms = tuple(wanted.forms(known.revisions if known else ()))
        job = Job(
            program=wanted.program,
            revision=time.time_ns() // 1000,
            update=document.encode(known.state if known else None),
            anew=known is None,
            around=None if known and known.surroundings is around else pickle.dumps(replace(around, floor=None)),
            floor=number,
            new_floor=new_floor,
            floors=frozenset(self._floors),
            forms=forms,
            base=wanted.revision(),
            forgotten=tuple(self._forgotten),
        )
        self._forgotten.clear()
        return job

    def take(self, wanted: Wanted, document: SharedDocument, job: Job, found: Found) -> None:
        """Note what the process has after a check."""
        revisions = (job.revision,) if job.base is None else (job.base, job.revision)
        self.programs[wanted.program] = KnownProgram(document, found.state, wanted.surroundings, revisions)

    def _floor(self, floor: FloorFacts | None) -> tuple[int, FloorFacts | None]:
        """Return the number of a map, and the map itself if the process does not have it."""
        if floor is None:
            return 0, None
        for number, known in self._floors.items():
            if known is floor:
                self._floors[number] = self._floors.pop(number)
                return number, None
        while len(self._floors) >= MOST_FLOORS:
            del self._floors[next(iter(self._floors))]
        number = next(self._numbers)
        self._floors[number] = floor
        return number, floor
