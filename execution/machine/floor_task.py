"""A task of the floor: one thing that a run asks of it, with its arguments worked out; pure."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any, Literal

from vipo_device.protocol.description import Scalar

TaskKind = Literal["move", "pick", "drop", "call", "perform", "release", "cover"]
FAILURE_KINDS = ("refused", "failed", "timed_out", "offline", "blocked", "cancelled")


@dataclass(frozen=True, slots=True)
class Target:
    """Where a task goes: a device or a named place by `id`, or a point in metres."""

    id: str = ""
    point: tuple[float, float] | None = None


@dataclass(frozen=True, slots=True)
class TaskOrder:
    """What is asked: `role` names the robot's role (empty for a call on a machine that no robot takes part in).

    A robot performs a method of its own where it stands, and is released there: such a task has no target, and neither
    has a cover, whose `arguments` are the `zone` by its id and the `lane` in metres (0: as wide as the robot).
    """

    kind: TaskKind
    target: Target
    role: str = ""
    object: str = ""
    quantity: float = 1
    method: str = ""
    arguments: Mapping[str, Scalar] = field(default_factory=dict)
    route: tuple[tuple[float, float], ...] = ()
    step: str = ""
    line: int = 0


def order_from_json(data: Mapping[str, Any]) -> TaskOrder:
    """Read an order from plain JSON, as states keep it."""
    target = data["target"]
    point = (float(target["point"][0]), float(target["point"][1])) if target["point"] else None
    route = tuple((float(x), float(y)) for x, y in data["route"])
    return TaskOrder(**{**data, "target": Target(target["id"], point), "route": route})
