"""Between MQTT and the database: what devices say goes in, commands and stops go out.

Any number of gateways share the load (MQTT shared subscriptions). A message is acknowledged to the broker only after
it is kept, so neither a restart of the database nor of the broker loses an answer; what cannot be read is counted,
logged and shown in the device's history, and harms nobody else.
"""

from __future__ import annotations

import json
import logging
import threading
import time
from collections import Counter, OrderedDict, deque
from dataclasses import dataclass, field
from datetime import UTC, datetime
from typing import Any

from django.db import DatabaseError, InterfaceError, OperationalError, connection

from execution import services as execution
from registry import live, wire
from registry import services as registry
from registry.errors import VipoError
from registry.mqtt import Message, MqttClient

log = logging.getLogger(__name__)

EVERYTHING = "$share/gateway/vipo/v1/dev/+/up/#"
KNOCKS = "$share/gateway/vipo/v1/join/+/+"
KNOCK = "knock/"
"""The kind of a knock; a kind of `up/` topics has no slash."""
SERVER_STATUS = "vipo/v1/srv/status"
WAKE_CHANNEL = "gateway"
POLL_S = 0.1
STOPS_EVERY_S = 1.0
CLAIM_LIMIT = 100
INBOX_LIMIT = 20_000
MESSAGES_PER_S = 50.0
BURST = 200.0
KNOCKS_PER_S = 1.0
KNOCKS_AT_ONCE = 20.0
KNOWN_DEVICES = 5_000
COMPLAINT_EVERY_S = 60.0
POISON_TRIES = 3


@dataclass(slots=True)
class TokenBucket:
    """Allows `rate` messages a second on average and `burst` at once; time is an argument."""

    rate: float = MESSAGES_PER_S
    burst: float = BURST
    tokens: float = BURST
    filled_at: float = 0.0

    def take(self, now: float) -> bool:
        """Take one token if there is one; `now` in seconds of a clock that only goes forward."""
        self.tokens = min(self.burst, self.tokens + (now - self.filled_at) * self.rate)
        self.filled_at = now
        if self.tokens < 1:
            return False
        self.tokens -= 1
        return True


def _new_bucket(name: str) -> TokenBucket:
    """Return a device's bucket, or a door's (`join:…`): behind that one, everybody may be a stranger."""
    rate, burst = (KNOCKS_PER_S, KNOCKS_AT_ONCE) if name.startswith("join:") else (MESSAGES_PER_S, BURST)
    return TokenBucket(rate, burst, burst, time.monotonic())


@dataclass(slots=True)
class Entry:
    """A message that waits to be handled."""

    message: Message
    device: str
    kind: str
    outdated: bool = False


class Inbox:
    """Messages in the order of their arrival; of a device's waiting states only the newest is kept."""

    def __init__(self, limit: int = INBOX_LIMIT) -> None:
        self._entries: deque[Entry] = deque()
        self._states: dict[str, Entry] = {}
        self._limit = limit
        self._changed = threading.Condition()

    def put(self, entry: Entry) -> bool:
        """Add a message; False when the inbox is full."""
        with self._changed:
            if len(self._entries) >= self._limit:
                return False
            if entry.kind == "state":
                older = self._states.get(entry.device)
                if older is not None:
                    older.outdated = True
                self._states[entry.device] = entry
            self._entries.append(entry)
            self._changed.notify()
            return True

    def get(self, timeout_s: float) -> Entry | None:
        """Return the next message, or None when none came in time."""
        with self._changed:
            if not self._entries and not self._changed.wait(timeout_s):
                return None
            if not self._entries:
                return None
            entry = self._entries.popleft()
            if self._states.get(entry.device) is entry:
                del self._states[entry.device]
            return entry


@dataclass(slots=True)
class Complaints:
    """How often each device's messages were dropped or refused, and when that was last written into its history."""

    counts: Counter[str] = field(default_factory=Counter)
    waiting: Counter[str] = field(default_factory=Counter)
    written_at: OrderedDict[str, float] = field(default_factory=OrderedDict)

    def add(self, device: str, reason: str, now: float) -> str | None:
        """Count one more; return a line for the device's history, at most one a minute."""
        self.counts[reason.split(":", 1)[0]] += 1
        self.waiting[device] += 1
        if now - self.written_at.get(device, -COMPLAINT_EVERY_S) < COMPLAINT_EVERY_S:
            return None
        self.written_at[device] = now
        self.written_at.move_to_end(device)
        if len(self.written_at) > KNOWN_DEVICES:
            self.written_at.popitem(last=False)
        others = self.waiting.pop(device) - 1
        return reason if not others else f"{reason} ({others} more since the last note)"


class Gateway:
    """One gateway; the embedded mode runs it in a thread, `manage.py gateway` in a process."""

    def __init__(self, settings: Any) -> None:
        # The same name after a restart takes over the session of the one that died, with the answers kept in it.
        self._client = MqttClient.from_settings(settings.VIPO_MQTT, client_id=settings.VIPO_GATEWAY, keep_session=True)
        self._inbox = Inbox()
        self._buckets: OrderedDict[str, TokenBucket] = OrderedDict()
        self.complaints = Complaints()
        self._notes: deque[tuple[str, str]] = deque(maxlen=1000)
        self._greeting_due = threading.Event()
        self._stops: dict[str, bytes] = {}
        self._stops_at = 0.0

    def run_forever(self, stopping: threading.Event) -> None:
        """Serve until `stopping` is set."""
        self._client.subscribe_handled(EVERYTHING, 1, self._arrived)
        self._client.subscribe_handled(KNOCKS, 1, self._arrived)
        self._client.on_connected(self._greeting_due.set)
        self._client.start()
        sender = threading.Thread(target=self._send_until, args=(stopping,), name="gateway-sender", daemon=True)
        sender.start()
        try:
            while not stopping.is_set():
                entry = self._inbox.get(0.2)
                if entry is not None:
                    self._handle(entry, stopping)
                self._write_notes()
                registry.flush_samples()
        finally:
            stopping.set()
            sender.join(5)
            self._client.stop()
            registry.flush_samples(all_of_it=True)
            connection.close()

    def _arrived(self, message: Message) -> None:
        """Sort a message into the inbox; runs on the network thread and must not wait."""
        found = wire.read_up_topic(message.topic)
        knock = wire.read_join_topic(message.topic)
        if found is None and knock is None:
            self.complaints.counts["topic"] += 1
            message.acknowledge()
            return
        device, kind = found or (knock[1] if knock else "", KNOCK)
        if not self._bucket(f"join:{knock[0]}" if knock else device).take(time.monotonic()):
            self._note(device, "too many messages: some were dropped")
            message.acknowledge()
        elif not self._inbox.put(Entry(message, device, kind)):
            self.complaints.counts["inbox full"] += 1

    def _bucket(self, device: str) -> TokenBucket:
        bucket = self._buckets.pop(device, None) or _new_bucket(device)
        self._buckets[device] = bucket
        if len(self._buckets) > KNOWN_DEVICES:
            self._buckets.popitem(last=False)
        return bucket

    def _handle(self, entry: Entry, stopping: threading.Event) -> None:
        """Take one message in; wait for a database that is away, and give up on what it will never take."""
        tries = 0
        while not entry.outdated and not stopping.is_set():
            try:
                self._take_in(entry.device, entry.kind, entry.message)
                break
            except VipoError as error:
                self._note(entry.device, f"{entry.kind}: {error.detail}")
                break
            except (OperationalError, InterfaceError) as error:
                log.warning("The database does not take a message of %s now: %s", entry.device, error)
                connection.close()
                stopping.wait(0.5)
            except DatabaseError:
                tries += 1
                if tries >= POISON_TRIES:
                    log.exception("A message of %s (%s) was given up.", entry.device, entry.kind)
                    break
            except Exception:  # the edge of the process: one device's message must not end all the others'
                log.exception("A message of %s (%s) failed.", entry.device, entry.kind)
                break
        else:
            if stopping.is_set() and not entry.outdated:
                return
        entry.message.acknowledge()

    def _take_in(self, device: str, kind: str, message: Message) -> None:
        at = datetime.now(UTC)
        if kind == KNOCK:
            site, _ = wire.read_join_topic(message.topic) or ("", "")
            registry.admit_newcomer(site=site, device_id=device, payload=message.payload, at=at)
        elif kind == "ack":
            ack = wire.parse_ack(message.payload)
            execution.record_ack(
                device=device, command_id=ack.command, status=ack.status, why=ack.why, result=ack.result, at=at
            )
        elif message.payload:  # an empty one only takes a retained message away
            view = self._ingest(device, kind, message, at)
            if view is not None:
                registry.note_samples(view=view, at=at)
                if kind == "presence" and view.online:
                    execution.resend_commands(device=device)
                execution.record_device_change(site=view.site, device_id=device)

    def _ingest(self, device: str, kind: str, message: Message, at: datetime) -> registry.DeviceView | None:
        payload = message.payload
        if kind == "desc":
            return registry.ingest_description(device_id=device, payload=payload, at=at)
        if kind == "presence":
            return registry.ingest_presence(device_id=device, payload=payload, at=at)
        if kind == "state":
            return registry.ingest_state(device_id=device, payload=payload, at=at, retained=message.retained)
        self.complaints.counts[f"topic up/{kind}"] += 1
        return None

    def _note(self, device: str, reason: str) -> None:
        """Count a message that was not taken; the worker writes it into the device's history."""
        line = self.complaints.add(device, reason, time.monotonic())
        if line is not None:
            log.warning("Device %s: %s", device, line)
            self._notes.append((device, line))

    def _write_notes(self) -> None:
        while self._notes:
            device, line = self._notes.popleft()
            try:
                registry.record_problem(device_id=device, text=line, at=datetime.now(UTC))
            except DatabaseError as error:
                log.warning("The note about %s was not kept: %s", device, error)

    def _send_until(self, stopping: threading.Event) -> None:
        while not stopping.is_set():
            try:
                busy = self._client.connected and self._send_once()
            except DatabaseError as error:
                log.warning("The database does not give commands now: %s", error)
                connection.close()
                busy = not stopping.wait(0.5)
            except Exception:  # the edge of the process: without this thread no command would ever go out
                log.exception("Sending commands failed.")
                busy = not stopping.wait(1.0)
            if not busy and live.wait_wake(WAKE_CHANNEL, POLL_S):
                self._stops_at = 0.0
        connection.close()

    def _send_once(self) -> bool:
        """Publish what waits; True when there may be more."""
        if self._greeting_due.is_set():
            self._greet()
        now = time.monotonic()
        if now - self._stops_at >= STOPS_EVERY_S:
            self._stops_at = now
            self._publish_stops()
        commands = execution.claim_commands(limit=CLAIM_LIMIT)
        for command in commands:
            self._client.publish(command.topic, command.payload, expiry_s=command.ttl_s)
        if commands:
            execution.mark_commands_sent(ids=[command.id for command in commands])
        return len(commands) == CLAIM_LIMIT

    def _greet(self) -> None:
        """Announce the server, upon which devices describe themselves anew; repeat the stops."""
        self._greeting_due.clear()
        self._stops.clear()
        self._publish_stops()
        birth = {"s": "online", "at": datetime.now(UTC).isoformat(timespec="milliseconds")}
        self._client.publish(SERVER_STATUS, json.dumps(birth).encode(), retain=True)
        _reconcile_accounts()

    def _publish_stops(self) -> None:
        for stop in execution.list_stops():
            body = {"active": stop.active, "by": stop.by, "at": stop.at.isoformat() if stop.at else None}
            payload = json.dumps(body).encode()
            if self._stops.get(stop.site) != payload:
                self._client.publish(f"vipo/v1/site/{stop.site}/stop", payload, retain=True)
                self._stops[stop.site] = payload


def _reconcile_accounts() -> None:
    """Let the broker's accounts agree with the registry, and say what only a person can mend."""
    try:
        removed, missing = registry.reconcile_accounts()
    except VipoError as error:
        log.warning("The broker's accounts were not looked through: %s", error.detail)
        return
    if removed:
        log.warning("The broker had accounts that the registry does not know; removed: %s", ", ".join(sorted(removed)))
    if missing:
        log.warning(
            "The broker has no account of %s. Run `manage.py broker_accounts` and start the broker again.",
            ", ".join(sorted(missing)[:20]),
        )
