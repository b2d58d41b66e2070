"""What the floor is told (events) and what it wants done (actions)."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import asdict, dataclass, field
from typing import Any

from editor.language.expressions.nodes import Zone
from editor.language.site.surroundings import ZoneFacts
from execution.machine.floor_task import TaskOrder
from vipo_device.protocol.description import Scalar

CONTROLS = ("pause", "resume", "cancel")
"""Methods about a command that a device has already; every device knows them."""
HALTING_CONTROLS = ("pause", "cancel")
"""Those after which less moves than before: they go out, whatever was stopped since."""


@dataclass(frozen=True, slots=True)
class Reason:
    """Why something waits: a code with arguments for translation, and the sentence in English."""

    code: str
    text: str
    args: Mapping[str, Scalar] = field(default_factory=dict)


@dataclass(frozen=True, slots=True)
class FloorZone:
    """A zone of a run's program, or of the site's floor; `key` is the same for all runs of that program."""

    key: str
    name: str
    rule: str
    points: tuple[tuple[float, float], ...]
    speed_m_s: float | None = None
    door: str = ""
    """The device that is opened for who drives through, where the rule is `door`."""
    robots: int = 1
    """How many may be in it at once, where the rule is `one_at_a_time`."""
    heading_deg: float | None = None
    """Where robots drive, where the rule is `one_way`: degrees from the x axis, counter-clockwise."""
    open_until: float = 0.0
    """Until when robots drive in freely, where the rule is `release`: seconds since 1970."""

    def is_open(self, now: float) -> bool:
        """Tell whether robots need not be let in one by one just now, where the rule is `release`."""
        return self.rule == "release" and self.open_until > now


def zone_from_json(data: Mapping[str, Any]) -> FloorZone:
    """Read a zone from plain JSON."""
    return FloorZone(**{**data, "points": tuple((float(x), float(y)) for x, y in data["points"])})


def floor_zones(program: str, zones: Iterable[Zone]) -> tuple[FloorZone, ...]:
    """Return the zones of a plan as the floor knows them."""
    return tuple(FloorZone(f"{program}/{z.id}", z.name, z.rule, z.points, z.speed_m_s, z.door) for z in zones)


def site_zones(zones: Iterable[ZoneFacts]) -> tuple[FloorZone, ...]:
    """Return the zones of a site's floor as the floor knows them; no program has their keys."""
    return tuple(
        FloorZone(f"site/{z.id}", z.name, z.rule, z.points, z.speed_m_s, robots=z.robots, heading_deg=z.heading_deg)
        for z in zones
    )


def zone_to_json(zone: FloorZone) -> dict[str, Any]:
    """Return a zone as plain JSON; what the version before did not know only where it says something."""
    usual = {"door": "", "robots": 1, "heading_deg": None, "open_until": 0.0}
    return {name: value for name, value in asdict(zone).items() if name not in usual or value != usual[name]}


@dataclass(frozen=True, slots=True)
class TaskAsked:
    """A run asks for a task. `wants` names the device of the role, or `can` what its robot must be able to do.

    `where` is the condition that must hold of any robot when it is chosen, as plans keep it in JSON (empty: none), and
    `said` the same in words; `holds` is how many objects it must be able to hold at once (0: one will do). `priority`
    of the run is -1, 0 or 1, `due` its deadline in seconds since 1970 (0: none).
    """

    run: str
    task: int
    order: TaskOrder
    wants: str = ""
    can: tuple[str, ...] = ()
    run_name: str = ""
    zones: tuple[FloorZone, ...] = ()
    where: Mapping[str, object] = field(default_factory=dict)
    said: str = ""
    priority: int = 0
    due: float = 0.0
    holds: int = 0


@dataclass(frozen=True, slots=True)
class TaskCancelled:
    """A run does not want the task any more; a robot settles at the next safe point."""

    run: str
    task: int


@dataclass(frozen=True, slots=True)
class RobotMoved:
    """A robot says where it is: metres and radians in the map's frame."""

    robot: str
    x: float
    y: float
    theta: float = 0.0


@dataclass(frozen=True, slots=True)
class RobotsReport:
    """What robots and doors report now, by device: what depends on it is decided in this step, nothing is kept."""

    readings: Mapping[str, Mapping[str, Scalar]]


@dataclass(frozen=True, slots=True)
class CommandAnswered:
    """A device answers a command: ACCEPTED, RUNNING, DONE, FAILED, REJECTED or CANCELED."""

    command: str
    status: str
    why: str = ""
    result: Mapping[str, Scalar] = field(default_factory=dict)


@dataclass(frozen=True, slots=True)
class DeviceOnline:
    """A device is there."""

    device: str


@dataclass(frozen=True, slots=True)
class DeviceOffline:
    """A device has gone."""

    device: str


@dataclass(frozen=True, slots=True)
class Tick:
    """Time has passed."""


@dataclass(frozen=True, slots=True)
class StopPressed:
    """Everything stops where it is."""


@dataclass(frozen=True, slots=True)
class StopReset:
    """The stop is over; runs stay paused until they are resumed by hand."""


@dataclass(frozen=True, slots=True)
class RunPaused:
    """Nothing new is begun for the run; its robots stop at the end of what is released."""

    run: str


@dataclass(frozen=True, slots=True)
class RunResumed:
    """The run goes on."""

    run: str


@dataclass(frozen=True, slots=True)
class RunOver:
    """The run has ended: its tasks are dropped and its robots are free."""

    run: str


@dataclass(frozen=True, slots=True)
class RobotLetIn:
    """A person lets a robot into a zone of the site, by its key, for one visit."""

    zone: str
    robot: str


@dataclass(frozen=True, slots=True)
class CallSent:
    """A person has told a device to do something, outside of any run; `name` is what others wait for meanwhile."""

    command: str
    device: str
    method: str
    arguments: Mapping[str, object]
    name: str = ""


@dataclass(frozen=True, slots=True)
class CallCancelled:
    """A person's command is not wanted any more, or was not answered; `given_up`: no answer is awaited."""

    command: str
    given_up: bool = False


Event = (
    CallSent | CallCancelled | TaskAsked | TaskCancelled | RobotMoved | RobotsReport | CommandAnswered | DeviceOnline
    | DeviceOffline | Tick | StopPressed | StopReset | RunPaused | RunResumed | RunOver | RobotLetIn
)  # fmt: skip


@dataclass(frozen=True, slots=True)
class SendCommand:
    """Send a device a command. `run` and `step` are for the log; pieces of a path have `piece` set."""

    id: str
    device: str
    method: str
    arguments: Mapping[str, object]
    run: str = ""
    step: str = ""
    piece: bool = False


@dataclass(frozen=True, slots=True)
class TaskOver:
    """A task is done (`kind` is empty) or has failed, with the kind of failure and the reason."""

    run: str
    task: int
    kind: str = ""
    why: str = ""
    result: Mapping[str, Scalar] = field(default_factory=dict)


@dataclass(frozen=True, slots=True)
class RoleBound:
    """A role has found its robot and keeps it until the run ends or releases it."""

    run: str
    role: str
    robot: str


@dataclass(frozen=True, slots=True)
class RoleReleased:
    """A role has given its robot back; one that is `bound` to it gets the same again."""

    run: str
    role: str
    robot: str
    bound: bool = False


@dataclass(frozen=True, slots=True)
class WaitChanged:
    """What a task waits for has changed; None: it goes on."""

    run: str
    task: int
    step: str
    robot: str
    reason: Reason | None


@dataclass(frozen=True, slots=True)
class TaskTold:
    """Something that people shall read of a task that goes on or is just over; `reason` says what."""

    run: str
    task: int
    step: str
    robot: str
    reason: Reason


@dataclass(frozen=True, slots=True)
class PathPlanned:
    """A robot has a new path, as a drawn line in metres."""

    robot: str
    run: str
    path: tuple[tuple[float, float], ...]


@dataclass(frozen=True, slots=True)
class DoorStuck:
    """A door has kept robots waiting too long: people should look at it. `why` is what it said, if anything."""

    device: str
    method: str
    why: str = ""


Action = DoorStuck | SendCommand | TaskOver | RoleBound | RoleReleased | WaitChanged | TaskTold | PathPlanned
