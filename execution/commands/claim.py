"""Which commands may go out now, and who sends them: several gateways ask, each command goes to one of them."""

from __future__ import annotations

import json
from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from datetime import datetime, timedelta
from functools import reduce
from typing import Any, NamedTuple
from uuid import UUID

from django.db import connection, transaction

from execution import database
from execution.database import preparing_cursor
from execution.fault_points import fault_point
from execution.floor_protocol import again_after_s
from execution.models import Command, Run
from execution.traffic.messages import CONTROLS, HALTING_CONTROLS
from registry import services as registry
from vipo_device.protocol import messages
from vipo_device.protocol.clock import steady_s

CLAIM_HOLDS_S = 1.0
"""Who comes later than that to send what was claimed does not: others are given it after `FIRST_RETRY_S`."""
NEVER_AGAIN_S = 7 * 86_400.0
"""A device that knows only its done flag would carry out a command anew each time that it hears it."""
UNANSWERED = (Command.Status.PENDING, Command.Status.SENT)
WINDOW = 12
"""A device remembers its last 16 commands: nobody runs so far ahead of an open one that it would do that one again."""


def _words(values: Iterable[str]) -> str:
    return ", ".join(f"'{value}'" for value in values)


_DUE = f"""
SELECT DISTINCT device FROM execution_command WHERE status IN ({_words(Command.OPEN)}) AND send_after <= %s
"""  # noqa: S608 - made of this product's own constants only
# `IS TRUE` makes PostgreSQL look devices up in a hash: a join, planned when little was open, takes seconds in a rush.
_CLAIM = f"""
WITH ready AS MATERIALIZED (
    SELECT <each ready>
), idless AS MATERIALIZED (
    SELECT <each idless>
), held AS MATERIALIZED (
    SELECT execution_run.id FROM execution_run JOIN execution_sitestop AS latch USING (site_id)
    WHERE execution_run.status IN ({_words(Run.OPEN)}) AND execution_run.fence < latch.pressed
), waiting AS MATERIALIZED (
    SELECT id, site_id, device, position, piece, tries, method, send_after, run, site_fence,
        min(position) OVER lane AS oldest,
        min(CASE WHEN piece AND status IN ({_words(UNANSWERED)}) THEN position END) OVER lane AS unanswered_piece
    FROM execution_command
    WHERE status IN ({_words(Command.OPEN)}) AND (device IN (SELECT device FROM ready)) IS TRUE
    WINDOW lane AS (PARTITION BY site_id, device)
), chosen AS MATERIALIZED (
    SELECT id FROM waiting
    WHERE send_after <= %(now)s
    AND (method IN ({_words(HALTING_CONTROLS)}) OR (run IN (SELECT id FROM held)) IS NOT TRUE)
    AND (method IN ({_words(CONTROLS)}) OR (
        site_id NOT IN (SELECT site_id FROM execution_sitestop WHERE active)
        AND NOT EXISTS (
            SELECT 1 FROM execution_run AS ended WHERE ended.id = waiting.run
            AND ended.status NOT IN ({_words(Run.OPEN)}) AND (NOT piece OR ended.fence < (
                SELECT pressed FROM execution_sitestop WHERE site_id = waiting.site_id
            ))
        )
        AND coalesce(site_fence >= (SELECT pressed FROM execution_sitestop WHERE site_id = waiting.site_id), true)
        AND NOT (piece AND position > coalesce(unanswered_piece, position))
        AND (tries > 0 OR position - oldest < {WINDOW} OR {WINDOW} > (
            SELECT count(*) FROM (
                SELECT 1 FROM execution_command AS own
                WHERE own.device = waiting.device AND own.site_id = waiting.site_id
                    AND own.position >= waiting.oldest AND own.position < waiting.position
                LIMIT {WINDOW}
            ) AS between_them
        ))
    ))
    ORDER BY site_id, position LIMIT %(limit)s
), taken AS MATERIALIZED (
    SELECT id AS taken_id FROM execution_command
    WHERE id IN (SELECT id FROM chosen) AND status IN ({_words(Command.OPEN)}) AND send_after <= %(now)s
    <lock>
)<haste>
UPDATE execution_command SET tries = tries + 1, send_after = CASE
    WHEN execution_command.device IN (SELECT device FROM idless) THEN %(never)s
    WHEN status NOT IN ({_words(UNANSWERED)}) THEN CASE WHEN tries = 1 THEN %(asked)s ELSE %(last)s END
    WHEN tries = 0 THEN %(first)s WHEN tries = 1 THEN %(second)s WHEN tries = 2 THEN %(third)s
    ELSE %(last)s END
FROM taken <hasty> WHERE id = taken_id
RETURNING site_id, position, id, device, method, arguments, ttl_s, tries, stand_in,
    (SELECT fence FROM execution_sitestop AS latch WHERE latch.site_id = execution_command.site_id)
"""  # noqa: S608 - made of this product's own constants only
_MARK = "UPDATE execution_command SET status = 'sent', sent_at = %s WHERE status = 'pending' AND id = %s"
_HASTE = """, haste AS MATERIALIZED (
    SELECT set_config('synchronous_commit', 'off', true) WHERE NOT EXISTS (
        SELECT 1 FROM execution_command JOIN taken ON id = taken_id WHERE device IN (SELECT device FROM idless)
    )
)"""
"""A claim does not wait for the disk. One that a crash of the database forgets is made again, with the same ids, which
devices know; so it waits where a device knows none."""
_DIALECTS = {
    "postgresql": {
        "<each ready>": "json_array_elements_text(%(ready)s::json) AS device",
        "<each idless>": "json_array_elements_text(%(idless)s::json) AS device",
        "<lock>": "FOR UPDATE SKIP LOCKED",
        "<haste>": _HASTE,
        "<hasty>": "LEFT JOIN haste ON true",
    },
    "sqlite": {
        "<each ready>": "value AS device FROM json_each(%(ready)s)",
        "<each idless>": "value AS device FROM json_each(%(idless)s)",
        "<lock>": "",
        "<haste>": "",
        "<hasty>": "",
    },
}
"""SQLite lets one write at a time: two that claim at once come one after the other."""
_CLAIMS = {
    vendor: reduce(lambda text, part: text.replace(*part), parts.items(), _CLAIM) for vendor, parts in _DIALECTS.items()
}


@dataclass(frozen=True, slots=True)
class OutgoingCommand:
    """A command as it goes out over MQTT; from `late_at_s` of `steady_s` on it must not, others may have it by then."""

    id: str
    device: str
    topic: str
    payload: bytes
    ttl_s: float
    tries: int
    late_at_s: float
    told_once: bool = False

    @property
    def wait_s(self) -> float:
        """For so long it may still wait for the broker: what others may have by then is given out again, not sent late.

        What is told only once, since its device knows no ids, waits as long as the command may.
        """
        return self.ttl_s if self.told_once else max(0.0, self.late_at_s - steady_s())

    @property
    def is_late(self) -> bool:
        """Tell whether the claim is over: this process slept, or was kept waiting."""
        return steady_s() >= self.late_at_s


def claim_commands(*, limit: int) -> tuple[OutgoingCommand, ...]:
    """Return commands that are due to be sent, in their order; nobody else is given them for a while.

    One whose sending is not confirmed by `mark_sent`, or that no device answers, is given out again. What
    is meant for a device that does not take part is kept back. While a site is stopped only pause, resume and
    cancel go out, and after that what belongs to a run, also a resume, once a person has resumed it. For a run that is
    over only these three go out, and the pieces of path on which its robots settle if no stop was pressed since. A
    piece of path waits until the robot has accepted the piece before it: with a gateway that died in between, it would
    otherwise cut the corner through a wall. Nothing new goes out while a command that is `WINDOW` older is open: asked
    again, the device might have forgotten it.
    Taking is one statement; before it stand two short questions, and none where nothing is due.
    """
    now = database.now()
    late_at_s = steady_s() + CLAIM_HOLDS_S
    with preparing_cursor() as cursor:
        cursor.execute(_DUE, [connection.ops.adapt_datetimefield_value(now)])
        due = [device for (device,) in cursor.fetchall()]
        facts = registry.list_delivery_facts(devices=due) if due else {}
        ready = [device for device in due if device not in facts or facts[device].takes_part]
        if not ready:
            return ()
        idless = [device for device in ready if device in facts and facts[device].knows_no_ids]
        told = {"ready": json.dumps(ready), "idless": json.dumps(idless)}
        fault_point("before_claim")
        cursor.execute(_CLAIMS[connection.vendor], _parameters(now, limit) | told)
        rows = cursor.fetchall()
    if rows:
        fault_point("after_claim")
    ordered = sorted(rows, key=lambda row: row[:2])
    return tuple(_outgoing(facts.get(row[3]), late_at_s, _Claimed(*row[2:])) for row in ordered)


def _parameters(now: datetime, limit: int) -> dict[str, Any]:
    waits_s = {
        "now": 0.0,
        "first": again_after_s(1, is_answered=False),
        "second": again_after_s(2, is_answered=False),
        "third": again_after_s(3, is_answered=False),
        "last": again_after_s(4, is_answered=False),
        "asked": again_after_s(2, is_answered=True),
        "never": NEVER_AGAIN_S,
    }
    when = connection.ops.adapt_datetimefield_value
    return {"limit": limit} | {name: when(now + timedelta(seconds=wait)) for name, wait in waits_s.items()}


class _Claimed(NamedTuple):
    """A claimed row; SQLite keeps the id without dashes, and a site that was never stopped has no fence."""

    id: UUID | str
    device: str
    method: str
    arguments: str
    ttl_s: float
    tries: int
    stand_in: bool
    fence: int | None


def _outgoing(facts: registry.DeliveryFacts | None, late_at_s: float, row: _Claimed) -> OutgoingCommand:
    legacy_topic = facts.topics.get(row.method) if facts and not row.stand_in else None
    own_topic = messages.down_topic(row.device, row.method, "sim" if row.stand_in else "dev")
    command, topic = str(UUID(str(row.id))), legacy_topic or own_topic
    payload = messages.command_payload(command, json.loads(row.arguments), row.ttl_s, row.fence or 0)
    told_once = facts is not None and facts.knows_no_ids
    return OutgoingCommand(command, row.device, topic, payload, row.ttl_s, row.tries, late_at_s, told_once)


def release_commands(*, commands: Iterable[OutgoingCommand]) -> int:
    """Give back claims that came to nothing, to be made again at once; return how many nobody else has by now."""
    now, count = database.now(), 0
    for command in commands:
        mine = Command.objects.filter(id=command.id, tries=command.tries, status__in=UNANSWERED)
        count += mine.update(send_after=now, tries=command.tries - 1)
    return count


def mark_sent(*, sent: Mapping[str, datetime]) -> None:
    """Say when these commands have gone out; those that were answered since stay as they are."""
    when, is_sqlite = connection.ops.adapt_datetimefield_value, connection.vendor == "sqlite"
    # in the order in which answers lock them, too
    keys = sorted((UUID(key), at) for key, at in sent.items())
    with transaction.atomic(), database.sent_together() as batch:
        batch.ask_many(_MARK, [(when(at), key.hex if is_sqlite else key) for key, at in keys])
