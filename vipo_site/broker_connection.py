"""One client's connection to the embedded broker: what amqtt does for it, within limits."""

from __future__ import annotations

import asyncio
from collections.abc import Callable
from typing import Any

from amqtt.mqtt.protocol.broker_handler import BrokerProtocolHandler

PACKET_LIMIT_BYTES = 16384
"""As `max_packet_size` in deploy/mosquitto/mosquitto.conf: whoever sends more is disconnected."""


class _PacketTooLarge(Exception):
    """A client announced a packet that is larger than anybody may send."""


class _CappedReader:
    """Reads for one client; a packet beyond the limit ends the connection before it is read."""

    def __init__(self, reader: Any) -> None:
        self._reader = reader

    async def read(self, n: int = -1) -> bytes:
        """Read `n` bytes."""
        if n > PACKET_LIMIT_BYTES:
            raise _PacketTooLarge
        data: bytes = await self._reader.read(n)
        return data

    def feed_eof(self) -> None:
        """Say that no more will come."""
        self._reader.feed_eof()


class Connection(BrokerProtocolHandler):  # type: ignore[misc]  # amqtt has no types
    """Serves one client."""

    def attach(self, session: Any, reader: Any, writer: Any) -> None:
        """Read devices' packets up to the limit only."""
        super().attach(session, reader if session.username == "server" else _CappedReader(reader), writer)

    def handle_read_timeout(self) -> None:
        """End a connection that was silent for 1.5 keep-alive times, so that its will is sent."""
        if self._reader_task is not None:
            self._reader_task.cancel()

    async def end(self) -> None:
        """End the connection now, and its will with it.

        The transport, too: of a client that speaks at this very moment, amqtt's reader hears the message and not that
        it was cancelled (asyncio.wait_for of Python 3.11), and would be waited for without end.
        """
        await self.handle_connection_closed()
        if self.writer is not None:
            self.writer._writer.transport.abort()


async def until(condition: Callable[[], bool], timeout_s: float) -> None:
    """Wait until the condition holds, at most so long."""
    for _ in range(round(timeout_s / 0.01)):
        if condition():
            return
        await asyncio.sleep(0.01)
