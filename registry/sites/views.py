"""What the registry says of sites and their places: frozen, and free of the database."""

from __future__ import annotations

from dataclasses import asdict, dataclass
from datetime import datetime
from typing import Any


@dataclass(frozen=True, slots=True)
class PlaceView:
    """A named place; metres and radians in the map frame. `label` is where its name is written, if not beside it."""

    id: str
    name: str
    kind: str
    x: float
    y: float
    theta: float
    label: tuple[float, float] | None = None


@dataclass(frozen=True, slots=True)
class ZoneView:
    """A zone of a site: a polygon in metres in the map frame; `speed_m_s` is how fast one may drive where it is slow.

    `rule` is `keep_out`, `slow`, `preferred`, `one_way`, where `heading_deg` says where one drives (degrees from the x
    axis, counter-clockwise), or `one_at_a_time`, where `robots` says how many may be in it at once.
    """

    id: str
    name: str
    rule: str
    points: tuple[tuple[float, float], ...]
    speed_m_s: float | None = None
    robots: int | None = None
    heading_deg: float | None = None
    open_until: datetime | None = None
    """Where people let robots in one by one: until when all may drive in; None, or past: nobody may."""


@dataclass(frozen=True, slots=True)
class ObstacleView:
    """A round thing on a site's floor that simulated robots meet: its middle and how wide it is, metres."""

    id: int
    x: float
    y: float
    size_m: float


@dataclass(frozen=True, slots=True)
class StopView:
    """The latched stop of a site."""

    active: bool
    by: str
    at: datetime | None


@dataclass(frozen=True, slots=True)
class SiteView:
    """A site and its counts; `role` is what the asking user is there, empty when nobody asks.

    `held_role` is what they would be with the second factor that the site demands of them.
    """

    slug: str
    name: str
    role: str
    machines: int
    robots: int
    online: int
    pending: int
    has_map: bool
    stop: StopView
    simulated: bool
    held_role: str = ""


def site_to_json(view: SiteView) -> dict[str, Any]:
    """Return the site as the API says it."""
    body = asdict(view)
    body["held_role"] = view.held_role or None
    body["stop"]["at"] = view.stop.at.isoformat() if view.stop.at else None
    return body
