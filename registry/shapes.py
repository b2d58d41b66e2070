"""The shapes of the registry's answers, which the HTTP APIs of all apps share.

The frontend's types are made from the shapes.
"""

from __future__ import annotations

from datetime import datetime
from typing import Annotated, Any, Literal

from ninja import Field, Schema

from registry.devices.views import Status
from registry.requests import Asked, AsTyped, Line, Number, Unchecked

Role = Literal["viewer", "commenter", "operator", "author", "admin"]
Kind = Literal["robot", "machine"]
Lifecycle = Literal["pending", "approved", "retired"]
Reading = Annotated[Any, Unchecked(bool | int | float | str | None)]


class Person(Schema):
    """Somebody who is signed in."""

    id: int
    name: str
    initials: str
    email: str


class DemoAccount(Schema):
    """An account that the demo shows on its sign-in page."""

    email: str
    password: str
    role: Role


class Me(Schema):
    """Who asks, whether they may make a site, and what their next request needs."""

    user: Person | None
    may_create_sites: bool
    csrf: str
    demo_accounts: list[DemoAccount]


class SignIn(Asked):
    """What somebody signs in with."""

    email: Line = Field(max_length=254)
    password: Annotated[str, AsTyped()] = Field(max_length=1000)
    code: Line = Field("", max_length=40, description="Of an authenticator app, or a recovery code.")


class NewPassword(Asked):
    """The password that somebody has, and the one that they want."""

    old: Annotated[str, AsTyped()] = Field(max_length=1000)
    new: Annotated[str, AsTyped()] = Field(max_length=1000)


class Stop(Schema):
    """The latched stop of a site."""

    active: bool
    by: str
    at: str | None


class SiteShape(Schema):
    """A site as its member sees it; `held_role` is what they are once they have the second factor that it demands."""

    slug: str
    name: str
    role: Role
    machines: int
    robots: int
    online: int
    pending: int
    has_map: bool
    stop: Stop
    simulated: bool
    held_role: Role | None


class Origin(Schema):
    """Where the grid's bottom left corner is, in metres and radians."""

    x: float
    y: float
    yaw: float


class PlaceShape(Schema):
    """A named place; `label` is where its name is written, if not beside it."""

    id: str
    name: str
    kind: str
    x: float
    y: float
    theta: float
    label: tuple[float, float] | None


ZoneRule = Literal["keep_out", "slow", "one_at_a_time", "one_way", "preferred", "release"]


class SiteZoneShape(Schema):
    """A zone of a site: corners in metres in the map frame; `speed_m_s` is how fast one may drive where it is slow.

    `robots` is how many may be in it at once where the rule is `one_at_a_time`, `heading_deg` where robots drive where
    it is `one_way`: degrees from the x axis, counter-clockwise. `open_until` is until when robots drive into one freely
    that they are let into one by one else; null, or past: they are let in one by one.
    """

    id: str
    name: str
    rule: ZoneRule
    points: list[tuple[float, float]]
    speed_m_s: float | None
    robots: int | None
    heading_deg: float | None
    open_until: datetime | None


class ObstacleShape(Schema):
    """A round thing that people put in the way of simulated robots: its middle and how wide it is, metres."""

    id: int
    x: float
    y: float
    size_m: float


class MapShape(Schema):
    """A site's map without its cells; robots plan without its `obstacles`, simulated ones meet them.

    `tag` is the ETag of the cells.
    """

    version: int
    tag: str
    width: int
    height: int
    resolution_m: float
    origin: Origin
    places: list[PlaceShape]
    zones: list[SiteZoneShape]
    obstacles: list[ObstacleShape]
    walls: list[tuple[float, float, float, float]]


class PoseShape(Schema):
    """Metres and radians in the map frame."""

    x: float
    y: float
    z: float = 0.0
    theta: float = 0.0


class SizeShape(Schema):
    """Metres."""

    x: float
    y: float
    z: float


class PropertyShape(Schema):
    """A reading and its last value."""

    name: str
    title: str
    type: str
    unit: str
    minimum: float | None
    maximum: float | None
    options: list[str]
    value: Reading


class ParameterShape(Schema):
    """An argument of a method."""

    name: str
    type: str
    unit: str
    minimum: float | None
    maximum: float | None
    options: list[str]
    required: bool


class MethodShape(Schema):
    """Something a device can be told to do."""

    name: str
    title: str
    topic: str
    message_type: str
    parameters: list[ParameterShape]


class Activity(Schema):
    """What a device is doing, for screens in other languages; `args` by code as in registry/devices/activity.py."""

    code: str
    args: dict[str, Reading]


class DeviceShape(Schema):
    """A device as it is now."""

    id: str
    name: str
    kind: Kind
    device_class: str
    icon: str
    lifecycle: Lifecycle
    status: Status
    doing: str
    activity: Activity | None
    location: PoseShape
    is_placed: bool
    size: SizeShape
    radius_m: float
    properties: list[PropertyShape]
    methods: list[MethodShape]
    asks: list[MethodShape]
    gives: list[str]
    takes: list[str]
    capacity: int
    carrying: dict[str, int]
    last_seen_at: str | None
    done: bool
    simulated: bool
    image: str
    description: str
    stand_in: bool
    stands_at: PoseShape | None
    has_key: bool
    dropped: int


class ApprovedDevice(DeviceShape):
    """A device that was let in; `credential` is its new key, told this once, null where it keeps the one it has."""

    credential: str | None
    taken: bool


class NewCredential(Schema):
    """A device's new key, told this once; `taken` says whether the device has it already."""

    credential: str
    taken: bool


class ChangeShape(Schema):
    """A field of a description that changed: its JSON before and after, empty where it was or is not there."""

    path: str
    before: str
    after: str


class DeviceEventShape(Schema):
    """One line of a device's history; `code` and `args` are what it is said from in another language."""

    at: str
    kind: str
    text: str
    code: str
    args: dict[str, Any]
    by: str
    changes: list[ChangeShape]


class Topic(Asked):
    """A topic that a device asks for, exactly as it names it."""

    topic: Line = Field(max_length=200)


class StandsAt(Asked):
    """Where a device stands: metres and radians in the map frame."""

    x: Number
    y: Number
    z: Number = 0.0
    theta: Number = 0.0


class DeviceEdit(Asked):
    """What people may say of a device; fields that are left out stay, a location of null is its own again."""

    name: Line | None = Field(None, max_length=100)
    location: StandsAt | None = None
