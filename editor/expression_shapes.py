"""The shapes of values as one line of text over HTTP."""

from __future__ import annotations

from typing import Annotated, Any

from ninja import Field, Schema

from editor.shapes import Value
from registry.shown import Shown


class ExpressionToRead(Schema):
    """A line that shall be read (`text`), or a Value that shall be printed as one; the names are those of a step."""

    text: str | None = Field(None, max_length=10_000)
    value: Any = None
    step: str = Field("", max_length=100)
    names: bool = False


class LineProblem(Schema):
    """Why a line means nothing, in each language; the column counts from 1."""

    message: str
    messages: dict[str, str]
    column: int


class PropertyName(Schema):
    """How a device's property is written behind the device's name and a dot."""

    name: str
    written: str


class LineName(Schema):
    """A name that can stand in a line: `kind` is device, place, zone, robot or variable."""

    name: str
    kind: str
    id: str
    properties: list[PropertyName]


class ExpressionShape(Schema):
    """A Value and the line for it, with its type and unit as far as they are known."""

    value: Annotated[Any, Shown(Value)]
    text: str
    type: str
    unit: str
    problem: LineProblem | None
    names: list[LineName]
