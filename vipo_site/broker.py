"""The embedded MQTT broker: amqtt in a thread of this process, with VIPO's own rules about who may do what.

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
import threading
import time
from collections.abc import Callable, Mapping
from contextlib import suppress
from datetime import UTC, datetime, timedelta
from typing import TYPE_CHECKING, Any

from amqtt.adapters import BufferReader
from amqtt.broker import Broker
from amqtt.contexts import Action
from amqtt.errors import AMQTTError, BrokerError, CodecError, MQTTError, NoDataError
from amqtt.mqtt.connack import NOT_AUTHORIZED, UNACCEPTABLE_PROTOCOL_VERSION, ConnackPacket
from amqtt.mqtt.protocol.broker_handler import BrokerProtocolHandler
from django.db import DatabaseError

from registry.errors import RegistryError
from vipo_site.doorkeeping import (
    LOOK_EVERY_S,
    Doorkeeper,
    RegistryDoorkeeper,
    may_publish,
    may_subscribe,
)

if TYPE_CHECKING:
    from registry.services import Login

log = logging.getLogger(__name__)

CONNECT_LIMIT_BYTES = 8192
PACKET_LIMIT_BYTES = 16384
"""As `max_packet_size` in deploy/mosquitto/mosquitto.conf: whoever sends more is disconnected."""
CONNECT_TIMEOUT_S = 10.0
PROTOCOL_LEVEL = 4
START_TIMEOUT_S = 15.0
END_TIMEOUT_S = 2.0
COMPLAINT_EVERY_S = 60.0
MOST_COMPLAINTS = 1000
UNREADABLE = (
    *(AMQTTError, MQTTError, CodecError, NoDataError),
    *(TimeoutError, asyncio.IncompleteReadError, OSError, IndexError, UnicodeError),
)
CheckPassword = Callable[[str, str], bool]


class PortInUse(RegistryError):
    """Another program listens on the MQTT port."""

    code = "port_in_use"
    status = 503


class BrokerFailed(RegistryError):
    """The embedded broker could not begin, for a reason that the message names."""

    code = "broker_failed"
    status = 503


class _PacketTooLarge(Exception):
    """A client announced a packet that is larger than anybody may send."""


class _PasswordDoorkeeper:
    """Lets in whoever a function accepts, for ever."""

    def __init__(self, check_password: CheckPassword) -> None:
        self._check_password = check_password

    def admit(self, username: str, password: str) -> str | None:
        """See Doorkeeper."""
        return "" if self._check_password(username, password) else None

    def find_ended(self, _logins: Mapping[str, Login]) -> frozenset[str]:
        """See Doorkeeper."""
        return frozenset()

    def wait(self) -> None:
        """See Doorkeeper."""
        time.sleep(LOOK_EVERY_S)


class EmbeddedBroker:
    """A running broker; `port` is the one it got, `stop()` ends it."""

    def __init__(self, *, host: str, port: int, server_password: str, doorkeeper: Doorkeeper) -> None:
        self.host, self.port = host, port
        self._rules = (server_password, doorkeeper)
        self._ready = threading.Event()
        self._failure: Exception | None = None
        self._loop: asyncio.AbstractEventLoop | None = None
        self._stopping: asyncio.Event | None = None
        self._thread = threading.Thread(target=self._run, name="mqtt-broker", daemon=True)

    def start(self) -> None:
        """Begin; returns when the port is open, raises PortInUse or BrokerFailed otherwise."""
        self._thread.start()
        if not self._ready.wait(START_TIMEOUT_S):
            raise BrokerFailed(f"The MQTT broker did not begin within {START_TIMEOUT_S:.0f} s. Start VIPO again.")
        if self._failure is not None:
            raise self._failure

    def stop(self) -> None:
        """End all connections and the thread; harmless when it has ended already."""
        if self._loop is not None and self._stopping is not None and self._thread.is_alive():
            self._loop.call_soon_threadsafe(self._stopping.set)
        self._thread.join(timeout=10)

    @property
    def running(self) -> bool:
        """True while the broker's thread serves."""
        return self._thread.is_alive() and self._ready.is_set() and self._failure is None

    def _run(self) -> None:
        for name in ("amqtt", "transitions"):
            logging.getLogger(name).setLevel(logging.CRITICAL)
        try:
            # Not asyncio.run: it would wait for ever for a task of amqtt that does not let itself be cancelled.
            loop = asyncio.new_event_loop()
            try:
                loop.run_until_complete(self._serve())
            finally:
                loop.run_until_complete(_cancel_the_rest())
                loop.close()
        except (BrokerError, OSError) as error:
            self._failure = self._explain(error)
        finally:
            self._ready.set()

    async def _serve(self) -> None:
        self._loop, self._stopping = asyncio.get_running_loop(), asyncio.Event()
        broker = VipoBroker(f"{self.host}:{self.port}", *self._rules)
        await broker.start()
        self.port = broker.bound_port
        self._ready.set()
        watching = asyncio.create_task(broker.end_whoever_must_go())
        await self._stopping.wait()
        watching.cancel()
        await broker.end()

    def _explain(self, error: Exception) -> Exception:
        cause = error.__cause__ if isinstance(error.__cause__, OSError) else error
        if isinstance(cause, OSError) and "in use" in str(cause):
            return PortInUse(
                f"The MQTT port {self.port} is in use by another program. "
                "Stop that program, or set VIPO_MQTT_PORT to a free port.",
            )
        return BrokerFailed(f"The MQTT broker cannot listen on {self.host}:{self.port}: {cause}.")


def start_broker(
    *,
    port: int,
    host: str = "127.0.0.1",
    server_password: str | None = None,
    check_password: CheckPassword | None = None,
) -> EmbeddedBroker:
    """Start the embedded broker on `port` (0: any free one) for the user `server` and for the registry's devices.

    The server's password is the one in the setting VIPO_MQTT unless one is given; `check_password(user, password)`
    stands in for the registry where there is none.
    """
    if server_password is None:
        from django.conf import settings

        server_password = str(settings.VIPO_MQTT["password"])
    doorkeeper = _PasswordDoorkeeper(check_password) if check_password else RegistryDoorkeeper()
    broker = EmbeddedBroker(host=host, port=port, server_password=server_password, doorkeeper=doorkeeper)
    broker.start()
    return broker


class _Subscriptions(dict[str, list[Any]]):
    """Subscriptions that may change while somebody walks through them."""

    def __iter__(self) -> Any:
        return iter(list(super().keys()))

    def items(self) -> Any:
        """Return a copy: amqtt awaits in the middle of its loops."""
        return [(topic, list(sessions)) for topic, sessions in super().items()]


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


class _Handler(BrokerProtocolHandler):  # type: ignore[misc]  # amqtt has no types
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
        await _until(lambda: not self._open, END_TIMEOUT_S)
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
            packet = await asyncio.wait_for(_read_connect(reader), CONNECT_TIMEOUT_S)
            level = _protocol_level(packet)
            if level != PROTOCOL_LEVEL:
                await _refuse(writer, UNACCEPTABLE_PROTOCOL_VERSION)
                raise MQTTError(f"Protocol level {level} is not spoken here.")
            handler, session = await _Handler.init_from_connect(BufferReader(packet), writer, self.plugins_manager)
        except UNREADABLE as error:
            await writer.close()
            raise MQTTError(f"No proper CONNECT from {remote_address}:{remote_port}: {error}") from error
        if not await self._admit(session):
            self._complain(session.client_id, session.username)
            await _refuse(writer, NOT_AUTHORIZED)
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
            await _until(lambda: old.transitions.state != "connected", 2.0)
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


async def _cancel_the_rest() -> None:
    """Cancel what still runs in this loop, and wait a moment for it."""
    others = [task for task in asyncio.all_tasks() if task is not asyncio.current_task()]
    for task in others:
        task.cancel()
    if others:
        await asyncio.wait(others, timeout=1.0)


async def _read_connect(reader: Any) -> bytes:
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


def _protocol_level(packet: bytes) -> int:
    """Return the level in a CONNECT: after the fixed header come the protocol's name and one byte."""
    start = 1
    while packet[start] & 0x80:
        start += 1
    start += 1
    name_length = int.from_bytes(packet[start : start + 2], "big")
    return packet[start + 2 + name_length]


async def _refuse(writer: Any, code: int) -> None:
    await ConnackPacket.build(0, code).to_stream(writer)
    await writer.close()


async def _until(condition: Callable[[], bool], timeout_s: float) -> None:
    for _ in range(round(timeout_s / 0.01)):
        if condition():
            return
        await asyncio.sleep(0.01)
