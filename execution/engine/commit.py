"""What a turn has come to, in one transaction under the lease; afterwards people and the gateway hear of it."""

from __future__ import annotations

import json
import time
from collections.abc import Iterable, Iterator, Sequence
from datetime import datetime, timedelta
from typing import Any
from uuid import UUID

from django.conf import settings
from django.db import IntegrityError, InterfaceError, OperationalError, transaction

from execution import database
from execution.engine import lease as leases
from execution.engine.dead_letter_capture import ByHand
from execution.engine.inbox import mark_taken
from execution.engine.lease import Lease
from execution.engine.rows import Guarded, insert_all, update_all
from execution.engine.turn import Turn
from execution.fault_points import fault_point
from execution.floor.fold import FloorWork, publish_traffic
from execution.floor_protocol import to_json
from execution.machine import machine
from execution.machine import messages as r
from execution.models import Command, DeadLetter, InboxEvent, Run, RunEvent, RunInput, Timer
from execution.runs import questions
from execution.runs.fold import RunWork
from execution.runs.journal import shown
from execution.traffic import floor
from execution.traffic import messages as m
from registry import services as registry

MOST_CHARACTERS = 300
FLOOR_BEAT_S = 2.0
"""The time of a floor at work is written at least so often: the next owner finds no gap where there was none."""
_FLOOR = """
UPDATE execution_floorstate
SET state = %(state)s, active = %(active)s, epoch = epoch + 1, commands = commands + %(more)s
WHERE id = %(id)s AND epoch = %(epoch)s
"""


WRITTEN = (
    "status", "reason", "watches", "late", "notices", "steps", "roles", "next_seq", "inputs_kept", "started_at",
    "ended_at",
)  # fmt: skip
"""What a turn may change of a run's row beside its state."""
BEGUN = ("state", "places", *WRITTEN)
"""What is written of a run that begins."""


class Outdated(Exception):
    """Somebody else has changed a run or the floor: what was decided about it is decided anew."""


def commit(turn: Turn, lease: Lease) -> bool:
    """Write what has changed and bring the memory up to date; False when nothing was worth writing.

    Raises LeaseLost or Outdated, and nothing is written.
    """
    is_beat = _is_beat_due(turn)
    if not turn.is_change and not is_beat:
        _remember(turn, is_floor=False)
        _show_traffic(turn)
        return False
    is_floor = turn.has_new_floor or is_beat
    with transaction.atomic():
        _write(turn, lease, is_floor=is_floor)
        _write_rest(turn, is_floor=is_floor)
        fault_point("before_commit")
    fault_point("after_commit")
    _tell(turn)
    _remember(turn, is_floor=is_floor)
    _show_traffic(turn)
    return turn.is_change


def _write(turn: Turn, lease: Lease, *, is_floor: bool) -> None:
    """Write what nearly every turn has, in one exchange with the database; raises LeaseLost or Outdated.

    What is guarded by an epoch comes first: where a later row does not fit, it is known whether that is why.
    """
    held, guarded = None, []
    try:
        with database.sent_together() as batch:
            held = leases.ask_to_hold(batch, lease)
            guarded += [_write_floor(batch, turn)] if is_floor else []
            guarded += _write_states(batch, _changed(turn), turn.now)
            _insert_rows(batch, turn, lease, is_floor=is_floor)
            mark_taken(batch, turn.taken, turn.now)
    except IntegrityError:
        if held is not None:
            _check(held, guarded)
        raise
    _check(held, guarded)


def _check(held: Any, guarded: Sequence[Guarded]) -> None:
    leases.check_held(held)
    if not all(each.is_whole for each in guarded):
        raise Outdated("Somebody else has changed the floor or a run.")


def _is_beat_due(turn: Turn) -> bool:
    is_late = time.monotonic() - turn.site.floor_written_at >= FLOOR_BEAT_S
    return is_late and turn.floor is not None and turn.floor is not turn.site.floor and turn.floor.is_active


def _write_floor(batch: database.Batch, turn: Turn) -> Guarded:
    work, row = turn.floor, turn.site.floor_row
    assert work is not None
    told = {
        "state": json.dumps(floor.to_json(work.state)),
        "active": work.is_active,
        "more": len(work.commands),
        "id": row.pk,
        "epoch": row.epoch,
    }
    return Guarded(1, batch.ask(_FLOOR, told))


def _give_up(turn: Turn) -> None:
    """Close the commands that the floor does not wait for any more, and say which doors need people."""
    work = turn.floor
    assert work is not None
    given_up = set(turn.site.floor.state.sent if turn.site.floor else ()) - set(work.state.sent) - work.answered
    if given_up:
        still_open = Command.objects.filter(id__in=given_up, status__in=Command.OPEN)
        still_open.update(status=Command.Status.TIMED_OUT, ended_at=turn.now)
    registry.raise_alerts(raised=[_as_raised(door, turn.now) for door in work.stuck])


def _as_raised(door: m.DoorStuck, now: datetime) -> registry.Raised:
    """Return the alert about a door that has kept robots waiting; it is over once the door has done what it is told."""
    why = {"why": door.why[:MOST_CHARACTERS]} if door.why else {}
    return registry.Raised(door.device, "command_failed", now, {"method": door.method, **why})


def _command_rows(turn: Turn, work: FloorWork, lease: Lease, position: int) -> list[Command]:
    return [
        Command(
            id=UUID(command.id),
            site_id=lease.site,
            position=position + number,
            device=command.device,
            method=command.method,
            arguments=dict(command.arguments),
            run=UUID(command.run) if command.run else None,
            step=command.step,
            piece=command.piece,
            fence=lease.epoch,
            stand_in=command.device in turn.site.simulated,
            send_after=turn.now,
            created_at=turn.now,
        )
        for number, command in enumerate(work.commands)
    ]


def _changed(turn: Turn) -> list[RunWork]:
    return [work for work in turn.runs.values() if work.is_changed]


def _insert_rows(batch: database.Batch, turn: Turn, lease: Lease, *, is_floor: bool) -> None:
    """Write commands, and lines, inputs and timers of runs."""
    if is_floor and turn.floor is not None:
        # the row that is known counts the commands as long as its epoch is that of the database
        insert_all(batch, Command, _command_rows(turn, turn.floor, lease, turn.site.floor_row.commands))
    changed = _changed(turn)
    written: list[RunWork | ByHand] = [*changed, *turn.by_hand.values()]
    _mark_simulated(turn, written)
    insert_all(batch, RunEvent, (line for work in written for line in work.lines))
    _insert_inputs(batch, changed, turn.now)


def _insert_inputs(batch: database.Batch, changed: Sequence[RunWork], now: datetime) -> None:
    inputs = (
        RunInput(run_id=work.row.id, seq=work.row.inputs_kept, at=now, taken=work.inputs)
        for work in changed
        if work.inputs
    )
    insert_all(batch, RunInput, inputs)
    insert_all(batch, Timer, _timers(changed, now))


def refused_runs(turn: Turn) -> Iterator[tuple[RunWork, Exception]]:
    """Yield the runs of which the database does not take what this turn has made of them alone, and why; keeps nothing.

    The turn is one that could not be written, and is given up.
    """
    for work in _changed(turn):
        try:
            with transaction.atomic():
                _write_alone(work, turn.now)
                transaction.set_rollback(True)
        except (OperationalError, InterfaceError):
            raise
        except Exception as error:  # noqa: BLE001 - whatever it is, it is this run's own
            yield work, error


def _write_alone(work: RunWork, now: datetime) -> None:
    """Write what one run has come to, but for what its floor is told."""
    with database.sent_together() as batch:
        _write_states(batch, [work], now)
        insert_all(batch, RunEvent, work.lines)
        _insert_inputs(batch, [work], now)
    for action in work.asked:
        _ask(work.row, action, now)


def _mark_simulated(turn: Turn, written: Sequence[RunWork | ByHand]) -> None:
    """Say in the journal where a stand-in was told, has answered, or sets out."""
    for work in written if turn.site.simulated else ():
        for line in work.lines:
            if line.device in turn.site.simulated and line.kind in {"command", "answer", "way"}:
                line.args = {**line.args, "simulated": True}


def _write_states(batch: database.Batch, changed: Sequence[RunWork], now: datetime) -> list[Guarded]:
    """Write the rows of runs; the state of one that has not begun stays nothing."""
    for work in changed:
        work.row.reason = work.row.reason[:500]
        work.row.inputs_kept += bool(work.inputs)
        if work.state is not None:
            work.row.state = machine.to_json(work.state)
    rows: dict[tuple[str, ...], list[tuple[Run, int]]] = {}
    for work in changed:
        names = WRITTEN if work.state is None else BEGUN if work.row.started_at == now else ("state", *WRITTEN)
        rows.setdefault(names, []).append((work.row, work.row.epoch))
    written = [update_all(batch, Run, names, those) for names, those in rows.items()]
    for work in changed:
        work.row.__dict__.pop("state", None)
    return written


def _timers(changed: Iterable[RunWork], now: datetime) -> Iterator[Timer]:
    for work in changed:
        for timer, seconds in work.timers.items():
            yield Timer(run_id=work.row.id, timer=timer, due_at=now + timedelta(seconds=seconds / settings.VIPO_SPEED))


def _ask(run: Run, action: r.AskPeople | r.CancelQuestion, now: datetime) -> None:
    if isinstance(action, r.AskPeople):
        questions.ask(run, action, now)
    else:
        questions.withdraw(run, action.question)


def _write_rest(turn: Turn, *, is_floor: bool) -> None:
    """Write what few turns have."""
    if is_floor:
        _give_up(turn)
    for hand in turn.by_hand.values():
        Run.objects.filter(id=hand.row.id).update(
            status=hand.row.status, reason=hand.row.reason, ended_at=hand.row.ended_at, next_seq=hand.row.next_seq,
            watches=hand.row.watches,
        )  # fmt: skip
    for work in _changed(turn):
        if work.dropped_timers:
            Timer.objects.filter(run=work.row, timer__in=work.dropped_timers).delete()
        for action in work.asked:
            _ask(work.row, action, turn.now)
    for row in turn.cut_off:  # no machine calls off what these have waited for
        Timer.objects.filter(run=row).delete()
        questions.withdraw_all(row)
    _keep(turn)


def _keep(turn: Turn) -> None:
    """Keep what nobody has taken in yet, and what was set aside."""
    epoch, slug = turn.site.floor_row.epoch, turn.site.slug
    InboxEvent.objects.bulk_create(
        (
            InboxEvent(
                site=slug, target=target, created_at=turn.now, payload=to_json(message),
                key=f"turn:{turn.site.site.pk}:{turn.site.epoch}:{epoch}:{turn.now.timestamp():.6f}:{number}",
            )
            for number, (target, message) in enumerate(turn.kept)
        )
    )  # fmt: skip
    DeadLetter.objects.bulk_create(
        DeadLetter(
            site=turn.site.site, run_id=each.run or None, target=each.target, event=each.event, error=each.error,
            at=turn.now,
        )
        for each in turn.dead
    )  # fmt: skip


def _tell(turn: Turn) -> None:
    """Let people see what is new, and wake the gateway."""
    slug = turn.site.slug
    messages: list[Any] = [message for work in _changed(turn) for message in work.live]
    written: list[RunWork | ByHand] = [*_changed(turn), *turn.by_hand.values()]
    for work in written:
        messages += shown(work.row, work.lines)
    messages += [dead_notice(each.run, each.error) for each in turn.dead]
    wakes = ("gateway",) if turn.floor is not None and turn.floor.commands else ()
    registry.publish_all([(slug, message) for message in messages], wakes)


def _show_traffic(turn: Turn) -> None:
    """Let people see where robots are about to drive, and why they wait."""
    if turn.floor is not None and turn.site.has_layout:
        publish_traffic(turn.site.slug, turn.site.layout, turn.floor.state)


def dead_notice(run: str, error: str) -> dict[str, Any]:
    """Return what people who watch the site are told when something was set aside."""
    text = f"Something could not be taken in and was set aside for an admin: {error}"
    return {
        "type": "notice", "run": run or None, "text": text, "level": "warning", "code": "set_aside",
        "args": {"error": error},
    }  # fmt: skip


def _remember(turn: Turn, *, is_floor: bool) -> None:
    """Bring the memory of the site to what was written."""
    site = turn.site
    commands = len(turn.floor.commands) if turn.floor is not None else 0
    if turn.floor is not None:
        site.floor = turn.floor.settled()
    if is_floor:
        site.floor_row.epoch += 1
        site.floor_row.commands += commands
        site.floor_written_at = time.monotonic()
    for key, work in turn.runs.items():
        if work.is_changed:
            work.row.epoch += 1
        if work.is_open:
            site.runs[key] = work.settled()
        else:
            site.forget_run(key)
    for key, hand in turn.by_hand.items():
        if hand.row.status not in Run.OPEN:
            site.forget_run(key)
