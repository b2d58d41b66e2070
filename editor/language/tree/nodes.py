"""The tree of a program: frozen, typed nodes; the ids of steps never take part in a comparison."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import field, replace
from operator import attrgetter
from typing import TYPE_CHECKING, Any, Final, cast, get_args

from editor.language.constructs.table import FORMS
from editor.language.expressions.nodes import AnswerSpec, Expression, PlaceRef, Point, Variable

if TYPE_CHECKING:
    from dataclasses import dataclass
else:
    from editor.language.allocation import dataclass

YES_OR_NO = AnswerSpec()
Arguments = tuple[tuple[str, Expression], ...]


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
class Perform:
    """The role's robot carries out a method of its own where it stands: an Operate whose device is a robot."""

    role: str
    method: str
    arguments: Arguments = ()
    step: str = field(default="", compare=False)


@dataclass(frozen=True, slots=True)
class Cover:
    """The role's robot drives over the whole of a zone (its id), in lanes of `lane_m` metres; None: as wide as it."""

    role: str
    zone: str = ""
    lane_m: Expression | None = None
    step: str = field(default="", compare=False)


@dataclass(frozen=True, slots=True)
class Release:
    """The role gives its robot back; used again it gets one anew."""

    role: str
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
class Repeat:
    """The body so many times."""

    times: Expression
    body: Block = ()
    step: str = field(default="", compare=False)


@dataclass(frozen=True, slots=True)
class ForEach:
    """The body once for each item, which `variable` holds; `index` holds the number of the round, from 1."""

    variable: str
    items: tuple[Expression, ...] = ()
    index: str = ""
    over: Variable | None = None
    """The variable whose list it goes through; then there are no `items`."""
    body: Block = ()
    step: str = field(default="", compare=False)

    @property
    def names(self) -> tuple[str, ...]:
        """Return the names that its body alone sees."""
        return tuple(name for name in (self.variable, self.index) if name)


@dataclass(frozen=True, slots=True)
class Set:
    """A variable takes a value (empty: still to be named)."""

    variable: str
    value: Expression
    step: str = field(default="", compare=False)


@dataclass(frozen=True, slots=True)
class Ask:
    """The people of the site are asked; the program waits for the answer."""

    question: Expression
    answer: AnswerSpec = YES_OR_NO
    variable: str = ""
    timeout_s: Expression | None = None
    step: str = field(default="", compare=False)


@dataclass(frozen=True, slots=True)
class Notify:
    """The people of the site are told something; level is info or warning."""

    message: Expression
    level: str = "info"
    step: str = field(default="", compare=False)


@dataclass(frozen=True, slots=True)
class End:
    """The program ends here."""

    step: str = field(default="", compare=False)


@dataclass(frozen=True, slots=True)
class Fail:
    """The program fails here, as `failed`, with a text; a Try around it may catch that."""

    message: Expression
    step: str = field(default="", compare=False)


@dataclass(frozen=True, slots=True)
class Return:
    """The function ends here, with a value if it gives one."""

    value: Expression | None = None
    step: str = field(default="", compare=False)


@dataclass(frozen=True, slots=True)
class Break:
    """The innermost loop ends here."""

    step: str = field(default="", compare=False)


@dataclass(frozen=True, slots=True)
class Continue:
    """The innermost loop goes on with its next round."""

    step: str = field(default="", compare=False)


@dataclass(frozen=True, slots=True)
class Parallel:
    """All branches at once; what follows begins when all have ended, or `needed` of them: the others are called off."""

    branches: tuple[Block, ...] = ()
    needed: int | None = None
    step: str = field(default="", compare=False)

    @property
    def races(self) -> bool:
        """Tell whether it may end before all of its branches have."""
        return self.needed is not None and self.needed < len(self.branches)


@dataclass(frozen=True, slots=True)
class Catch:
    """What a Try does about a failure of one of these kinds (none: any); `branch` is its name in the document."""

    kinds: tuple[str, ...] = ()
    block: Block = ()
    branch: str = field(default="", compare=False)

    def takes(self, kind: str) -> bool:
        """Tell whether a failure of this kind is one of its."""
        return not self.kinds or kind in self.kinds


@dataclass(frozen=True, slots=True)
class Try:
    """The body, the first of `handlers` that takes its failure, and `final` whatever happens.

    Without handlers, and where none takes it, a failure goes on outwards.
    """

    body: Block = ()
    handlers: tuple[Catch, ...] = ()
    final: Block = ()
    step: str = field(default="", compare=False)

    @property
    def kinds(self) -> tuple[tuple[str, ...], ...]:
        """Return what each of its catches takes."""
        return tuple(handler.kinds for handler in self.handlers)

    @property
    def catches(self) -> tuple[Block, ...]:
        """Return the steps of each of its catches."""
        return tuple([handler.block for handler in self.handlers])


@dataclass(frozen=True, slots=True)
class Limit:
    """The body, which may take so many seconds; what is then under way in it is called off, and it has timed out."""

    seconds: Expression
    body: Block = ()
    step: str = field(default="", compare=False)


@dataclass(frozen=True, slots=True)
class Call:
    """A function of this program, by its method name (empty: still to be chosen)."""

    function: str
    arguments: Arguments = ()
    result: str = ""
    """The variable that takes what the function gives."""
    step: str = field(default="", compare=False)


Node = (
    Move | Pick | Drop | Cover | Release | Operate | Perform | Wait | WaitUntil | If | While | Repeat | ForEach
    | Parallel | Try | Limit | Call | Set | Ask | Notify | End | Fail | Return | Break | Continue
)  # fmt: skip
Block = tuple[Node, ...]
LOADS: Final = (Pick, Drop)
DRIVES: Final = (Move, Pick, Drop, Cover)
"""Every node with a field of type `role` but Release, also what is done where the robot stands.

(A check of a class against such a row is several times as quick as against a union.)
"""
ACTS: Final = (*DRIVES, Perform)
"""What a robot does, there or where it stands."""
OF_ROBOTS: Final = (*ACTS, Release)
"""What names a role."""


@dataclass(frozen=True, slots=True)
class Event:
    """A second entry: the body runs each time the condition becomes true."""

    condition: Expression
    body: Block = ()
    starts: str = "branch"
    step: str = field(default="", compare=False)


def robot_field(node: Node) -> str:
    """Return the parameter of a robot's step that says which robot it is."""
    return "device" if isinstance(node, Perform) else "role"


ERROR_CLASSES: Final[Mapping[str, str]] = {
    "refused": "Refused",
    "failed": "Failed",
    "timed_out": "TimedOut",
    "offline": "Offline",
    "blocked": "Blocked",
    "cancelled": "Cancelled",
}
"""The kinds of failures that a Try may catch, with their classes in the script."""
NODES: Final[Mapping[str, type[Any]]] = {node.__name__: node for node in (*get_args(Node), Event)}
"""The classes of nodes, by the names that the records of constructs call them by."""


def _getter(attributes: tuple[str, ...]) -> Callable[[Node], tuple[Block, ...]]:
    """Return what reads these branches of a node."""
    if len(attributes) > 1:
        return attrgetter(*attributes)
    only: Callable[[Node], Block] = attrgetter(attributes[0])
    return lambda node: (only(node),)


def _of_try(node: Any) -> tuple[Block, ...]:
    return (node.body, *node.catches, node.final)


_BRANCHES: Final[Mapping[type[Node], tuple[str, ...]]] = {
    NODES[name]: tuple(attribute for _, attribute in construct.branches) for name, (construct, _) in FORMS.items()
}
_BLOCKS: Final[Mapping[type[Node], Callable[[Node], tuple[Block, ...]]]] = {
    NODES[name]: attrgetter("branches")
    if construct.names_branches
    else _getter(tuple(attribute for _, attribute in construct.branches))
    for name, (construct, _) in FORMS.items()
    if (construct.branches or construct.names_branches) and NODES[name] is not Event
} | {Try: _of_try}
COMPOSITES = frozenset(_BLOCKS)
"""The nodes that hold others."""


def blocks_of(node: Node) -> tuple[Block, ...]:
    """Return the branches of a node, in reading order."""
    get = _BLOCKS.get(node.__class__)
    return () if get is None else get(node)


def with_blocks(node: Node, blocks: tuple[Block, ...]) -> Node:
    """Return a node that holds others with these branches, in the order of `blocks_of`."""
    if isinstance(node, Parallel):
        return replace(node, branches=blocks)
    if isinstance(node, Try):
        body, *caught, final = blocks
        handlers = tuple(replace(each, block=block) for each, block in zip(node.handlers, caught, strict=True))
        return replace(node, body=body, handlers=handlers, final=final)
    whole: Any = node
    return cast("Node", replace(whole, **dict(zip(_BRANCHES[node.__class__], blocks, strict=True))))


def walk(block: Block) -> list[Node]:
    """Return the nodes of a block and of everything in it, in reading order."""
    nodes: list[Node] = []
    _gather(block, nodes)
    return nodes


def _gather(block: Block, nodes: list[Node]) -> None:
    for node in block:
        nodes.append(node)
        get = _BLOCKS.get(node.__class__)
        if get is not None:
            for inner in get(node):
                _gather(inner, nodes)
