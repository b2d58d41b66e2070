"""What a simulated world offers: commands in, time forward, events out. Physics and kinematics both offer it."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from math import inf
from typing import Literal, Protocol

from registry.floorplan.plan import FREE, Grid
from simulation.behaviour import Kind
from vipo_device.protocol.description import Description, Pose, Scalar
from vipo_device.protocol.messages import AckStatus, is_final

MOST_SEED = 2**31 - 1
"""The largest seed that can be asked for; the least is 0, which leaves nothing to chance in rehearsals."""
DELIVERY_S = 60.0
"""After so long people see to a simulated machine that is empty or full."""
FaultKind = Literal[
    "stop", "fail_next", "offline", "lose_ack", "late", "dead", "deaf", "doubled", "wrong_value", "drops", "battery",
    "obstacle",
]  # fmt: skip


@dataclass(frozen=True, slots=True)
class Fault:
    """Something that goes wrong on purpose: `device` does `kind` from `at_s` on, for `for_s` seconds.

    With a `step` it begins when that is entered for the `nth` time, with `odds` at each command with this chance.
    `error` is what the device says of a failure, `after_s` how late answers are, `name` and `value` what a reading
    shows wrongly; `value` is also the charge (%) that a battery falls to. An obstacle belongs to no device: it is a
    thing of `size_m` at (`x`, `y`).
    """

    device: str
    kind: FaultKind
    at_s: float = 0.0
    step: str = ""
    nth: int = 1
    odds: float = 0.0
    for_s: float = inf
    error: str = ""
    after_s: float = 0.0
    name: str = ""
    value: Scalar = ""
    x: float = 0.0
    y: float = 0.0
    size_m: float = 0.5


@dataclass(frozen=True, slots=True)
class Obstacle:
    """A round thing on the floor that is on no map: its middle and how wide it is, metres."""

    x: float
    y: float
    size_m: float


@dataclass(frozen=True, slots=True)
class Ack:
    """A device's answer to a command."""

    t_s: float
    device: str
    command: str
    status: AckStatus
    why: str = ""
    result: Mapping[str, Scalar] = field(default_factory=dict)

    @property
    def is_final(self) -> bool:
        """True when the command is over."""
        return is_final(self.status)


@dataclass(frozen=True, slots=True)
class Scene:
    """All that a world is made from; what is not said begins as if nothing had happened yet.

    `stocks` says what each machine holds, `poses` where a robot stands (its description says where it is at home),
    `carrying` what it carries, `readings` what properties show. After `delivery_s` (none: never) an empty source is
    filled, a full sink is emptied and a robot whose battery is empty gets a full one, as people would do; where
    `delivered` is said, that is done to these devices alone. `bodiless`
    machines are not in anybody's way. `remembered` are the final answers that devices would give again, oldest first.
    `kinds` say how devices behave (none: those that VIPO comes with); the seed 0 leaves nothing to chance, each
    other one is a course of its own. `paces` say, by device and method, how many times as long as that something takes:
    what was measured at the real ones. `idless` devices describe themselves by the paper's message: the real ones know
    no command by its id, so nobody sends them one twice.
    """

    grid: Grid
    devices: Sequence[Description]
    seed: int = 0
    faults: Sequence[Fault] = ()
    stocks: Mapping[str, Mapping[str, int]] = field(default_factory=dict)
    poses: Mapping[str, Pose] = field(default_factory=dict)
    carrying: Mapping[str, Mapping[str, int]] = field(default_factory=dict)
    readings: Mapping[str, Mapping[str, Scalar]] = field(default_factory=dict)
    delivery_s: float | None = None
    delivered: frozenset[str] | None = None
    bodiless: frozenset[str] = frozenset()
    remembered: Mapping[str, Sequence[Ack]] = field(default_factory=dict)
    kinds: Sequence[Kind] | None = None
    paces: Mapping[str, Mapping[str, float]] = field(default_factory=dict)
    idless: frozenset[str] = frozenset()


@dataclass(frozen=True, slots=True)
class PropertyChanged:
    """A reading changed."""

    t_s: float
    device: str
    name: str
    value: Scalar


@dataclass(frozen=True, slots=True)
class Contact:
    """Two bodies touched or came nearer than their clearance; `other` is a device id or `wall`."""

    t_s: float
    device: str
    other: str
    distance_m: float
    x: float
    y: float


@dataclass(frozen=True, slots=True)
class FaultBegan:
    """A fault on purpose begins."""

    t_s: float
    fault: Fault


def open_floor(around: Pose) -> Grid:
    """Return a floor without walls: where nobody asks whether a path is free, but how long it takes."""
    half_m = 5_000.0
    return Grid(1, 1, 2 * half_m, around.x - half_m, around.y - half_m, bytes([FREE]))


WorldEvent = Ack | PropertyChanged | Contact | FaultBegan


@dataclass(frozen=True, slots=True)
class RobotSnapshot:
    """Where a robot is, how fast it drives, and what it carries."""

    pose: Pose
    speed_m_s: float
    carrying: Mapping[str, int]
    battery: float


class World(Protocol):
    """A simulated world in virtual time; not thread-safe, one per process when it is physics."""

    @property
    def time_s(self) -> float:
        """Return the virtual time."""

    def command(self, device: str, method: str, arguments: Mapping[str, object], command: str) -> None:
        """Give a device a command, as a message on its topic would; answers come as Ack events."""

    def advance(self, seconds: float) -> list[WorldEvent]:
        """Let time pass and return what happened, oldest first."""

    def reach(self, step: str) -> None:
        """Say that a step of the program is entered, with which faults may begin."""

    def put_in_the_way(self, obstacles: Sequence[Obstacle]) -> None:
        """Say what stands on the floor that is on no map, besides faults; what stood there before is gone."""

    def hold(self, *, active: bool) -> None:
        """Stop everything where it is, as the site's stop does, until it is called again with False."""

    def robots(self) -> Mapping[str, RobotSnapshot]:
        """Return every robot's state."""

    def readings(self) -> Mapping[str, Mapping[str, Scalar]]:
        """Return every device's properties."""

    def busy(self) -> Mapping[str, bool]:
        """Return, for each device, whether it is doing something (the paper's `done`, negated)."""

    def stocks(self) -> Mapping[str, Mapping[str, int]]:
        """Return what each machine holds."""

    def set_stock(self, machine: str, stock: Mapping[str, int]) -> None:
        """Say what a machine holds by now, as after a delivery."""

    def remembered(self) -> Mapping[str, Sequence[Ack]]:
        """Return the final answers that each device would give again, oldest first (at most 16)."""

    def under_way(self) -> Mapping[str, Sequence[str]]:
        """Return the commands that each device has begun or queued."""

    def close(self) -> None:
        """Give back what the world holds."""
