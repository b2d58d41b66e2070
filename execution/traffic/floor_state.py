"""The state of a site's floor between two events; plain JSON when it is stored."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import asdict, dataclass, field, fields
from typing import Any

from execution.machine.floor_task import TaskOrder, order_from_json
from execution.traffic.layout import Node
from execution.traffic.messages import FloorZone, Reason, zone_from_json, zone_to_json
from registry.floorplan.coverage import Lane

STATE_FORMAT = 1


@dataclass(frozen=True, slots=True)
class Robot:
    """A robot on the floor. `path` leads from `path[passed]`, where it is or was last, to its goal.

    It may drive up to `path[released]`; `held` are the cells that nobody else may enter. At rest the path has one node.
    """

    id: str
    x: float
    y: float
    theta: float = 0.0
    path: tuple[Node, ...] = ()
    passed: int = 0
    released: int = 0
    held: tuple[int, ...] = ()
    online: bool = True
    run: str = ""
    evading: str = ""
    """The robot that it makes room for, or `home`: not for its own task."""
    yields_to: str = ""
    yields_since: float = 0.0
    blocked_since: float | None = None
    idle_since: float = 0.0
    progress_at: float = 0.0
    refusals: int = 0
    """How many pieces of path in turn it has refused."""
    route_of: str = ""
    """The task (`run/number`) along whose route the path leads; empty: none."""
    route_at: tuple[int, ...] = ()
    """Where on the path the points of the route are that are still ahead."""


@dataclass(frozen=True, slots=True)
class FloorTask:
    """A task on the floor; `command` is set while a device carries it out."""

    run: str
    number: int
    seq: int
    order: TaskOrder
    wants: str = ""
    can: tuple[str, ...] = ()
    run_name: str = ""
    robot: str = ""
    command: str = ""
    arrived: bool = False
    wait: Reason | None = None
    absent_since: float | None = None
    """Since when the device that it waits for has been away; left as it was while it waits for none."""
    where: Mapping[str, object] = field(default_factory=dict)
    """What must hold of any robot when it is chosen, as plans keep it in JSON; empty: nothing."""
    said: str = ""
    """The same in words."""
    priority: int = 0
    """Of its run: -1 low, 0 normal, 1 high."""
    due: float = 0.0
    """When its run should be over, in seconds since 1970; 0: no deadline."""
    behind_since: float | None = None
    """Since when it has found no robot and others went first; None: not yet."""
    holds: int = 0
    """How many objects any robot must be able to hold at once when it is chosen; 0: one will do."""
    points_passed: int = 0
    """How many points of its route, or of its lanes, the robot has driven over, in their order."""
    lanes: tuple[Lane, ...] = ()
    """The lanes of a cover, in their order, worked out when it has its robot."""
    put_off: int = 0
    """How many points at the end of the lanes were in somebody's way before, and are tried a second time."""


@dataclass(frozen=True, slots=True)
class Sent:
    """A command under way: a robot's piece of path ends at path index `upto`; else it carries out a task."""

    id: str
    device: str
    run: str = ""
    task: int = -1
    upto: int = -1
    at: float = 0.0
    limit_s: float = 0.0
    held_up: bool = False
    told: str = ""
    """The method that a door is told; empty for all other devices."""


@dataclass(frozen=True, slots=True)
class Door:
    """A door that robots pass, as far as it concerns them."""

    id: str
    is_open: bool = False
    ours: bool = False
    """It was opened here and is to be closed here."""
    command: str = ""
    """The opening or closing under way."""
    robots: tuple[str, ...] = ()
    """Who is in the passage or will be soon."""
    shut_since: float | None = None
    """Since when robots have needed it without its being open, or while it was away."""
    needed_at: float = 0.0
    moved_at: float = 0.0
    retry_at: float = 0.0
    why: str = ""
    """What it said last when it did not do what it was told."""


@dataclass(frozen=True, slots=True)
class Admission:
    """A person has let a robot into a zone, by their keys, at a time (s); `entered` once it is or was in it since."""

    zone: str
    robot: str
    at: float = 0.0
    entered: bool = False


@dataclass(frozen=True, slots=True)
class FloorState:
    """All that traffic knows. `namespace` makes the command ids of this floor its own."""

    namespace: str
    now: float = 0.0
    next_seq: int = 1
    stopped: bool = False
    robots: Mapping[str, Robot] = field(default_factory=dict)
    tasks: tuple[FloorTask, ...] = ()
    sent: Mapping[str, Sent] = field(default_factory=dict)
    calls: Mapping[str, str] = field(default_factory=dict)
    """By machine: the run whose call it carries out."""
    stations: Mapping[str, str] = field(default_factory=dict)
    """By machine: the robot that it serves."""
    roles: Mapping[str, str] = field(default_factory=dict)
    """By `run/role`: the robot that it has found."""
    names: Mapping[str, str] = field(default_factory=dict)
    """What people call the runs."""
    paused: tuple[str, ...] = ()
    offline: Mapping[str, float] = field(default_factory=dict)
    """By device: since when it has been away."""
    zones: Mapping[str, tuple[FloorZone, ...]] = field(default_factory=dict)
    """By run: the zones of its program; under no name those of the site that its robots heed already."""
    locks: Mapping[str, str] = field(default_factory=dict)
    """By zone for one robot at a time: the robot that is in it."""
    passages: tuple[FloorZone, ...] = ()
    """The passages of doors that runs have told of; they hold for every robot."""
    doors: Mapping[str, Door] = field(default_factory=dict)
    admissions: tuple[Admission, ...] = ()
    awaiting: Mapping[str, str] = field(default_factory=dict)
    """By robot: the key of the zone that it waits to be let into."""
    lattice: str = ""
    """By which lattice cells are numbered, as `Layout.numbering` says."""


STORED_AS: Mapping[type, Mapping[str, str]] = {
    Robot: {"path": "way"},
    FloorTask: {"number": "mission"},
    Sent: {"task": "mission"},
}
"""What kept states call the parts that have got another name since; the tasks themselves they call `jobs`."""


LATER = frozenset({"passages", "doors", "admissions", "awaiting", "lattice"})
"""Parts that states did not have at first: they are written where they say something."""
WRITTEN_WHERE_SET = frozenset(
    {
        "where",
        "said",
        "holds",
        "priority",
        "due",
        "behind_since",
        "points_passed",
        "route_of",
        "route_at",
        "lanes",
        "put_off",
        "told",
    }
)
"""Parts that are written only where they say something, so that the version before reads all other states."""


def to_json(state: FloorState) -> dict[str, Any]:
    """Return the state as plain JSON."""
    whole = {f.name: getattr(state, f.name) for f in fields(state) if f.name != "tasks"}
    stored = {
        **whole,
        "format": STATE_FORMAT,
        "robots": [_stored(robot) for robot in state.robots.values()],
        "jobs": [_stored(task) for task in state.tasks],
        "sent": [_stored(sent) for sent in state.sent.values()],
        "calls": dict(state.calls),
        "stations": dict(state.stations),
        "roles": dict(state.roles),
        "names": dict(state.names),
        "offline": dict(state.offline),
        "zones": {run: [zone_to_json(zone) for zone in zones] for run, zones in state.zones.items()},
        "locks": dict(state.locks),
        "passages": [zone_to_json(zone) for zone in state.passages],
        "doors": [asdict(door) for door in state.doors.values()],
        "admissions": [asdict(admission) for admission in state.admissions],
        "awaiting": dict(state.awaiting),
    }
    return {name: value for name, value in stored.items() if value or name not in LATER}


def from_json(data: Mapping[str, Any]) -> FloorState:
    """Read what `to_json` wrote."""
    if data["format"] != STATE_FORMAT:
        raise ValueError(f"A floor's state of format {data['format']} cannot be read; this reads {STATE_FORMAT}.")
    robots = [_robot(item) for item in data["robots"]]
    sent = [Sent(**_known(item, Sent)) for item in data["sent"]]
    more = {
        "robots": {robot.id: robot for robot in robots},
        "tasks": tuple(_task(item) for item in data["jobs"]),
        "sent": {item.id: item for item in sent},
        "paused": tuple(data["paused"]),
        "zones": {run: tuple(map(zone_from_json, zones)) for run, zones in data.get("zones", {}).items()},
        "passages": tuple(map(zone_from_json, data.get("passages", ()))),
        "doors": {item["id"]: Door(**{**item, "robots": tuple(item["robots"])}) for item in data.get("doors", ())},
        "admissions": tuple(Admission(**item) for item in data.get("admissions", ())),
    }
    return FloorState(**{**{key: value for key, value in data.items() if key not in {"format", "jobs"}}, **more})


def _stored(item: Robot | FloorTask | Sent) -> dict[str, Any]:
    stored = asdict(item)
    for name, key in STORED_AS[type(item)].items():
        stored[key] = stored.pop(name)
    return {name: value for name, value in stored.items() if value or name not in WRITTEN_WHERE_SET}


def _known(data: Mapping[str, Any], kind: type) -> dict[str, Any]:
    """Return what was stored of a robot, a task or a command, by the names that its parts have now."""
    known = dict(data)
    for name, key in STORED_AS[kind].items():
        known[name] = known.pop(key)
    return known


def _robot(data: Mapping[str, Any]) -> Robot:
    known = _known(data, Robot)
    route_at = tuple(known.get("route_at", ()))
    return Robot(**{**known, "path": tuple(known["path"]), "held": tuple(known["held"]), "route_at": route_at})


def _task(data: Mapping[str, Any]) -> FloorTask:
    known = _known(data, FloorTask)
    reason = Reason(**known["wait"]) if known["wait"] else None
    order = order_from_json(known["order"])
    lanes = tuple(Lane(*lane) for lane in known.get("lanes", ()))
    return FloorTask(**{**known, "order": order, "can": tuple(known["can"]), "wait": reason, "lanes": lanes})
