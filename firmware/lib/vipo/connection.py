"""Opening a connection to a broker, and being let in."""

import socket
import sys
from asyncio import open_connection  # loads the streams here, where the heap has no holes yet

from vipo.packets import CONNACK, REFUSALS, WRONG_KEY, MqttFailure, Refused
from vipo.portable import show_error

WRITTEN_BYTES = 512
# CPython's streams send at once by themselves.
HAS_TO_ASK = sys.implementation.name == "micropython"
# Not every port names them; they are the same for Linux and lwIP.
TCP = getattr(socket, "IPPROTO_TCP", 6)
NODELAY = getattr(socket, "TCP_NODELAY", 1)


async def open_stream(client):
    """Return (reader, writer) of a connection to a client's broker."""
    if client.tls is None:
        reader, writer = await open_connection(client.host, client.port)
        if HAS_TO_ASK:
            send_at_once(writer.s)
        return reader, writer
    tls = AtOnce(client.tls) if HAS_TO_ASK else client.tls
    return await open_connection(client.host, client.port, ssl=tls, server_hostname=client.host)


def send_at_once(connection):
    """Switch Nagle's algorithm off: with it, an answer waits for the other side's delayed acknowledgement."""
    try:
        connection.setsockopt(TCP, NODELAY, 1)
    except (OSError, ValueError) as error:
        show_error(error)  # an old port cannot; it is slower by up to 40 ms


class AtOnce:
    """A TLS context whose connections send at once; only while they are made is their own socket at hand."""

    def __init__(self, tls):
        self._tls = tls

    def wrap_socket(self, connection, **options):
        """Return the connection under TLS."""
        send_at_once(connection)
        return self._tls.wrap_socket(connection, **options)


async def shake_hands(reader, writer, hello):
    """Send a CONNECT and see that the broker takes it. Raises Refused, MqttFailure."""
    writer.write(hello)
    await writer.drain()
    answer = await reader.readexactly(4)
    if answer[:2] != bytes((CONNACK << 4, 2)):
        raise MqttFailure("the broker did not answer as one")
    if answer[3]:
        failure = Refused if answer[3] in WRONG_KEY else MqttFailure
        raise failure("refused: " + REFUSALS.get(answer[3], str(answer[3])))


async def write_all(writer, data):
    """Write bytes, a few at a time: what a stream cannot send at once it copies."""
    view = memoryview(data)
    for start in range(0, len(data), WRITTEN_BYTES):
        writer.write(view[start : start + WRITTEN_BYTES])
        await writer.drain()
