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
from collections import OrderedDict, deque
from collections.abc import Mapping, Sequence
from datetime import UTC, datetime
from typing import Any

from django.db import DatabaseError, InterfaceError, connection

from execution import database
from execution.commands.claim import OutgoingCommand, claim_commands, mark_sent, release_commands
from execution.fault_points import fault_point
from execution.gateway.dashboards import Dashboards
from execution.gateway.ingest import ENROLMENT, Ingester
from execution.gateway.queue import KNOWN_DEVICES, Complaints, Entry, Inbox, TokenBucket, new_bucket, with_others
from execution.gateway.stops import Stops
from execution.gateway.unmarked import Unmarked
from registry import services as registry
from registry.services import Outage
from vipo_device.protocol import messages
from vipo_device.protocol.errors import VipoError
from vipo_device.protocol.faults import facts_of, fault, printable
from vipo_device.protocol.mqtt_client import Message, MqttClient

log = logging.getLogger(__name__)
FLOOD = fault("flood")

EVERYTHING = "$share/gateway/vipo/v1/dev/+/up/#"
STAND_INS = "$share/gateway/vipo/v1/sim/+/up/+"
ENROLMENTS = "$share/gateway/vipo/v1/join/+/+"
SERVER_STATUS = "vipo/v1/srv/status"
WAKE_CHANNEL, STOPS_CHANNEL = "gateway", "stops"
POLL_S = 0.1
CLAIM_LIMIT = 100
MOST_AT_ONCE = 200
COUNT_EVERY_S = 2.0
TOO_MANY = "too many messages"
MOST_CHARACTERS = 300
KINDS = frozenset({"desc", "state", "ack", "presence", "map", ENROLMENT})
REASONS = KINDS | {TOO_MANY}
"""What is counted by name; whatever else a topic says is counted as `other`."""


class Gateway:
    """One gateway; the embedded mode runs it in a thread, `manage.py gateway` in a process."""

    def __init__(self, settings: Any, heartbeat: registry.HeartbeatWriter | None = None) -> None:
        # The same name after a restart takes over the session of the one that died, with the answers kept in it.
        self._client = MqttClient.from_settings(settings.VIPO_MQTT, client_id=settings.VIPO_GATEWAY, keep_session=True)
        self._dashboards = Dashboards(self._client, settings)
        self._heartbeat = heartbeat
        self._inbox = Inbox()
        self._buckets: OrderedDict[str, TokenBucket] = OrderedDict()
        self.complaints = Complaints()
        self._outage = Outage("The database", "What devices say waits at the broker, and commands wait.")
        self._outages_seen = 0
        self._unmarked = Unmarked()
        self._ingester = Ingester(self._note, self.complaints.counts, self._unmarked, self._outage)
        self._notes: deque[tuple[str, str, Mapping[str, Any]]] = deque(maxlen=1000)
        self._greeting_due = threading.Event()
        self._stops = Stops(self._client)
        self._counted_at = 0.0

    def run_forever(self, stopping: threading.Event) -> None:
        """Serve until `stopping` is set."""
        registry.watch_amount(name="gateway_inbox", read=self._inbox.__len__)
        self._client.subscribe_handled(EVERYTHING, 1, self._arrived)
        self._client.subscribe_handled(STAND_INS, 1, self._arrived)
        self._client.subscribe_handled(ENROLMENTS, 1, self._arrived)
        self._stops.listen()
        self._client.on_connected(self._greeting_due.set)
        self._client.on_connected(self._dashboards.forget_broker)
        self._client.start()
        threads = [
            threading.Thread(target=run, args=(stopping,), name=f"gateway-{name}", daemon=True)
            for name, run in (("sender", self._send_until), ("dashboards", self._dashboards.run_until))
        ]
        for thread in threads:
            thread.start()
        try:
            while not stopping.is_set():
                self._beat()
                entries = self._inbox.get_all(0.2, MOST_AT_ONCE)
                self._renew_connection()
                self._ingester.ingest_all(entries, stopping)
                self._write_notes()
                self._count_dropped(time.monotonic())
                registry.flush_samples()
                registry.flush_alerts()
        finally:
            stopping.set()
            for thread in threads:
                thread.join(5)
            self._client.stop()
            registry.flush_samples(all_of_it=True)
            connection.close()

    def _beat(self) -> None:
        if self._heartbeat is not None:
            self._heartbeat.beat("works" if self._client.connected else "broker_away")

    def _renew_connection(self) -> None:
        """Give up a connection from before an outage; the other thread may have noticed it first."""
        if self._outages_seen != self._outage.count:
            self._outages_seen = self._outage.count
            connection.close()

    def _arrived(self, message: Message) -> None:
        """Sort a message into the inbox; runs on the network thread and must not wait."""
        said = messages.read_stand_in_topic(message.topic)
        found = said or messages.read_up_topic(message.topic)
        _count("mqtt_messages_in", found[1] if found else ENROLMENT, KINDS)
        enrolment = messages.read_join_topic(message.topic)
        if found is None and enrolment is None:
            self.complaints.counts["topic"] += 1
            _count("mqtt_messages_refused", "topic", REASONS)
            message.acknowledge()
            return
        device, kind = found or (printable(enrolment[1]) if enrolment else "", ENROLMENT)
        # whoever asks to be enrolled may name any device
        sender = f"join:{enrolment[0]}" if enrolment else f"sim:{device}" if said else device
        if not self._bucket(sender).take(time.monotonic()):
            self._note(sender, FLOOD.text, facts_of([FLOOD]))
            message.acknowledge()
        elif not self._inbox.put(Entry(message, device, kind, stand_in=said is not None)):
            self.complaints.counts["inbox full"] += 1
            _count("mqtt_messages_refused", TOO_MANY, REASONS)

    def _bucket(self, device: str) -> TokenBucket:
        bucket = self._buckets.pop(device, None) or new_bucket(device)
        self._buckets[device] = bucket
        if len(self._buckets) > KNOWN_DEVICES:
            self._buckets.popitem(last=False)
        return bucket

    def _note(self, device: str, reason: str, facts: Mapping[str, Any]) -> None:
        """Count a message that was not taken; the worker writes it into the device's history."""
        note_complaint(device, reason, facts)
        _count("mqtt_messages_refused", reason.partition(":")[0], REASONS)
        kind = tuple((each["code"], each.get("path")) for each in facts.get("faults", ()))
        others = self.complaints.count(device, reason, time.monotonic(), kind)
        if others is not None:
            line = with_others(reason, others)
            log.warning("Device %s: %s", device, line)
            self._notes.append((device, line, {**facts, "more": others}))

    def _write_notes(self) -> None:
        while self._notes:
            device, line, facts = self._notes.popleft()
            try:
                registry.record_problem(device_id=device, text=line, facts=facts, at=datetime.now(UTC))
            except DatabaseError as error:
                log.warning("The note about %s was not kept: %s", device, error)

    def _count_dropped(self, now: float) -> None:
        """Add up every few seconds what was not taken, for the devices' pages."""
        if now - self._counted_at < COUNT_EVERY_S:
            return
        self._counted_at = now
        if dropped := self.complaints.take_dropped():
            try:
                registry.count_dropped(dropped=dropped)
            except DatabaseError as error:
                log.warning("What was dropped is not counted now: %s", error)

    def _send_until(self, stopping: threading.Event) -> None:
        while not stopping.is_set():
            try:
                busy = self._client.connected and self._send_once()
            except (DatabaseError, InterfaceError) as error:
                self._outage.begin(error)
                connection.close()
                busy = not stopping.wait(0.5)
            except Exception:  # the edge of the process: without this thread no command would ever go out
                log.exception("Sending commands failed.")
                busy = not stopping.wait(1.0)
            if not busy:
                registry.wait_wake(WAKE_CHANNEL, POLL_S)
        self._mark_last()
        connection.close()

    def _send_once(self) -> bool:
        """Publish what waits; True when there may be more."""
        if self._greeting_due.is_set():
            self._greet()
        if registry.wait_wake(STOPS_CHANNEL, 0) or self._stops.is_due():
            self._stops.publish()
        commands = claim_commands(limit=CLAIM_LIMIT)
        self._outage.end()
        self._publish(commands)
        self._mark()
        return len(commands) == CLAIM_LIMIT

    def _publish(self, commands: Sequence[OutgoingCommand]) -> None:
        """Send what is claimed; what others may have by now is given back instead."""
        sent: list[str] = []
        late: list[OutgoingCommand] = []
        for command in commands:
            if command.is_late:
                late.append(command)
            else:
                fault_point("before_publish")
                self._client.publish(command.topic, command.payload, expiry_s=command.ttl_s, wait_s=command.wait_s)
                fault_point("after_publish")
                sent.append(command.id)
        if sent:
            self._unmarked.add(sent, database.now())
            registry.count(name="mqtt_messages_out", labels=("command",), by=len(sent))
        if late:
            count = release_commands(commands=late)
            log.warning(
                "%d commands were claimed too long ago to be sent; %d of them are free again.", len(late), count
            )

    def _mark(self) -> None:
        """Say what has gone out, once for all that went out in a moment: what is answered by then needs no word."""
        if due := self._unmarked.list_due():
            fault_point("before_mark")
            mark_sent(sent=due)
            fault_point("after_mark")
            self._unmarked.forget(due)

    def _mark_last(self) -> None:
        """Say what has gone out before this gateway ends; without that it is only asked for once more."""
        left = self._unmarked.list_due(all_of_it=True)
        try:
            if left:
                mark_sent(sent=left)
        except (DatabaseError, InterfaceError) as error:
            log.warning("%d commands stay unmarked: %s", len(left), error)

    def _greet(self) -> None:
        """Announce the server, upon which devices describe themselves anew; repeat the stops."""
        self._greeting_due.clear()
        try:
            self._stops.publish(all_of_them=True)
        except (DatabaseError, InterfaceError):
            self._greeting_due.set()
            raise
        birth = {"s": "online", "at": datetime.now(UTC).isoformat(timespec="milliseconds")}
        self._client.publish(SERVER_STATUS, json.dumps(birth).encode(), retain=True)
        _reconcile_accounts()


def _count(name: str, kind: str, known: frozenset[str]) -> None:
    registry.count(name=name, labels=(kind if kind in known else "other",))


def note_complaint(device: str, reason: str, facts: Mapping[str, Any] | None = None) -> None:
    """Take in why a message was dropped or refused; touches no database."""
    kind, _, detail = reason.partition(": ")
    args = {"why": detail[:MOST_CHARACTERS], **({"faults": facts["faults"]} if facts and "faults" in facts else {})}
    if kind == TOO_MANY:
        registry.note_alert(device_id=device, code="messages_dropped")
    elif kind == "desc":
        registry.note_alert(device_id=device, code="description_refused", args=args)
    elif "/" not in kind:  # who asks to be enrolled is nobody yet
        registry.note_alert(device_id=device, code="messages_refused", args=args)


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
