"""What of the programs of a site stands on its floor: steps and points, and which of them another map would trouble."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from contextlib import suppress
from dataclasses import dataclass
from typing import Any, Literal

from editor.documents.store import get_document
from editor.language.expressions.nodes import Point
from editor.language.expressions.values import read_point
from editor.programs.programs import list_programs
from registry.services import Page
from vipo_device.protocol.errors import VipoError

Where = Literal["floor", "wall", "outside"]
MOST_PROGRAMS = 1000


@dataclass(frozen=True, slots=True)
class ProgramTrouble:
    """How much of a program another map troubles: steps that are off it, and points that robots drive to in walls."""

    id: str
    name: str
    steps_outside: int
    points_walled: int


def list_program_troubles(*, site: str, where: Callable[[Point], Where]) -> tuple[ProgramTrouble, ...]:
    """Return the programs that a map troubles; `where` says what is at a point of it. Programs come by name."""
    found = []
    for program in list_programs(site=site, page=Page(limit=MOST_PROGRAMS)):
        with suppress(VipoError):  # what cannot be read, or has just been deleted, can have no steps named
            document = get_document(program_id=program.id)
            outside = sum(1 for point in step_points(document) if where(point) == "outside")
            walled = sum(1 for point in goal_points(document) if where(point) == "wall")
            if outside or walled:
                found.append(ProgramTrouble(str(program.id), program.name, outside, walled))
    return tuple(sorted(found, key=lambda each: (each.name, each.id)))


def step_points(document: Mapping[str, Any]) -> Iterator[Point]:
    """Yield where the steps of a document stand, in metres; comments are none."""
    for step in document["steps"].values():
        if step.get("place") is not None and (point := read_point(step.get("pos"))) is not None:
            yield point


def goal_points(document: Mapping[str, Any]) -> Iterator[Point]:
    """Yield the points that the steps of a document name as goals, in metres, wherever they stand in them."""
    waiting: list[Any] = [step.get("params") for step in document["steps"].values()]
    for value in waiting:  # grows while it is gone through
        if isinstance(value, dict):
            if (point := read_point(value.get("point"))) is not None:
                yield point
            waiting += value.values()
        elif isinstance(value, list):
            waiting += value
