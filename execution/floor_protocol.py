"""What a run and the floor say to each other, and what others say to either: every message, and its one form in JSON.

The run machine and traffic do not know each other. Runs in the database and rehearsals in memory both carry between
them what the functions here make of an action, so that a rehearsal cannot differ from a run. Pure.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import MISSING, Field, asdict, dataclass, field, fields, is_dataclass
from functools import cache
from types import NoneType, UnionType
from typing import Any, Literal, TypeVar, assert_never, get_args, get_origin, get_type_hints

from editor.language.plan.instructions import RoleBinding
from editor.language.plan.json_form import expression_to_json
from execution.machine import messages as r
from execution.machine.places import ROLE
from execution.traffic import messages as m
from execution.traffic.floor_state import WRITTEN_WHERE_SET
from vipo_device.protocol.description import Scalar

ToFloor = (
    m.TaskAsked | m.TaskCancelled | m.RunPaused | m.RunResumed | m.RunOver
    | m.CommandAnswered | m.CallSent | m.CallCancelled | m.StopPressed | m.StopReset | m.RobotLetIn
)  # fmt: skip
"""What a floor is told: by runs, by devices' answers, by people. They are events of traffic as they stand."""

FIRST_RETRY_S = 2.0
"""A command that no device answers is sent again after this, then after twice as long, and so on."""
LAST_RETRY_S = 15.0
ASKED_AFTER_S = (5.0, 10.0, LAST_RETRY_S)
"""A command that was accepted is asked for again after these, by how often it has been sent; an answer that a dead
gateway was to take waits with the broker until that gateway is back."""


def again_after_s(tries: int, *, is_answered: bool) -> float:
    """Return how long after its last sending or answer a command is sent again that has been sent `tries` times."""
    sent = max(tries, 1)
    if is_answered:
        return ASKED_AFTER_S[min(sent, len(ASKED_AFTER_S)) - 1]
    return min(LAST_RETRY_S, FIRST_RETRY_S * 2.0 ** min(sent - 1, 8))


@dataclass(frozen=True, slots=True)
class TaskEnded:
    """A task of the floor is done (`kind` is empty) or has failed, with the kind of failure and the reason."""

    task: int
    kind: str = ""
    why: str = ""
    result: Mapping[str, Scalar] = field(default_factory=dict)


@dataclass(frozen=True, slots=True)
class RoleFilled:
    """A role has found its robot."""

    role: str
    robot: str


@dataclass(frozen=True, slots=True)
class RoleEmptied:
    """A role has given its robot back; a `bound` one has the same robot when it has one again."""

    role: str
    robot: str
    bound: bool = False


@dataclass(frozen=True, slots=True)
class WaitNoted:
    """What a step waits for has changed; no reason: it goes on."""

    step: str
    robot: str
    reason: m.Reason | None


@dataclass(frozen=True, slots=True)
class TaskNoted:
    """Something that people shall read of a step's task: `reason` says what."""

    step: str
    robot: str
    reason: m.Reason


@dataclass(frozen=True, slots=True)
class CommandGiven:
    """A device was told to do something for the run."""

    device: str
    method: str
    step: str
    arguments: Mapping[str, object]


@dataclass(frozen=True, slots=True)
class CommandEnded:
    """A device has answered such a command for good: DONE, FAILED, REJECTED or CANCELED."""

    device: str
    method: str
    step: str
    status: str
    why: str


@dataclass(frozen=True, slots=True)
class RobotSetsOut:
    """A robot of the run has a new path, as a drawn line in metres."""

    robot: str
    path: tuple[tuple[float, float], ...]


@dataclass(frozen=True, slots=True)
class ResumeAsked:
    """A person lets the run go on."""

    by: str = ""


@dataclass(frozen=True, slots=True)
class QuestionAnswered:
    """A person has answered what the run asked; the value fits."""

    question: int
    value: Scalar
    by: str
    step: str


@dataclass(frozen=True, slots=True)
class DeadlinePassed:
    """The run should be over by now, and is not."""


ToRun = (
    TaskEnded | RoleFilled | RoleEmptied | WaitNoted | TaskNoted | CommandGiven | CommandEnded | RobotSetsOut
    | ResumeAsked | QuestionAnswered | DeadlinePassed | r.TimerFired | r.PauseAsked | r.CancelAsked
)  # fmt: skip
"""What a run is told: by the floor, by devices' answers, by the ticker, by people."""


@dataclass(frozen=True, slots=True)
class AskingRun:
    """What the floor is told of a run with each task.

    Its id, what people call it, its program's roles and zones, its priority and deadline (`TaskAsked`).
    """

    id: str
    name: str
    roles: Mapping[str, RoleBinding]
    zones: tuple[m.FloorZone, ...]
    priority: int = 0
    due: float = 0.0


def to_floor(run: AskingRun, action: r.Ask | r.Cancel | r.Finished) -> ToFloor:
    """Return what the floor is told of something that a run's machine wants done."""
    match action:
        case r.Ask(task=task, order=order):
            role = run.roles.get(order.role, RoleBinding(order.role))
            where = expression_to_json(role.where) or {}
            wants = role.device or ""
            return m.TaskAsked(
                run.id, task, order, wants, role.can, run.name, run.zones, where, role.said, run.priority, run.due,
                role.holds,
            )  # fmt: skip
        case r.Cancel(task=task):
            return m.TaskCancelled(run.id, task)
        case r.Finished():
            return m.RunOver(run.id)
        case _:
            assert_never(action)


def to_run(action: m.Action) -> tuple[str, ToRun] | None:
    """Return which run is told what of something that traffic does; None: no run is concerned."""
    match action:
        case m.TaskOver():
            return action.run, TaskEnded(action.task, action.kind, action.why, action.result)
        case m.RoleBound():
            return action.run, RoleFilled(action.role, action.robot)
        case m.RoleReleased():
            return action.run, RoleEmptied(action.role, action.robot, action.bound)
        case m.WaitChanged():
            return action.run, WaitNoted(action.step, action.robot, action.reason)
        case m.TaskTold():
            return action.run, TaskNoted(action.step, action.robot, action.reason)
        case m.DoorStuck():
            return None
        case m.SendCommand():
            is_told = action.run and not action.piece and action.method not in m.CONTROLS
            given = CommandGiven(action.device, action.method, action.step, action.arguments)
            return (action.run, given) if is_told else None
        case m.PathPlanned():
            return (action.run, RobotSetsOut(action.robot, action.path)) if action.run else None
        case _:
            assert_never(action)


def to_machine(message: ToRun) -> r.Event | None:
    """Return what a run's machine takes in of a message; None: it is only written into the journal."""
    match message:
        case TaskEnded(task=task, kind=kind, why=why, result=result):
            return r.TaskFailed(task, kind, why) if kind else r.TaskDone(task, result)
        case RoleFilled(role=role, robot=robot):
            return r.Facts({(ROLE, role): robot})
        case RoleEmptied(role=role, bound=bound):
            return None if bound else r.Facts({(ROLE, role): ""})
        case QuestionAnswered(question=question, value=value):
            return r.Answered(question, value)
        case ResumeAsked():
            return r.Resumed()
        case r.TimerFired() | r.PauseAsked() | r.CancelAsked():
            return message
        case WaitNoted() | TaskNoted() | CommandGiven() | CommandEnded() | RobotSetsOut() | DeadlinePassed():
            return None
        case _:
            assert_never(message)


TO_FLOOR: Mapping[str, type[ToFloor]] = {
    "mission_asked": m.TaskAsked,
    "mission_cancelled": m.TaskCancelled,
    "run_paused": m.RunPaused,
    "run_resumed": m.RunResumed,
    "run_over": m.RunOver,
    "answered": m.CommandAnswered,
    "call_sent": m.CallSent,
    "call_cancelled": m.CallCancelled,
    "stop_pressed": m.StopPressed,
    "stop_reset": m.StopReset,
    "robot_let_in": m.RobotLetIn,
}
TO_RUN: Mapping[str, type[ToRun]] = {
    "mission_over": TaskEnded,
    "role_bound": RoleFilled,
    "role_released": RoleEmptied,
    "wait": WaitNoted,
    "told": TaskNoted,
    "command": CommandGiven,
    "answer": CommandEnded,
    "way": RobotSetsOut,
    "timer": r.TimerFired,
    "pause": r.PauseAsked,
    "resume": ResumeAsked,
    "cancel": r.CancelAsked,
    "answered": QuestionAnswered,
    "deadline": DeadlinePassed,
}
"""What kept messages are called in JSON; databases have rows with these names, so they stay."""
STORED_AS = {"task": "mission"}
"""What a part of a message is called in JSON where that differs."""
PLAIN: frozenset[type] = frozenset({str, int, float, bool, NoneType, object})
_names: Mapping[type, str] = {kind: name for kinds in (TO_FLOOR, TO_RUN) for name, kind in kinds.items()}
Message = TypeVar("Message")


class UnreadableMessage(Exception):
    """Kept JSON is no message that this version knows; the sentence says what is wrong with it."""


def to_json(message: ToFloor | ToRun) -> dict[str, Any]:
    """Return a message as plain JSON; its `type` says what it is."""
    said = {name: value for name, value in asdict(message).items() if value or name not in WRITTEN_WHERE_SET}
    if isinstance(message, m.TaskAsked):
        said["zones"] = [m.zone_to_json(zone) for zone in message.zones]
    parts = {STORED_AS.get(name, name): value for name, value in said.items()}
    return {"type": _names[type(message)], **parts}


def floor_message_from_json(data: Mapping[str, Any]) -> ToFloor:
    """Read what `to_json` made of a message to a floor; raises UnreadableMessage."""
    return _read_message(TO_FLOOR, data)


def run_message_from_json(data: Mapping[str, Any]) -> ToRun:
    """Read what `to_json` made of a message to a run; raises UnreadableMessage."""
    return _read_message(TO_RUN, data)


def _read_message(kinds: Mapping[str, type[Message]], data: Mapping[str, Any]) -> Message:
    name = data.get("type")
    kind = kinds.get(name) if isinstance(name, str) else None
    if kind is None:
        raise UnreadableMessage(f"There is no message of type {name!r}. Known are: {', '.join(kinds)}.")
    message: Message = _read_object(kind, {key: part for key, part in data.items() if key != "type"}, repr(name))
    return message


def _read_object(kind: Any, data: Any, where: str) -> Any:
    if not isinstance(data, Mapping):
        raise UnreadableMessage(f"{where} is {data!r} where an object is needed.")
    parts = _parts(kind)
    if unknown := sorted(data.keys() - parts.keys()):
        raise UnreadableMessage(f"{where} has no part called {unknown[0]!r}.")
    if missing := [key for key, (part, _) in parts.items() if key not in data and _is_needed(part)]:
        raise UnreadableMessage(f"{where} lacks {missing[0]!r}.")
    read = ((*parts[key], key, value) for key, value in data.items())
    return kind(**{part.name: _read(hint, value, f"{where}.{key}") for part, hint, key, value in read})


@cache
def _parts(kind: Any) -> Mapping[str, tuple[Field[Any], Any]]:
    """Return the parts of a class of messages by what JSON calls them, with their types."""
    hints = get_type_hints(kind)
    return {STORED_AS.get(part.name, part.name): (part, hints[part.name]) for part in fields(kind)}


def _is_needed(part: Field[Any]) -> bool:
    return part.default is MISSING and part.default_factory is MISSING


def _read(hint: Any, value: Any, where: str) -> Any:
    """Return JSON as what a part is declared to be: objects as dataclasses, lists as tuples, the rest as it is.

    A part may be of several plain types, or of one other type or None.
    """
    plain = _plain(hint)
    if plain is not None:
        if type(value) in plain or object in plain or (type(value) is int and float in plain):
            return value
    elif isinstance(hint, UnionType):
        return None if value is None else _read(get_args(hint)[0], value, where)
    elif is_dataclass(hint):
        return _read_object(hint, value, where)
    elif isinstance(value, list | tuple):
        inner = get_args(hint)
        hints = [inner[0]] * len(value) if inner[-1] is ... else inner
        if get_origin(hint) is tuple and len(hints) == len(value):
            return tuple(_read(each, item, where) for each, item in zip(hints, value, strict=True))
    elif isinstance(value, Mapping) and get_origin(hint) is Mapping:
        return {key: _read(get_args(hint)[1], item, f"{where}.{key}") for key, item in value.items()}
    elif get_origin(hint) is Literal and value in get_args(hint):
        return value
    raise UnreadableMessage(f"{where} is {value!r}, which is no {getattr(hint, '__name__', hint)}.")


@cache
def _plain(hint: Any) -> frozenset[type] | None:
    """Return which plain types a part may have; None if it is more than that."""
    kinds = get_args(hint) if isinstance(hint, UnionType) else (hint,)
    return frozenset(kinds) if PLAIN.issuperset(kinds) else None
