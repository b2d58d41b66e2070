"""Devices as W3C Things: how they are written, what people may change of one, and what has become of one.

What becomes of Things is kept in the order in which it was decided; the newest thousand for who was away.
"""

from __future__ import annotations

import json
from collections.abc import Collection, Mapping, Sequence
from dataclasses import dataclass, replace
from hashlib import sha256
from math import isfinite
from typing import Any, Literal

from django.db import connection, transaction
from django.db.models import Max

from registry.devices.thing_forms import consumed_thing
from registry.devices.views import OWN_PLACE, DeviceView, NewPlace
from registry.errors import RegistryError
from registry.live.fanout import publish
from registry.models import Site, ThingEvent
from vipo_device.descriptions.thing_description import DEVICE_URN
from vipo_device.protocol.description import Description, Pose
from vipo_device.protocol.messages import BadMessage, parse_json

EventName = Literal["thing_created", "thing_updated", "thing_deleted"]
EVENTS: tuple[EventName, ...] = ("thing_created", "thing_updated", "thing_deleted")
PATCHABLE = ("title", "vipo:location")
THINGS = ":things"
"""Where it is called out that there is news; no site has such a name."""
MOST_KEPT = 1000
_ORDER_LOCK = 0x7468696E67


class BadThingPatch(RegistryError):
    """A change of a Thing that is no merge patch, or of what is not for people to change."""

    code = "bad_thing_patch"
    status = 400


@dataclass(frozen=True, slots=True)
class ThingPatch:
    """What people may say of a Thing; None stays as it is, an empty name is the device's own again."""

    name: str | None
    pose: NewPlace | None


def thing_to_json(view: DeviceView, base: str) -> dict[str, Any]:
    """Return a device as a Thing Description, with the name and place that hold; `base` is where VIPO is served."""
    return {**consumed_thing(view.played, view.site), "base": base}


def thing_text(view: DeviceView, base: str) -> str:
    """Return a device's Thing Description as it is sent."""
    return json.dumps(thing_to_json(view, base), ensure_ascii=False)


def thing_tag(text: str) -> str:
    """Return the entity tag (RFC 9110) of what is sent."""
    return f'"{sha256(text.encode()).hexdigest()[:32]}"'


def device_id_of(thing: str) -> str:
    """Return the device's id of a Thing's, which may be given with or without its `urn:vipo:device:`."""
    return thing.removeprefix(DEVICE_URN)


def read_patch(body: bytes) -> ThingPatch:
    """Read a JSON merge patch (RFC 7396) of `title` and `vipo:location`. Raises BadThingPatch."""
    try:
        patch = parse_json(body)
    except BadMessage as error:
        said = error.fault.about("The patch").sentence
        raise BadThingPatch(f'{said} Send a JSON object, such as {{"title": "Oven"}}.') from error
    if not isinstance(patch, dict) or not patch:
        raise BadThingPatch("A merge patch is a JSON object with at least one field.")
    if strange := [name for name in patch if name not in PATCHABLE]:
        raise BadThingPatch(
            f"{strange[0][:64]!r} cannot be changed here: the device says it itself. Change {' or '.join(PATCHABLE)}."
        )
    return ThingPatch(_title(patch), _pose(patch))


def _title(patch: Mapping[str, Any]) -> str | None:
    title = patch.get("title", "")
    if title is not None and not isinstance(title, str):
        raise BadThingPatch("`title` must be a text, or null for the device's own.")
    return (title or "") if "title" in patch else None


def _pose(patch: Mapping[str, Any]) -> NewPlace | None:
    if "vipo:location" not in patch:
        return None
    numbers = patch["vipo:location"]
    if numbers is None:
        return OWN_PLACE
    if not isinstance(numbers, list) or len(numbers) not in (2, 3, 4) or not all(map(_is_number, numbers)):
        raise BadThingPatch(
            "`vipo:location` must be [x, y, z, theta] in metres and radians, z and theta may be left out; or null for "
            "the device's own."
        )
    return Pose(*map(float, numbers))


def _is_number(value: Any) -> bool:
    return isinstance(value, int | float) and not isinstance(value, bool) and isfinite(value)


def what_became(before: DeviceView | None, after: DeviceView) -> tuple[EventName, dict[str, Any]] | None:
    """Return what a decision or a description made of a Thing, and the change: nothing for readings and drives.

    The change is the whole Thing but its `base` when it is new, and a merge patch (RFC 7396) when it is another.
    """
    was, is_now = _as_listed(before), _as_listed(after)
    if was == is_now:
        return None
    if is_now is None:
        return ("thing_deleted", {})
    if was is None:
        return ("thing_created", consumed_thing(after.played, after.site))
    change = merge_patch(consumed_thing(was, after.site), consumed_thing(is_now, after.site))
    return ("thing_updated", change) if change else None


def _as_listed(view: DeviceView | None) -> Description | None:
    """Return what a directory says of a device but for its state; None when it does not stand there."""
    if view is None or view.lifecycle != "approved":
        return None
    still = replace(view.played, done=True)
    return replace(still, pose=Pose(0.0, 0.0)) if view.kind == "robot" else still


def merge_patch(before: Mapping[str, Any], after: Mapping[str, Any]) -> dict[str, Any]:
    """Return the JSON merge patch (RFC 7396) that makes the one of the other; null takes a member away."""
    patch: dict[str, Any] = {name: None for name in before if name not in after}
    for name, value in after.items():
        old = before.get(name)
        if isinstance(old, Mapping) and isinstance(value, Mapping):
            patch |= {name: inner} if (inner := merge_patch(old, value)) else {}
        elif name not in before or old != value:
            patch[name] = value
    return patch


@dataclass(frozen=True, slots=True)
class ThingNews:
    """What became of a Thing; `change` as `what_became` says it. Later news have greater ids."""

    id: int
    kind: str
    device_id: str
    change: Mapping[str, Any]


def record_thing(before: DeviceView | None, after: DeviceView) -> None:
    """Write what became of a device's Thing, if anything did; call it within the transaction that changes it."""
    record_things([(before, after)])


def record_things(changes: Sequence[tuple[DeviceView | None, DeviceView]]) -> None:
    """Write what became of devices' Things, if anything did; call it within the transaction that changes them."""
    became = [(after, what_became(before, after)) for before, after in changes]
    told = [(after, news) for after, news in became if news is not None]
    if not told:
        return
    _wait_for_turn()
    sites = dict(Site.objects.filter(slug__in={after.site for after, _ in told}).values_list("slug", "pk"))
    rows = ThingEvent.objects.bulk_create(
        ThingEvent(site_id=sites[after.site], device_id=after.id, kind=kind, change=change)
        for after, (kind, change) in told
    )
    ThingEvent.objects.filter(pk__lte=rows[-1].pk - MOST_KEPT).delete()
    transaction.on_commit(call_listeners)


def _wait_for_turn() -> None:
    """See to it that ids become visible in their order: a reader never finds a lower one later."""
    if connection.vendor == "postgresql":
        with connection.cursor() as cursor:
            cursor.execute("SELECT pg_advisory_xact_lock(%s)", [_ORDER_LOCK])


def call_listeners() -> None:
    """Let those who listen look for news, and whether they may still hear them."""
    publish(THINGS, {"type": "things"})


def newest_news() -> int:
    """Return the newest id; 0 before the first."""
    return ThingEvent.objects.aggregate(newest=Max("pk"))["newest"] or 0


def is_kept_since(after: int) -> bool:
    """Tell whether all that came after that id is still there."""
    newest = newest_news()
    return newest - MOST_KEPT <= after <= newest


def read_news(*, after: int, sites: Collection[str], most: int) -> tuple[ThingNews, ...]:
    """Return at most that many news of these sites that came after that id, oldest first."""
    rows = ThingEvent.objects.filter(pk__gt=after, site__slug__in=sites).order_by("pk")[:most]
    return tuple(ThingNews(row.pk, row.kind, row.device_id, row.change) for row in rows)
