"""Values as one line of text: what the inspector's field takes, read and printed for one step of a program."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Any
from uuid import UUID

from editor.documents.store import get_document
from editor.language.expressions.names import member_name
from editor.language.expressions.printing import quote
from editor.language.expressions.temperatures import base_unit
from editor.language.one_line.scope import LineScope, make_line_scope
from editor.language.one_line.values import NotUnderstood, parse_line, print_line, type_of_line
from editor.language.tree.robots import readings_told, short_reading
from editor.programs.checking import build_surroundings
from editor.programs.compilations import print_program
from editor.programs.programs import get_program
from vipo_device.protocol.texts import cleaned_json
from vipo_device.protocol.units import is_measure


@dataclass(frozen=True, slots=True)
class LineProblemView:
    """Why a line means nothing; the column counts from 1."""

    message: str
    messages: dict[str, str]
    column: int


@dataclass(frozen=True, slots=True)
class PropertyNameView:
    """How a device's property is written behind the device's name and a dot."""

    name: str
    written: str


@dataclass(frozen=True, slots=True)
class NameView:
    """A name that can stand in a line: `kind` is device, place, zone, robot or variable."""

    name: str
    kind: str
    id: str
    properties: tuple[PropertyNameView, ...] = ()


@dataclass(frozen=True, slots=True)
class ExpressionView:
    """A value with its line, its type and its unit (empty: not known); `names` only when they were asked for."""

    value: Any
    text: str
    type: str
    unit: str
    problem: LineProblemView | None = None
    names: tuple[NameView, ...] = field(default=())


def read_expression(*, program_id: UUID | str, text: str, step: str = "", names: bool = False) -> ExpressionView:
    """Return the value that a line stands for; one that means nothing has no value but a problem.

    Raises:
        NoSuchProgram: there is no such program.
    """
    line = _scope(program_id, step)
    try:
        value = cleaned_json(parse_line(text, line))
    except NotUnderstood as error:
        problem = LineProblemView(str(error), {**error.messages}, error.column)
        return ExpressionView(None, text, "", "", problem, _line_names(line) if names else ())
    return _view(value, text, line, names=names)


def print_expression(*, program_id: UUID | str, value: Any, step: str = "", names: bool = False) -> ExpressionView:
    """Return the line for a value. Raises NoSuchProgram."""
    line = _scope(program_id, step)
    return _view(value, print_line(value, line), line, names=names)


def _view(value: Any, text: str, line: LineScope, *, names: bool) -> ExpressionView:
    value_type = type_of_line(value, line)
    unit = base_unit(value_type.unit) if is_measure(value_type.unit) else ""
    return ExpressionView(value, text, value_type.type, unit, None, _line_names(line) if names else ())


def _scope(program_id: UUID | str, step: str) -> LineScope:
    document = get_document(program_id=program_id)
    surroundings = build_surroundings(site=get_program(program_id=program_id).site)
    return make_line_scope(document, surroundings, print_program(document, surroundings), step)


_KINDS = {"get": "device", "place": "place", "zone": "zone"}


def _line_names(line: LineScope) -> tuple[NameView, ...]:
    return (
        *(NameView(written, "variable", name) for name, written in line.names.items()),
        *(NameView(name, "robot", role, _of_robot(name, line)) for name, role in line.role_ids.items()),
        *(NameView(name, _KINDS[kind], thing, _properties(thing, line)) for (kind, thing), name in line.things.items()),
    )


def _of_robot(role: str, line: LineScope) -> tuple[PropertyNameView, ...]:
    robots = line.scope.robots_of(role)
    named = ((name, short_reading(robots, name)) for name in readings_told(robots))
    return tuple(PropertyNameView(name, short or f"read({quote(name)})") for name, short in named)


def _properties(thing: str, line: LineScope) -> tuple[PropertyNameView, ...]:
    description = line.scope.description(thing)
    names = [] if description is None else [spec.name for spec in description.properties]
    return tuple(PropertyNameView(name, member_name(name, names) or f"read({quote(name)})") for name in names)
