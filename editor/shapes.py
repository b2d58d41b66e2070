"""The shapes of documents and compiled programs over HTTP: described, not checked (see `registry.shapes`)."""

from __future__ import annotations

from datetime import datetime
from typing import TYPE_CHECKING, Annotated, Any, Literal
from uuid import UUID

from ninja import Field, Schema
from typing_extensions import TypeAliasType

from editor.language.constructs.table import CONSTRUCTS
from editor.language.document.outline import LONGEST_ID
from registry.requests import Asked, Flag, Line, Repaired, Unchecked

Position = tuple[float, float]
MOST_COMMENT, MOST_MENTIONS = 2000, 20
"""Letters of a comment, and whom it may mention."""
if TYPE_CHECKING:
    StepKind = str
else:
    StepKind = TypeAliasType("StepKind", Literal[tuple(CONSTRUCTS)])


class DevicePlace(Schema):
    """Where a device stands."""

    device: str


class NamedPlace(Schema):
    """A named place of the map."""

    place: str


class PointPlace(Schema):
    """A point of the map, metres."""

    point: Position


class ParameterUse(Schema):
    """A variable: a parameter of the program or the function, or what a step has set."""

    param: str


class Quantity(Schema):
    """A number with its unit."""

    quantity: tuple[float, str]


class RoleUse(Schema):
    """Whichever robot has the role."""

    role: str


class Whereabouts(Schema):
    """Where something is, as a point."""

    at: Place | RoleUse


class ZoneUse(Schema):
    """A zone of the program."""

    zone: str


class PropertyUse(Schema):
    """What a device says of itself now: the device, or the parameter or role that names it, and the property."""

    property: tuple[str | ParameterUse | RoleUse, str]


class Operation(Schema):
    """An operator with what it is applied to."""

    op: str
    args: list[Value]


Place = TypeAliasType("Place", DevicePlace | NamedPlace | PointPlace | ParameterUse)
Value = TypeAliasType(
    "Value",
    "str | bool | float | list[Any] | ParameterUse | Quantity | Whereabouts | ZoneUse | PropertyUse | Operation | None",
)


class StepShape(Schema):
    """A step: `place` is parent, branch and order; without it the step is a draft. `pos` in metres."""

    kind: StepKind
    place: tuple[str, str, str] | None = None
    pos: Position | None = None
    params: dict[str, Any]


class ParameterDefinition(Schema):
    """A parameter of a program or a function."""

    name: str
    type: str
    unit: str | None = None
    default: Annotated[Any, Unchecked(Value)] = None


class LibrarySource(Schema):
    """Where a function was copied from."""

    library: str
    version: int


class FunctionShape(Schema):
    """A function; its body is the steps whose parent is its id."""

    name: str
    parameters: list[ParameterDefinition]
    result: ResultShape | None = None
    source: LibrarySource | None = None


class RoleShape(Schema):
    """A role: bound to a robot, or to any that can do what is named, and of which a condition on its readings holds."""

    name: str | None = None
    device: str | None = None
    can: list[str] | None = None
    where: Value | None = None


class ZoneShape(Schema):
    """A named area of the map: a polygon in metres, and what it asks of robots."""

    name: str
    rule: Literal["keep_out", "one_at_a_time", "slow", "door"]
    points: list[Position]
    speed_m_s: float | None = None
    door: str | None = None


class ResultShape(Schema):
    """What a function gives back."""

    type: str
    unit: str | None = None


class DocumentShape(Schema):
    """A program's document, format 2; see docs/shapes/document.md."""

    format: Literal[2]
    start_pos: Position | None = None
    steps: dict[Annotated[str, Field(max_length=LONGEST_ID)], StepShape]
    functions: dict[str, FunctionShape]
    roles: dict[str, RoleShape]
    parameters: dict[str, ParameterDefinition]
    zones: dict[str, ZoneShape]


Document = Annotated[dict[str, Any], Unchecked(DocumentShape)]
MaybeDocument = Annotated[dict[str, Any] | None, Unchecked(DocumentShape | None)]


class Words(Schema):
    """A sentence in each language of the screens."""

    en: str
    de: str


class FixShape(Schema):
    """A change that mends a problem: `field` of the step becomes `value`."""

    label: str
    labels: Words
    label_code: str
    step: str
    field: str
    value: Any


class DiagnosticShape(Schema):
    """Something that is wrong with a step, or odd; `line` of the script counts from 1."""

    code: str
    severity: Literal["error", "warning"]
    step: str
    field: str
    message: str
    messages: Words
    when: Literal["now", "ever"] = Field(description="Whether it is so only as the site is at present.")
    args: dict[str, Any]
    line: int | None
    fix: FixShape | None


class CompiledShape(Schema):
    """A compiled program; `lines` has the step of each line of the script, or an empty text."""

    revision: int
    script: str
    lines: list[str]
    numbers: dict[str, str]
    diagnostics: list[DiagnosticShape]
    added_moves: list[str]
    order: list[str] = Field(description="Ids of steps in reading order, drafts last.")
    depth: dict[str, int]


class ScriptProblem(Schema):
    """Where a script leaves the language; lines and columns count from 1."""

    code: str
    line: int
    column: int
    end_line: int | None
    end_column: int | None
    message: str
    messages: dict[str, str]
    found: str
    expected: str
    hints: dict[str, str] = Field(description="What is expected, by language.")


class DrawnScriptShape(Schema):
    """What a script came to: `document` is what the program would be, null while the script is not valid or stale.

    Stale: the base does not print as the script that was shown; `script` is then what it prints.
    """

    ok: bool
    stale: bool
    document: MaybeDocument
    script: str
    lines: list[str]
    diagnostics: list[ScriptProblem]


class DefinitionShape(Schema):
    """What a library function holds; `functions` are those that it calls, `roles` and `zones` those that it names."""

    id: str = ""
    function: FunctionShape
    functions: dict[str, FunctionShape] = {}
    steps: dict[str, StepShape]
    roles: dict[str, RoleShape] = {}
    zones: dict[str, ZoneShape] = {}


StepKinds = Annotated[list[str], Unchecked(list[StepKind])]
Compiled = Annotated[dict[str, Any], Unchecked(CompiledShape)]
Definition = Annotated[dict[str, Any], Unchecked(DefinitionShape)]
Parameters = Annotated[list[dict[str, Any]], Unchecked(list[ParameterDefinition])]


class ExpressionToRead(Asked):
    """A line that shall be read (`text`), or a Value that shall be printed as one; the names are those of a step."""

    text: Annotated[str | None, Repaired()] = Field(None, max_length=10_000)
    value: Annotated[Any, Repaired()] = None
    step: Line = Field("", max_length=100)
    names: Flag = False


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

    value: Annotated[Any, Unchecked(Value)]
    text: str
    type: str
    unit: str
    problem: LineProblem | None
    names: list[LineName]


class Author(Schema):
    """Who wrote something."""

    id: int
    name: str
    initials: str


class ProgramShape(Schema):
    """A program as lists show it."""

    id: UUID
    name: str
    site: str
    kinds: StepKinds
    devices: list[str]
    places: list[str]
    edited_at: datetime
    edited_by: Author | None
    errors: int
    warnings: int


class ProgramName(Asked):
    """A name for a program."""

    name: Line = Field(max_length=200)
