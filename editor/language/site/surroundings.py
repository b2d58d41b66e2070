"""What a program is checked against: the devices and places of its site, as plain data."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Final, Literal, NamedTuple, Protocol

from editor.language.site.signature import Signature
from vipo_device.protocol.description import Description, PropertySpec, Scalar

ZoneRule = Literal["keep_out", "one_at_a_time", "slow", "one_way", "preferred", "release"]
Lifecycle = Literal["pending", "approved", "retired"]


@dataclass(frozen=True, slots=True)
class DeviceFacts:
    """A device as the language sees it: what it can do for ever, and how it is now."""

    description: Description
    lifecycle: Lifecycle = "approved"
    online: bool = True
    readings: Mapping[str, Scalar] = field(default_factory=dict)
    standing_at: str | None = None
    """The id of the device at whose station this robot is known to stand, if any."""


@dataclass(frozen=True, slots=True)
class PlaceFacts:
    """A named place: a dock, a room's centre, or a point that people gave a name."""

    id: str
    name: str
    kind: Literal["dock", "room", "point"]
    x: float
    y: float
    theta: float = 0.0


@dataclass(frozen=True, slots=True)
class ZoneFacts:
    """A zone of the site's floor: a polygon in metres that all robots keep out of, share, go slowly in, or rather use.

    Where they share it, `robots` of them may be in it at once. Where it is one-way they drive towards `heading_deg`,
    degrees from the x axis, counter-clockwise, or across.
    """

    id: str
    name: str
    rule: ZoneRule
    points: tuple[tuple[float, float], ...]
    speed_m_s: float | None = None
    robots: int = 1
    heading_deg: float | None = None


class FloorFacts(Protocol):
    """What the map can tell the checks; the implementation lives with the map."""

    @property
    def known_m(self) -> tuple[float, float, float, float]:
        """What is known of the map: left, bottom, right and top in metres."""

    def is_inside(self, x_m: float, y_m: float) -> bool:
        """Tell whether the point lies on the map."""

    def is_free(self, x_m: float, y_m: float, radius_m: float) -> bool:
        """Tell whether a robot of that radius can stand at the point."""

    def is_reachable(self, from_xy: tuple[float, float], to_xy: tuple[float, float], radius_m: float) -> bool:
        """Tell whether a robot of that radius finds a path."""

    def can_stop(self, x_m: float, y_m: float, radius_m: float) -> bool:
        """Tell whether traffic lets robots drive to a point, `radius_m` being the largest robot's of the site."""

    def why_not_covered(self, outline: tuple[tuple[float, float], ...], lane_m: float, radius_m: float) -> str:
        """Return why robots cannot cover a zone in lanes so wide: outside, nothing, too_many; empty: they can."""

    def has_machine(self, device_id: str) -> bool:
        """Tell whether the machine stands on this floor."""

    def station(self, device_id: str, radius_m: float) -> tuple[float, float] | None:
        """Return where a robot of that radius stands to serve a machine; None when it has no room to."""


@dataclass(frozen=True, slots=True)
class HeldDevice:
    """A device that a variable may hold: by its id, or as the robot of a role, by its name in the script.

    Without either it is one that people choose for a parameter: any approved one, of which these methods are used.
    """

    device: str | None = None
    role: str | None = None
    methods: frozenset[str] = frozenset()

    @property
    def is_chosen(self) -> bool:
        """Tell whether people choose it when the program starts."""
        return self.device is None and self.role is None


class Counting(NamedTuple):
    """In which unit devices count one thing: the first of them, and the first that counts it in another, if any."""

    first: tuple[Description, str]
    other: tuple[Description, str] | None = None


class Told(NamedTuple):
    """What devices report together under one name: its type, empty where they differ, and how its numbers count."""

    type: str = ""
    counting: Counting | None = None
    """None: none of them reports a number."""


class CrewFacts(Protocol):
    """The robots that may take the roles of a program, and the devices that its variables may hold."""

    def robots(self, role: str) -> tuple[Description, ...]:
        """Return the descriptions of the robots that may take a role, by its name in the script; sorted by id."""

    def told_by(self, role: str, name: str) -> tuple[PropertySpec | None, ...]:
        """Return what each of these robots says of a property, in the same order; None: it does not report it."""

    def reading(self, role: str, name: str) -> PropertySpec | None:
        """Return what they say together of a property; None where they do not say the same, or nothing."""

    def held(self, held: frozenset[HeldDevice] | None) -> tuple[Description, ...]:
        """Return the devices that a variable may hold, sorted by id; None, not known: all approved ones of the site."""

    def units_taken(self, held: frozenset[HeldDevice] | None, method: str) -> Mapping[str, Counting]:
        """Return in which units these take the numbers of a method, by the names of its parameters."""

    def told_by_held(self, held: frozenset[HeldDevice] | None, name: str) -> Told:
        """Return what these report under a name; one that says no unit counts as the others do."""


class _Nobody:
    def robots(self, role: str) -> tuple[Description, ...]:
        return ()

    def told_by(self, role: str, name: str) -> tuple[PropertySpec | None, ...]:
        return ()

    def reading(self, role: str, name: str) -> PropertySpec | None:
        return None

    def held(self, held: frozenset[HeldDevice] | None) -> tuple[Description, ...]:
        return ()

    def units_taken(self, held: frozenset[HeldDevice] | None, method: str) -> Mapping[str, Counting]:
        return {}

    def told_by_held(self, held: frozenset[HeldDevice] | None, name: str) -> Told:
        return Told()


NOBODY: Final[CrewFacts] = _Nobody()


@dataclass(frozen=True, slots=True)
class LibraryFacts:
    """A function of the library: what each of its versions is to who calls it."""

    name: str
    versions: Mapping[int, Signature] = field(default_factory=dict)


@dataclass(frozen=True, slots=True)
class Surroundings:
    """Everything outside a program that its meaning depends on."""

    devices: Mapping[str, DeviceFacts] = field(default_factory=dict)
    places: Mapping[str, PlaceFacts] = field(default_factory=dict)
    floor: FloorFacts | None = None
    library: Mapping[str, LibraryFacts] | None = None
    """The functions of the library by id; None: nobody knows them here."""
    zones: tuple[ZoneFacts, ...] = ()
    """What holds on the site's floor for every robot, by id: a program need not say it again."""
    crew: CrewFacts = field(default=NOBODY, compare=False, repr=False)
    """Whose readings a role's are, or a variable's, in the program that is looked at."""


def what_programs_see(surroundings: Surroundings) -> object:
    """Return what single steps are checked and printed by, to compare; not where robots are, nor what is measured."""
    devices = [
        (facts.lifecycle, facts.online, d.id, d.name, d.kind, d.gives, d.takes, d.capacity, d.properties, d.methods)
        for facts in surroundings.devices.values()
        for d in (facts.description,)
    ]
    return [*surroundings.devices], devices, surroundings.places, surroundings.zones


def standing_places(surroundings: Surroundings) -> dict[str, str]:
    """Return beside which device each robot stands, as far as it is known: robot id → device id."""
    known = ((name, facts.standing_at) for name, facts in surroundings.devices.items())
    return {name: place for name, place in known if place is not None}
