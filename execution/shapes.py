"""The shapes of execution's HTTP answers and requests; `execution.views` makes the answers."""

from __future__ import annotations

from typing import Annotated, Any, Literal
from uuid import UUID

from ninja import Field, Schema
from pydantic import AwareDatetime, ConfigDict, Strict

from editor.shapes import MOST_COMMENT, MOST_MENTIONS, Compiled, DevicePlace, Document, NamedPlace, PointPlace, Position
from registry.requests import Asked, Flag, Line, Number, Unchecked

RunStatus = Literal["pending", "running", "paused", "finished", "failed", "cancelled"]
StepStatus = Literal["waiting", "running", "done", "failed", "skipped"]
Scalar = bool | int | float | str
Priority = Literal["low", "normal", "high"]
MapVersion = Annotated[int, Strict(), Field(ge=0, lt=2**31)]
MapTag = Annotated[Line, Field(max_length=160)]


class RunsAsked(Asked):
    """Which of a site's runs are asked for: the newest that fit, or with `before` those older than that number."""

    limit: int = Field(50, ge=1, le=200)
    before: int | None = Field(None, ge=1, lt=2**31)
    state: Literal[RunStatus, "open"] | None = Field(
        None, description="With `open` those that are pending, running or paused."
    )
    program: UUID | None = None
    since: AwareDatetime | None = Field(None, description="Made at this moment or later.")
    until: AwareDatetime | None = Field(None, description="Made before this moment.")


OfVersion = Annotated[
    Annotated[int, Strict(), Field(ge=1, lt=2**31)] | None,
    Field(description="The version of the program that is taken; as it is drawn now if none."),
]


class StartRun(Asked):
    """Parameters of a run, and in which order and when it is done; what is left out has its default."""

    version: OfVersion = None
    parameters: dict[str, Any] = {}
    priority: Priority = "normal"
    not_before: Annotated[
        AwareDatetime | None, Field(description="It waits until then and begins by itself; at most a year ahead.")
    ] = None
    deadline: Annotated[
        AwareDatetime | None, Field(description="It should be over by then; people are told when it is not.")
    ] = None
    emergency: Annotated[
        str, Field(max_length=500, description="Why an admin starts it without the approvals that the site demands.")
    ] = ""


End = Annotated[Any, Unchecked(Position | DevicePlace | NamedPlace | PointPlace)]


class AskRoute(Asked):
    """Two ends of a way: `[x, y]` or a Place; in JSON the first is called `from`."""

    start: End = Field(alias="from")
    to: End


class CommentOnRun(Asked):
    """A comment that begins a thread about a moment of a run: `t_s` seconds after its start.

    A later moment than the run has had is the last that it has had. `label` is what people call what happens then.
    """

    text: str = Field(min_length=1, max_length=MOST_COMMENT, pattern=r"\S")
    mentions: list[int] = Field([], max_length=MOST_MENTIONS)
    t_s: Annotated[Number, Field(ge=0, le=1e9)]
    label: Line = Field("", max_length=120)


class ThreadBegun(Schema):
    """The thread that was begun, which is read among those of the program."""

    thread: UUID
    program: UUID


class AskRoutes(Asked):
    """Many ways at once."""

    pairs: list[AskRoute] = Field(max_length=500)


class RouteShape(Schema):
    """The way a robot would drive, in metres, and about how many seconds it takes."""

    path: list[Position]
    length_m: float
    seconds: int


class RunProgram(Schema):
    """Which program; its name is as it was when it was started."""

    id: str
    name: str


class WaitReason(Schema):
    """Why something waits, for screens to say in their language; devices and robots are named by their ids."""

    code: str
    args: dict[str, Scalar]


class Cause(Schema):
    """Why something ended or was not done, for screens to say in their language (execution/reasons.py)."""

    code: str
    args: dict[str, str]


class RunStepShape(Schema):
    """How far a step of a run is; `wait` and `why` say what it waits for, `count` how often it has begun."""

    status: StepStatus
    started_at: str | None
    ended_at: str | None
    robot: str | None
    wait: str | None
    why: WaitReason | None = None
    count: int


class PermitShape(Schema):
    """Which approvals let a run start: how many were demanded and whose were there; or the reason of an emergency."""

    needed: int
    approved_by: list[str]
    emergency: str


class RunSummaryShape(Schema):
    """A run as lists and live messages have it; times are ISO 8601. Lists have no steps of one that is `archived`."""

    id: str
    number: int
    program: RunProgram
    site: str
    version: int
    status: RunStatus
    reason: str
    cause: Cause | None
    created_at: str
    started_at: str | None
    ended_at: str | None
    started_by: str
    steps: dict[str, RunStepShape]
    roles: dict[str, str]
    priority: Priority
    not_before: str | None
    deadline: str | None
    archived: bool
    permit: PermitShape | None


class RunShape(RunSummaryShape):
    """A run with the program as it was when it was started."""

    document: Document
    compiled: Compiled


class RunEventShape(Schema):
    """One line of a run's journal; `t_s` counts from the run's start."""

    seq: int
    at: str
    t_s: float
    kind: str
    step: str
    device: str
    robot: str
    text: str
    cause: Cause | None
    code: str
    args: dict[str, Any]


class AwaitedAdmission(Schema):
    """A robot that waits to be let into a zone of its site; `run` is the id of the run that it works for, if any."""

    zone: str
    zone_name: str
    robot: str
    robot_name: str
    run: str


class LetRobotIn(Asked):
    """Which robot is let in."""

    robot: str = Field(max_length=64)


class AnswerShape(Schema):
    """What a question may be answered with; `options` for a choice, limits for a number."""

    type: Literal["boolean", "number", "text", "choice"]
    unit: str
    minimum: float | None
    maximum: float | None
    options: list[str]


class QuestionShape(Schema):
    """Something that a run asks the people of its site; `value` is the answer once there is one."""

    id: str
    run: str
    run_number: int
    program: RunProgram
    site: str
    step: str
    text: str
    answer: AnswerShape
    state: Literal["open", "answered", "withdrawn"]
    value: Scalar | None
    asked_at: str
    answered_by: str
    answered_at: str | None


class AnswerQuestion(Asked):
    """The answer: yes or no, a number, a text, or one of the options."""

    value: Annotated[Any, Unchecked(Scalar)]


class ArmProgram(Asked):
    """Whether the program shall start by itself."""

    on: Flag


class ArmedShape(Schema):
    """A program that starts by itself, in the version that was armed."""

    program: str
    version: int
    by: str
    at: str


class CallMethod(Asked):
    """A method of a device, and its arguments by name."""

    method: Line = Field(max_length=64)
    args: dict[str, Any] = {}


class ActionInput(Asked):
    """The arguments of an action, by name, as its Thing Description says."""

    model_config = ConfigDict(extra="allow")


class ActionStatus(Schema):
    """What has come of an action, as the Web of Things says it; `output` once it is completed, `error` if it failed."""

    status: Literal["pending", "running", "completed", "failed"]
    href: str
    timeRequested: str
    timeEnded: str | None = None
    output: dict[str, Scalar | None] | None = None
    error: dict[str, Scalar] | None = None


class CallShape(Schema):
    """Something that a person told a device to do; `over` once nothing more will come of it."""

    id: str
    device: str
    method: str
    args: dict[str, Any]
    by: str
    status: Literal["pending", "sent", "accepted", "running", "done", "failed", "rejected", "cancelled", "timed_out"]
    over: bool
    why: str
    cause: Cause | None
    result: dict[str, Scalar | None]
    created_at: str
    expires_at: str
    sent_at: str | None
    ended_at: str | None


class UseRobotMap(Asked):
    """Which robot's map, and the versions that were looked at: of the robot's map, and of the site's (0: none).

    The tags are those of the two maps, as they were told: after a backup was brought back another map may have the
    number, and is refused then. An empty one says nothing.
    """

    device: Line = Field(max_length=64)
    version: MapVersion
    tag: MapTag = ""
    replaces: MapVersion
    replaces_tag: MapTag = ""


class RestoreMap(Asked):
    """Which version of the site's map is to hold again, and which one held when that was decided.

    The tags are those of the two maps, as they were told: after a backup was brought back another map may have the
    number, and is refused then. An empty one says nothing.
    """

    version: MapVersion
    tag: MapTag = ""
    replaces: MapVersion
    replaces_tag: MapTag = ""


class MapTroubleOfDevices(Schema):
    """A machine or place that a map does not suit, and whether it is so only with that map."""

    id: str
    name: str
    kind: Literal["machine", "place"]
    why: Literal["outside", "walled", "unreachable"]
    is_new: bool


class MapTroubleOfPrograms(Schema):
    """A program with steps that would be off the map, or with points in walls to which robots drive."""

    id: str
    name: str
    steps_outside: int
    points_walled: int


class BroughtMapDifference(Schema):
    """What changes when a map replaces the site's version `replaces` (0: none), in square metres, and for whom."""

    replaces: int
    floor_gained_m2: float
    floor_lost_m2: float
    walls_gained_m2: float
    walls_lost_m2: float
    troubles: list[MapTroubleOfDevices]
    programs: list[MapTroubleOfPrograms]


class ChangedMap(Schema):
    """The version that holds now."""

    version: int
