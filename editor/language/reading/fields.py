"""Fields of a step in a document → what its node has; one small function for each type of field."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Final

from editor.language.constructs.record import Field, FieldType
from editor.language.document.outline import Params, mapping
from editor.language.expressions.declarations import normal_answer
from editor.language.expressions.nodes import Point
from editor.language.expressions.values import read_point
from editor.language.reading.names import text_of
from editor.language.reading.reader import Reader

LISTS: Final = (list, tuple)
ReadsField = Callable[[Reader, str, Params], object]


def _role(field: Field) -> ReadsField:
    return lambda reader, step, params: reader.role(step, params)


def _place(field: Field) -> ReadsField:
    name = field.name
    return lambda reader, step, params: reader.place(step, params, name)


def _value(field: Field) -> ReadsField:
    name = field.name
    if field.optional:
        return lambda reader, step, params: reader.given(step, params, name)
    return lambda reader, step, params: reader.value(step, params, name)


def _variable(field: Field) -> ReadsField:
    name = field.name
    return lambda reader, step, params: reader.variable(params, name)


def _choice(field: Field) -> ReadsField:
    name, choices = field.name, field.choices

    def read(reader: Reader, step: str, params: Params) -> str:
        given = params.get(name)
        return given if isinstance(given, str) and given in choices else choices[0]

    return read


def _route(field: Field) -> ReadsField:
    name = field.name
    return lambda reader, step, params: read_route(params.get(name))


def read_route(value: object) -> tuple[Point, ...]:
    """Return the points of a route; what is no point is left out."""
    points = [read_point(point) for point in value] if isinstance(value, LISTS) else []
    return tuple(point for point in points if point is not None)


def _zone(field: Field) -> ReadsField:
    name = field.name
    return lambda reader, step, params: text_of(params.get(name))


def _answer(field: Field) -> ReadsField:
    name = field.name
    return lambda reader, step, params: normal_answer(mapping(params.get(name)))


FIELD_READERS: Mapping[FieldType, Callable[[Field], ReadsField]] = {
    "role": _role,
    "place": _place,
    "value": _value,
    "variable": _variable,
    "choice": _choice,
    "route": _route,
    "zone": _zone,
    "answer": _answer,
}
