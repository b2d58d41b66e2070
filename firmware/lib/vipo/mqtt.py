"""An MQTT 3.1.1 client on asyncio streams: QoS 1, last will, keep-alive, TLS, reconnect with back-off.

What is to be sent waits in a queue and is sent again after a reconnect until the broker has acknowledged it. One task
reads, one writes, one watches the clock; when one ends, the connection is made anew.
"""

import asyncio
import random

from vipo.connection import open_stream, shake_hands, write_all
from vipo.outbox import Outbox
from vipo.packets import (
    PUBACK,
    PUBLISH,
    SUBACK,
    SUBSCRIBE_FAILED,
    MqttFailure,
    Refused,
    connect_packet,
    read_packet,
    split_publish,
    subscribe_packet,
)
from vipo.portable import close_stream, seconds_since, ticks_ms

ANSWER_TIMEOUT_S = 10
MOST_UNANSWERED = 16
LONGEST_BACK_OFF_S = 30
MOST_STARVED = 5

# A ValueError is a topic or an answer that cannot be read; a MemoryError lost a packet in the middle.
FAILURES = (OSError, EOFError, ValueError, MemoryError, MqttFailure, asyncio.TimeoutError)


class Client:
    """One connection that comes back by itself; the client's id is its user. `run()` never returns, cancel it to end.

    `prepare` (a coroutine) is awaited before each connection, `on_refused` called when the password was wrong.
    """

    def __init__(self, host, port, client_id, password, keepalive_s=15, tls=None):
        self.host, self.port = host, port
        self.client_id, self.password = client_id, password
        self.will = None
        self.keepalive_s = keepalive_s
        self.tls = tls
        self.on_message = self.on_up = self.on_down = None
        self.prepare = self.on_refused = None
        self.topics = []
        self.connected = False
        self.first_back_off_s = 1
        self.outbox = Outbox()
        self._codes = b""
        self._broken = ""
        self._was_served = False
        self._starved = 0
        self._heard = 0
        self._news, self._over, self._subscribed = asyncio.Event(), asyncio.Event(), asyncio.Event()

    def subscribe(self, topic):
        """Hear a topic filter at QoS 1, from the next connection on."""
        self.topics.append(topic)

    def publish(self, topic, payload, retain=False, replace=False):
        """Queue a message for QoS 1; with `replace` instead of older ones of its topic."""
        self.outbox.put(topic, payload, retain, replace)
        self._news.set()

    def pending(self):
        """Return how many messages the broker has not acknowledged yet."""
        return len(self.outbox.queue)

    async def run(self):
        """Connect, serve, and begin again when the connection ends.

        Raises MemoryError when the heap was too full several times in a row: only a restart makes one whole again.
        """
        pause_s = self.first_back_off_s
        while True:
            self._was_served = False
            try:
                await self._session()
            except FAILURES as error:
                self._make_room(error)
                if isinstance(error, Refused) and self.on_refused:
                    self.on_refused()
                if self.on_down:
                    self.on_down(str(error) or "no answer")
            # A broker that lets in and hangs up at once is asked ever more seldom, too.
            if self._was_served:
                pause_s, self._starved = self.first_back_off_s, 0
            if self._starved >= MOST_STARVED:
                raise MemoryError
            # Devices that lost their broker together do not come back all at once.
            await asyncio.sleep(pause_s * (0.75 + random.random() / 2))
            pause_s = min(pause_s * 2, LONGEST_BACK_OFF_S)

    async def _session(self):
        if self.prepare:
            await self.prepare()
        reader, writer = await asyncio.wait_for(open_stream(self), ANSWER_TIMEOUT_S)
        tasks = []
        try:
            hello = connect_packet(self.client_id, self.client_id, self.password, self.keepalive_s, self.will)
            await asyncio.wait_for(shake_hands(reader, writer, hello), ANSWER_TIMEOUT_S)
            self._begin()
            for part in (self._read_loop(reader), self._write_loop(writer), self._watch_loop()):
                tasks.append(asyncio.create_task(self._guard(part)))
            await self._over.wait()
        finally:
            self.connected = False
            for task in tasks:
                task.cancel()
            await close_stream(writer)
        raise MqttFailure(self._broken)

    def _begin(self):
        self._broken = ""
        self.outbox.begin()
        for event in (self._over, self._subscribed):
            event.clear()
        self._heard = ticks_ms()
        self.connected = True

    async def _guard(self, part):
        """Run a part of the session; when it ends, so does the session."""
        try:
            await part
        except FAILURES as error:
            self._broken = self._broken or str(error) or "no answer"
            self._make_room(error)
        finally:
            self._over.set()

    def _make_room(self, error):
        if isinstance(error, MemoryError):
            self._starved += 1
            self.outbox.shorten()

    async def _write_loop(self, writer):
        if self.topics:
            writer.write(subscribe_packet(self.outbox.next_id(), self.topics))
            await writer.drain()
            await asyncio.wait_for(self._subscribed.wait(), ANSWER_TIMEOUT_S)
            if SUBSCRIBE_FAILED in self._codes:
                raise MqttFailure("refused: a topic")
        if self.on_up:
            self.on_up()
        while True:
            pieces = self.outbox.next_pieces()
            for piece in pieces:
                await write_all(writer, piece)
            if not pieces:
                self._news.clear()
                await self._news.wait()

    async def _watch_loop(self):
        """See that the broker speaks and answers, and that it hears from this client often enough."""
        pinged = ticks_ms()
        while True:
            await asyncio.sleep(min(1, self.keepalive_s / 4))
            if seconds_since(self._heard) > 1.5 * self.keepalive_s:
                raise MqttFailure("the broker fell silent")
            if self.outbox.longest_wait_s() > ANSWER_TIMEOUT_S:
                raise MqttFailure("the broker does not answer")
            if seconds_since(pinged) >= self.keepalive_s / 2:
                pinged, self.outbox.ping_due = ticks_ms(), True
                self._news.set()

    async def _read_loop(self, reader):
        while True:
            kind, body, whole = await read_packet(reader)
            self._heard = ticks_ms()
            if kind >> 4 == PUBLISH:
                await self._received(kind, body, whole)
            elif kind >> 4 == PUBACK:
                if self.outbox.acknowledge(int.from_bytes(body[:2], "big")):
                    self._was_served = True
                    self._news.set()
            elif kind >> 4 == SUBACK:
                self._codes = bytes(body[2:])
                self._subscribed.set()

    async def _received(self, kind, body, whole):
        """Hand a message on, of one that is too long the beginning, and answer the broker."""
        topic, payload, number = split_publish(kind, body)
        if self.on_message:
            self.on_message(topic, payload, bool(kind & 1), whole)
        if number:
            self.outbox.to_answer.append(number)
            self._news.set()
        while len(self.outbox.to_answer) > MOST_UNANSWERED:
            await asyncio.sleep(0.01)
