"""A run's state between two events: threads, frames, what they wait for; plain JSON when it is stored."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import asdict, dataclass, field
from typing import Any, Literal

from vipo_device.protocol.description import Scalar

RunStatus = Literal["running", "paused", "finished", "failed", "cancelled"]
STATE_FORMAT = 2
FLOOR_TASK = "mission"
"""What `waits_for` says of a thread that waits for a task of the floor; kept states have always called it so."""
MAIN = 0
"""The thread that carries out the program's body; when it is over the run is."""


@dataclass(frozen=True, slots=True)
class Guard:
    """A Try or a time limit around the running stretch; `calls` and `open` say how deep the thread stood at its begin.

    A time limit of so many seconds has the number of its timer as `limit`, and takes nothing but what that ends.
    """

    handler: int
    kinds: tuple[str, ...]
    calls: int
    open: int
    final: bool = False
    limit: int = 0
    seconds: float = 0.0


@dataclass(frozen=True, slots=True)
class Activation:
    """A function being carried out: its frame, where to go on after it, and where its value goes."""

    frame: int
    back_to: int
    result: str | None = None
    open: int = 0
    shared: bool = False


@dataclass(frozen=True, slots=True)
class Wake:
    """What a thread was told: it may go on, or it fails, or (`final`) it is to end, past all but `final` guards.

    A `final` one without a kind ends in good order: its steps count as done. One with a `limit` ends what stands in
    the time limit with this timer, and is an ordinary failure from there on.
    """

    kind: str = ""
    why: str = ""
    final: bool = False
    value: Scalar = None
    limit: int = 0

    @property
    def ends(self) -> bool:
        """Tell whether the thread does not simply go on."""
        return self.final or bool(self.kind)


@dataclass(frozen=True, slots=True)
class Pending:
    """A `final` handler under way, and what goes on at its Rethrow; `calls` and `guards` say how deep it stands."""

    handler: int
    calls: int
    guards: int
    wake: Wake


@dataclass(frozen=True, slots=True)
class Thread:
    """One line of execution.

    `waits_for` is empty while it can go on, else `FLOOR_TASK`, `timer`, `until`, `yield`, `ask` or `join`. `event` is
    the number of the event whose body it carries out, or -1.
    """

    id: int
    at: int
    calls: tuple[Activation, ...]
    guards: tuple[Guard, ...] = ()
    open: tuple[str, ...] = ()
    leaf: str = ""
    waits_for: str = ""
    waits_id: int = 0
    wake: Wake | None = None
    parent: int | None = None
    pending: tuple[Pending, ...] = ()
    event: int = -1


@dataclass(frozen=True, slots=True)
class Ending:
    """How the run will end once all threads have unwound."""

    status: Literal["finished", "failed"]
    reason: str = ""


@dataclass(frozen=True, slots=True)
class RunState:
    """All that a run knows.

    `frames` are variables by frame number; frame 0 holds the program's. `truths` says by event whether its condition
    held when it was last looked at.
    """

    status: RunStatus = "running"
    reason: str = ""
    threads: Mapping[int, Thread] = field(default_factory=dict)
    frames: Mapping[int, Mapping[str, Scalar | tuple[Scalar, ...]]] = field(default_factory=dict)
    facts: Mapping[tuple[str, str], Scalar] = field(default_factory=dict)
    next_id: int = 1
    truths: Mapping[int, bool] = field(default_factory=dict)
    ending: Ending | None = None


def to_json(state: RunState) -> dict[str, Any]:
    """Return the state as plain JSON."""
    return {
        "format": STATE_FORMAT,
        "status": state.status,
        "reason": state.reason,
        "threads": [asdict(thread) for thread in state.threads.values()],
        "frames": {str(number): dict(frame) for number, frame in state.frames.items()},
        "facts": [[device, name, value] for (device, name), value in state.facts.items()],
        "next_id": state.next_id,
        "truths": [[event, truth] for event, truth in state.truths.items()],
        "ending": asdict(state.ending) if state.ending else None,
    }


def from_json(data: Mapping[str, Any]) -> RunState:
    """Read what `to_json` wrote, also in its former version."""
    data = climb(data)
    threads = [_thread(item) for item in data["threads"]]
    return RunState(
        status=data["status"],
        reason=data["reason"],
        threads={thread.id: thread for thread in threads},
        frames={int(number): _frame(frame) for number, frame in data["frames"].items()},
        facts={(device, name): value for device, name, value in data["facts"]},
        next_id=data["next_id"],
        truths={int(event): truth for event, truth in data["truths"]},
        ending=Ending(**data["ending"]) if data["ending"] else None,
    )


def _frame(data: Mapping[str, Any]) -> dict[str, Any]:
    """Return the variables of a frame; JSON knows only one kind of list."""
    return {name: tuple(value) if isinstance(value, list) else value for name, value in data.items()}


def climb(data: Mapping[str, Any]) -> Mapping[str, Any]:
    """Bring a stored state to today's format, a version at a time."""
    while data["format"] in LADDER:
        data = LADDER[data["format"]](data)
    if data["format"] != STATE_FORMAT:
        raise ValueError(f"A run's state of format {data['format']} cannot be read; this program reads {STATE_FORMAT}.")
    return data


def _from_1_to_2(data: Mapping[str, Any]) -> Mapping[str, Any]:
    """Format 1 knew neither events nor questions, and a run ended at once."""
    return {**data, "format": 2, "truths": [], "ending": None}


LADDER: Mapping[int, Callable[[Mapping[str, Any]], Mapping[str, Any]]] = {1: _from_1_to_2}


def _thread(data: Mapping[str, Any]) -> Thread:
    more = {
        "calls": tuple(Activation(**call) for call in data["calls"]),
        "guards": tuple(Guard(**{**guard, "kinds": tuple(guard["kinds"])}) for guard in data["guards"]),
        "open": tuple(data["open"]),
        "wake": Wake(**data["wake"]) if data["wake"] else None,
        "pending": tuple(Pending(**{**p, "wake": Wake(**p["wake"])}) for p in data.get("pending", ())),
    }
    return Thread(**{**data, **more})
