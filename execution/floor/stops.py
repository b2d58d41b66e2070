"""Stop all: latched for a site, past all queues, reset only by an operator. Not an emergency stop in the safety sense.

The latch is one statement of its own: whoever is dead or frozen in the middle of a press holds nobody up, and from it
on no command leaves (`execution.commands.claim`). Each press and each reset raises the site's fence. What was begun
under an older fence than the last press stands still until a person resumes it, however the two crossed; what runs,
floor and armed programs are told follows from the latch, is told once for each fence, and by anybody.
"""

from __future__ import annotations

import json
import logging
import time
from dataclasses import dataclass
from datetime import UTC, datetime
from uuid import uuid4

from django.db import OperationalError, connection, transaction
from django.db.models import BigIntegerField, F, QuerySet, Value
from django.db.models.functions import Greatest

from execution import mailbox
from execution.floor import stop_publisher
from execution.machine.messages import PauseAsked
from execution.models import ArmedProgram, Command, Run, SiteStop, StopFollowed
from execution.traffic.messages import CallCancelled, StopPressed, StopReset
from registry import services as registry
from vipo_device.protocol.clock import steady_s
from vipo_device.protocol.messages import StopMessage

log = logging.getLogger(__name__)
HELD_UP_S = 0.5


@dataclass(frozen=True, slots=True)
class StopView:
    """The stop of a site; `fence` is raised by each press and reset, `pressed` is what the last press raised it to."""

    site: str
    active: bool
    by: str
    at: datetime | None
    fence: int = 0
    pressed: int = 0


def stop_payload(stop: StopView) -> bytes:
    """Return what devices are told of a stop: `{"active", "at", "fence"}`."""
    at = stop.at.isoformat() if stop.at else None
    return json.dumps({"active": stop.active, "at": at, "fence": stop.fence}).encode()


def list_stops() -> tuple[StopView, ...]:
    """Return the stop of every site where it was ever pressed."""
    rows = SiteStop.objects.select_related("site").order_by("site_id")
    return tuple(_view(row) for row in rows)


def get_stop(*, site: str) -> StopView:
    """Return the stop of a site as it is now; not pressed where it never was."""
    row = SiteStop.objects.select_related("site").filter(site__slug=site).first()
    return StopView(site, False, "", None) if row is None else _view(row)


def _view(row: SiteStop) -> StopView:
    return StopView(row.site.slug, row.active, row.by, row.at, row.fence, row.pressed)


def is_stopped(*, site: str) -> bool:
    """Tell whether the site's stop is latched."""
    return get_stop(site=site).active


def press_stop(*, site: str, by: str) -> StopView:
    """Stop every device of the site and pause every run; pressing it again changes nothing."""
    return _change(site, active=True, by=by)


def reset_stop(*, site: str, by: str) -> StopView:
    """Let the site's devices be used again; runs stay paused until somebody resumes them."""
    return _change(site, active=False, by=by)


def _change(site: str, *, active: bool, by: str) -> StopView:
    """Latch or unlatch, tell the devices, then let everything follow; the second who does so follows, too."""
    began_s = steady_s()
    number = registry.get_site_id(site=site)
    SiteStop.objects.get_or_create(site_id=number)
    next_fence = Greatest(F("fence") + 1, Value(time.time_ns() // 1_000_000, output_field=BigIntegerField()))
    raised = {"fence": next_fence, "pressed": next_fence} if active else {"fence": next_fence}
    latch = SiteStop.objects.filter(site_id=number, active=not active)
    is_news = latch.update(active=active, by=by, at=datetime.now(UTC), **raised)
    stop = get_stop(site=site)
    if is_news:
        transaction.on_commit(lambda: _tell(stop, began_s))
    follow_stop(site=site)
    return stop


def _tell(stop: StopView, began_s: float) -> None:
    """Tell the devices by this process's own way, wake the gateways for theirs, and tell the browsers."""
    stop_publisher.publish_stop(stop.site, stop_payload(stop), began_s)
    for channel in ("stops", "gateway"):  # what there is to look at, then the hint that ends the gateway's wait
        registry.wake(channel)
    at = stop.at.isoformat() if stop.at else None
    registry.publish(stop.site, {"type": "stop", "active": stop.active, "by": stop.by, "at": at})


def catch_up_stop(*, site: str, told: StopMessage) -> StopView:
    """Raise a fence that is older than what devices were told, as after a database was put back from a backup.

    Devices would take no command otherwise. One that they were told to be stopped under stays stopped.
    """
    fence = told.fence or 0
    behind = SiteStop.objects.filter(site__slug=site, fence__lt=fence)
    if told.active:
        behind.update(fence=fence + 1, pressed=fence + 1, active=True, at=datetime.now(UTC))
    else:
        behind.update(fence=fence + 1)
    follow_stop(site=site)
    return get_stop(site=site)


def follow_stop(*, site: str) -> bool:
    """Tell runs, floor, calls and armed programs of a stop what they have not heard.

    False while somebody else does, or holds what it needs: the ticker sees to it then, and nobody waits here for who
    sleeps.
    """
    StopFollowed.objects.get_or_create(site_id=registry.get_site_id(site=site))
    try:
        return _follow_alone(site)
    except OperationalError as error:
        log.warning("What follows from the stop of %s waits for the ticker: %s", site, error)
        return False


def _follow_alone(site: str) -> bool:
    with transaction.atomic():
        if connection.vendor == "postgresql":
            with connection.cursor() as cursor:
                cursor.execute(f"SET LOCAL lock_timeout = '{HELD_UP_S}s'")
        told = StopFollowed.objects.select_for_update(skip_locked=True, of=("self",)).filter(site__slug=site).first()
        if told is None:
            return False
        stop = get_stop(site=site)
        if told.fence != stop.fence:
            _note(stop, told)
            _follow(stop)
            StopFollowed.objects.filter(pk=told.pk).update(fence=stop.fence)
    return True


def _note(stop: StopView, told: StopFollowed) -> None:
    """Write into the site's record what was pressed since it was told last; by whom is known of the latest alone.

    Not with the latch itself, which waits for nothing.
    """
    shown = told.site
    if stop.active and (not shown.stop_active or shown.stop_at != stop.at):
        registry.note_act(site_id=shown.pk, code="stop_pressed", by=stop.by, at=stop.at)
    elif not stop.active:
        if not shown.stop_active and stop.pressed > told.fence:
            registry.note_act(site_id=shown.pk, code="stop_pressed", actor=registry.VIPO)
        if shown.stop_active or stop.pressed > told.fence:
            registry.note_act(site_id=shown.pk, code="stop_reset", by=stop.by, at=stop.at)


def _follow(stop: StopView) -> None:
    if stop.at is not None:
        registry.set_site_stop(site=stop.site, active=stop.active, by=stop.by, at=stop.at)
    pause_held(_open_held(stop.site))
    cancel_calls(stop=stop)
    _disarm_all(stop)
    mailbox.post_to_floor(stop.site, [(f"stop:{stop.site}:{stop.pressed}", StopPressed())])
    if not stop.active:
        mailbox.post_to_floor(stop.site, [(f"reset:{stop.site}:{stop.fence}", StopReset())])


def follow_stops() -> None:
    """Look after what was cut off: stops that were not followed to the end, and runs that go on under an old fence."""
    behind = SiteStop.objects.exclude(site__stop_followed__fence=F("fence")).filter(fence__gt=0)
    for site in list(behind.values_list("site__slug", flat=True)):
        follow_stop(site=site)
    with transaction.atomic():
        pause_held(_open_held().exclude(status=Run.Status.PAUSED))


def _open_held(site: str = "") -> QuerySet[Run]:
    there = {"site__slug": site} if site else {}
    return Run.objects.filter(status__in=Run.OPEN, fence__lt=F("site__stop_latch__pressed"), **there)


def pause_held(runs: QuerySet[Run], again: str = "") -> None:
    """Ask runs to pause that stand still under an old fence, once at each of their steps, or once more."""
    facts = ("id", "site__slug", "epoch", "site__stop_latch__pressed", "site__stop_latch__by")
    for run, site, epoch, pressed, by in list(runs.values_list(*facts)):
        who = by or "Somebody"
        asked = PauseAsked(f"{who} stopped all devices of the site")
        mailbox.post_to_run(site, run, [(f"stop:{run}:{pressed}:{epoch}{again}", asked)])


def hold_if_stopped(run: Run) -> bool:
    """Pause a run that began or went on while the stop was pressed; tell whether that was so."""
    mine = _open_held().filter(id=run.id)
    if not mine.exists():
        return False
    with transaction.atomic():
        pause_held(mine, f":{uuid4().hex}")  # the one that it was sent with the stop may stand before the order
    return True


def cancel_calls(*, stop: StopView) -> None:
    """End what people told devices by hand before the stop: there is nothing with which they could resume it."""
    calls = Command.objects.filter(site__slug=stop.site, status__in=Command.OPEN, site_fence__lt=stop.pressed)
    if not calls.exists():
        return
    with transaction.atomic():
        unsent = calls.select_for_update(skip_locked=True, of=("self",)).filter(status=Command.Status.PENDING, tries=0)
        over = list(unsent.values_list("id", flat=True))
        why, now = f"{stop.by or 'Somebody'} stopped all devices of the site", datetime.now(UTC)
        calls.filter(id__in=over).update(status=Command.Status.CANCELLED, why=why, ended_at=now)
        for call in over:
            given_up = CallCancelled(str(call), given_up=True)
            mailbox.post_to_floor(stop.site, [(f"call-stopped:{call}", given_up)])
        for call in list(calls.values_list("id", flat=True)):
            mailbox.post_to_floor(stop.site, [(f"call-cancel:{call}", CallCancelled(str(call)))])


def _disarm_all(stop: StopView) -> None:
    """No program starts by itself after a stop until somebody arms it again."""
    if ArmedProgram.objects.filter(site__slug=stop.site, fence__lt=stop.pressed).delete()[0]:
        transaction.on_commit(lambda: registry.publish(stop.site, {"type": "armed", "programs": []}))
