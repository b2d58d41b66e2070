"""The shapes of the HTTP answers and requests about rehearsals; `execution.rehearsals.views` makes the answers."""

from __future__ import annotations

from typing import Annotated, Any, Literal

from ninja import Field, Schema
from pydantic import Strict

from editor.shapes import Compiled, Document, Position
from execution.shapes import Cause, OfVersion, Scalar, StepStatus, WaitReason
from registry.requests import Asked, Unchecked
from simulation.world import MOST_SEED

Driver = Literal["physics", "kinematic"]
Seed = Annotated[int, Strict(), Field(ge=0, lt=MOST_SEED + 1)]


class FaultsOnPurpose(Asked):
    """What goes wrong on purpose, in the form of docs/testing-programs.md; `at_step` is a step's id."""

    version: Literal[1] = 1
    faults: list[dict[str, Any]] = Field([], max_length=100)


class StartRehearsal(Asked):
    """How a rehearsal is done: with `physics`, or `kinematic` and quicker; `faults` go wrong in it on purpose."""

    version: OfVersion = None
    parameters: dict[str, Any] = {}
    seed: Seed = 0
    driver: Driver = "physics"
    faults: FaultsOnPurpose | None = None


class RehearsalError(Schema):
    """Something that the real run would meet, too."""

    t: float
    step: str
    kind: str
    message: str
    code: str
    args: dict[str, Scalar]


class RobotFigures(Schema):
    """What a robot did, and its charge at the end (%)."""

    distance_m: float
    busy_s: float
    wait_s: float
    battery: float


class MachineFigures(Schema):
    """What a machine did."""

    busy_s: float


class Encounter(Schema):
    """Two bodies that came too near, or touched."""

    t: float
    a: str
    b: str
    distance_m: float
    x: float
    y: float


class WaitShape(Schema):
    """A robot that had to wait, and why."""

    t: float
    duration_s: float
    robot: str
    reason: str
    why: WaitReason


class RehearsedStep(Schema):
    """One time that a step was carried out."""

    step: str
    count: int
    robot: str
    device: str
    started_s: float
    ended_s: float | None
    status: StepStatus


class Frames(Schema):
    """Where each robot was, every `dt_s`: x, y, theta."""

    dt_s: float
    robots: dict[str, list[tuple[float, float, float]]]


class PlannedWay(Schema):
    """A way that a robot set out on."""

    t: float
    robot: str
    path: list[Position]


class ObstacleInTheWay(Schema):
    """A thing that lay on the floor on purpose from `t` on, until it was taken away (null: to the end)."""

    t: float
    until: float | None
    x: float
    y: float
    size_m: float


class ZoneWait(Schema):
    """How long robots waited before a zone for so many at once; `mark` tells whether it is as it was then."""

    mark: str
    waited_s: float


class LogLine(Schema):
    """A line of what happened: in English, and `code` with `args` for other languages."""

    t: float
    step: str
    device: str
    text: str
    code: str
    args: dict[str, Scalar]


class RehearsalResultShape(Schema):
    """What a rehearsal found: figures, and the whole course of it."""

    ok: bool
    duration_s: float
    errors: list[RehearsalError]
    robots: dict[str, RobotFigures]
    machines: dict[str, MachineFigures]
    near_misses: list[Encounter]
    collisions: list[Encounter]
    waits: list[WaitShape]
    steps: list[RehearsedStep]
    frames: Frames
    carrying: dict[str, list[tuple[float, dict[str, int]]]]
    machine_states: dict[str, list[tuple[float, bool]]]
    properties: dict[str, list[tuple[float, str, Scalar | None]]]
    routes: list[PlannedWay]
    obstacles: list[ObstacleInTheWay]
    zone_waits: dict[str, ZoneWait]
    log: list[LogLine]


RehearsalResult = Annotated[dict[str, Any] | None, Unchecked(RehearsalResultShape | None)]


class CourseShape(Schema):
    """How far a rehearsal is: its virtual time, the step it is at, and how many steps were done once.

    `share` is of these steps; without `end_known` the program repeats some, and they do not tell when it ends.
    """

    virtual_s: float
    step: str
    steps_done: int
    steps: int
    share: float
    end_known: bool


class RehearsalSummaryShape(Schema):
    """A rehearsal without its program; `progress` goes from 0 to 1, `tries` is how often it was begun.

    Tests of a program stand in the same queue (`kind`); their results are with the program's tests.
    `place` counts from 1 in the queue of all sites, while it waits; `mine` tells whether the asker has started it.
    """

    id: str
    kind: Literal["rehearsal", "tests"]
    program: str
    program_name: str
    status: Literal["queued", "running", "done", "failed", "cancelled"]
    progress: float
    course: CourseShape | None
    place: int | None
    tries: int
    reason: str
    cause: Cause | None
    started_by: str
    mine: bool
    created_at: str
    began_at: str | None
    ended_at: str | None


class AskedFor(Schema):
    """How a rehearsal was asked for: the version, and the conditions; steps are named by their ids.

    `paces` are the measured ones that were in use, by device and method: so many times as long as the model's time.
    """

    version: int
    seed: int
    driver: Driver
    parameters: dict[str, Scalar]
    faults: list[dict[str, Any]]
    paces: dict[str, dict[str, float]] = {}


class RehearsalShape(RehearsalSummaryShape):
    """A rehearsal with its result, once there is one; how the oldest were `asked` for is not known."""

    asked: AskedFor | None
    result: RehearsalResult
    document: Document
    compiled: Compiled
