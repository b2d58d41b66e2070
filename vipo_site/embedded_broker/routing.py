"""How the embedded broker spreads and keeps messages: to whoever asked, into outboxes with limits.

amqtt would make a task of every message for every reader. Whatever finds no room is dropped, counted, and said.
"""

from __future__ import annotations

import asyncio
import logging
import time
from collections import Counter, deque
from typing import Any

from amqtt.broker import Broker
from amqtt.contexts import Action

from execution.gateway.queue import Complaints, TokenBucket, with_others
from vipo_device.protocol.faults import Fault, facts_of, fault
from vipo_device.protocol.topics import is_reader
from vipo_site.embedded_broker.access_control import Line, may_publish, may_subscribe
from vipo_site.embedded_broker.client_queue import Letter
from vipo_site.embedded_broker.connection import Publication
from vipo_site.embedded_broker.subscriptions import (
    ASKS_AT_ONCE,
    ASKS_PER_S,
    MOST_FILTERS,
    MOST_FILTERS_OF_READER,
    MOST_KEPT,
    MOST_KEPT_IN_ALL,
    MOST_LEVELS,
    KeptTopics,
    Subscriptions,
)

log = logging.getLogger(__name__)

SERVER = "server"
REFUSED = 0x80
NO_ROOM = fault("no_room")


class SpreadingBroker(Broker):  # type: ignore[misc]  # amqtt has no types
    """amqtt's broker with subscriptions, retained messages and outboxes of its own."""

    def __init__(self, config: Any) -> None:
        super().__init__(config)
        self._subscriptions = Subscriptions()
        self._kept = KeptTopics()
        self._complaints = Complaints()
        self._lines: deque[Line] = deque(maxlen=1000)

    def take_dropped(self) -> tuple[Counter[str], list[Line]]:
        """Return what was dropped since this was asked last, by user, and (user, line) for the histories."""
        lines = list(self._lines)
        self._lines.clear()
        return self._complaints.take_dropped(), lines

    async def _topic_filtering(self, session: Any, topic: str, action: Any) -> bool:
        username = session.username or ""
        if username == SERVER:
            return True
        if action == Action.PUBLISH:
            return may_publish(username, topic)
        return may_subscribe(username, topic, session.attributes.get("site", ""), session.attributes.get("topics", ()))

    async def add_subscription(self, subscription: tuple[str, int], session: Any) -> int:
        """Let a session hear a filter, at QoS 1 at most (a token's: 0); 128 when it may not, or holds too many."""
        topic_filter, qos = subscription
        held = session.attributes.setdefault("filters", set())
        looks_on = is_reader(session.username or "")
        most = MOST_FILTERS_OF_READER if looks_on else MOST_FILTERS
        is_too_many = topic_filter not in held and len(held) >= most
        if topic_filter.count("/") >= MOST_LEVELS or is_too_many or (looks_on and not _may_ask(session)):
            self._drop(session, fault("many_subscriptions", most=most))
            return REFUSED
        granted: int = await super().add_subscription((topic_filter, min(qos, 0 if looks_on else 1)), session)
        if granted != REFUSED:
            held.add(topic_filter)
        return granted

    def _del_subscription(self, topic_filter: str, session: Any) -> int:
        session.attributes.get("filters", set()).discard(topic_filter)
        deleted: int = super()._del_subscription(topic_filter, session)
        if topic_filter in self._subscriptions and not self._subscriptions[topic_filter]:
            del self._subscriptions[topic_filter]
        return deleted

    async def _del_all_subscriptions(self, session: Any) -> None:
        for topic_filter in list(session.attributes.get("filters", ())):
            self._del_subscription(topic_filter, session)

    async def _receive(self, session: Any, said: Publication) -> None:
        """Take a message in: refuse it, or spread it, and keep it when it is to be retained."""
        if said.topic.count("/") >= MOST_LEVELS or not await self._topic_filtering(session, said.topic, Action.PUBLISH):
            self._drop(session, fault("foreign_topic", topic=said.topic[:100]))
            return
        await self._broadcast_message(session, said.topic, said.payload)
        if said.retain:
            await self.retain_message(session, said.topic, said.payload, said.qos)

    async def _broadcast_message(
        self, _session: Any, topic: str, data: bytes | bytearray, force_qos: int | None = None
    ) -> None:
        """Put a message into the outboxes of those who asked for it."""
        name, payload = topic.encode(), bytes(data)
        for holder, granted in self._subscriptions.find(topic):
            qos = granted if force_qos is None else min(force_qos, granted)
            away = holder.transitions.state != "connected"
            if away and (holder.clean_session or not qos):
                continue
            if not holder.attributes["outbox"].put(Letter(name, payload, qos)):
                self._drop(holder, NO_ROOM)

    async def retain_message(
        self, session: Any, topic: str, data: bytes | bytearray | None, qos: int | None = None
    ) -> None:
        """Keep a message for those who will ask, in place of the one before; of each device some topics only."""
        if not data:
            self._kept.remove(topic)
        else:
            most = MOST_KEPT_IN_ALL if session.username == SERVER else MOST_KEPT
            if not self._kept.add(session.username, topic, len(topic) + len(data), most=most):
                self._drop(session, fault("many_retained", most=most))
                return
        await super().retain_message(None, topic, data, qos)

    async def _publish_retained_messages_for_subscription(self, subscription: tuple[str, int], session: Any) -> None:
        """Give retained messages to a subscriber only, and only after it asked."""
        topic_filter, qos = subscription
        if topic_filter not in session.attributes.get("filters", ()):
            return
        start = topic_filter.split("+", 1)[0].split("#", 1)[0]
        for topic, kept in list(self._retained_messages.items()):
            if topic.startswith(start) and self._matches(topic, topic_filter):
                letter = Letter(topic.encode(), bytes(kept.data), min(qos, kept.qos or 0, 1), retained=True)
                if not session.attributes["outbox"].put(letter):
                    self._drop(session, NO_ROOM)
        await asyncio.sleep(0)

    def _drop(self, session: Any, why: Fault) -> None:
        """Count something that was not taken or not sent; say it once a minute."""
        name = session.username or ""
        others = self._complaints.count(name, why.text, time.monotonic())
        if others is not None:
            line = with_others(why.text, others)
            log.warning("MQTT: %s: %s", session.client_id, line)
            self._lines.append((name, line, {**facts_of([why]), "more": others}))


def _may_ask(session: Any) -> bool:
    now = time.monotonic()
    bucket = session.attributes.setdefault("asks", TokenBucket(ASKS_PER_S, ASKS_AT_ONCE, ASKS_AT_ONCE, now))
    return bool(bucket.take(now))
