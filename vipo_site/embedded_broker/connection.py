"""One client's connection to the embedded broker.

amqtt takes every packet as a task of its own and sends every message as one, so that what a client says too fast or
does not read has no bound. Here packets are handled one after the other, and a client is read no faster than that;
what it is sent waits in its outbox.
"""

from __future__ import annotations

import asyncio
import socket
from collections.abc import Awaitable, Callable
from contextlib import suppress
from dataclasses import dataclass
from typing import Any

from amqtt.adapters import BufferReader
from amqtt.errors import AMQTTError, CodecError, MQTTError, NoDataError
from amqtt.mqtt import packet as kinds
from amqtt.mqtt.connack import ConnackPacket
from amqtt.mqtt.disconnect import DisconnectPacket
from amqtt.mqtt.protocol.broker_handler import BrokerProtocolHandler
from amqtt.mqtt.subscribe import SubscribePacket
from amqtt.mqtt.unsubscribe import UnsubscribePacket

from vipo_device.protocol.faults import Fault, fault
from vipo_site.embedded_broker.client_queue import DEVICE_ROOM, Outbox

PACKET_LIMIT_BYTES = 16384
"""As `max_packet_size` in deploy/mosquitto/mosquitto.conf: whoever sends more is disconnected."""
STUCK_S = 30.0
MOST_ASKING = 16
MOST_UNRELEASED = 1000
MOST_UNREAD_BYTES = 128 * 1024
"""Linux counts its own upkeep, too, and so keeps twice as much memory for as many bytes."""
FLUSH_BYTES = 2**16
_PINGRESP = b"\xd0\x00"
_ACKNOWLEDGED, _RECEIVED, _COMPLETE = 0x40, 0x50, 0x70


class Unfit(Exception):
    """A client broke the protocol or its limits; the text says how. Its connection ends, and its will is sent."""

    def __init__(self, why: Fault) -> None:
        self.why = why
        super().__init__(why.text)


@dataclass(frozen=True, slots=True)
class Publication:
    """A message as a client said it."""

    topic: str
    payload: bytes
    qos: int
    retain: bool


class Connection(BrokerProtocolHandler):  # type: ignore[misc]  # amqtt has no types
    """Serves one client; `receive` takes what it publishes, `complain` hears why it was thrown out."""

    receive: Callable[[Any, Publication], Awaitable[None]]
    complain: Callable[[Any, Fault], None]

    def attach(self, session: Any, reader: Any, writer: Any) -> None:
        """Belong to a session, and to what waits in it."""
        super().attach(session, reader, writer)
        self._outbox: Outbox = session.attributes.setdefault("outbox", Outbox(DEVICE_ROOM))
        self._unreleased: set[int] = session.attributes.setdefault("unreleased", set())
        self._sender: asyncio.Task[None] | None = None
        self._pending_subscriptions: asyncio.Queue[Any] = asyncio.Queue(MOST_ASKING)
        self._pending_unsubscriptions: asyncio.Queue[Any] = asyncio.Queue(MOST_ASKING)

    async def start(self) -> None:
        """Begin to read and to send."""
        await super().start()
        self._outbox.begin()
        self._sender = asyncio.create_task(self._send_waiting())

    async def stop(self) -> None:
        """End; what the client has not read by now it will not read."""
        if self._sender is not None and self._sender is not asyncio.current_task():
            self._sender.cancel()
        if self.writer is not None and self.writer._writer.transport.get_write_buffer_size():
            self.writer._writer.transport.abort()
        await super().stop()

    async def end(self) -> None:
        """End the connection now, and its will with it.

        The transport, too: whoever is waited for hears it at once (asyncio.wait_for of Python 3.11 may lose a
        cancellation).
        """
        await self.handle_connection_closed()
        if self.writer is not None:
            self.writer._writer.transport.abort()

    async def _reader_loop(self) -> None:
        self._reader_ready.set()
        session = self.session
        try:
            while await self._read_one():
                pass
        except Unfit as reason:
            self.complain(session, reason.why)
        except (*UNREADABLE, ValueError, asyncio.CancelledError):
            pass  # amqtt's own loop takes a cancellation as the order to end properly, and so does this one
        await self.handle_connection_closed()
        self._reader_stopped.set()
        await self.stop()

    async def _read_one(self) -> bool:
        """Read and handle a packet; False when the client takes its leave."""
        await asyncio.sleep(0)  # others' turn, also when the packet is here already
        async with asyncio.timeout(self.keepalive_timeout):
            head, body = await self._read_packet()
        kind = head >> 4
        if kind == kinds.PUBLISH:
            await self._take_publication(head, body)
        elif kind == kinds.PUBACK:
            self._outbox.acknowledge(_number(body))
        elif kind == kinds.PUBREL:
            self._unreleased.discard(_number(body))
            await self._answer(bytes((_COMPLETE, 2)) + body[:2])
        elif kind in (kinds.SUBSCRIBE, kinds.UNSUBSCRIBE):
            await self._ask(kind, head, body)
        elif kind == kinds.PINGREQ:
            await self._answer(_PINGRESP)
        elif kind == kinds.DISCONNECT:
            await self.handle_disconnect(DisconnectPacket())
            return False
        else:
            raise Unfit(fault("odd_packet"))
        return True

    async def _read_packet(self) -> tuple[int, bytes]:
        """Return the first byte and the body; raises Unfit when the packet is larger than anybody may send."""
        head, byte = await self.reader.read(2)
        async with asyncio.timeout(STUCK_S):
            length, shift = byte & 0x7F, 7
            while byte & 0x80 and shift <= 21:
                (byte,) = await self.reader.read(1)
                length |= (byte & 0x7F) << shift
                shift += 7
            if length + 1 + shift // 7 > PACKET_LIMIT_BYTES:
                raise Unfit(fault("giant_packet", most=PACKET_LIMIT_BYTES))
            return head, (await self.reader.read(length) if length else b"")

    async def _take_publication(self, head: int, body: bytes) -> None:
        """Hand a message on and answer it; one of QoS 2 that comes once more is only answered."""
        qos, end = head >> 1 & 3, 2 + int.from_bytes(body[:2], "big")
        said = Publication(body[2:end].decode(), body[end + 2 if qos else end :], qos, bool(head & 1))
        if not said.topic or {"+", "#", "\0"} & set(said.topic) or said.topic.startswith("$") or qos == 3:
            raise Unfit(fault("no_topic"))
        number = _number(body[end:]) if qos else 0
        if number not in self._unreleased or qos < 2:
            await self.receive(self.session, said)
        if qos == 1:
            await self._answer(bytes((_ACKNOWLEDGED, 2)) + number.to_bytes(2, "big"))
        elif qos == 2:
            self._unreleased.add(number)
            if len(self._unreleased) > MOST_UNRELEASED:
                raise Unfit(fault("unreleased"))
            await self._answer(bytes((_RECEIVED, 2)) + number.to_bytes(2, "big"))

    async def _ask(self, kind: int, head: int, body: bytes) -> None:
        """Hand a change of subscriptions to amqtt, which takes one after the other."""
        header, reader = kinds.MQTTFixedHeader(kind, head & 0x0F, len(body)), BufferReader(body)
        if kind == kinds.SUBSCRIBE:
            await self.handle_subscribe(await SubscribePacket.from_stream(reader, fixed_header=header))
        else:
            await self.handle_unsubscribe(await UnsubscribePacket.from_stream(reader, fixed_header=header))

    async def _answer(self, data: bytes) -> None:
        self.writer.write(data)
        await self._flush()

    async def _flush(self) -> None:
        """Wait until the client reads; raises TimeoutError when it does not for a long time."""
        async with asyncio.timeout(STUCK_S):
            await self.writer.drain()

    async def _send_waiting(self) -> None:
        """Send what comes into the outbox, as fast as the client reads."""
        with suppress(OSError, TimeoutError):
            while True:
                self._outbox.news.clear()
                size = 0
                for packet in self._outbox.packets():
                    self.writer.write(packet)
                    size += len(packet)
                    if size > FLUSH_BYTES:
                        await self._flush()
                        await asyncio.sleep(0)
                        size = 0
                await self._flush()
                await self._outbox.news.wait()
        await self.end()


def _number(body: bytes) -> int:
    """Return a packet id; raises Unfit when there is none."""
    number = int.from_bytes(body[:2], "big")
    if len(body) < 2 or not number:
        raise Unfit(fault("no_packet_id"))
    return number


async def until(condition: Callable[[], bool], timeout_s: float) -> None:
    """Wait until the condition holds, at most so long."""
    for _ in range(round(timeout_s / 0.01)):
        if condition():
            return
        await asyncio.sleep(0.01)


CONNECT_LIMIT_BYTES = 8192
PROTOCOL_LEVEL = 4
UNREADABLE = (
    *(AMQTTError, MQTTError, CodecError, NoDataError),
    *(TimeoutError, asyncio.IncompleteReadError, OSError, IndexError, UnicodeError),
)


async def read_connect(reader: Any) -> bytes:
    """Read one whole packet, so that a wrong length cannot make the parser wait."""
    head = await _exactly(reader, 1)
    length, shift = 0, 0
    while True:
        byte = await _exactly(reader, 1)
        head += byte
        length |= (byte[0] & 0x7F) << shift
        shift += 7
        if not byte[0] & 0x80:
            break
        if shift > 21:
            raise MQTTError("The packet's length is not one.")
    if head[0] != 0x10 or length > CONNECT_LIMIT_BYTES:
        raise MQTTError("The first packet is not a CONNECT.")
    return head + await _exactly(reader, length)


async def _exactly(reader: Any, size: int) -> bytes:
    data: bytes = await reader.read(size)
    if len(data) < size:
        raise MQTTError("The connection ended within its first packet.")
    return data


def protocol_level(packet: bytes) -> int:
    """Return the level in a CONNECT: after the fixed header come the protocol's name and one byte."""
    start = 1
    while packet[start] & 0x80:
        start += 1
    start += 1
    name_length = int.from_bytes(packet[start : start + 2], "big")
    return packet[start + 2 + name_length]


async def refuse(writer: Any, code: int) -> None:
    """Answer a CONNECT with a return code of MQTT 3.1.1, and close; who is gone already hears it no more."""
    with suppress(OSError):
        await ConnackPacket.build(0, code).to_stream(writer)
        await writer.close()


def set_socket_options(writer: asyncio.StreamWriter) -> None:
    """Let the system end a connection whose other side is gone without a word, after about two minutes.

    For one that does not read it keeps `MOST_UNREAD_BYTES` and not the megabytes that it would.
    """
    peer: socket.socket = writer.get_extra_info("socket")
    peer.setsockopt(socket.SOL_SOCKET, socket.SO_SNDBUF, MOST_UNREAD_BYTES)
    peer.setsockopt(socket.SOL_SOCKET, socket.SO_KEEPALIVE, 1)
    for name, value in (("TCP_KEEPIDLE", 60), ("TCP_KEEPINTVL", 15), ("TCP_KEEPCNT", 4)):
        if hasattr(socket, name):  # not every system has all three
            peer.setsockopt(socket.IPPROTO_TCP, getattr(socket, name), value)
