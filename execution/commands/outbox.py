"""The outbox: commands are sent until they are answered, with the same id each time; answers come back here.

A device that answers as docs/protocol.md says is judged by its answers alone, one that knows only a done flag by that.
"""

from __future__ import annotations

import json
import logging
from collections import defaultdict
from collections.abc import Collection, Mapping, Sequence
from dataclasses import dataclass, field
from datetime import UTC, datetime, timedelta
from functools import reduce
from typing import Any, NamedTuple
from uuid import UUID

from django.db import connection, transaction
from django.db.models import Exists, F, OuterRef, Q
from django.utils.dateparse import parse_datetime

from execution import database, mailbox
from execution.commands.claim import NEVER_AGAIN_S, UNANSWERED
from execution.fault_points import fault_point
from execution.floor_protocol import FIRST_RETRY_S, CommandEnded, ToFloor, ToRun, again_after_s
from execution.models import Command, Run
from execution.reasons import SENTENCES
from execution.traffic.messages import CONTROLS, CommandAnswered
from registry import services as registry
from vipo_device.kit.log_ids import LogId, bind_ids
from vipo_device.protocol.description import Scalar

log = logging.getLogger(__name__)
CONTROL_LIMIT_S = 60.0
STATUS = {
    "ACCEPTED": Command.Status.ACCEPTED,
    "RUNNING": Command.Status.RUNNING,
    "DONE": Command.Status.DONE,
    "FAILED": Command.Status.FAILED,
    "REJECTED": Command.Status.REJECTED,
    "CANCELED": Command.Status.CANCELLED,
}
OUT = SENTENCES["no_device"]
AT_WORK = "Seen at work by its done flag."
FINAL = frozenset({"DONE", "FAILED", "REJECTED", "CANCELED"})
_SITES = Command._meta.get_field("site").related_model._meta.db_table
_LOCK = f"""
SELECT command.id, device, status, run, method, step, piece, position, site_id, place.slug,
    tries, send_after<flush>
FROM execution_command AS command JOIN {_SITES} AS place ON place.id = site_id
WHERE command.id <these> ORDER BY command.id <lock>
"""  # noqa: S608 - made of this product's own names only
_DIALECTS = {
    "postgresql": {
        "<flush>": ", CASE WHEN %(hasty)s THEN set_config('synchronous_commit', 'off', true) END",
        "<these>": "= ANY(%(ids)s)",
        "<lock>": "FOR UPDATE OF command",
    },
    "sqlite": {"<flush>": "", "<these>": "IN (SELECT value FROM json_each(%(ids)s))", "<lock>": ""},
}
_LOCKS = {
    vendor: reduce(lambda text, part: text.replace(*part), parts.items(), _LOCK) for vendor, parts in _DIALECTS.items()
}
_ANSWERED = """
UPDATE execution_command SET status = %s, why = %s, sent_at = coalesce(sent_at, %s), ended_at = coalesce(%s, ended_at),
    send_after = coalesce(%s, send_after), result = coalesce(%s, result)
WHERE id = %s
"""


def resend_commands(*, device: str) -> int:
    """Let all open commands of a device that has come in be sent at once and in their order; return how many.

    It may have been started anew and know none of them; one that it knows it only answers again.
    """
    open_rows = Command.objects.filter(device=device, status__in=Command.OPEN)
    return open_rows.update(send_after=database.now())


@dataclass(frozen=True, slots=True)
class Answer:
    """What a device says of a command."""

    device: str
    command: str
    status: str
    why: str = ""
    result: Mapping[str, Scalar] = field(default_factory=dict)


def record_ack(
    *, device: str, command_id: str, status: str, why: str, result: Mapping[str, Scalar], at: datetime
) -> bool:
    """Take in a device's answer; False if it is late, repeated, unknown, or about another device's command."""
    return record_acks(answers=[Answer(device, command_id, status, why, result)], at=at, durable=True)[0]


def record_acks(*, answers: Sequence[Answer], at: datetime, durable: bool = False) -> list[bool]:
    """Take in answers in one transaction; say of each whether it was news, as `record_ack` does.

    Unless it is to be `durable` nobody waits for the disk: an answer that a crash of the database forgets comes again,
    since its command is sent again, and what follows from it is written behind it in the same log.
    """
    asked: defaultdict[UUID, list[Answer]] = defaultdict(list)
    for answer in answers:
        if answer.status in STATUS and (number := _uuid(answer.command)) is not None:
            asked[number].append(answer)
    if not asked:
        return [False] * len(answers)
    fault_point("before_answer")
    with transaction.atomic():
        heard = [(row, said) for row in _lock(list(asked), durable=durable) if (said := _own(row, asked[row.id]))]
        if heard:
            _write(heard, at)
        for row, said in heard:
            _follow(row, said, at)
    fault_point("after_answer")
    called_off = {row.run for row, said in heard if row.method == "cancel" and said.status == "DONE" and row.run}
    if called_off:  # in transactions of its own: answers lock their commands in one order
        end_commands_of_runs_over(at, runs=called_off)
    taken = {id(said) for _, said in heard}
    return [id(answer) in taken for answer in answers]


class _Open(NamedTuple):
    """A command that is answered, as it was before; `site` is the site's slug."""

    id: UUID
    device: str
    status: str
    run: UUID | None
    method: str
    step: str
    piece: bool
    position: int
    site_id: int
    site: str
    tries: int
    send_after: datetime

    def sent_at(self, at: datetime) -> datetime:
        """Return when it went out, if that is not marked yet: it was claimed for `FIRST_RETRY_S` just before."""
        return min(at, self.send_after - timedelta(seconds=FIRST_RETRY_S)) if self.tries == 1 else at


def _lock(ids: Sequence[UUID], *, durable: bool) -> list[_Open]:
    """Return these commands, which nobody else changes before the transaction is over; always in the same order."""
    is_postgres = connection.vendor == "postgresql"
    given = list(ids) if is_postgres else json.dumps([number.hex for number in ids])
    with database.sent_together() as batch:  # with the beginning of the transaction
        answer = batch.ask(_LOCKS[connection.vendor], {"ids": given, "hasty": not durable})
    found = [_Open(*row[: len(_Open._fields)]) for row in answer.fetchall()]
    return found if is_postgres else [_from_sqlite(row) for row in found]


def _from_sqlite(row: _Open) -> _Open:
    run, after = UUID(str(row.run)) if row.run else None, parse_datetime(str(row.send_after))
    assert after is not None
    return row._replace(
        id=UUID(str(row.id)),
        run=run,
        piece=bool(row.piece),
        send_after=after if after.tzinfo else after.replace(tzinfo=UTC),
    )


def _own(row: _Open, answers: Sequence[Answer]) -> Answer | None:
    """Return what the device that was asked says of an open command; others may know the id, too."""
    if row.status not in Command.OPEN:
        return None
    return next((answer for answer in answers if answer.device == row.device), None)


def _write(heard: Sequence[tuple[_Open, Answer]], at: datetime) -> None:
    """Write answers, and tell floors and runs of those that end a command, in one exchange with the database."""
    told: defaultdict[str, list[tuple[str, str, ToFloor | ToRun]]] = defaultdict(list)
    for row, said in heard:
        if said.status in FINAL and row.method not in CONTROLS:
            told[row.site] += _news(row, said.status, said.why, said.result)
    with database.sent_together() as batch:
        batch.ask_many(_ANSWERED, [_columns(row, said, at) for row, said in heard])
        for site, messages in told.items():
            mailbox.put(batch, site, messages)
    for site in told:
        mailbox.hint(site)


def _columns(row: _Open, answer: Answer, at: datetime) -> tuple[Any, ...]:
    is_final, when = answer.status in FINAL, connection.ops.adapt_datetimefield_value
    again_s = again_after_s(row.tries, is_answered=True)
    return (
        STATUS[answer.status].value,
        answer.why[:500],
        when(row.sent_at(at)),
        when(at if is_final else None),
        when(None if is_final else at + timedelta(seconds=again_s)),
        json.dumps(dict(answer.result)) if is_final else None,
        row.id if connection.vendor == "postgresql" else row.id.hex,
    )


def _follow(row: _Open, answer: Answer, at: datetime) -> None:
    """See to what follows from an answer beside what runs and floor are told."""
    if row.piece and row.status in UNANSWERED:
        transaction.on_commit(lambda: registry.wake("gateway"))
    _note_answer(row, answer)
    if answer.status == "DONE" and row.piece:
        _close_pieces_before(row, at)


def _note_answer(row: _Open, answer: Answer) -> None:
    status = STATUS[answer.status]
    registry.count(name="command_answers", labels=(status,))
    if status in (Command.Status.FAILED, Command.Status.REJECTED):
        ids: dict[LogId, object] = {"site": row.site, "run": row.run, "step": row.step, "command": row.id}
        with bind_ids(ids | {"device": row.device}):
            log.info("%s did not do %s (%s): %s", row.device, row.method, status, answer.why or "it says no more")


def record_done_flag(*, device: str, done: bool, at: datetime) -> bool:
    """Take in what the done flag of a device is that knows nothing else, as in the VIPO paper; tell if that was news.

    A command is at work once `done` was false after it had been sent, and done once it is true again after that; what
    never shows these edges is given up by its time limit.
    """
    rows = Command.objects.filter(device=device).exclude(method__in=CONTROLS).order_by("position")
    if done:
        row = rows.filter(status=Command.Status.RUNNING, why=AT_WORK).first()
    else:
        # One that is just going out is not marked as sent yet; the device may be faster.
        going_out = Q(status=Command.Status.PENDING, tries__gt=0)
        row = rows.filter(going_out | Q(status=Command.Status.SENT, sent_at__lte=at)).first()
    if row is None:
        return False
    status, why = ("DONE", "") if done else ("RUNNING", AT_WORK)
    with transaction.atomic():
        is_news = record_ack(device=device, command_id=str(row.id), status=status, why=why, result={}, at=at)
        Command.objects.filter(id=row.id).update(send_after=at + timedelta(seconds=NEVER_AGAIN_S))
    return is_news


def _close_pieces_before(row: _Open, at: datetime) -> None:
    """A robot drives its pieces in order: who has reached the end of one is past those before it, heard or not."""
    earlier = Command.objects.select_for_update(of=("self",)).select_related("site").filter(
        device=row.device, site=row.site_id, piece=True, position__lt=row.position, status__in=Command.OPEN
    )  # fmt: skip
    for piece in earlier.order_by("position"):
        piece.status, piece.ended_at = Command.Status.DONE, at
        piece.save(update_fields=["status", "ended_at"])
        mailbox.post(piece.site.slug, _news(_open(piece), "DONE", "", {}))


def _open(row: Command) -> _Open:
    return _Open(
        row.id, row.device, row.status, row.run, row.method, row.step, row.piece, row.position, row.site_id,
        row.site.slug, row.tries, row.send_after,
    )  # fmt: skip


def _news(row: _Open, status: str, why: str, result: Mapping[str, Scalar]) -> list[tuple[str, str, ToFloor | ToRun]]:
    """Return what the floor is told, and the run for its journal."""
    answer = CommandAnswered(str(row.id), status, why, result)
    told: list[tuple[str, str, ToFloor | ToRun]] = [(mailbox.site_target(row.site), f"answer:{row.id}", answer)]
    if row.run is not None and not row.piece:
        ended = CommandEnded(row.device, row.method, row.step, status, why)
        told.insert(0, (mailbox.run_target(row.run), f"note:{row.id}", ended))
    return told


def end_commands_of_those_out(now: datetime) -> None:
    """End what devices were told that do not take part any more: another one may come in by such an id."""
    waiting = Command.objects.filter(status__in=Command.OPEN)
    out = registry.find_out(devices=set(waiting.values_list("device", flat=True)))
    for number in list(waiting.filter(device__in=out).order_by("position").values_list("id", flat=True)) if out else ():
        with transaction.atomic():
            row = waiting.select_for_update(of=("self",)).select_related("site").filter(id=number).first()
            if row is not None:
                _end(row, OUT.format(device=row.device), now)


def end_commands_of_runs_over(now: datetime, *, runs: Collection[UUID] | None = None) -> None:
    """End as cancelled what no device has been told of a run that is over: it is told no more, so none will answer.

    Of these runs, or of all.
    A device was told nothing by a command that never went out, or if it has done its cancel without a word of it.
    Pieces of path still go out, so that the robot settles, unless everything was stopped since: as `claim` has it.
    """
    over = Run.objects.filter(id=OuterRef("run")).exclude(status__in=Run.OPEN)
    stopped_since = over.filter(fence__lt=F("site__stop_latch__pressed"))
    rows = Command.objects.filter(status__in=UNANSWERED).exclude(method__in=CONTROLS)
    rows = rows if runs is None else rows.filter(run__in=runs)
    kept_back = dict(rows.filter(Q(Exists(over), piece=False) | Exists(stopped_since)).values_list("id", "run"))
    if not kept_back:
        return
    called_off = Command.objects.filter(run__in=set(kept_back.values()), method="cancel", status=Command.Status.DONE)
    names = called_off.values_list("arguments__command", flat=True)
    cancelled = kept_back.keys() & {_uuid(str(named)) for named in names}
    unheard = rows.filter(Q(status=Command.Status.PENDING, tries=0) | Q(id__in=cancelled))
    for number in list(unheard.filter(id__in=kept_back).order_by("position").values_list("id", flat=True)):
        with transaction.atomic():
            row = unheard.select_for_update(of=("self",)).select_related("site").filter(id=number).first()
            if row is not None:
                _end(row, "", now, "CANCELED")


def _end(row: Command, why: str, now: datetime, status: str = "FAILED") -> None:
    row.status, row.why, row.ended_at = STATUS[status], why, now
    row.save(update_fields=["status", "why", "ended_at"])
    if row.method not in CONTROLS:
        mailbox.post(row.site.slug, _news(_open(row), status, why, {}))


def _uuid(text: str) -> UUID | None:
    try:
        return UUID(text)
    except ValueError:
        return None


def drop_stale_controls(now: datetime) -> None:
    """Give up on pause, resume and cancel commands that no device answers."""
    before = now - timedelta(seconds=CONTROL_LIMIT_S)
    stale = Command.objects.filter(status__in=Command.OPEN, method__in=CONTROLS, created_at__lt=before)
    stale.update(status=Command.Status.TIMED_OUT, ended_at=now)
