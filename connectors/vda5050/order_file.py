"""What outlives a restart of the connector: one JSON file for each vehicle, written before anything is sent."""

from __future__ import annotations

import json
import logging
import os
from collections.abc import Mapping
from dataclasses import asdict, dataclass, field
from pathlib import Path
from typing import Any

from vipo_device.protocol.description import Pose

log = logging.getLogger(__name__)
FORMAT = 1


@dataclass(slots=True)
class Memory:
    """`boot` counts the starts, `home` is where the vehicle was first seen, `headers` counts messages by topic."""

    boot: int = 0
    home: Pose | None = None
    headers: dict[str, int] = field(default_factory=dict)
    control: Mapping[str, Any] = field(default_factory=dict)


def write_memory(path: Path, memory: Memory) -> None:
    """Write the file in one piece: who reads it finds the old or the new one."""
    path.parent.mkdir(parents=True, exist_ok=True)
    draft = path.with_suffix(".new")
    draft.write_text(json.dumps({"format": FORMAT, **asdict(memory)}, separators=(",", ":")))
    os.replace(draft, path)  # noqa: PTH105 - the atomic rename is what matters here


def read_memory(path: Path, now: int) -> Memory:
    """Return what was kept, with the next boot; `now`, in seconds, is where boots begin, so that none goes back."""
    try:
        memory = _memory(json.loads(path.read_text()))
    except FileNotFoundError:
        memory = Memory()
    except (OSError, ValueError, KeyError, TypeError, AttributeError) as error:
        log.warning("%s cannot be read (%s); what the vehicle was doing is judged by what it says.", path, error)
        memory = Memory()
    memory.boot = max(memory.boot + 1, now)
    return memory


def _memory(body: dict[str, Any]) -> Memory:
    if body.pop("format") != FORMAT:
        raise ValueError(f"it is not of format {FORMAT}")
    return Memory(**{**body, "home": Pose(**body["home"]) if body["home"] else None})
