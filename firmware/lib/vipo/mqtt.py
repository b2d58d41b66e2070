"""An MQTT 3.1.1 client on asyncio streams: QoS 1, last will, keep-alive, TLS, reconnect with back-off.

What is to be sent waits in a queue and is sent again after a reconnect until the broker has acknowledged it. A few
messages fly at once. One task reads, one writes, one watches the clock; when one ends, the connection is made anew.
"""

import asyncio
import random

from vipo.packets import (
    CONNACK,
    PINGREQ,
    PUBACK,
    PUBLISH,
    REFUSALS,
    SUBACK,
    SUBSCRIBE_FAILED,
    MqttFailure,
    connect_packet,
    puback_packet,
    publish_packet,
    read_packet,
    split_publish,
    subscribe_packet,
)
from vipo.portable import close_stream, seconds_since, ticks_ms

ANSWER_TIMEOUT_S = 10
MOST_FLYING = 8
MOST_QUEUED = 64
MOST_UNANSWERED = 16
LONGEST_BACK_OFF_S = 30
LAST_ID = 65535

# A ValueError is a topic or an answer that cannot be read; a MemoryError lost a packet in the middle.
FAILURES = (OSError, EOFError, ValueError, MemoryError, MqttFailure, asyncio.TimeoutError)


class Message:
    """One message on its way; `number` is 0 until it was sent, `sent_at` are ticks, None before this connection's."""

    def __init__(self, topic, payload, retain):
        self.topic, self.payload, self.retain = topic, payload, retain
        self.number = 0
        self.sent_at = None


class Client:
    """One connection that comes back by itself. `run()` never returns, cancel it to end."""

    def __init__(self, host, port, client_id, user, password, keepalive_s=15, tls=None):
        self.host, self.port = host, port
        self.client_id, self.user, self.password = client_id, user, password
        self.will = None
        self.keepalive_s = keepalive_s
        self.tls = tls
        self.on_message = self.on_up = self.on_down = None
        self.topics = []
        self.connected = False
        self.first_back_off_s = 1
        self.last_id = 0
        self._queue = []
        self._to_answer = []
        self._codes = b""
        self._ping_due = False
        self._broken = ""
        self._was_up = False
        self._heard = 0
        self._news, self._over, self._subscribed = asyncio.Event(), asyncio.Event(), asyncio.Event()

    def subscribe(self, topic):
        """Hear a topic filter at QoS 1, from the next connection on."""
        self.topics.append(topic)

    def publish(self, topic, payload, retain=False, replace=False):
        """Queue a message for QoS 1; with `replace`, older ones of its topic that do not fly are left out.

        A full queue loses its oldest message that does not fly.
        """
        if replace:
            self._queue = [m for m in self._queue if m.topic != topic or m.sent_at is not None]
        if len(self._queue) >= MOST_QUEUED:
            self._queue.pop(len(self._flying()))
        self._queue.append(Message(topic, payload, retain))
        self._news.set()

    def pending(self):
        """Return how many messages the broker has not acknowledged yet."""
        return len(self._queue)

    async def run(self):
        """Connect, serve, and begin again when the connection ends."""
        pause_s = self.first_back_off_s
        while True:
            self._was_up = False
            try:
                await self._session()
            except FAILURES as error:
                if self.on_down:
                    self.on_down(str(error) or "no answer")
            if self._was_up:
                pause_s = self.first_back_off_s
            # Devices that lost their broker together do not come back all at once.
            await asyncio.sleep(pause_s * (0.75 + random.random() / 2))
            pause_s = min(pause_s * 2, LONGEST_BACK_OFF_S)

    async def _session(self):
        reader, writer = await asyncio.wait_for(self._open(), ANSWER_TIMEOUT_S)
        tasks = []
        try:
            await asyncio.wait_for(self._handshake(reader, writer), ANSWER_TIMEOUT_S)
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
        """Forget the connection before; what it left unacknowledged is sent again, in order."""
        self._broken, self._ping_due = "", False
        self._to_answer = []
        for message in self._queue:
            message.sent_at = None
        for event in (self._over, self._subscribed):
            event.clear()
        self._heard = ticks_ms()
        self.connected = self._was_up = True

    async def _open(self):
        if self.tls is None:
            return await asyncio.open_connection(self.host, self.port)
        return await asyncio.open_connection(self.host, self.port, ssl=self.tls, server_hostname=self.host)

    async def _guard(self, part):
        """Run a part of the session; when it ends, so does the session."""
        try:
            await part
        except FAILURES as error:
            self._broken = self._broken or str(error) or "no answer"
        finally:
            self._over.set()

    async def _handshake(self, reader, writer):
        writer.write(connect_packet(self.client_id, self.user, self.password, self.keepalive_s, self.will))
        await writer.drain()
        answer = await reader.readexactly(4)
        if answer[:2] != bytes((CONNACK << 4, 2)):
            raise MqttFailure("the broker did not answer as one")
        if answer[3]:
            raise MqttFailure("refused: " + REFUSALS.get(answer[3], str(answer[3])))

    async def _write_loop(self, writer):
        if self.topics:
            writer.write(subscribe_packet(self._next_id(), self.topics))
            await writer.drain()
            await asyncio.wait_for(self._subscribed.wait(), ANSWER_TIMEOUT_S)
            if SUBSCRIBE_FAILED in self._codes:
                raise MqttFailure("refused: a topic")
        if self.on_up:
            self.on_up()
        while True:
            data = self._next_packet()
            if data:
                writer.write(data)
                await writer.drain()
            else:
                self._news.clear()
                await self._news.wait()

    def _next_packet(self):
        """Return what is to be written next, or None; answers go first."""
        if self._to_answer:
            return puback_packet(self._to_answer.pop(0))
        if self._ping_due:
            self._ping_due = False
            return bytes((PINGREQ << 4, 0))
        flying = len(self._flying())
        if flying == len(self._queue) or flying >= MOST_FLYING:
            return None
        message = self._queue[flying]
        again = bool(message.number)
        message.number = message.number or self._next_id()
        message.sent_at = ticks_ms()
        return publish_packet(message.number, message.topic, message.payload, message.retain, again)

    def _flying(self):
        """Return the messages that wait for the broker's answer: they stand first in the queue."""
        return [m for m in self._queue[: MOST_FLYING + 1] if m.sent_at is not None]

    async def _watch_loop(self):
        """See that the broker speaks and answers, and that it hears from this client often enough."""
        pinged = ticks_ms()
        while True:
            await asyncio.sleep(min(1, self.keepalive_s / 4))
            if seconds_since(self._heard) > 1.5 * self.keepalive_s:
                raise MqttFailure("the broker fell silent")
            flying = self._flying()
            if flying and seconds_since(flying[0].sent_at) > ANSWER_TIMEOUT_S:
                raise MqttFailure("the broker does not answer")
            if seconds_since(pinged) >= self.keepalive_s / 2:
                pinged, self._ping_due = ticks_ms(), True
                self._news.set()

    async def _read_loop(self, reader):
        while True:
            kind, body, whole = await read_packet(reader)
            self._heard = ticks_ms()
            if kind >> 4 == PUBLISH:
                await self._received(kind, body, whole)
            elif kind >> 4 == PUBACK:
                self._acknowledged(int.from_bytes(body[:2], "big"))
            elif kind >> 4 == SUBACK:
                self._codes = body[2:]
                self._subscribed.set()

    async def _received(self, kind, body, whole):
        """Hand a message on, with None for a payload that is too long, and answer the broker."""
        topic, payload, number = split_publish(kind, body)
        if self.on_message:
            self.on_message(topic, payload if whole else None, bool(kind & 1))
        if number:
            self._to_answer.append(number)
            self._news.set()
        while len(self._to_answer) > MOST_UNANSWERED:
            await asyncio.sleep(0.01)

    def _acknowledged(self, number):
        for index, message in enumerate(self._queue):
            if message.number == number and message.sent_at is not None:
                self._queue.pop(index)
                self._news.set()
                return

    def _next_id(self):
        """Return the next packet id: 1 to 65535, then from 1 again, leaving out those in use."""
        while True:
            self.last_id = self.last_id % LAST_ID + 1
            if not any(message.number == self.last_id for message in self._queue):
                return self.last_id
