"""What the run machine is told (events) and what it wants done (actions); pure."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field

from editor.language.expressions.nodes import AnswerSpec
from execution.machine.floor_task import TaskOrder
from vipo_device.protocol.description import Scalar


@dataclass(frozen=True, slots=True)
class Facts:
    """Readings have changed: values by (device id, property)."""

    values: Mapping[tuple[str, str], Scalar]


@dataclass(frozen=True, slots=True)
class TaskDone:
    """A task that the floor was asked for is over."""

    task: int
    result: Mapping[str, Scalar] = field(default_factory=dict)


@dataclass(frozen=True, slots=True)
class TaskFailed:
    """A task failed; `kind` is one of `execution.machine.floor_task.FAILURE_KINDS`."""

    task: int
    kind: str
    why: str


@dataclass(frozen=True, slots=True)
class TimerFired:
    """A timer that was set is due."""

    timer: int


@dataclass(frozen=True, slots=True)
class Answered:
    """A person has answered a question; the value fits what was asked for."""

    question: int
    value: Scalar


@dataclass(frozen=True, slots=True)
class PauseAsked:
    """Ask for nothing new until resumed; what is under way settles."""

    reason: str = ""


@dataclass(frozen=True, slots=True)
class Resumed:
    """Go on."""


@dataclass(frozen=True, slots=True)
class CancelAsked:
    """End the run."""

    reason: str = ""


Event = Facts | TaskDone | TaskFailed | TimerFired | Answered | PauseAsked | Resumed | CancelAsked


@dataclass(frozen=True, slots=True)
class Ask:
    """Ask the floor for a task."""

    task: int
    order: TaskOrder


@dataclass(frozen=True, slots=True)
class Cancel:
    """The task is not wanted any more; no answer is awaited."""

    task: int


@dataclass(frozen=True, slots=True)
class SetTimer:
    """Send TimerFired in so many seconds."""

    timer: int
    seconds: float


@dataclass(frozen=True, slots=True)
class CancelTimer:
    """The timer is not needed any more."""

    timer: int


@dataclass(frozen=True, slots=True)
class AskPeople:
    """Put a question to the people of the site; Answered is awaited."""

    question: int
    text: str
    answer: AnswerSpec
    step: str = ""


@dataclass(frozen=True, slots=True)
class CancelQuestion:
    """The question is withdrawn; no answer is awaited."""

    question: int


@dataclass(frozen=True, slots=True)
class Tell:
    """Tell the people of the site; `level` is info or warning."""

    text: str
    level: str = "info"
    step: str = ""


@dataclass(frozen=True, slots=True)
class StepEntered:
    """A step of the program begins."""

    step: str


@dataclass(frozen=True, slots=True)
class StepLeft:
    """A step of the program is done."""

    step: str


@dataclass(frozen=True, slots=True)
class StepFailed:
    """A step of the program was not done."""

    step: str
    kind: str
    why: str


@dataclass(frozen=True, slots=True)
class Finished:
    """The run is over: finished, failed or cancelled, with the reason."""

    status: str
    reason: str


Action = (
    Ask | Cancel | SetTimer | CancelTimer | AskPeople | CancelQuestion | Tell
    | StepEntered | StepLeft | StepFailed | Finished
)  # fmt: skip
