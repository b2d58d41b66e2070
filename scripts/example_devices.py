"""The devices of the sites of examples/field: machines that hand out, take in or work, and robots."""

from __future__ import annotations

from dataclasses import dataclass
from math import pi

from vipo_device.protocol.description import Description, MethodSpec, ParameterSpec, Pose, PropertySpec, Size
from vipo_device.protocol.messages import down_topic

ROBOT_RADIUS_M = 0.18
Spot = tuple[float, float]


@dataclass(frozen=True)
class Machine:
    """A machine that hands objects out, takes them in, or works for a time (`job`: name, title, unit, most)."""

    id: str
    name: str
    look: str
    at: Spot
    size: Spot
    text: str
    gives: str = ""
    takes: str = ""
    capacity: int = 0
    readings: tuple[PropertySpec, ...] = ()
    job: tuple[str, str, str, float] | None = None

    def describe(self, site: str) -> Description:
        """Return its description at a site."""
        progress = (PropertySpec("jobStatus", "number", "PERCENT", 0.0, 100.0, "Job"),) if self.job else ()
        return Description(
            id=self.id,
            name=self.name,
            kind="machine",
            device_class=self.look,
            pose=Pose(self.at[0], -self.at[1], 0.0, 0.0),
            size=Size(self.size[0], self.size[1], 1.4),
            description=self.text,
            site=site,
            simulated=True,
            capacity=self.capacity,
            gives=(self.gives,) if self.gives else (),
            takes=(self.takes,) if self.takes else (),
            properties=(*progress, *self.readings),
            methods=(self._method(),),
        )

    def _method(self) -> MethodSpec:
        if self.job:
            name, title, unit, most = self.job
            time = ParameterSpec("time", "number", unit, 1.0, most)
            return MethodSpec(name, down_topic(self.id, name), "time", title, (time,))
        name, title, kind = ("dispense", "Dispense", self.gives) if self.gives else ("accept", "Accept", self.takes)
        options = ParameterSpec("object", "object", options=(kind,))
        given = (options, ParameterSpec("value", "number", "", 1.0, 24.0))
        return MethodSpec(name, down_topic(self.id, name), "object", title, given)


def stock(most: float) -> tuple[PropertySpec, ...]:
    """Return the reading that says how many objects there are."""
    return (PropertySpec("stock", "number", "", 0.0, most, "In stock"),)


def free(most: float) -> tuple[PropertySpec, ...]:
    """Return the reading that says how many more fit in."""
    return (PropertySpec("freeSlots", "number", "", 0.0, most, "Free slots"),)


@dataclass(frozen=True)
class Door:
    """A door that opens and closes when it is told to, and says how it stands; its drive hangs beside the doorway."""

    id: str
    name: str
    at: Spot
    size: Spot
    text: str

    def describe(self, site: str) -> Description:
        """Return its description at a site."""
        return Description(
            id=self.id,
            name=self.name,
            kind="machine",
            device_class="door",
            pose=Pose(self.at[0], -self.at[1], 0.0, 0.0),
            size=Size(self.size[0], self.size[1], 2.1),
            description=self.text,
            site=site,
            simulated=True,
            properties=(PropertySpec("state", "text", title="State", options=("closed", "moving", "open")),),
            methods=tuple(
                MethodSpec(name, down_topic(self.id, name), "", name.capitalize()) for name in ("open", "close")
            ),
        )


@dataclass(frozen=True)
class Robot:
    """A robot that carries two objects, or one that cleans floors."""

    id: str
    name: str
    dock: Spot
    text: str
    cleans: bool = False

    def describe(self, site: str) -> Description:
        """Return its description at a site."""
        return Description(
            id=self.id,
            name=self.name,
            kind="robot",
            device_class="turtlebot",
            pose=Pose(self.dock[0], -self.dock[1], 0.0, round(pi / 2, 4)),
            size=Size(2 * ROBOT_RADIUS_M, 2 * ROBOT_RADIUS_M, 0.42),
            description=self.text,
            site=site,
            simulated=True,
            capacity=0 if self.cleans else 2,
            radius_m=ROBOT_RADIUS_M,
            speed_m_s=0.5,
            properties=(PropertySpec("battery", "number", "PERCENT", 0.0, 100.0, "Battery"),),
            methods=self._methods(),
        )

    def _methods(self) -> tuple[MethodSpec, ...]:
        hand = (
            ParameterSpec("device", "device"),
            ParameterSpec("object", "object"),
            ParameterSpec("value", "number", "", 1.0, 2.0),
        )
        cleaning = ("clean", "time", (ParameterSpec("time", "number", "MIN", 1.0, 30.0),))
        tools = (cleaning,) if self.cleans else (("pick", "object", hand), ("drop", "object", hand))
        moving = ("move", "location", (ParameterSpec("path", "location"),))
        return tuple(
            MethodSpec(name, down_topic(self.id, name), message, name.capitalize(), given)
            for name, message, given in (moving, *tools)
        )
