"""An MQTT 3.1.1 client on asyncio streams: QoS 0 and 1, last will, keep-alive, reconnect with back-off.

What is to be sent waits in a queue and is sent again after a reconnect until the broker has acknowledged it. Every
wait has a time limit, so a broker that fell silent is left and looked for again.
"""

import asyncio

from vipo.portable import seconds_since, ticks_ms

CONNECT, CONNACK, PUBLISH, PUBACK, SUBSCRIBE, SUBACK, PINGREQ, DISCONNECT = 1, 2, 3, 4, 8, 9, 12, 14
REFUSALS = {1: "protocol", 2: "client id", 3: "broker not ready", 4: "user or password", 5: "not allowed"}
ANSWER_TIMEOUT_S = 10
MAX_PACKET = 16384
MAX_QUEUE = 64
LONGEST_BACK_OFF_S = 30


class MqttFailure(Exception):
    """The connection is of no use any more; the text says why."""


# A ValueError is a topic or an answer that cannot be read.
FAILURES = (OSError, EOFError, ValueError, MqttFailure, asyncio.TimeoutError)


class Client:
    """One connection that comes back by itself. `run()` never returns, cancel it to end."""

    def __init__(self, host, port, client_id, user, password, will=None, keepalive_s=15, tls=None):
        self.host, self.port = host, port
        self.client_id, self.user, self.password = client_id, user, password
        self.will = will
        self.keepalive_s = keepalive_s
        self.tls = tls
        self.on_message = None
        self.on_up = None
        self.on_down = None
        self.topics = []
        self.connected = False
        self.first_back_off_s = 1
        self._queue = []
        self._news = asyncio.Event()
        self._packet_id = 0
        self._answers = {}
        self._writer = None
        self._reading = None
        self._broken = ""
        self._was_up = False
        self._heard = 0
        self._lock = asyncio.Lock()

    def subscribe(self, topic):
        """Hear a topic filter at QoS 1, from the next connection on."""
        self.topics.append(topic)

    def publish(self, topic, payload, retain=False, replace=False):
        """Queue a message for QoS 1. With `replace`, an older one of the same topic that still waits is left out."""
        if replace:
            self._queue = [m for i, m in enumerate(self._queue) if m[0] != topic or (i == 0 and m[3])]
        if len(self._queue) >= MAX_QUEUE:
            self._queue.pop(1)
        self._queue.append([topic, payload, retain, 0])
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
            await asyncio.sleep(pause_s)
            pause_s = min(pause_s * 2, LONGEST_BACK_OFF_S)

    async def close(self):
        """Say goodbye, so that the will is not sent."""
        if self.connected:
            await self._write(bytes((DISCONNECT << 4, 0)))
            self._writer.close()

    async def _session(self):
        reader, self._writer = await asyncio.wait_for(self._open(), ANSWER_TIMEOUT_S)
        helpers = []
        self._broken = ""
        self._answers = {}
        try:
            await self._handshake(reader)
            self._heard = ticks_ms()
            self.connected = self._was_up = True
            self._reading = asyncio.create_task(self._read_loop(reader))
            helpers = [asyncio.create_task(self._guard(loop)) for loop in (self._greet_and_send, self._ping_loop)]
            await self._until_read_ends()
        finally:
            self.connected = False
            for task in helpers:
                task.cancel()
            if self._reading is not None:
                self._reading.cancel()
            self._reading = None
            self._writer.close()

    async def _until_read_ends(self):
        try:
            await self._reading
        except asyncio.CancelledError:
            if not self._broken:
                raise
            raise MqttFailure(self._broken)

    async def _open(self):
        if self.tls is None:
            return await asyncio.open_connection(self.host, self.port)
        try:
            return await asyncio.open_connection(self.host, self.port, ssl=self.tls, server_hostname=self.host)
        except TypeError:
            return await asyncio.open_connection(self.host, self.port, ssl=self.tls)

    async def _guard(self, loop):
        """Run a helper loop; when it fails, the reading ends and with it the session."""
        try:
            await loop()
        except FAILURES as error:
            self._break(str(error) or "no answer")

    def _break(self, reason):
        self._broken = reason
        if self._reading is not None:
            self._reading.cancel()

    async def _handshake(self, reader):
        flags = 0x02 | 0xC0
        payload = text(self.client_id)
        if self.will:
            topic, message, retain = self.will
            flags |= 0x04 | (1 << 3) | (0x20 if retain else 0)
            payload += text(topic) + blob(message)
        payload += text(self.user) + text(self.password)
        body = text("MQTT") + bytes((4, flags)) + self.keepalive_s.to_bytes(2, "big") + payload
        await self._write(packet(CONNECT << 4, body))
        kind, answer = await asyncio.wait_for(read_packet(reader), ANSWER_TIMEOUT_S)
        if kind >> 4 != CONNACK or len(answer) < 2:
            raise MqttFailure("the broker did not answer as one")
        if answer[1]:
            raise MqttFailure("refused: " + REFUSALS.get(answer[1], str(answer[1])))

    async def _greet_and_send(self):
        if self.topics:
            number = self._next_id()
            body = number.to_bytes(2, "big") + b"".join(text(t) + b"\x01" for t in self.topics)
            codes = await self._ask(number, packet(SUBSCRIBE << 4 | 2, body))
            if 0x80 in codes:
                raise MqttFailure("refused: a topic")
        if self.on_up:
            self.on_up()
        while True:
            while self._queue:
                await self._send(self._queue[0])
            self._news.clear()
            await self._news.wait()

    async def _send(self, message):
        topic, payload, retain, number = message
        repeated = bool(number)
        number = number or self._next_id()
        message[3] = number
        head = PUBLISH << 4 | 0x02 | (0x08 if repeated else 0) | (1 if retain else 0)
        await self._ask(number, packet(head, text(topic) + number.to_bytes(2, "big") + payload))
        self._queue.remove(message)

    async def _ask(self, number, data):
        """Send a packet and wait for the answer that bears its number; return what follows the number."""
        event = asyncio.Event()
        self._answers[number] = (event, [])
        try:
            await self._write(data)
            await asyncio.wait_for(event.wait(), ANSWER_TIMEOUT_S)
            return self._answers[number][1]
        finally:
            self._answers.pop(number, None)

    async def _ping_loop(self):
        while True:
            await asyncio.sleep(self.keepalive_s / 2)
            if seconds_since(self._heard) > 1.5 * self.keepalive_s:
                raise MqttFailure("the broker fell silent")
            await self._write(bytes((PINGREQ << 4, 0)))

    async def _read_loop(self, reader):
        while True:
            kind, body = await read_packet(reader)
            self._heard = ticks_ms()
            if kind >> 4 == PUBLISH:
                await self._received(kind, body)
            elif kind >> 4 in (PUBACK, SUBACK) and len(body) >= 2:
                waiting = self._answers.get(int.from_bytes(body[:2], "big"))
                if waiting:
                    waiting[1].extend(body[2:])
                    waiting[0].set()

    async def _received(self, kind, body):
        if body is None:
            return
        length = int.from_bytes(body[:2], "big")
        topic, rest = bytes(body[2 : 2 + length]).decode(), body[2 + length :]
        number = b""
        if kind & 0x06:
            number, rest = bytes(rest[:2]), rest[2:]
        if self.on_message:
            self.on_message(topic, bytes(rest), bool(kind & 1))
        if number:
            await self._write(bytes((PUBACK << 4, 2)) + number)

    async def _write(self, data):
        async with self._lock:
            self._writer.write(data)
            await asyncio.wait_for(self._writer.drain(), ANSWER_TIMEOUT_S)

    def _next_id(self):
        """Return the next packet id: 1 to 65535, then from 1 again, leaving out those in use."""
        while True:
            self._packet_id = self._packet_id % 65535 + 1
            if self._packet_id not in self._answers:
                return self._packet_id


async def read_packet(reader):
    """Return (first byte, body); a body over the limit is read and dropped, and None is returned for it."""
    kind = (await reader.readexactly(1))[0]
    length = shift = 0
    while True:
        byte = (await reader.readexactly(1))[0]
        length |= (byte & 0x7F) << shift
        shift += 7
        if not byte & 0x80:
            break
        if shift > 21:
            raise MqttFailure("the broker sent nonsense")
    if length <= MAX_PACKET:
        return kind, await reader.readexactly(length)
    while length:
        length -= len(await reader.readexactly(min(length, 1024)))
    return kind, None


def packet(kind, body):
    """Return a packet with its length in front."""
    length, head = len(body), bytearray((kind,))
    while True:
        byte, length = length & 0x7F, length >> 7
        head.append(byte | 0x80 if length else byte)
        if not length:
            return bytes(head) + body


def blob(data):
    """Return bytes with their length in front."""
    return len(data).to_bytes(2, "big") + data


def text(value):
    """Return a string as MQTT writes it."""
    return blob(value.encode())
