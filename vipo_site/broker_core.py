"""The embedded MQTT broker: amqtt with VIPO's own rules about who may do what.

amqtt 0.12 is used through a subclass, because as it comes it (1) drops the session that a stranger names before it
asks for a password, (2) sends wills without asking the topic rules, (3) gives every newcomer the retained messages of
all other clients' subscriptions, (4) loses a message when somebody subscribes while it is being spread, (5) never ends
a connection that fell silent, and (6) waits for ever on a CONNECT of MQTT 5.
"""

from __future__ import annotations

import asyncio
import hmac
import logging
import math
import time
from contextlib import suppress
from datetime import UTC, datetime, timedelta
from typing import TYPE_CHECKING, Any

from amqtt.adapters import BufferReader
from amqtt.broker import Broker
from amqtt.contexts import Action
from amqtt.errors import MQTTError
from amqtt.mqtt.connack import NOT_AUTHORIZED, UNACCEPTABLE_PROTOCOL_VERSION
from django.db import DatabaseError

from vipo_site.broker_connect import PROTOCOL_LEVEL, UNREADABLE, protocol_level, read_connect, refuse
from vipo_site.broker_connection import Connection, until
from vipo_site.doorkeeping import Doorkeeper, may_publish, may_subscribe

if TYPE_CHECKING:
    from registry.services import Login

log = logging.getLogger(__name__)

CONNECT_TIMEOUT_S = 10.0
END_TIMEOUT_S = 2.0
COMPLAINT_EVERY_S = 60.0
MOST_COMPLAINTS = 1000


class _Subscriptions(dict[str, list[Any]]):
    """Subscriptions that may change while somebody walks through them."""

    def __iter__(self) -> Any:
        return iter(list(super().keys()))

    def items(self) -> Any:
        """Return a copy: amqtt awaits in the middle of its loops."""
        return [(topic, list(sessions)) for topic, sessions in super().items()]


class VipoBroker(Broker):  # type: ignore[misc]  # amqtt has no types
    """amqtt with VIPO's rules; see the module's text for what it mends."""

    def __init__(self, bind: str, server_password: str, doorkeeper: Doorkeeper) -> None:
        super().__init__({"listeners": {"default": {"type": "tcp", "bind": bind}}, "plugins": {}})
        self._server_password = server_password
        self._doorkeeper = doorkeeper
        self._logins: dict[str, Login] = {}
        self._refused_at: dict[str, float] = {}
        self._subscriptions = _Subscriptions()
        self._open: set[asyncio.StreamWriter] = set()

    @property
    def bound_port(self) -> int:
        """The port that the system gave."""
        return int(self._servers["default"].instance.sockets[0].getsockname()[1])

    async def end(self) -> None:
        """Close the port first, so that nobody comes back meanwhile, then the connections, then the rest."""
        self._servers["default"].instance.close()
        for writer in list(self._open):
            writer.transport.abort()
        await until(lambda: not self._open, END_TIMEOUT_S)
        with suppress(TimeoutError):
            await asyncio.wait_for(self.shutdown(), END_TIMEOUT_S)

    async def stream_connected(
        self, reader: asyncio.StreamReader, writer: asyncio.StreamWriter, listener_name: str
    ) -> None:
        """Serve one connection, and know it while it is open."""
        self._open.add(writer)
        try:
            await super().stream_connected(reader, writer, listener_name)
        finally:
            self._open.discard(writer)
            writer.close()

    async def _initialize_client_session(
        self, reader: Any, writer: Any, remote_address: str, remote_port: int
    ) -> tuple[Any, Any]:
        """Read the CONNECT, ask for the password, and only then touch the sessions."""
        try:
            packet = await asyncio.wait_for(read_connect(reader), CONNECT_TIMEOUT_S)
            level = protocol_level(packet)
            if level != PROTOCOL_LEVEL:
                await refuse(writer, UNACCEPTABLE_PROTOCOL_VERSION)
                raise MQTTError(f"Protocol level {level} is not spoken here.")
            handler, session = await Connection.init_from_connect(BufferReader(packet), writer, self.plugins_manager)
        except UNREADABLE as error:
            await writer.close()
            raise MQTTError(f"No proper CONNECT from {remote_address}:{remote_port}: {error}") from error
        if not await self._admit(session):
            self._complain(session.client_id, session.username)
            await refuse(writer, NOT_AUTHORIZED)
            raise MQTTError("Not authorised.")
        session = await self._take_over(session)
        session.keep_alive = math.ceil(session.keep_alive * 1.5)
        return handler, session

    def _complain(self, client: str, user: str | None) -> None:
        """Say that somebody was refused; of one who comes again and again, once a minute."""
        now = time.monotonic()
        if now - self._refused_at.get(client, -COMPLAINT_EVERY_S) >= COMPLAINT_EVERY_S:
            if len(self._refused_at) >= MOST_COMPLAINTS:
                self._refused_at.clear()
            self._refused_at[client] = now
            log.warning("MQTT: refused %s (user %s): wrong password or name.", client, user)

    async def _admit(self, session: Any) -> bool:
        username, password = session.username or "", session.password or ""
        if username == "server":
            return hmac.compare_digest(password.encode(), self._server_password.encode())
        will_is_own = not session.will_flag or may_publish(username, session.will_topic or "")
        if not username or session.client_id != username or not will_is_own:
            return False
        at = datetime.now(UTC)
        key = await asyncio.to_thread(self._doorkeeper.admit, username, password)
        if key is None:
            return False
        self._logins[username] = _login(key, at)
        return True

    async def end_whoever_must_go(self) -> None:
        """End the connections whose device was taken out or got another key, until cancelled."""
        while True:
            await asyncio.to_thread(self._doorkeeper.wait)
            soon_after = datetime.now(UTC) - timedelta(seconds=CONNECT_TIMEOUT_S)
            there = {
                name: handler
                for name, (session, handler) in list(self._sessions.items())
                if name in self._logins and session.transitions.state == "connected"
            }
            self._logins = {n: login for n, login in self._logins.items() if n in there or login.at > soon_after}
            try:
                ended = await asyncio.to_thread(self._doorkeeper.find_ended, dict(self._logins))
            except DatabaseError as error:
                log.warning("MQTT: who must go is not known now: %s", error)
                continue
            for name in ended & there.keys():
                log.info("MQTT: ended the connection of %s: its key does not hold any more.", name)
                await there[name].end()

    async def _take_over(self, session: Any) -> Any:
        """End an older connection of the same client first, so that its will goes out before the new one speaks."""
        old, handler = self._sessions.get(session.client_id, (None, None))
        if old is not None and old.transitions.state == "connected":
            await handler.end()
            await until(lambda: old.transitions.state != "connected", 2.0)
        if session.clean_session:
            await self._delete_session(session.client_id)
            session.parent = 0
            return session
        if old is None:
            return session
        for field in ("will_flag", "will_message", "will_topic", "will_qos", "will_retain", "keep_alive", "username"):
            setattr(old, field, getattr(session, field))
        old.parent = 1
        return old

    async def _authenticate(self, session: Any, _listener: Any) -> bool:
        """Everybody who comes this far was admitted before."""
        return True

    async def _topic_filtering(self, session: Any, topic: str, action: Any) -> bool:
        username = session.username or ""
        if username == "server":
            return True
        if action == Action.PUBLISH:
            return may_publish(username, topic)
        return may_subscribe(username, topic)

    async def _publish_retained_messages_for_subscription(self, subscription: tuple[str, int], session: Any) -> None:
        """Give retained messages to a subscriber only, and only after it asked (QoS 0 here: amqtt's own idea)."""
        holders = self._subscriptions.get(subscription[0], [])
        if any(holder is session for holder, _qos in holders):
            await super()._publish_retained_messages_for_subscription(subscription, session)


def _login(key: str, at: datetime) -> Login:
    from registry.services import Login  # the apps' models load only after Django is set up

    return Login(key, at)
