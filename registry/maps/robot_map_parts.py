"""A robot's map on `up/map`: parts wait in the database until all are there, whichever gateways heard them.

A robot has one map under way: the first part of a newer one (by boot and number) forgets the parts of the one before.
So what a robot that never finishes can fill is bounded, and so is what all of them together can.
"""

from __future__ import annotations

from dataclasses import dataclass
from datetime import datetime, timedelta

from django.db import transaction
from django.db.models import Q, QuerySet

from registry.floorplan.map_message import GridPart, read_grid_part, unpack_grid
from registry.floorplan.plan import Grid
from registry.maps.robot_maps import keep_robot_map
from registry.models import Device, RobotMapDraft, RobotMapPart
from vipo_device.protocol.faults import fault
from vipo_device.protocol.messages import BadMessage

MOST_PACKED = 4_000_000
"""Bytes of one map as it comes, packed; the parts that the protocol allows have not many more."""
MOST_DRAFTS = 32
DRAFT_LIFE = timedelta(minutes=10)
MAPS_AT_ONCE = 3.0
MAP_EVERY_S = 5.0


@dataclass(frozen=True, slots=True)
class Whole:
    """A map all of whose parts have come, and its cells as they came."""

    grid: Grid
    packed: bytes


Outcome = Whole | BadMessage | None


def ingest_map_part(*, device_id: str, payload: bytes, at: datetime) -> bool:
    """Take in one message of `up/map`; True when it made a map whole, which is kept then. Raises BadMessage.

    Left aside is what comes from devices that are not approved, of an older boot or map, and twice.
    """
    part = read_grid_part(payload)
    with transaction.atomic():
        device = _find_robot(device_id, part.boot)
        outcome = None if device is None else _take(device, part, at)
    if isinstance(outcome, BadMessage):
        raise outcome  # what was decided about the parts holds all the same
    return outcome is not None


def _find_robot(device_id: str, boot: int) -> Device | None:
    rows = Device.objects.filter(pk=device_id, lifecycle=Device.Lifecycle.APPROVED, description__isnull=False)
    device = rows.select_related("site").defer("source").first()
    if device is None or device.is_locked_out or boot < device.presence_boot:
        return None
    if not device.description or device.description["kind"] != "robot":
        raise BadMessage(fault("map_of_machine"))
    return device


def _take(device: Device, part: GridPart, at: datetime) -> Outcome:
    draft = _lock_draft(device, at)
    name, known = (part.boot, part.number), (draft.boot, draft.number)
    if name < known or (name == known and draft.is_over):
        return None
    if name == known and draft.head != _head(part):
        return BadMessage(fault("map_parts_differ"))
    draft.spoken_at = at
    if name > known:
        _begin(draft, part)
    outcome = _add(draft, part)
    if isinstance(outcome, Whole):
        keep_robot_map(device=device, grid=outcome.grid, packed=outcome.packed, at=at)
    draft.save()
    return outcome


def _lock_draft(device: Device, at: datetime) -> RobotMapDraft:
    rows = RobotMapDraft.objects.select_for_update(of=("self",))
    draft = rows.filter(pk=device.pk).first()
    if draft is None:
        defaults = {"spoken_at": at, "tokens": MAPS_AT_ONCE, "filled_at": at}
        RobotMapDraft.objects.get_or_create(device=device, defaults=defaults)
        draft = rows.get(pk=device.pk)
    return draft


def _head(part: GridPart) -> list[float]:
    return [part.parts, part.width, part.height, part.resolution_m, *part.origin]


def _begin(draft: RobotMapDraft, part: GridPart) -> None:
    """Forget what is left of an older map, and of the robots that have said nothing of theirs for the longest."""
    RobotMapPart.objects.filter(draft=draft).delete()
    draft.boot, draft.number, draft.head = part.boot, part.number, _head(part)
    draft.size, draft.is_over = 0, False
    others = RobotMapDraft.objects.filter(size__gt=0).exclude(pk=draft.pk)
    newest = others.order_by("-spoken_at").values_list("pk", flat=True)[: MOST_DRAFTS - 1]
    silent = others.filter(Q(spoken_at__lt=draft.spoken_at - DRAFT_LIFE) | ~Q(pk__in=list(newest)))
    for other in silent.select_for_update(skip_locked=True, of=("self",)):
        _forget(other)
        other.save()


def _forget(draft: RobotMapDraft) -> None:
    RobotMapPart.objects.filter(draft=draft).delete()
    draft.size, draft.is_over = 0, True


def _add(draft: RobotMapDraft, part: GridPart) -> Outcome:
    """Add a part, and return the map when it was the last one that was missing."""
    _, is_new = RobotMapPart.objects.get_or_create(draft=draft, part=part.part, defaults={"packed": part.packed})
    draft.size += len(part.packed) if is_new else 0
    if draft.size > MOST_PACKED:
        _forget(draft)
        return BadMessage(fault("map_bytes", most=MOST_PACKED))
    rows = RobotMapPart.objects.filter(draft=draft).order_by("part")
    return _finish(draft, part, rows) if rows.count() == part.parts else None


def _finish(draft: RobotMapDraft, part: GridPart, rows: QuerySet[RobotMapPart]) -> Outcome:
    packed = b"".join(bytes(row) for row in rows.values_list("packed", flat=True))
    _forget(draft)
    if not _take_token(draft):
        return BadMessage(fault("map_too_often", seconds=f"{MAP_EVERY_S * 2:g}"))
    try:
        return Whole(unpack_grid(part, packed), packed)
    except BadMessage as error:
        return error


def _take_token(draft: RobotMapDraft) -> bool:
    """Allow so many maps at once and one every few seconds: each costs some time to unpack."""
    filled_s = (draft.spoken_at - draft.filled_at).total_seconds()
    draft.tokens = min(MAPS_AT_ONCE, draft.tokens + max(0.0, filled_s) / MAP_EVERY_S)
    draft.filled_at = draft.spoken_at
    if draft.tokens < 1:
        return False
    draft.tokens -= 1
    return True
