"""Opening a connection to a broker, and being let in."""

import asyncio

from vipo.packets import CONNACK, REFUSALS, WRONG_KEY, MqttFailure, Refused

WRITTEN_BYTES = 512


async def open_stream(client):
    """Return (reader, writer) of a connection to a client's broker."""
    if client.tls is None:
        return await asyncio.open_connection(client.host, client.port)
    return await asyncio.open_connection(client.host, client.port, ssl=client.tls, server_hostname=client.host)


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
