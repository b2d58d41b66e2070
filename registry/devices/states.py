"""What many devices say at once is taken in together: one question and one write for a whole batch.

The same rules as for a single message: rows are locked in the order of their ids, and what is older than what is known
is ignored by (boot, seq).
"""

from __future__ import annotations

import json
from collections.abc import Mapping, Sequence
from dataclasses import asdict, dataclass
from datetime import datetime

from django.db import connection, transaction

from registry.devices.history import history_text, write_event
from registry.devices.rows import BadDevice
from registry.devices.samples import note_samples
from registry.devices.stand_ins import keep_aside, real_of
from registry.devices.views import DeviceView, changed_state, device_news, view_of
from registry.live.fanout import publish_all
from registry.models import Device
from vipo_device.protocol.description import DeviceState
from vipo_device.protocol.errors import VipoError
from vipo_device.protocol.faults import refusal_facts
from vipo_device.protocol.messages import parse_state

MOST_READINGS = 128
WRITE_STATE = """
    UPDATE registry_device SET boot = %s, seq = %s, done = %s, command = %s, properties = %s, pose = %s, online = %s,
    last_seen_at = %s WHERE id = %s
"""


@dataclass(frozen=True, slots=True)
class StateMessage:
    """A state that came in; a retained one tells how the device was, not that it is there now.

    `stand_in` tells that the device's stand-in says it.
    """

    device_id: str
    payload: bytes
    at: datetime
    retained: bool = False
    stand_in: bool = False


Outcome = DeviceView | VipoError | None
"""The device as it is now; why its message was refused; None when it was old, or of a device that nobody knows.

Who counts as offline and says old states only would never be heard: that is refused.
"""


def ingest_states(*, states: Sequence[StateMessage]) -> tuple[Outcome, ...]:
    """Take in the states of different devices, at most one of each; return what came of each, in the same order."""
    outcomes: dict[str, Outcome] = {}
    said: dict[str, tuple[DeviceState, StateMessage]] = {}
    for message in states:
        try:
            said[message.device_id] = (parse_state(message.payload), message)
        except VipoError as error:
            outcomes[message.device_id] = error
    if said:
        with transaction.atomic():
            taken, changes = _take_all(said)
        outcomes |= taken
        for before, after in changes:
            note_samples(before=before, after=after, at=said[after.id][1].at)
    return tuple(outcomes.get(message.device_id) for message in states)


def ingest_state(
    *, device_id: str, payload: bytes, at: datetime, retained: bool = False, stand_in: bool = False
) -> DeviceView | None:
    """Take in a device's state; None when it is old, a replay, of a device that nobody knows, or only kept aside.

    A retained message tells how the device was, not that it is there now.
    """
    (outcome,) = ingest_states(states=[StateMessage(device_id, payload, at, retained, stand_in)])
    if isinstance(outcome, VipoError):
        raise outcome
    return outcome


def _take_all(
    said: Mapping[str, tuple[DeviceState, StateMessage]],
) -> tuple[dict[str, Outcome], list[tuple[DeviceView, DeviceView]]]:
    views: dict[str, Outcome] = {}
    written: list[Device] = []
    changes: list[tuple[DeviceView, DeviceView]] = []
    for device in _lock_rows(list(said)):
        state, message = said[device.pk]
        if message.stand_in and not device.stand_in:  # it was on its way when the device was switched back
            continue
        if device.stand_in and not message.stand_in:
            _keep_aside(device, state, message)
            continue
        if (state.boot, state.seq) <= (device.boot, device.seq):
            views[device.pk] = _why_unheard(device, state, message)
            continue
        before = view_of(device, device.site.slug) if device.description_hash else None
        _change(device, state, message)
        written.append(device)
        if before is not None:
            views[device.pk] = after = view_of(device, device.site.slug)
            _tell_trouble(device, before, after, message.at)
            changes.append((before, after))
    _write(written)
    news = [(after.site, device_news(before, after, changed_state(before, after))) for before, after in changes]
    transaction.on_commit(lambda: publish_all(news))
    return views, changes


def _why_unheard(device: Device, said: DeviceState, message: StateMessage) -> VipoError | None:
    """Return why an old state is refused: its device speaks, and counts as offline. None where it is but late."""
    if message.retained or device.online or device.is_locked_out:
        return None
    facts = {"seq": said.seq, "boot": said.boot, "last": device.seq, "start": device.boot}
    return BadDevice(*refusal_facts("old_state", **facts))


def _keep_aside(device: Device, state: DeviceState, message: StateMessage) -> None:
    real = real_of(device)
    if (state.boot, state.seq) > (real.boot, real.seq):
        _change(real, state, message)
        keep_aside(device, real)


def _lock_rows(ids: list[str]) -> list[Device]:
    rows = Device.objects.select_for_update(of=("self",)).select_related("site").filter(pk__in=ids)
    return list(rows.defer("description", "source").order_by("pk"))


def _change(device: Device, said: DeviceState, message: StateMessage) -> None:
    device.boot, device.seq, device.done, device.command = said.boot, said.seq, said.done, said.command
    known = {**device.properties, **said.properties}
    device.properties = known if len(known) <= MOST_READINGS else dict(said.properties)
    device.pose = asdict(said.pose) if said.pose else device.pose
    is_alive = not message.retained and said.boot >= device.presence_boot and not device.is_locked_out
    device.online = device.online or is_alive
    device.last_seen_at = message.at


def _write(devices: list[Device]) -> None:
    """Write the rows with one prepared statement: the database does less for each than for a save."""
    when = connection.ops.adapt_datetimefield_value
    rows = [
        (d.boot, d.seq, d.done, d.command, json.dumps(d.properties), json.dumps(d.pose) if d.pose else None, d.online,
         when(d.last_seen_at), d.pk)
        for d in devices
    ]  # fmt: skip
    with connection.cursor() as cursor:
        cursor.executemany(WRITE_STATE, rows)


def _tell_trouble(device: Device, before: DeviceView, after: DeviceView, at: datetime) -> None:
    """Write into the history that a device reports an error, or no longer does."""
    if after.status == "error" and before.status != "error":
        write_event(device, at, "error", history_text("error", text=after.activity.text))
    elif before.status == "error" and after.status not in ("error", "offline"):
        write_event(device, at, "recovered", history_text("recovered"))
