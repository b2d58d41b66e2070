"""What a record of a construct says: its fields, the nodes that it can be, its script and its look.

Reading, drawing, printing, parsing, the forms and chips of the editor and the API follow from records. What a
construct means stands elsewhere: in the checks, and in the plan.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

FieldType = Literal[
    "role",
    "own_robot",
    "place",
    "value",
    "values",
    "variable",
    "loop_variable",
    "choice",
    "choices",
    "route",
    "zone",
    "answer",
    "arguments",
    "method",
    "function",
    "branches",
    "whole",
    "text",
    "flag",
]
"""What can stand in a field. `own_robot`: the role whose robot does a method of its own; `variable`: the name of one
that the step sets; `loop_variable`: its body alone sees it; `choice`: one of fixed words, `choices`: several of them;
`route`: points; `zone`: one of the program; `whole`: a whole number that is written out, which only Parallel reads (a
number that a step is told is a `value` with `wanted="number"`); `text`: plain text without values."""
Wanted = Literal["", "time", "length", "number", "text", "boolean", "object", "list"]


@dataclass(frozen=True, slots=True)
class Field:
    """One thing that a step is told: a parameter in the document, an attribute of the node."""

    name: str
    type: FieldType = "value"
    wanted: Wanted = ""
    """What kind of value it takes; empty: any."""
    at: str = ""
    """The attribute of the node, where it is not called like the parameter."""
    optional: bool = False
    """Whether it may be left out; then the node has None, and the script says nothing."""
    choices: tuple[str, ...] = ()
    """The fixed words; the first is meant where none is given."""
    numbered: int = 0
    """How many of it a step may have, the others under its name with a number from 2; 0: just the one."""
    explained: bool = False
    """Whether each choice has a sentence of its own in the form."""
    suggested: str = ""
    """What a new variable is called, in a new step."""
    accepts: str = ""
    """Which places suit: machines that have `gives` or `takes` or `methods`; empty: any place of the map."""
    shown: bool = True
    """Whether the chip says it."""

    @property
    def attribute(self) -> str:
        """Return the attribute of the node."""
        return self.at or self.name


@dataclass(frozen=True, slots=True)
class Form:
    """A node that a step can be: its fields in the order of the node's attributes, and how the script writes it."""

    node: str
    """Empty where a step is no single node."""
    fields: tuple[Field, ...] = ()
    script: str = ""
    """Python in which the names of fields stand for their values; empty where a function of its own writes it."""
    example: str = ""
    """What people are told to write who have written it otherwise."""
    marked_by: str = ""
    """The field that tells this form from the last one of the construct."""


Family = Literal["motion", "machine", "logic", "func", "note"]
Shape = Literal["pill", "box", "diamond", "header", "fork", "root", "note"]


@dataclass(frozen=True, slots=True)
class Look:
    """How a construct is drawn, and where it is found."""

    icon: str
    family: Family
    shape: Shape
    key: str = ""
    """The key that takes the tool; empty: none."""
    rare: bool = False
    """Found under "more" instead of in the rail."""
    letters: int = 8
    """About how many letters its chip has beside its values."""
    tall: bool = False
    """Whether its condition stands beside the chip."""


@dataclass(frozen=True, slots=True)
class Construct:
    """A kind of step."""

    kind: str
    forms: tuple[Form, ...]
    look: Look
    branches: tuple[tuple[str, str], ...] = ()
    """The names of its branches in the document, each with the attribute of the node."""
    names_branches: bool = False
    """Whether each step names its branches itself, which the node has as one row."""
    loops: bool = False
    """Whether the body is done again and again."""
    takes_time: bool = False
    """Whether time goes by at it, so that a loop in which it stands does not just turn."""

    @property
    def fields(self) -> tuple[Field, ...]:
        """Return the fields of all forms."""
        return tuple({field.name: field for form in self.forms for field in form.fields}.values())

    @property
    def drives(self) -> bool:
        """Tell whether a robot does it."""
        return any(field.type == "role" for field in self.fields)
