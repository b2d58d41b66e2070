"""What the processes of one game agree on: its sites and devices, and what each run tells which device."""

from __future__ import annotations

from dataclasses import dataclass
from random import Random
from uuid import UUID, uuid5

from vipo_device.protocol.description import Description, MethodSpec, ParameterSpec, Pose, PropertySpec, Size
from vipo_device.protocol.messages import down_topic

DEVICES_EACH = 4
NAMESPACE = UUID("7b0f3a52-6c1e-4d0b-9a39-2f6f4b1c0d11")
STEPS_MOST = 100
PASSWORD = "a word of this game"


@dataclass(frozen=True)
class Game:
    """How many runs of how many commands over how many sites; all chance comes from the seed."""

    runs: int
    sites: int
    commands: int
    seed: int

    @property
    def slugs(self) -> list[str]:
        return [f"hall{number}" for number in range(1, self.sites + 1)]

    def devices(self, slug: str) -> list[str]:
        return [f"{slug}.oven{number}" for number in range(1, DEVICES_EACH + 1)]

    @property
    def all_devices(self) -> list[str]:
        return [device for slug in self.slugs for device in self.devices(slug)]

    def site_of(self, run: int) -> str:
        return self.slugs[run % self.sites]

    def program_of(self, run: int) -> UUID:
        """Return what tells this run from the others in the database."""
        return uuid5(NAMESPACE, f"{self.seed}:{run}")

    def steps_of(self, run: int) -> list[tuple[str, int]]:
        """Return the device of each step, and the value by which its log tells the step."""
        chance = Random(f"{self.seed}:{run}")
        devices = self.devices(self.site_of(run))
        return [(chance.choice(devices), run * STEPS_MOST + step) for step in range(self.commands)]

    def count_at(self, slug: str, runs: int) -> int:
        """Return how many of the first `runs` runs are this site's."""
        return sum(self.site_of(run) == slug for run in range(runs))


def describe(device: str) -> Description:
    """Return what an oven says of itself."""
    slug, _, number = device.partition(".oven")
    return Description(
        device, device, "machine", "oven", Pose(2.0 * int(number), 2.0), Size(0.4, 0.4, 0.4), site=slug,
        properties=(PropertySpec("temperature", "number", "DEG_C", -20, 1000),),
        methods=(MethodSpec("heat", down_topic(device, "heat"), parameters=(ParameterSpec("value", "number"),)),),
    )  # fmt: skip
