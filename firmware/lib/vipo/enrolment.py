"""Enrolment: a device that nobody knows says its own key at its site, to the server alone."""

import asyncio
import json

from vipo.connection import open_stream, shake_hands
from vipo.packets import DISCONNECT, PUBACK, MqttFailure, connect_packet, publish_head, read_packet
from vipo.portable import close_stream

ANSWER_TIMEOUT_S, KEEPALIVE_S = 10, 15


async def enrol(client, site, join_key, key):
    """Say a client's key as its site's account for enrolment. Raises MqttFailure, OSError and the like."""
    account = "join:" + site
    reader, writer = await asyncio.wait_for(open_stream(client), ANSWER_TIMEOUT_S)
    try:
        hello = connect_packet(account, account, join_key, KEEPALIVE_S, None)
        await asyncio.wait_for(shake_hands(reader, writer, hello), ANSWER_TIMEOUT_S)
        topic = "vipo/v1/join/%s/%s" % (site, client.client_id)
        payload = json.dumps({"key": key}).encode()
        writer.write(publish_head(1, topic, len(payload), False, False) + payload)
        await writer.drain()
        kind, _, _ = await asyncio.wait_for(read_packet(reader), ANSWER_TIMEOUT_S)
        if kind >> 4 != PUBACK:
            raise MqttFailure("the enrolment was not answered")
        writer.write(bytes((DISCONNECT << 4, 0)))
        await writer.drain()
    finally:
        await close_stream(writer)
