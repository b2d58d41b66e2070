"""The nodes of expressions, and the places, answers and zones that go with them: frozen values without behaviour."""

from __future__ import annotations

from typing import TYPE_CHECKING, Final, Literal

from vipo_device.protocol.description import Scalar

if TYPE_CHECKING:
    from dataclasses import dataclass
else:
    from editor.language.allocation import dataclass

Point = tuple[float, float]
"""A point of the map: x and y in metres."""


@dataclass(frozen=True, slots=True)
class Constant:
    """A value written in the program."""

    value: Scalar | tuple[Scalar, ...]


PROBLEM: Final = "problem"
"""What the script calls the failure that a Try has caught."""
OF_PROBLEM: Final = ("problem.text", "problem.kind")
"""What is known of it, under the names of variables that only a catch has: why it failed, and its kind."""


@dataclass(frozen=True, slots=True)
class Variable:
    """A parameter or a variable of the running frame."""

    name: str


@dataclass(frozen=True, slots=True)
class Reading:
    """A device's property; `device` is a Constant with its id, a Variable bound to one, or the Located of a role."""

    device: Expression
    property: str


@dataclass(frozen=True, slots=True)
class Operation:
    """An operator or a function of the closed list, applied to its arguments; `not` and `-` take one."""

    operator: str
    arguments: tuple[Expression, ...]


@dataclass(frozen=True, slots=True)
class Quantity:
    """A number with its unit as people wrote it; the compiler converts it, no plan has one."""

    value: float
    unit: str


@dataclass(frozen=True, slots=True)
class Located:
    """Something that has a place: exactly one field is set. A device's and a place's value is its id."""

    device: str | None = None
    place: str | None = None
    point: Point | None = None
    role: str | None = None
    zone: str | None = None


Expression = Constant | Variable | Reading | Operation | Quantity | Located


@dataclass(frozen=True, slots=True)
class PlaceRef:
    """Where to go: exactly one of the fields is set. `value` yields a device's or place's id when it runs."""

    device: str | None = None
    place: str | None = None
    point: Point | None = None
    value: Expression | None = None


@dataclass(frozen=True, slots=True)
class AnswerSpec:
    """What a question may be answered with: `type` is boolean, number, text or choice."""

    type: str = "boolean"
    unit: str = ""
    minimum: float | None = None
    maximum: float | None = None
    options: tuple[str, ...] = ()


@dataclass(frozen=True, slots=True)
class Zone:
    """A named area of the map: a polygon in metres that robots of this run keep out of, share, or go slowly in.

    With the rule `door` it is the passage of the device `door`, which is opened for every robot that comes.
    """

    id: str
    name: str
    rule: Literal["keep_out", "one_at_a_time", "slow", "door"]
    points: tuple[Point, ...]
    speed_m_s: float | None = None
    door: str = ""


MISSING = Constant(None)
"""A value that is still to be entered."""


def is_missing(expression: Expression) -> bool:
    """Tell whether a value is still to be entered."""
    return isinstance(expression, Constant) and expression.value is None


NOWHERE = PlaceRef()
"""A place that is still to be chosen."""
