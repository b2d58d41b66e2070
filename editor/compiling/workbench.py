"""What a child process keeps of the programs that it checks, and a check. No I/O, no Django.

A job brings what has changed since the last one: of the document the Yjs update that is lacking, of what is around the
program only what is another, of the compiled form the patches that other processes told.
"""

from __future__ import annotations

import pickle
import time
from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from typing import Any

from editor.documents.shared_document import SharedDocument
from editor.language import compiled_to_json
from editor.language.allocation import paused_collector
from editor.language.compiler import EditedProgram
from editor.language.site.surroundings import FloorFacts, Surroundings
from editor.programs.compiled_patch import apply_patch, make_patch
from editor.programs.summary import Summary, summary_of

Form = Mapping[str, Any]


@dataclass(frozen=True, slots=True)
class Job:
    """A check that is wanted; `revision` is the number of the look, `base` that of the form that a patch begins from.

    With `anew` nothing is known of the program, and `update` is all of it. `around` are the surroundings, pickled,
    without their floor, where they are others than before; `floor` is one of those that were sent with a job, by its
    number, and `floors` are the numbers of those to keep. `forms` lead from a form that is known here to `base`.
    `forgotten` are programs that nobody looks at any more.
    """

    program: str
    revision: int
    update: bytes
    anew: bool
    around: bytes | None
    floor: int
    new_floor: FloorFacts | None
    floors: frozenset[int]
    forms: tuple[Form, ...]
    base: int | None
    forgotten: tuple[str, ...]


@dataclass(frozen=True, slots=True)
class Found:
    """What a check found: `said` is the form, or a patch of the one that the job named; `state` how far it looked."""

    said: Form
    summary: Summary
    state: bytes
    took_s: float


@dataclass(frozen=True, slots=True)
class Fault:
    """A check that raised what it should not, in words for the log."""

    story: str


@dataclass(slots=True)
class _Known:
    """What is kept of a program; its forms are the one before the last check and the one that the check made."""

    document: SharedDocument = field(default_factory=SharedDocument)
    edited: EditedProgram = field(default_factory=EditedProgram)
    around: Surroundings = field(default_factory=lambda: Surroundings(devices={}, places={}))
    forms: tuple[Form, ...] = ()


class Workbench:
    """The programs of one child process."""

    def __init__(self) -> None:
        """Know nothing yet."""
        self._known: dict[str, _Known] = {}
        self._floors: dict[int, FloorFacts] = {}

    def check(self, job: Job) -> Found:
        """Take in what is new, and check. Whatever it raises, the program is forgotten then."""
        for program in job.forgotten:
            self._known.pop(program, None)
        self._take_floors(job)
        known = self._known.pop(job.program, None)
        known = _Known() if known is None or job.anew else known
        if job.update:
            known.document.apply(job.update)
        if job.around is not None:
            known.around = pickle.loads(job.around)  # noqa: S301 - from the parent process, by a pipe
        found = _found(job, known, self._floors.get(job.floor))
        self._known[job.program] = known
        return found

    def _take_floors(self, job: Job) -> None:
        if job.new_floor is not None:
            self._floors[job.floor] = job.new_floor
        self._floors = {number: floor for number, floor in self._floors.items() if number in job.floors}


def _found(job: Job, known: _Known, floor: FloorFacts | None) -> Found:
    began_s = time.process_time()
    document = known.document.to_json()
    with paused_collector():
        look = known.edited.look(document, replace(known.around, floor=floor))
        compiled = look.compiled(with_plan=False)
    form = compiled_to_json(compiled, job.revision)
    base = _base(job, known.forms)
    known.forms = (form,) if base is None else (base, form)
    said = form if base is None else make_patch(base, form)
    return Found(said, summary_of(document, compiled), known.document.state(), time.process_time() - began_s)


def _base(job: Job, forms: tuple[Form, ...]) -> Form | None:
    """Return the form that a patch is to begin from."""
    by_revision = {form["revision"]: form for form in forms}
    for told in job.forms:
        before = by_revision.get(told.get("base"))
        by_revision[told["revision"]] = told if before is None else apply_patch(before, told)
    return None if job.base is None else by_revision[job.base]
