"""What a twin remembers over a restart: one JSON file, written in one piece."""

from __future__ import annotations

import json
import logging
import time
from collections.abc import Mapping, Sequence
from dataclasses import asdict, dataclass, field, replace
from pathlib import Path
from typing import Any

from simulation.world import Ack, Scene, World
from vipo_device.kit.atomic_file import write_file
from vipo_device.protocol.description import Pose, Scalar

log = logging.getLogger(__name__)
FORMAT = 1


@dataclass(frozen=True, slots=True)
class TwinMemory:
    """How the world was, and how often each device has started. `first_boot` counts for devices without a number."""

    boots: Mapping[str, int] = field(default_factory=dict)
    poses: Mapping[str, Pose] = field(default_factory=dict)
    carrying: Mapping[str, Mapping[str, int]] = field(default_factory=dict)
    stocks: Mapping[str, Mapping[str, int]] = field(default_factory=dict)
    readings: Mapping[str, Mapping[str, Scalar]] = field(default_factory=dict)
    remembered: Mapping[str, Sequence[Ack]] = field(default_factory=dict)
    first_boot: int = 1

    def next_boot(self, device: str) -> int:
        """Return the number of the start that comes now."""
        return self.boots.get(device, self.first_boot - 1) + 1

    def over(self, older: TwinMemory) -> TwinMemory:
        """Return this with what an older one knows of devices that are not in the world now: they may come back.

        Nothing is forgotten, for the registry deletes no device that has described itself: those not here are retired.
        """
        return replace(
            self,
            poses={**older.poses, **self.poses},
            carrying={**older.carrying, **self.carrying},
            stocks={**older.stocks, **self.stocks},
            readings={**older.readings, **self.readings},
            remembered={**older.remembered, **self.remembered},
        )

    def put_into(self, scene: Scene) -> Scene:
        """Return the scene as it was left.

        Commands that were under way are unknown to it: objects change hands at the end of a command, so none of them
        has had its effect, and each is carried out when the server sends it again.
        """
        return replace(
            scene,
            poses=self.poses,
            carrying=self.carrying,
            stocks={**scene.stocks, **self.stocks},
            readings=self.readings,
            remembered=self.remembered,
        )


def snapshot(world: World, boots: Mapping[str, int]) -> TwinMemory:
    """Return what is to be remembered of a world as it is now."""
    robots = world.robots()
    return TwinMemory(
        boots=boots,
        poses={name: robot.pose for name, robot in robots.items()},
        carrying={name: robot.carrying for name, robot in robots.items()},
        stocks=world.stocks(),
        readings=world.readings(),
        remembered=world.remembered(),
    )


def write_memory(path: Path, memory: TwinMemory) -> None:
    """Keep what is to be remembered. Raises OSError."""
    body = {"format": FORMAT, **asdict(memory)}
    del body["first_boot"]
    write_file(path, json.dumps(body, separators=(",", ":")))


def read_memory(path: Path) -> TwinMemory:
    """Return what was remembered; a file that cannot be read is left aside and the world begins anew."""
    try:
        return _memory(json.loads(path.read_text()))
    except FileNotFoundError:
        return TwinMemory()
    except (OSError, ValueError, KeyError, TypeError, AttributeError) as error:
        log.warning("%s cannot be read (%s); the twin begins with everything in its place.", path.name, error)
        # Boot numbers must not go back, so they continue from the clock.
        return TwinMemory(first_boot=int(time.time()))


def _memory(body: dict[str, Any]) -> TwinMemory:
    if body["format"] != FORMAT:
        raise ValueError(f"format {body['format']!r} is not {FORMAT}")
    return TwinMemory(
        boots={k: int(v) for k, v in body["boots"].items()},
        poses={k: Pose(**v) for k, v in body["poses"].items()},
        carrying={k: dict(v) for k, v in body["carrying"].items()},
        stocks={k: dict(v) for k, v in body["stocks"].items()},
        readings={k: dict(v) for k, v in body["readings"].items()},
        remembered={k: [Ack(**answer) for answer in v] for k, v in body["remembered"].items()},
    )
