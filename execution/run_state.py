"""A run's state between two events: threads, frames, what they wait for; plain JSON when it is stored."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import asdict, dataclass, field
from typing import Any, Literal

from registry.capability import Scalar

RunStatus = Literal["running", "paused", "finished", "failed", "cancelled"]
STATE_FORMAT = 1


@dataclass(frozen=True, slots=True)
class Guard:
    """A Try around the running stretch; `calls` and `open` say how deep the thread stood when it began."""

    handler: int
    kinds: tuple[str, ...]
    calls: int
    open: int


@dataclass(frozen=True, slots=True)
class Activation:
    """A function being carried out: its frame, where to go on after it, and where its value goes."""

    frame: int
    back_to: int
    result: str | None = None
    open: int = 0


@dataclass(frozen=True, slots=True)
class Wake:
    """What a waiting thread was told: it may go on, or what it waited for failed."""

    kind: str = ""
    why: str = ""


@dataclass(frozen=True, slots=True)
class Thread:
    """One line of execution. `waits_for` is empty while it can go on, else `mission`, `timer`, `until` or `join`."""

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


@dataclass(frozen=True, slots=True)
class RunState:
    """All that a run knows. `frames` are variables by frame number; frame 0 holds the program's parameters."""

    status: RunStatus = "running"
    reason: str = ""
    threads: Mapping[int, Thread] = field(default_factory=dict)
    frames: Mapping[int, Mapping[str, Scalar]] = field(default_factory=dict)
    facts: Mapping[tuple[str, str], Scalar] = field(default_factory=dict)
    next_id: int = 1


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
    }


def from_json(data: Mapping[str, Any]) -> RunState:
    """Read what `to_json` wrote."""
    if data["format"] != STATE_FORMAT:
        raise ValueError(f"A run's state of format {data['format']} cannot be read; this program reads {STATE_FORMAT}.")
    threads = [_thread(item) for item in data["threads"]]
    return RunState(
        status=data["status"],
        reason=data["reason"],
        threads={thread.id: thread for thread in threads},
        frames={int(number): dict(frame) for number, frame in data["frames"].items()},
        facts={(device, name): value for device, name, value in data["facts"]},
        next_id=data["next_id"],
    )


def _thread(data: Mapping[str, Any]) -> Thread:
    guards = tuple(Guard(g["handler"], tuple(g["kinds"]), g["calls"], g["open"]) for g in data["guards"])
    more = {
        "calls": tuple(Activation(**call) for call in data["calls"]),
        "guards": guards,
        "open": tuple(data["open"]),
        "wake": Wake(**data["wake"]) if data["wake"] else None,
    }
    return Thread(**{**data, **more})
