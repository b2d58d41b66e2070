"""Which commands may go out now, and who sends them: several gateways ask, each command goes to one of them."""

from __future__ import annotations

from bisect import bisect_left
from collections import defaultdict
from collections.abc import Iterable
from dataclasses import dataclass
from datetime import UTC, datetime, timedelta
from uuid import UUID

from django.db import transaction
from django.db.models import F

from execution.models import Command, SiteStop
from registry import services as registry
from registry import wire

FIRST_RETRY_S = 2.0
LAST_RETRY_S = 15.0
NEVER_AGAIN_S = 7 * 86_400.0
"""A device that knows only its done flag would carry out a command anew each time that it hears it."""
MOST_DUE = 5000
CONTROLS = ("pause", "resume", "cancel")
UNANSWERED = (Command.Status.PENDING, Command.Status.SENT)
WINDOW = 12
"""A device remembers its last 16 commands: nobody runs so far ahead of an open one that it would do that one again."""


@dataclass(frozen=True, slots=True)
class OutgoingCommand:
    """A command as it goes out over MQTT."""

    id: str
    device: str
    topic: str
    payload: bytes
    ttl_s: float


@dataclass(frozen=True, slots=True)
class _Waiting:
    """An open command that is due; `position` orders the commands of a site."""

    id: UUID
    site: int
    device: str
    position: int
    piece: bool
    is_first_try: bool
    is_control: bool


@dataclass(slots=True)
class _Lane:
    """The open commands of one device at one site, by their positions."""

    site: int
    device: str
    oldest: int
    unanswered_piece: int | None = None
    since_oldest: list[int] | None = None

    def holds_piece(self, position: int) -> bool:
        """Tell whether a piece of way before this one is not answered yet."""
        return self.unanswered_piece is not None and self.unanswered_piece < position

    def is_far_ahead(self, position: int) -> bool:
        """Tell whether at least `WINDOW` commands lie between the oldest open one and this one."""
        if position - self.oldest < WINDOW:
            return False
        if self.since_oldest is None:
            own = Command.objects.filter(site_id=self.site, device=self.device, position__gte=self.oldest)
            self.since_oldest = list(own.order_by("position").values_list("position", flat=True))
        return bisect_left(self.since_oldest, position) >= WINDOW


def claim_commands(*, limit: int) -> tuple[OutgoingCommand, ...]:
    """Return commands that are due to be sent, in their order; nobody else is given them for a while.

    One whose sending is not confirmed by `mark_commands_sent`, or that no device answers, is given out again. While a
    site is stopped only pause, resume and cancel go out. A piece of way waits until the robot has accepted the piece
    before it: with a gateway that died in between, it would otherwise cut the corner through a wall. Nothing new goes
    out while a command that is `WINDOW` older is open: asked again, the device might have forgotten it.
    """
    now = datetime.now(UTC)
    due = _list_due(now)
    if not due:
        return ()
    chosen = _let_out(due)[:limit]
    return tuple(_outgoing(row) for row in _take([row.id for row in chosen], now))


def _list_due(now: datetime) -> list[_Waiting]:
    rows = Command.objects.filter(status__in=Command.OPEN, send_after__lte=now).order_by("site_id", "position")
    found = rows.values_list("id", "site_id", "device", "position", "piece", "tries", "method")[:MOST_DUE]
    return [
        _Waiting(key, site, device, position, piece, tries == 0, method in CONTROLS)
        for key, site, device, position, piece, tries, method in found
    ]


def _let_out(due: list[_Waiting]) -> list[_Waiting]:
    """Leave out what has to wait for another command, or for the end of a stop."""
    stopped = set(SiteStop.objects.filter(active=True).values_list("site_id", flat=True))
    lanes = _read_lanes({row.device for row in due})
    return [row for row in due if _may_go(row, lanes.get((row.site, row.device)), is_stopped=row.site in stopped)]


def _may_go(row: _Waiting, lane: _Lane | None, *, is_stopped: bool) -> bool:
    if row.is_control:
        return True
    if is_stopped:
        return False
    if lane is None:  # everything of the device has ended meanwhile, this one too
        return False
    if row.piece and lane.holds_piece(row.position):
        return False
    return not (row.is_first_try and lane.is_far_ahead(row.position))


def _read_lanes(devices: set[str]) -> dict[tuple[int, str], _Lane]:
    lanes: dict[tuple[int, str], _Lane] = {}
    rows = Command.objects.filter(device__in=devices, status__in=Command.OPEN).order_by("position")
    for site, device, position, piece, status in rows.values_list("site_id", "device", "position", "piece", "status"):
        lane = lanes.setdefault((site, device), _Lane(site, device, position))
        if piece and status in UNANSWERED and lane.unanswered_piece is None:
            lane.unanswered_piece = position
    return lanes


def _take(ids: list[UUID], now: datetime) -> list[Command]:
    """Take these for ourselves until their next try; another gateway that asks at the same time gets none of them."""
    later: dict[float, list[UUID]] = defaultdict(list)
    with transaction.atomic():
        rows = Command.objects.filter(id__in=ids, status__in=Command.OPEN, send_after__lte=now)
        taken = list(rows.select_for_update(skip_locked=True, of=("self",)).order_by("site_id", "position"))
        once = registry.list_done_flag_only(devices={row.device for row in taken})
        for row in taken:
            later[NEVER_AGAIN_S if row.device in once else _wait_s(row)].append(row.id)
        for wait_s, those in later.items():
            again = now + timedelta(seconds=wait_s)
            Command.objects.filter(id__in=those).update(tries=F("tries") + 1, send_after=again)
    return taken


def _wait_s(row: Command) -> float:
    if row.status in {Command.Status.ACCEPTED, Command.Status.RUNNING}:
        return LAST_RETRY_S
    return min(LAST_RETRY_S, FIRST_RETRY_S * 2.0**row.tries)


def _outgoing(row: Command) -> OutgoingCommand:
    payload = wire.command_payload(str(row.id), row.arguments, row.ttl_s)
    return OutgoingCommand(str(row.id), row.device, wire.down_topic(row.device, row.method), payload, row.ttl_s)


def mark_commands_sent(*, ids: Iterable[str]) -> None:
    """Say that these commands have gone out."""
    sent = Command.objects.filter(id__in=list(ids), status=Command.Status.PENDING)
    sent.update(status=Command.Status.SENT, sent_at=datetime.now(UTC))
