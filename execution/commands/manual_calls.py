"""Telling a device to do something by hand, outside of any run.

A call is one row of the outbox. The floor knows of it as it knows of a run's commands: runs wait for the device, the
site's stop holds it, and it has a time limit.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from datetime import datetime, timedelta
from typing import Any
from uuid import UUID, uuid4

from django.db import transaction
from django.db.models import F

from execution import database, mailbox
from execution.errors import BadArguments, NotFound, NotPossibleNow
from execution.floor.stops import cancel_calls, get_stop, is_stopped
from execution.job_lease import fence_of
from execution.models import Command, FloorState, Run
from execution.traffic import floor
from execution.traffic.messages import CONTROLS, CallCancelled, CallSent
from execution.views import CallView, view_call
from registry import services as registry
from vipo_device.protocol.arguments import find_misfits
from vipo_device.protocol.doors import door_methods
from vipo_device.protocol.messages import EXPLORE

EXPIRY_S = 30.0
"""A call that no device has answered after so long is given up: a person waits, and a late start would surprise."""
NO_ANSWER = "The device did not answer in time. Look whether it is switched on and connected."
MOST_MISFITS = 5
ONLY_IN_PROGRAMS = "drives only in a program, where its way is kept free of others. Draw a Move and run it."


def call_method(*, site: str, device_id: str, method: str, arguments: Mapping[str, Any], by: str) -> CallView:
    """Send a device a command, and return the call.

    Raises:
        NoSuchDevice: the site has no such device.
        BadArguments: the device has no such method, or the method does not take these arguments.
        NotPossibleNow: the site is stopped, the device is busy, held by a run, away, or not approved, or the method's
            topic is not confirmed.
    """
    fence = get_stop(site=site).fence
    device = registry.get_device(site=site, device_id=device_id)
    if device.kind == "robot" and method == "move":
        raise NotPossibleNow(f"{device.name} {ONLY_IN_PROGRAMS}")
    given = {name: value for name, value in arguments.items() if value is not None}
    _check_arguments(device, method, given)
    with transaction.atomic():
        FloorState.objects.get_or_create(site_id=registry.get_site_id(site=site))
        row = FloorState.objects.select_for_update(of=("self",)).get(site__slug=site)
        present = registry.get_device(site=site, device_id=device_id)
        _check_free(row, present)
        _check_passage(row, present, method)
        _check_exploring(row, present, method)
        command = _write(row, _Order(device_id, method, given, by, fence, stand_in=present.stand_in))
        sent = CallSent(str(command.id), device_id, method, given, f"{command.by}, by hand")
        mailbox.post_to_floor(site, [(f"call:{command.id}", sent)])
        transaction.on_commit(lambda: registry.wake("gateway"))
    cancel_calls(stop=get_stop(site=site))  # a stop that was pressed meanwhile has not seen this one
    return view_call(command)


def _check_arguments(device: registry.DeviceView, method: str, arguments: Mapping[str, Any]) -> None:
    if waiting := next((asked.topic for asked in device.asks if asked.name == method), None):
        raise NotPossibleNow(f"{method} waits until an admin confirms its topic {waiting} on {device.name}'s page.")
    devices = registry.list_device_ids(site=device.site, lifecycle="approved")
    places = [place.id for place in registry.list_places(site=device.site)]
    misfits = find_misfits(device.canonical, method, arguments, devices, places)
    if misfits:
        raise BadArguments(" ".join(misfits[:MOST_MISFITS]))


def _check_free(row: FloorState, device: registry.DeviceView) -> None:
    """Refuse unless the device may be used now; the floor's row is locked, so it stays so until this is written."""
    if device.lifecycle != "approved":
        raise NotPossibleNow(f"{device.name} waits for approval. An admin of the site can approve it.")
    if is_stopped(site=device.site):
        raise NotPossibleNow("The site is stopped. Reset the stop first.")
    if not device.online:
        mend = (
            "Look whether `manage.py stand_ins` runs" if device.stand_in else "Switch it on, or look at its connection"
        )
        raise NotPossibleNow(f"{device.name} is offline. {mend}.")
    check_unused(row, device)


def check_unused(row: FloorState, device: registry.DeviceView) -> None:
    """Raise NotPossibleNow where a run holds the device, or it carries something out; the floor's row is locked."""
    if holder := _holding_run(row, device.id):
        raise NotPossibleNow(f"{device.name} is held by {_run_words(holder)}. Wait until it is over, or cancel it.")
    other = _open_commands(row.site_id, device.id).first()
    if other is not None:
        raise NotPossibleNow(f"{device.name} still carries out {other.method}. Wait until it is done.")


def _check_passage(row: FloorState, device: registry.DeviceView, method: str) -> None:
    """Refuse whatever is not opening to a door that robots pass; to open one that sticks helps them."""
    door = floor.from_json(row.state).doors.get(device.id) if row.state else None
    methods = door_methods(device.canonical)
    if door is not None and door.robots and (methods is None or method != methods.opens):
        raise NotPossibleNow(f"{device.name} is held open for robots that pass. Wait until they are through.")


def _check_exploring(row: FloorState, device: registry.DeviceView, method: str) -> None:
    """Refuse to let a robot drive where it likes among those whose ways are kept free of each other."""
    if device.kind != "robot" or method != EXPLORE:
        return
    run = Run.objects.filter(site_id=row.site_id, status__in=Run.OPEN).order_by("number").first()
    if run is not None:
        raise NotPossibleNow(
            f"{device.name} drives where it likes while it explores. Wait until run {run.number} of "
            f"“{run.program_name}” is over, or cancel it."
        )


def _holding_run(row: FloorState, device_id: str) -> str:
    """Return the id of the run that the device is needed for now, or an empty text."""
    open_runs = _open_commands(row.site_id, device_id).exclude(run=None).values_list("run", flat=True)
    if row.state is None:
        return str(open_runs.first() or "")
    state = floor.from_json(row.state)
    robot = state.robots.get(state.stations.get(device_id, device_id))
    held = [robot.run if robot else "", state.calls.get(device_id, ""), *map(str, open_runs)]
    acting = [task.run for task in state.tasks if task.command and task.order.target.id == device_id]
    return next((run for run in (*held, *acting) if _is_run(run)), "")


def _is_run(run: str) -> bool:
    return bool(run) and Run.objects.filter(id=run).exists()


def _run_words(run: str) -> str:
    row = Run.objects.get(id=run)
    return f"run {row.number} of “{row.program_name}”"


def _open_commands(site: int, device_id: str) -> Any:
    rows = Command.objects.filter(site_id=site, device=device_id, status__in=Command.OPEN)
    return rows.exclude(method__in=CONTROLS).order_by("position")


@dataclass(frozen=True, slots=True)
class _Order:
    """What a person tells a device, and the site's fence when they did."""

    device: str
    method: str
    arguments: Mapping[str, Any]
    by: str
    fence: int
    stand_in: bool


def _write(row: FloorState, order: _Order) -> Command:
    now = database.now()
    # By the epoch the owner sees that the device is taken now: what it has decided meanwhile is decided anew.
    FloorState.objects.filter(pk=row.pk).update(commands=F("commands") + 1, epoch=F("epoch") + 1)
    return Command.objects.create(
        id=uuid4(),
        site_id=row.site_id,
        position=row.commands,
        device=order.device,
        method=order.method,
        arguments=dict(order.arguments),
        by=order.by[:120],
        fence=fence_of(row.site_id),
        site_fence=order.fence,
        stand_in=order.stand_in,
        ttl_s=EXPIRY_S,
        send_after=now,
        created_at=now,
    )


def get_call(*, site: str, call_id: UUID) -> CallView:
    """Return a call and what has come of it. Raises NotFound."""
    return view_call(_find(site, call_id))


def list_open_calls(*, site: str) -> list[CallView]:
    """Return the calls of a site that are under way, oldest first."""
    rows = Command.objects.filter(site__slug=site, run=None, status__in=Command.OPEN)
    return [view_call(row) for row in rows.exclude(by="").order_by("created_at", "id")]


def cancel_call(*, site: str, call_id: UUID) -> CallView:
    """Ask the device to end a call; one that is over stays as it is. Raises NotFound."""
    command = _find(site, call_id)
    if command.status in Command.OPEN:
        mailbox.post_to_floor(site, [(f"call-cancel:{command.id}", CallCancelled(str(command.id)))])
    return view_call(command)


def _find(site: str, call_id: UUID) -> Command:
    command = Command.objects.filter(id=call_id, site__slug=site, run=None).exclude(by="").first()
    if command is None:
        raise NotFound("There is no such call at this site.")
    return command


def expire_calls(*, now: datetime) -> int:
    """Give up the calls that no device has answered; return how many."""
    waiting = (Command.Status.PENDING, Command.Status.SENT)
    late = Command.objects.filter(status__in=waiting, run=None, created_at__lt=now - timedelta(seconds=EXPIRY_S))
    count = 0
    for command in late.exclude(by="").select_related("site"):
        with transaction.atomic():
            mine = Command.objects.filter(id=command.id, status__in=waiting)
            if mine.update(status=Command.Status.TIMED_OUT, why=NO_ANSWER, ended_at=now):
                given_up = CallCancelled(str(command.id), given_up=True)
                mailbox.post_to_floor(command.site.slug, [(f"call-expired:{command.id}", given_up)])
                count += 1
    return count
