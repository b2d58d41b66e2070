"""What execution knows that gives cause for alerts: who is needed now, and commands that went wrong."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterator, Sequence
from datetime import datetime, timedelta

from execution.models import Command, FloorState, Run
from execution.traffic.messages import CONTROLS
from registry import services as registry

LOOK_BACK = timedelta(minutes=1)
GONE_WRONG: dict[str, registry.AlertCode] = {
    Command.Status.REJECTED: "command_rejected",
    Command.Status.FAILED: "command_failed",
    Command.Status.TIMED_OUT: "command_timed_out",
}
MOST_CHARACTERS = 300


def watch_alerts(*, now: datetime, since: datetime) -> None:
    """Raise and end alerts by how things are; `since` is when this process began to watch."""
    known = registry.list_open_alerts(codes=frozenset(GONE_WRONG.values()))
    raised = list(_find_gone_wrong(known, now))
    registry.raise_alerts(raised=raised)
    anew = {(each.device_id, each.code) for each in raised}  # later than what `known` says, so judged the next time
    before = [alert for alert in known if (alert.device_id, alert.code) not in anew]
    registry.end_alerts(ids=_find_done_since(before), at=now)
    registry.watch_devices(now=now, since=since, at_work=_find_at_work())


def _find_at_work() -> frozenset[str]:
    """Return the devices that carry something out, the robots of runs that are under way, and the doors before them."""
    commands = Command.objects.filter(status__in=Command.OPEN).exclude(method__in=CONTROLS)
    runs = Run.objects.filter(status__in=(Run.Status.RUNNING, Run.Status.PAUSED))
    robots = {robot for roles in runs.values_list("roles", flat=True) for robot in roles.values()}
    kept = FloorState.objects.filter(active=True).values_list("state__doors", flat=True)
    doors = {door["id"] for each in kept for door in each or () if door["robots"]}
    return frozenset(robots.union(doors, commands.values_list("device", flat=True).distinct()))


def _find_gone_wrong(known: Sequence[registry.AlertView], now: datetime) -> Iterator[registry.Raised]:
    """Yield the commands that went wrong within the last minute and are no alert yet, those of a kind as one.

    A piece of path that a robot refuses is none: it is given another one.
    """
    rows = Command.objects.filter(status__in=list(GONE_WRONG), ended_at__gt=now - LOOK_BACK).order_by("ended_at")
    rows = rows.exclude(method__in=CONTROLS).exclude(piece=True, status=Command.Status.REJECTED)
    told_at = {(alert.device_id, alert.code): alert.last_at for alert in known}
    together: defaultdict[tuple[str, registry.AlertCode], list[Command]] = defaultdict(list)
    for row in rows.only("device", "status", "method", "why", "ended_at"):
        key = (row.device, GONE_WRONG[row.status])
        if row.ended_at and (key not in told_at or row.ended_at > told_at[key]):
            together[key].append(row)
    for (device, code), commands in together.items():
        yield _as_raised(device, code, commands, now)


def _as_raised(device: str, code: registry.AlertCode, commands: Sequence[Command], now: datetime) -> registry.Raised:
    last = commands[-1]
    args = {"method": last.method, **({"why": last.why[:MOST_CHARACTERS]} if last.why else {})}
    return registry.Raised(device, code, last.ended_at or now, args, len(commands))


def _find_done_since(known: Sequence[registry.AlertView]) -> list[int]:
    """Return the alerts about commands whose device has carried the same method out since.

    Asked for is the one that was done last, which stands at one end of an index (`commands_done`): one row of each
    alert every second, however much the device has done, and however long nobody looked. Asked whether there is any
    since then, PostgreSQL reads the whole table, in the belief that it soon meets one.
    """
    done = Command.objects.filter(status=Command.Status.DONE).order_by("-ended_at").values_list("ended_at", flat=True)
    return [
        alert.id
        for alert in known
        if done.filter(device=alert.device_id, method=alert.args["method"], ended_at__gt=alert.last_at)[:1]
    ]
