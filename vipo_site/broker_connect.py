"""A client's first packet, read whole before anything else is done."""

from __future__ import annotations

import asyncio
import socket
from typing import Any

from amqtt.errors import AMQTTError, CodecError, MQTTError, NoDataError
from amqtt.mqtt.connack import ConnackPacket

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
    """Answer a CONNECT with a return code of MQTT 3.1.1, and close."""
    await ConnackPacket.build(0, code).to_stream(writer)
    await writer.close()


def notice_dead_peers(writer: asyncio.StreamWriter) -> None:
    """Let the system end a connection whose other side is gone without a word, after about two minutes."""
    peer: socket.socket = writer.get_extra_info("socket")
    peer.setsockopt(socket.SOL_SOCKET, socket.SO_KEEPALIVE, 1)
    for name, value in (("TCP_KEEPIDLE", 60), ("TCP_KEEPINTVL", 15), ("TCP_KEEPCNT", 4)):
        if hasattr(socket, name):  # not every system has all three
            peer.setsockopt(socket.IPPROTO_TCP, getattr(socket, name), value)
