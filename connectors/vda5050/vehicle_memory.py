"""What outlives a restart of the connector: one JSON file for each vehicle, written before anything is sent."""

from __future__ import annotations

import json
import logging
from collections.abc import Mapping
from dataclasses import asdict, dataclass, field
from pathlib import Path
from typing import Any

from connectors.vda5050.factsheet import device_id
from connectors.vda5050.messages import VehicleName
from vipo_device.kit.atomic_file import write_file
from vipo_device.protocol.description import Pose

log = logging.getLogger(__name__)
FORMAT = 1


@dataclass(slots=True)
class VehicleMemory:
    """`boot` counts the starts, `home` is where the vehicle was first seen, `headers` counts messages by topic."""

    boot: int = 0
    home: Pose | None = None
    headers: dict[str, int] = field(default_factory=dict)
    control: Mapping[str, Any] = field(default_factory=dict)


def memory_path(folder: Path, name: VehicleName) -> Path:
    """Return where is kept what was open at a vehicle; the file is there once it has been a device."""
    return folder / f"{device_id(name)}.json"


def write_memory(path: Path, memory: VehicleMemory) -> None:
    """Keep a vehicle's memory. Raises OSError."""
    write_file(path, json.dumps({"format": FORMAT, **asdict(memory)}, separators=(",", ":")))


def read_memory(path: Path, now: int) -> VehicleMemory:
    """Return what was kept, with the next boot; `now`, in seconds, is where boots begin, so that none goes back."""
    try:
        memory = _memory(json.loads(path.read_text()))
    except FileNotFoundError:
        memory = VehicleMemory()
    except (OSError, ValueError, KeyError, TypeError, AttributeError) as error:
        log.warning("%s cannot be read (%s); what the vehicle was doing is judged by what it says.", path, error)
        memory = VehicleMemory()
    memory.boot = max(memory.boot + 1, now)
    return memory


def _memory(body: dict[str, Any]) -> VehicleMemory:
    if body.pop("format") != FORMAT:
        raise ValueError(f"it is not of format {FORMAT}")
    return VehicleMemory(**{**body, "home": Pose(**body["home"]) if body["home"] else None})
