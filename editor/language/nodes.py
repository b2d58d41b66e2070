"""The tree of a program: frozen, typed nodes; the ids of steps never take part in a comparison."""

from __future__ import annotations

from dataclasses import dataclass, field

from editor.language.plan import Constant, Expression, PlaceRef
from registry.capability import Scalar

MISSING = Constant(None)
"""A value that is still to be entered."""
NOWHERE = PlaceRef()
"""A place that is still to be chosen."""

Arguments = tuple[tuple[str, Expression], ...]
Point = tuple[float, float]


@dataclass(frozen=True, slots=True)
class Move:
    """The role's robot goes to a place; `added` tells that VIPO put it in before a pick or a drop elsewhere."""

    role: str
    to: PlaceRef
    route: tuple[Point, ...] = ()
    step: str = field(default="", compare=False)
    added: bool = field(default=False, compare=False)


@dataclass(frozen=True, slots=True)
class Pick:
    """The role's robot takes objects where it stands, which is `at`; `place_field` is the parameter that says so."""

    role: str
    at: PlaceRef
    object: Expression
    quantity: Expression
    step: str = field(default="", compare=False)
    place_field: str = field(default="at", compare=False)
    route: tuple[Point, ...] = field(default=(), compare=False)


@dataclass(frozen=True, slots=True)
class Drop:
    """The role's robot leaves objects where it stands, which is `at`; `route` is the way there that was drawn."""

    role: str
    at: PlaceRef
    object: Expression
    quantity: Expression
    step: str = field(default="", compare=False)
    place_field: str = field(default="at", compare=False)
    route: tuple[Point, ...] = field(default=(), compare=False)


@dataclass(frozen=True, slots=True)
class Operate:
    """A device carries out one of its methods; arguments are sorted by name, missing ones left out."""

    device: PlaceRef
    method: str
    arguments: Arguments = ()
    step: str = field(default="", compare=False)


@dataclass(frozen=True, slots=True)
class Wait:
    """Wait for a time in seconds."""

    seconds: Expression
    step: str = field(default="", compare=False)


@dataclass(frozen=True, slots=True)
class WaitUntil:
    """Wait until a condition holds, at most `timeout_s` seconds when that is given."""

    condition: Expression
    timeout_s: Expression | None = None
    step: str = field(default="", compare=False)


@dataclass(frozen=True, slots=True)
class If:
    """One of two branches."""

    condition: Expression
    then: Block = ()
    otherwise: Block = ()
    step: str = field(default="", compare=False)


@dataclass(frozen=True, slots=True)
class While:
    """The body again and again while the condition holds."""

    condition: Expression
    body: Block = ()
    step: str = field(default="", compare=False)


@dataclass(frozen=True, slots=True)
class Parallel:
    """All branches at once; what follows begins when all have ended."""

    branches: tuple[Block, ...] = ()
    step: str = field(default="", compare=False)


@dataclass(frozen=True, slots=True)
class Try:
    """The body, and `catch` when it fails with one of `kinds` (none: any)."""

    kinds: tuple[str, ...] = ()
    body: Block = ()
    catch: Block = ()
    step: str = field(default="", compare=False)


@dataclass(frozen=True, slots=True)
class Call:
    """A function of this program, by its method name (empty: still to be chosen)."""

    function: str
    arguments: Arguments = ()
    step: str = field(default="", compare=False)


Node = Move | Pick | Drop | Operate | Wait | WaitUntil | If | While | Parallel | Try | Call
Block = tuple[Node, ...]


@dataclass(frozen=True, slots=True)
class Parameter:
    """A parameter of a function or of the program, under its name in the script; an empty type is not known."""

    name: str
    default: Scalar = None
    type: str = field(default="", compare=False)
    unit: str = field(default="", compare=False)


@dataclass(frozen=True, slots=True)
class Function:
    """A function: `method` is its name in the script, `id` and `name` those in the document."""

    method: str
    parameters: tuple[Parameter, ...] = ()
    body: Block = ()
    id: str = field(default="", compare=False)
    name: str = field(default="", compare=False)


@dataclass(frozen=True, slots=True)
class Role:
    """A robot of the program, under its name in the script: one device, or any that can do all of `can`.

    `at` is the device where it stands at the beginning, when the program relies on that.
    """

    name: str
    device: str | None = None
    can: tuple[str, ...] = ()
    at: str | None = None
    id: str = field(default="", compare=False)


@dataclass(frozen=True, slots=True)
class Tree:
    """A whole program."""

    body: Block = ()
    functions: tuple[Function, ...] = ()
    roles: tuple[Role, ...] = ()
    parameters: tuple[Parameter, ...] = ()


_COMPOSITES = frozenset({If, While, Parallel, Try})


def blocks_of(node: Node) -> tuple[Block, ...]:
    """Return the branches of a node, in reading order."""
    if node.__class__ not in _COMPOSITES:
        return ()
    match node:
        case If(then=then, otherwise=otherwise):
            return (then, otherwise)
        case While(body=body):
            return (body,)
        case Parallel(branches=branches):
            return branches
        case Try(body=body, catch=catch):
            return (body, catch)
    return ()
