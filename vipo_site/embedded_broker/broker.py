"""The embedded MQTT broker: amqtt with VIPO's own rules about who may do what.

amqtt 0.12 is used through a subclass, because as it comes it (1) drops the session that a stranger names before it
asks for a password, (2) sends wills without asking the topic rules, (3) sends whoever comes the retained messages of
all other clients' subscriptions, (4) loses a message when somebody subscribes while it is being spread, (5) never ends
a connection that fell silent, (6) waits for ever on a CONNECT of MQTT 5, and (7) has no bound on what is said too fast,
not read, kept, asked for or begun; docs/adr/0014 has all of it. What is dropped is counted for the device's page, as
the gateway counts.
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
from amqtt.errors import MQTTError
from amqtt.mqtt.connack import NOT_AUTHORIZED, SERVER_UNAVAILABLE, UNACCEPTABLE_PROTOCOL_VERSION
from django.db import DatabaseError

from vipo_device.protocol.credentials import own_key
from vipo_device.protocol.faults import printable
from vipo_device.protocol.topics import OWN_ACCOUNTS, is_reader
from vipo_site.embedded_broker.access_control import AccessControl, Admitted, may_publish
from vipo_site.embedded_broker.arrivals import Arrivals
from vipo_site.embedded_broker.client_queue import DEVICE_ROOM, READER_ROOM, SERVER_ROOM, Outbox, Room
from vipo_site.embedded_broker.connection import (
    PROTOCOL_LEVEL,
    UNREADABLE,
    Connection,
    protocol_level,
    read_connect,
    refuse,
    set_socket_options,
    until,
)
from vipo_site.embedded_broker.routing import SERVER, SpreadingBroker

if TYPE_CHECKING:
    from registry.services import Login

log = logging.getLogger(__name__)

CONNECT_TIMEOUT_S = 10.0
END_TIMEOUT_S = 2.0
COMPLAINT_EVERY_S = 60.0
MOST_COMPLAINTS = 1000
MOST_SHOWN = 80
MOST_CONNECTIONS = 800
MOST_READERS = 100
"""Programs that look on, of all connections: the rest is for devices."""
MOST_NOT_ADMITTED = 100
MOST_ABSENT = 1000
FORGET_AFTER_S = 3600


class VipoBroker(SpreadingBroker):
    """amqtt with VIPO's rules; see the module's text for what it mends."""

    def __init__(self, bind: str, server_password: str, access_control: AccessControl) -> None:
        super().__init__(
            {
                "listeners": {"default": {"type": "tcp", "bind": bind}},
                "plugins": {},
                "session_expiry_interval": FORGET_AFTER_S,
            }
        )
        self._server_password = server_password
        self._access_control = access_control
        self._logins: dict[str, Login] = {}
        self._refused_at: dict[str, float] = {}
        self._arrivals = Arrivals()
        self._ending = False
        self._open: dict[asyncio.StreamWriter, None] = {}
        self._not_admitted: dict[asyncio.StreamWriter, None] = {}

    @property
    def bound_port(self) -> int:
        """The port that the system gave."""
        return int(self._servers["default"].instance.sockets[0].getsockname()[1])

    async def end(self) -> None:
        """Close the port first, so that nobody comes back meanwhile, then the connections, then the rest."""
        self._ending = True
        self._servers["default"].instance.close()
        for writer in list(self._open):
            writer.transport.abort()
        await until(lambda: not self._open, END_TIMEOUT_S)
        with suppress(TimeoutError):
            await asyncio.wait_for(self.shutdown(), END_TIMEOUT_S)

    async def stream_connected(
        self, reader: asyncio.StreamReader, writer: asyncio.StreamWriter, listener_name: str
    ) -> None:
        """Serve one connection, and know it while it is open; of too many strangers the first has to go."""
        if self._ending or len(self._open) >= MOST_CONNECTIONS + MOST_NOT_ADMITTED:
            writer.transport.abort()
            return
        self._open[writer] = self._not_admitted[writer] = None
        if len(self._not_admitted) > MOST_NOT_ADMITTED:
            first = next(iter(self._not_admitted))
            del self._not_admitted[first]
            first.transport.abort()
        set_socket_options(writer)
        try:
            await super().stream_connected(reader, writer, listener_name)
        finally:
            self._open.pop(writer, None)
            self._not_admitted.pop(writer, None)
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
        if is_reader(session.username or ""):
            # the broker's clients have one connection by one name, and nothing waits for a program that is away
            session.client_id, session.clean_session = session.username, True
        is_calm = self._arrivals.may_come(session.username or "", remote_address, time.monotonic())
        if not is_calm or not self._has_room(session.username or ""):
            self._complain(session, "it comes again and again" if not is_calm else "too many programs look on")
            await refuse(writer, SERVER_UNAVAILABLE)
            raise MQTTError("Too many connections.")
        if fault := await self._find_fault(session):
            self._arrivals.note_refused(session.username or "", remote_address, time.monotonic())
            self._complain(session, fault)
            await refuse(writer, NOT_AUTHORIZED)
            raise MQTTError("Not authorised.")
        self._arrivals.note_admitted(session.username or "", time.monotonic())
        self._not_admitted.pop(writer._writer, None)
        session = await self._take_over(session)
        session.keep_alive = math.ceil(session.keep_alive * 1.5)
        session.attributes.setdefault("outbox", Outbox(_room_of(session.username or "")))
        handler.receive, handler.complain = self._receive, self._drop
        return handler, session

    def _has_room(self, username: str) -> bool:
        """Tell whether somebody may be one more connection: programs that look on leave most room to devices."""
        there = [n for n, (s, _) in self._sessions.items() if is_reader(n) and s.transitions.state == "connected"]
        return not is_reader(username) or username in there or len(there) < MOST_READERS

    def _complain(self, session: Any, fault: str) -> None:
        """Say that somebody was refused; of one who comes again and again, once a minute."""
        now, client = time.monotonic(), session.client_id
        if now - self._refused_at.get(client, -COMPLAINT_EVERY_S) >= COMPLAINT_EVERY_S:
            if len(self._refused_at) >= MOST_COMPLAINTS:
                self._refused_at.clear()
            self._refused_at[client] = now
            log.warning("MQTT: refused %s (user %s): %s.", _shown(client), _shown(session.username), fault)

    async def _find_fault(self, session: Any) -> str:
        """Return why somebody may not come in, empty when they may."""
        username, password = session.username or "", session.password or ""
        if username == SERVER:
            right = hmac.compare_digest(password.encode(), self._server_password.encode())
            return "" if right else "wrong password"
        if username in OWN_ACCOUNTS:
            right = hmac.compare_digest(password.encode(), own_key(username, self._server_password).encode())
            if right and session.will_flag and not may_publish(username, session.will_topic or ""):
                return "its last will is not on a topic of its own"
            return "" if right else "wrong password"
        if not username or session.client_id != username:
            return "a device's client id and its user name must both be its id"
        if session.will_flag and not may_publish(username, session.will_topic or ""):
            return "its last will is not on a topic of its own"
        if self._sessions.get(username, (session, None))[0].username == SERVER:
            return "the server itself uses this name"
        at = datetime.now(UTC)
        admitted = await asyncio.to_thread(self._access_control.admit, username, password)
        if admitted is None:
            return "wrong password, or nobody of this name"
        session.attributes["topics"], session.attributes["site"] = admitted.topics, admitted.site
        self._logins[username] = _login(admitted, at)
        return ""

    async def end_whoever_must_go(self) -> None:
        """End the connections whose device was taken out or got another key, until cancelled."""
        while True:
            await asyncio.to_thread(self._access_control.wait)
            soon_after = datetime.now(UTC) - timedelta(seconds=CONNECT_TIMEOUT_S)
            there = {
                name: handler
                for name, (session, handler) in list(self._sessions.items())
                if name in self._logins and session.transitions.state == "connected"
            }
            self._logins = {n: login for n, login in self._logins.items() if n in there or login.at > soon_after}
            await self._forget_absent()
            try:
                await self._record()
                ended = await asyncio.to_thread(self._access_control.find_ended, dict(self._logins))
            except DatabaseError as error:
                log.warning("MQTT: who must go is not known now: %s", error)
                continue
            for name in ended & there.keys():
                log.info("MQTT: ended the connection of %s: its key does not hold any more.", name)
                await there[name].end()

    async def _take_over(self, session: Any) -> Any:
        """End an older connection of the same client first, so that its will goes out before the new one speaks.

        Several may come at once: who has waited looks again, for another may be in by then. From the last look until
        amqtt knows the connection, nothing is awaited that could let one more in between.
        """
        ended: Any = None
        old, handler = self._sessions.get(session.client_id, (None, None))
        while old is not None and old.transitions.state == "connected" and handler is not ended:
            ended = handler
            await handler.end()
            await until(lambda there=old: there.transitions.state != "connected", 2.0)  # type: ignore[misc]
            old, handler = self._sessions.get(session.client_id, (None, None))
        if session.clean_session or old is None or old.clean_session or _topics(old) != _topics(session):
            await self._delete_session(session.client_id)
            session.parent = 0
            return session
        for field in ("will_flag", "will_message", "will_topic", "will_qos", "will_retain", "keep_alive", "username"):
            setattr(old, field, getattr(session, field))
        old.parent = 1
        return old

    async def _authenticate(self, session: Any, _listener: Any) -> bool:
        """Everybody who comes this far was admitted before."""
        return True

    async def _client_message_loop(self, session: Any, handler: Any) -> None:
        """See that a session ends with its loop, however that ended."""
        try:
            await super()._client_message_loop(session, handler)
        finally:
            if session.transitions.state == "connected" and self._get_handler(session) is handler:
                lost = asyncio.get_running_loop().create_future()
                lost.set_result(None)
                await self._handle_disconnect(session, handler, lost)

    async def _cleanup_session(self, client_id: str) -> None:
        """Forget a session, but not one that has come back while amqtt was about to."""
        session, _ = self._sessions.get(client_id, (None, None))
        if session is None or session.transitions.state != "connected" or self.transitions.state != "started":
            await super()._cleanup_session(client_id)

    async def _record(self) -> None:
        """Give what was dropped to the registry, for the devices' pages."""
        dropped, lines = self.take_dropped()
        if dropped:
            await asyncio.to_thread(self._access_control.record, dropped, lines)

    async def _forget_absent(self) -> None:
        """Forget the sessions that have been away the longest when too many are kept."""
        away = [
            (session.last_disconnect_time or 0, name)
            for name, (session, _) in self._sessions.items()
            if session.transitions.state == "disconnected"
        ]
        for _, name in sorted(away)[: max(0, len(away) - MOST_ABSENT)]:
            await self._cleanup_session(name)


def _room_of(username: str) -> Room:
    if username in {SERVER, *OWN_ACCOUNTS}:
        return SERVER_ROOM
    return READER_ROOM if is_reader(username) else DEVICE_ROOM


def _topics(session: Any) -> frozenset[str]:
    topics: frozenset[str] = session.attributes.get("topics", frozenset())
    return topics


def _shown(name: str | None) -> str:
    return printable((name or "")[:MOST_SHOWN])


def _login(admitted: Admitted, at: datetime) -> Login:
    from registry.services import Login  # the apps' models load only after Django is set up

    return Login(admitted.key, at, admitted.topics)
