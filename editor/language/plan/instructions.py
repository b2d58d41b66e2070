"""The plan: flat instructions that the run machine executes, each with its step and its script line."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import field
from typing import TYPE_CHECKING, Final, Literal

from editor.language.expressions.nodes import AnswerSpec, Expression, PlaceRef, Point, Zone
from vipo_device.protocol.description import Scalar

if TYPE_CHECKING:
    from dataclasses import dataclass
else:
    from editor.language.allocation import dataclass

PLAN_FORMAT = 2


@dataclass(frozen=True, slots=True)
class Move:
    """The role's robot drives to a place (to a device's station, for a device)."""

    role: str
    to: PlaceRef
    route: tuple[Point, ...] = ()


@dataclass(frozen=True, slots=True)
class Cover:
    """The role's robot drives over the whole of a zone, by its id, in lanes of `lane_m` metres; None: as wide as it."""

    role: str
    zone: str
    lane_m: Expression | None = None


@dataclass(frozen=True, slots=True)
class Pick:
    """The role's robot takes objects at a device, and is brought there first if it stands elsewhere."""

    role: str
    at: PlaceRef
    object: Expression
    quantity: Expression


@dataclass(frozen=True, slots=True)
class Drop:
    """The role's robot leaves objects at a device, and is brought there first if it stands elsewhere."""

    role: str
    at: PlaceRef
    object: Expression
    quantity: Expression


@dataclass(frozen=True, slots=True)
class Call:
    """A device carries out a method; `serves` names the role whose robot stands there (dispense, accept)."""

    device: PlaceRef
    method: str
    arguments: Mapping[str, Expression]
    serves: str | None = None


@dataclass(frozen=True, slots=True)
class Perform:
    """The role's robot carries out a method of its own where it stands."""

    role: str
    method: str
    arguments: Mapping[str, Expression]


@dataclass(frozen=True, slots=True)
class Release:
    """The role gives its robot back; one that has none has nothing to give."""

    role: str


@dataclass(frozen=True, slots=True)
class Wait:
    """Wait for a time in seconds."""

    seconds: Expression


@dataclass(frozen=True, slots=True)
class WaitUntil:
    """Wait until a condition holds; past `timeout_s` it fails as `timed out`."""

    condition: Expression
    timeout_s: Expression | None


@dataclass(frozen=True, slots=True)
class Branch:
    """Go on if the condition holds, else jump."""

    condition: Expression
    otherwise: int


@dataclass(frozen=True, slots=True)
class Jump:
    """Go on at another instruction."""

    to: int


@dataclass(frozen=True, slots=True)
class Fork:
    """Start one thread per address; the thread that forks goes on at `join` when all of them have met a Join.

    Where so many are `needed` (0: all), the others are called off as soon as that many have.
    """

    branches: tuple[int, ...]
    join: int
    needed: int = 0


@dataclass(frozen=True, slots=True)
class Join:
    """End of a forked thread."""


@dataclass(frozen=True, slots=True)
class TryBegin:
    """From here to the matching TryEnd, a failure of one of `kinds` (empty: any) goes on at `handler`.

    A `final` guard takes everything, an early End too; its handler ends in a Rethrow.
    """

    handler: int
    kinds: tuple[str, ...] = ()
    final: bool = False


@dataclass(frozen=True, slots=True)
class Caught:
    """The beginning of a handler that looks at the failure: variables of the running frame take what it was."""

    text: str
    kind: str


@dataclass(frozen=True, slots=True)
class TryEnd:
    """Leave the innermost guarded stretch of this thread."""


@dataclass(frozen=True, slots=True)
class LimitBegin:
    """From here to the matching TryEnd there are so many seconds; past them all in it ends, and fails as `timed_out`.

    What ends in it carries out `final` guards alone; guards around it take the failure as any other.
    """

    seconds: Expression


@dataclass(frozen=True, slots=True)
class Rethrow:
    """Behind a `final` handler: go on failing, or ending, as before it."""


@dataclass(frozen=True, slots=True)
class Invoke:
    """Call the function that begins at `entry` in a new frame; `result` names the variable that takes its value."""

    entry: int
    function: str
    arguments: Mapping[str, Expression]
    result: str | None = None
    shared: bool = False
    """The result is a variable of the program (frame 0), not of the running frame."""


@dataclass(frozen=True, slots=True)
class Return:
    """Leave the function's frame, with a value if it has one."""

    value: Expression | None = None


@dataclass(frozen=True, slots=True)
class Assign:
    """Set a variable: of the program (frame 0) when it is `shared`, else of the running frame."""

    name: str
    value: Expression
    shared: bool = False


@dataclass(frozen=True, slots=True)
class AskPerson:
    """Ask the people of the site and wait; past `timeout_s` it fails as `timed_out`."""

    question: Expression
    answer: AnswerSpec
    result: str | None = None
    shared: bool = False
    timeout_s: Expression | None = None


@dataclass(frozen=True, slots=True)
class Notify:
    """Tell the people of the site."""

    message: Expression
    level: str = "info"


@dataclass(frozen=True, slots=True)
class Fail:
    """Fail as `failed`, for the reason that the message is."""

    message: Expression


@dataclass(frozen=True, slots=True)
class End:
    """The program is over; roles are released. One that comes `early` carries out the `final` guards around it."""

    early: bool = False


@dataclass(frozen=True, slots=True)
class EventEnd:
    """The body of an event is over."""


Action = (
    Move | Pick | Drop | Cover | Release | Call | Perform | Wait | WaitUntil | Branch | Jump | Fork | Join
    | TryBegin | Caught | TryEnd | LimitBegin | Rethrow | Invoke | Return | Assign | AskPerson | Notify | Fail | End
    | EventEnd
)  # fmt: skip

LEAVES: Final = (
    Move, Pick, Drop, Cover, Release, Call, Perform, Wait, WaitUntil, Assign, AskPerson, Notify, Fail, End,
)  # fmt: skip
"""What is a step by itself, which a run tells of when it comes to it; all others only decide what comes next."""


@dataclass(frozen=True, slots=True)
class Instruction:
    """One instruction with where it comes from: `step` is its id (empty for glue), `line` counts from 1."""

    do: Action
    step: str = ""
    line: int = 0
    enters: tuple[str, ...] = ()
    """Steps that begin when this instruction begins (a While, a Try, a Parallel, a call)."""
    leaves: tuple[str, ...] = ()
    """Steps that are over when this instruction is over."""


@dataclass(frozen=True, slots=True)
class RoleBinding:
    """How a role finds its robot: a given device, or any that can do all of these methods.

    `where` must hold of any robot when it is chosen, a condition on the readings of its role; `said` is it in words.
    `holds` is how many objects it must be able to hold at once; 0: one will do.
    """

    role: str
    device: str | None = None
    can: tuple[str, ...] = ()
    where: Expression | None = None
    said: str = ""
    holds: int = 0


@dataclass(frozen=True, slots=True)
class EventEntry:
    """A second entry: each time the condition becomes true, beside the running program, or as a run of its own."""

    step: str
    entry: int
    condition: Expression
    starts: Literal["branch", "run"] = "branch"


@dataclass(frozen=True, slots=True)
class Plan:
    """A whole program, ready to be carried out. Execution begins at instruction 0."""

    instructions: tuple[Instruction, ...]
    roles: Mapping[str, RoleBinding] = field(default_factory=dict)
    parameters: Mapping[str, Scalar] = field(default_factory=dict)
    """The program's parameters with their defaults."""
    reads: tuple[tuple[str, str], ...] = ()
    """(device id, property) pairs that conditions look at, as far as they are known before the run."""
    format: int = PLAN_FORMAT
    events: tuple[EventEntry, ...] = ()
    zones: tuple[Zone, ...] = ()
