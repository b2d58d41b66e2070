"""Messages of devices into the services: many at once where nothing is lost by it, in each device's own order."""

from __future__ import annotations

import logging
import threading
from collections import Counter, defaultdict, deque
from collections.abc import Callable, Iterator, Mapping, Sequence
from datetime import datetime
from time import monotonic
from typing import Any

from django.db import DatabaseError, InterfaceError, OperationalError, connection

from execution import database, mailbox
from execution.commands import outbox
from execution.gateway.queue import Entry
from execution.gateway.unmarked import Unmarked
from registry import services as registry
from registry.services import Outage
from vipo_device.kit.log_ids import add_ids, bind_ids
from vipo_device.protocol import messages
from vipo_device.protocol.errors import VipoError

log = logging.getLogger(__name__)
ENROLMENT = "knock/"
"""The kind of a request to be enrolled; a kind of `up/` topics has no slash."""
OTHER_TOPIC = "topic up"
"""What messages of kinds that nobody knows are counted as, all as one: devices may make up any number of kinds."""
POISON_TRIES = 3
MOST_DESCRIPTIONS = 50
"""So many are read and kept in one go: what others wait for does not wait long behind them."""
CHANGES_EVERY_S = 0.1
"""The floor and the runs of a site are woken at most so often because a device has said something."""


class Ingester:
    """Takes messages in and acknowledges each to the broker once it is kept, or will never be."""

    def __init__(
        self,
        note: Callable[[str, str, Mapping[str, Any]], None],
        counts: Counter[str],
        unmarked: Unmarked | None = None,
        outage: Outage | None = None,
    ) -> None:
        self._note, self._counts, self._unmarked = note, counts, unmarked or Unmarked()
        self._outage = outage or Outage("The database", "What devices say waits.")
        self._woken_at: dict[str, float] = {}

    def ingest_all(self, entries: Sequence[Entry], stopping: threading.Event) -> None:
        """Take in what has come; the messages of one device in the order of their arrival."""
        for together in _rounds(entries):
            self._ingest_round(together, stopping)

    def _ingest_round(self, entries: list[Entry], stopping: threading.Event) -> None:
        """Take in at most one message of each device: answers first, since runs wait for them."""
        answers = [e for e in entries if e.kind == "ack"]
        self._take_or_handle(self._take_answers, answers, stopping)
        states = [e for e in entries if e.kind == "state" and e.message.payload and not e.outdated]
        said = [e for e in entries if e.kind == "desc" and e.message.payload]
        unchanged = {id(entry) for entry in self._take_unchanged(said)}
        changed = [entry for entry in said if id(entry) not in unchanged]
        together = {id(entry) for entry in (*answers, *states, *said)}
        for entry in entries:
            if id(entry) not in together:
                self._handle(entry, stopping)
        for start in range(0, len(changed), MOST_DESCRIPTIONS):
            some = changed[start : start + MOST_DESCRIPTIONS]
            self._take_or_handle(self._take_descriptions, some, stopping)
        self._take_or_handle(self._take_states, states, stopping)

    def _take_or_handle(
        self, take: Callable[[list[Entry]], bool], entries: list[Entry], stopping: threading.Event
    ) -> None:
        """Take messages in together, or each by itself where that did not work."""
        if entries and not take(entries):
            for entry in entries:
                self._handle(entry, stopping)

    def _take_unchanged(self, entries: list[Entry]) -> list[Entry]:
        """Acknowledge the descriptions that say nothing new, and return them."""
        if not entries:
            return []
        said = {entry.device: entry.message.payload for entry in entries}
        try:
            same = registry.find_unchanged(descriptions=said, at=database.now())
        except (DatabaseError, InterfaceError):
            return []
        registry.note_mended(devices=same, code="description_refused")
        unchanged = [entry for entry in entries if entry.device in same]
        for entry in unchanged:
            entry.message.acknowledge()
        return unchanged

    def _take_answers(self, entries: list[Entry]) -> bool:
        """Take in answers of different devices in one transaction; False when that did not work."""
        at = database.now()
        return self._take_together(entries, "ack", lambda: self._ingest_answers(entries, at), at)

    def _ingest_answers(self, entries: list[Entry], at: datetime) -> list[VipoError | None]:
        """Return of each answer why it could not be read, None where it could."""
        outcomes: list[VipoError | None] = []
        answers = []
        for entry in entries:
            try:
                ack = messages.parse_ack(entry.message.payload)
            except VipoError as error:
                outcomes.append(error)
            else:
                outcomes.append(None)
                answers.append(outbox.Answer(entry.device, ack.command, ack.status, ack.why, ack.result))
        taken = outbox.record_acks(answers=answers, at=at)
        self._unmarked.forget(answer.command for answer, is_news in zip(answers, taken, strict=True) if is_news)
        return outcomes

    def _take_states(self, entries: list[Entry]) -> bool:
        """Take in states of different devices with one question and one write; False when that did not work."""
        at = database.now()
        said = [registry.StateMessage(e.device, e.message.payload, at, e.message.retained, e.stand_in) for e in entries]
        return self._take_together(entries, "state", lambda: registry.ingest_states(states=said), at)

    def _take_descriptions(self, entries: list[Entry]) -> bool:
        """Take in descriptions of different devices with few statements; False when that did not work."""
        at = database.now()
        said = [registry.DescriptionMessage(e.device, e.message.payload, at) for e in entries]
        return self._take_together(entries, "desc", lambda: registry.ingest_descriptions(descriptions=said), at)

    def _take_together(
        self,
        entries: list[Entry],
        kind: str,
        ingest: Callable[[], Sequence[registry.DeviceView | VipoError | None]],
        at: datetime,
    ) -> bool:
        try:
            for entry, outcome in zip(entries, ingest(), strict=True):
                if isinstance(outcome, VipoError):
                    self._note(entry.device, f"{kind}: {outcome.detail}", {**outcome.facts, "kind": kind})
                elif outcome is not None:
                    self._pass_on(outcome, kind, at)
                    if kind == "desc":
                        registry.note_mended(devices=[entry.device], code="description_refused")
        except (DatabaseError, InterfaceError):
            return False  # each is tried by itself then, and waits for a database that is away
        except Exception:  # the edge of the process: one device's message must not end all the others'
            log.exception("What %d devices said (%s) was not taken in together.", len(entries), kind)
            return False
        for entry in entries:
            entry.message.acknowledge()
        return True

    def _handle(self, entry: Entry, stopping: threading.Event) -> None:
        """Take one message in; wait for a database that is away, and give up on what it will never take."""
        with bind_ids({"device": entry.device}):
            self._handle_bound(entry, stopping)

    def _handle_bound(self, entry: Entry, stopping: threading.Event) -> None:
        tries = 0
        while not entry.outdated and not stopping.is_set():
            try:
                self._ingest_one(entry)
                self._outage.end()
                break
            except registry.NotOfSite as error:  # the id may be another site's, which hears nothing of it
                self._note(_asked_at(entry), f"{entry.kind}: {error.detail}", {**error.facts, "kind": entry.kind})
                break
            except VipoError as error:
                self._note(entry.device, f"{entry.kind}: {error.detail}", {**error.facts, "kind": entry.kind})
                break
            except (OperationalError, InterfaceError) as error:
                self._outage.begin(error)
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

    def _ingest_one(self, entry: Entry) -> None:
        at, device, kind, message = database.now(), entry.device, entry.kind, entry.message
        if kind == ENROLMENT:
            site, _ = messages.read_join_topic(message.topic) or ("", "")
            registry.enrol_device(site=site, device_id=device, payload=message.payload, at=at)
        elif kind == "ack":
            ack = messages.parse_ack(message.payload)
            add_ids({"command": ack.command})
            outbox.record_ack(
                device=device, command_id=ack.command, status=ack.status, why=ack.why, result=ack.result, at=at
            )
        elif kind == "map" and message.payload:
            registry.ingest_map_part(device_id=device, payload=message.payload, at=at)
        elif message.payload:  # an empty one only takes a retained message away
            view = self._ingest(entry, at)
            if view is not None:
                if kind == "presence" and view.online and not view.only_done_flag:
                    outbox.resend_commands(device=device)
                self._pass_on(view, kind, at)

    def _ingest(self, entry: Entry, at: datetime) -> registry.DeviceView | None:
        device, kind, message = entry.device, entry.kind, entry.message
        payload, stand_in = message.payload, entry.stand_in
        if kind == "desc":
            view = registry.ingest_description(device_id=device, payload=payload, at=at)
            registry.note_mended(devices=[device], code="description_refused")
            return view
        if kind == "presence":
            return registry.ingest_presence(device_id=device, payload=payload, at=at, stand_in=stand_in)
        if kind == "state":
            return registry.ingest_state(
                device_id=device, payload=payload, at=at, retained=message.retained, stand_in=stand_in
            )
        self._counts[OTHER_TOPIC] += 1
        return None

    def _pass_on(self, view: registry.DeviceView, kind: str, at: datetime) -> None:
        """Let commands and floors know of what a device has said; of its done flag only where it said that."""
        if view.only_done_flag and kind != "presence":
            outbox.record_done_flag(device=view.id, done=view.done, at=at)
        self._wake_watching(view.site, monotonic())

    def _wake_watching(self, site: str, now: float) -> None:
        """Wake what depends on poses, presence or readings; what comes too soon after that is seen by the next."""
        if now - self._woken_at.get(site, -CHANGES_EVERY_S) >= CHANGES_EVERY_S:
            self._woken_at[site] = now
            mailbox.say_changed(site)


def _asked_at(entry: Entry) -> str:
    site, _ = messages.read_join_topic(entry.message.topic) or ("", "")
    return f"join:{site}"


def _rounds(entries: Sequence[Entry]) -> Iterator[list[Entry]]:
    """Share the messages out so that each round has at most one of a device, its earliest."""
    waiting: defaultdict[str, deque[Entry]] = defaultdict(deque)
    for entry in entries:
        waiting[entry.device].append(entry)
    while waiting:
        yield [queue.popleft() for queue in waiting.values()]
        for device in [name for name, queue in waiting.items() if not queue]:
            del waiting[device]
