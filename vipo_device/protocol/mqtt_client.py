"""The MQTT client port: paho behind a small surface, for the gateway and the twin.

MQTT 5 is preferred. A broker that does not speak it (amqtt) answers the first CONNECT with a refusal or closes the
connection; the client then speaks 3.1.1 for the rest of its life. Callbacks run on the client's own network thread.
"""

from __future__ import annotations

import logging
import ssl
import threading
from collections import deque
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from functools import partial
from math import inf
from types import SimpleNamespace
from typing import Any, Literal

import paho.mqtt.client as paho
from paho.mqtt.enums import CallbackAPIVersion, MQTTProtocolVersion
from paho.mqtt.packettypes import PacketTypes
from paho.mqtt.properties import Properties
from paho.mqtt.reasoncodes import ReasonCode
from paho.mqtt.subscribeoptions import SubscribeOptions

from vipo_device.protocol.errors import MqttError
from vipo_device.protocol.outgoing import NONE, Limits, Outgoing, limits_of
from vipo_device.protocol.readiness import wait_ready
from vipo_device.protocol.sockets import drop_unsent, send_at_once, tls_context

# paho waits by select() and takes a socket with a number above 1,023 for a lost connection, again and again.
paho.__dict__["select"] = SimpleNamespace(select=wait_ready)

log = logging.getLogger(__name__)

ProtocolVersion = Literal["auto", "5", "3.1.1"]
Will = tuple[str, bytes, int, bool]
MessageCallback = Callable[[str, bytes, bool], None]

EARLY_LIMIT = 50_000
"""So many messages wait for a connection, the newest ones; MQTT numbers at most 65,535 that are unconfirmed."""
OWN_PREFIX = "server:"
"""Before the client ids of VIPO's own processes. Client ids are one table over all of a broker's listeners, and who
comes with a known one ends the other's connection; a device's is its user name, which has no such beginning."""
KEEPALIVE_S = 15
SESSION_EXPIRY_S = 10
MISSES_TOLD = 3
"""After so many attempts in a row that reach no broker the log says so, once."""


@dataclass(frozen=True, slots=True)
class Message:
    """A message that its reader acknowledges by hand, once it is safely kept."""

    topic: str
    payload: bytes
    retained: bool
    acknowledge: Callable[[], None]
    qos: int = 1


HandledCallback = Callable[[Message], None]


@dataclass(frozen=True, slots=True)
class _Subscription:
    topic: str
    qos: int
    plain: MessageCallback | None
    handled: HandledCallback | None


class MqttClient:
    """One connection to a broker that comes back by itself.

    `will` is (topic, payload, qos, retain). `keep_session` asks the broker to keep what arrives while this client is
    away (for 10 s) and makes messages be acknowledged by hand, through `subscribe_handled`.
    """

    def __init__(  # noqa: PLR0913 - a connection has that many independent facts
        self,
        *,
        host: str,
        port: int,
        username: str,
        password: str,
        client_id: str,
        tls: ssl.SSLContext | None = None,
        will: Will | None = None,
        protocol: ProtocolVersion = "auto",
        keep_session: bool = False,
    ) -> None:
        self._host, self._port = host, port
        self._username, self._password = username, password
        self._client_id = client_id
        self._tls, self._will = tls, will
        self._keep_session = keep_session
        self._settled = protocol != "auto"
        self._version: ProtocolVersion = "5" if protocol == "auto" else protocol
        self._subscriptions: list[_Subscription] = []
        self._connected_callbacks: list[Callable[[], None]] = []
        self._refused_callbacks: list[Callable[[], None]] = []
        self._early: deque[Outgoing] = deque(maxlen=EARLY_LIMIT)
        self._limits: dict[int, Limits] = {}
        self._guard = threading.RLock()
        self._answered = threading.Condition(self._guard)
        self._unanswered: set[int | None] = set()
        self._online = threading.Event()
        self._stopping = False
        self._refusal = ""
        self._misses = 0
        self._paho = self._make_client()

    @classmethod
    def from_settings(cls, settings: Mapping[str, Any], *, client_id: str, **more: Any) -> MqttClient:
        """Return a client of VIPO's own, from the setting VIPO_MQTT; no device can have its client id."""
        return cls(
            host=settings["host"],
            port=settings["port"],
            username=settings["username"],
            password=settings["password"],
            client_id=OWN_PREFIX + client_id,
            tls=tls_context(settings.get("ca", "")) if settings.get("tls") else None,
            protocol=settings.get("protocol", "auto"),
            **more,
        )

    @property
    def connected(self) -> bool:
        """True while the broker has accepted this connection."""
        return self._online.is_set()

    @property
    def protocol(self) -> ProtocolVersion:
        """The version that is spoken now: "5" or "3.1.1"."""
        return self._version

    @property
    def refusal(self) -> str:
        """Why the broker refused the last attempt, empty when it did not."""
        return self._refusal

    def wait_connected(self, timeout_s: float) -> bool:
        """Block until the connection stands; False when it did not within the time."""
        return self._online.wait(timeout_s)

    def wait_subscribed(self, timeout_s: float) -> bool:
        """Block until the broker has taken every subscription; False when it has not within the time."""
        with self._answered:
            return self._answered.wait_for(lambda: self.connected and not self._unanswered, timeout_s)

    def on_connected(self, callback: Callable[[], None]) -> None:
        """Call back after every connection, once the subscriptions were asked for again."""
        self._connected_callbacks.append(callback)

    def on_refused(self, callback: Callable[[], None]) -> None:
        """Call back each time that the broker does not let this client in; a new password counts from the next try."""
        self._refused_callbacks.append(callback)

    def subscribe(self, topic: str, qos: int, callback: MessageCallback) -> None:
        """Hear a topic filter, now and after every reconnect; acknowledged when the callback returns."""
        self._add(_Subscription(topic, qos, callback, None))

    def subscribe_handled(self, topic: str, qos: int, callback: HandledCallback) -> None:
        """Hear a topic filter; the reader calls `acknowledge()` itself. Needs `keep_session`."""
        if not self._keep_session:
            raise MqttError("subscribe_handled needs a client made with keep_session=True.")
        self._add(_Subscription(topic, qos, None, callback))

    def publish(
        self,
        topic: str,
        payload: bytes,
        *,
        qos: int = 1,
        retain: bool = False,
        expiry_s: float | None = None,
        wait_s: float | None = None,
    ) -> None:
        """Send a message; QoS 1 is kept and sent after a reconnect, unless `expiry_s` or `wait_s` are over by then.

        With MQTT 5 the broker is told what is left of `expiry_s`, and delivers it no later, either.
        """
        message = Outgoing(topic, payload, qos, retain, limits_of(expiry_s, wait_s))
        with self._guard:
            if self.connected:
                self._send(message)
            elif qos > 0 or not self._settled:
                self._early.append(message)

    def change_password(self, password: str) -> None:
        """Come in with another password from the next connection on."""
        with self._guard:
            self._password = password
            self._paho.username_pw_set(self._username, password)

    def start(self) -> None:
        """Begin to connect, in a thread of its own; an absent broker is tried again, 0.5 to 5 s apart."""
        with self._guard:
            self._stopping = False
            self._launch()

    def stop(self) -> None:
        """Say goodbye properly (the will is not sent) and end the network thread. Sends what is still queued."""
        with self._guard:
            self._stopping = True
            client = self._paho
        self._drain(client)
        client.disconnect()
        client.loop_stop()
        self._online.clear()
        with self._guard:
            if self._stopping and client is self._paho and not client._out_messages:
                self._paho = self._make_client()  # the old one lets its sockets go at once, not at some collection

    def _make_client(self) -> paho.Client:
        version = MQTTProtocolVersion.MQTTv5 if self._version == "5" else MQTTProtocolVersion.MQTTv311
        clean = not self._keep_session if self._version == "3.1.1" else None
        client = paho.Client(
            CallbackAPIVersion.VERSION2,
            client_id=self._client_id,
            clean_session=clean,
            protocol=version,
            manual_ack=self._keep_session,
        )
        client.username_pw_set(self._username, self._password)
        client.reconnect_delay_set(min_delay=1, max_delay=5)
        client.max_queued_messages_set(0)
        client.max_inflight_messages_set(200)
        if self._tls is not None:
            client.tls_set_context(self._tls)
        if self._will is not None:
            topic, payload, qos, retain = self._will
            client.will_set(topic, payload, qos, retain)
        client.on_socket_open = lambda _client, _data, opened: send_at_once(opened)
        client.on_socket_close = self._closing
        client.on_connect = self._connected
        client.on_connect_fail = self._missed
        client.on_disconnect = self._disconnected
        client.on_message = self._received
        client.on_subscribe = self._subscribed
        client.on_publish = self._published
        return client

    def _launch(self) -> None:
        options: dict[str, Any] = {}
        if self._version == "5":
            properties = Properties(PacketTypes.CONNECT)  # type: ignore[no-untyped-call]  # paho says nothing
            properties.SessionExpiryInterval = SESSION_EXPIRY_S if self._keep_session else 0
            options = {"clean_start": not self._keep_session, "properties": properties}
        self._paho.connect_async(self._host, self._port, keepalive=KEEPALIVE_S, **options)
        self._paho.loop_start()

    def _connected(self, client: paho.Client, _data: Any, _flags: Any, reason: ReasonCode, _properties: Any) -> None:
        if client is not self._paho:
            return
        if reason.is_failure:
            self._refused(client, str(reason))
            return
        with self._guard:
            self._settled, self._refusal, self._misses = True, "", 0
            self._unanswered.clear()
            for subscription in self._subscriptions:
                self._ask(subscription)
            self._send_waiting(client)
            self._online.set()
        with self._answered:
            self._answered.notify_all()
        for callback in list(self._connected_callbacks):
            callback()

    def _send_waiting(self, client: paho.Client) -> None:
        """Send what no broker has confirmed yet, unless its time is over; paho would send it again however late."""
        unconfirmed = [
            Outgoing(one.topic, bytes(one.payload), one.qos, one.retain, self._limits.get(one.mid, NONE))
            for one in client.drop_out_messages()
        ]
        waiting = deque([*unconfirmed, *self._early], maxlen=EARLY_LIMIT)
        self._limits.clear()
        self._early.clear()
        late = sum(message.limits.is_late for message in waiting)
        for message in waiting:
            if not message.limits.is_late:
                self._send(message)
        if late:
            log.warning("%s: %d messages waited too long for the broker; they are not sent.", self._client_id, late)

    def _missed(self, _client: paho.Client, _data: Any) -> None:
        self._misses += 1
        if self._misses == MISSES_TOLD:
            where = f"{self._host}:{self._port}"
            log.warning("%s does not reach the MQTT broker at %s; it goes on trying.", self._client_id, where)

    def _refused(self, client: paho.Client, reason: str) -> None:
        is_new, self._refusal = reason != self._refusal, reason
        if not self._settled and "protocol version" in reason.lower():
            self._change_version(client)
            return
        log.log(
            logging.WARNING if is_new else logging.DEBUG, "The MQTT broker refused %s: %s.", self._client_id, reason
        )
        for callback in list(self._refused_callbacks):
            callback()

    def _disconnected(self, client: paho.Client, _data: Any, _flags: Any, reason: ReasonCode, _properties: Any) -> None:
        if client is not self._paho:
            return
        self._online.clear()
        if self._stopping:
            return
        if not self._settled and not self._refusal:
            self._change_version(client)
            return
        log.info("The MQTT connection of %s ended: %s.", self._client_id, reason)

    def _closing(self, _client: paho.Client, _data: Any, closing: Any) -> None:
        """Let nothing of a lost connection arrive later, beside the next one."""
        if not self._stopping:
            drop_unsent(closing)

    def _change_version(self, old: paho.Client) -> None:
        """Replace the client by one of the other version; runs on the old one's network thread, which then ends."""
        with self._guard:
            if self._stopping or old is not self._paho:
                return
            self._version = "3.1.1" if self._version == "5" else "5"
            self._paho = self._make_client()
            self._launch()
        old.loop_stop()

    def _received(self, client: paho.Client, _data: Any, message: paho.MQTTMessage) -> None:
        """Hand a message to whoever asked for its topic."""
        hit = next((s for s in self._subscriptions if paho.topic_matches_sub(_bare(s.topic), message.topic)), None)
        if hit is not None and hit.handled is not None:
            acknowledge = partial(_acknowledge, client, message.mid, message.qos)
            hit.handled(Message(message.topic, bytes(message.payload), message.retain, acknowledge, message.qos))
            return
        if hit is not None and hit.plain is not None:
            hit.plain(message.topic, bytes(message.payload), message.retain)
        if self._keep_session:
            _acknowledge(client, message.mid, message.qos)

    def _add(self, subscription: _Subscription) -> None:
        with self._guard:
            self._subscriptions.append(subscription)
            if self.connected:
                self._ask(subscription)

    def _ask(self, subscription: _Subscription) -> None:
        if self._version == "5":
            _, number = self._paho.subscribe(subscription.topic, options=SubscribeOptions(qos=subscription.qos))
        else:
            _, number = self._paho.subscribe(_bare(subscription.topic), qos=subscription.qos)
        self._unanswered.add(number)

    def _subscribed(self, client: paho.Client, _data: Any, number: int, _reasons: Any, _properties: Any) -> None:
        with self._answered:
            if client is self._paho:
                self._unanswered.discard(number)
                self._answered.notify_all()

    def _send(self, message: Outgoing) -> None:
        properties = None
        if message.limits.ends_s < inf and self._version == "5":
            properties = Properties(PacketTypes.PUBLISH)  # type: ignore[no-untyped-call]  # paho says nothing
            properties.MessageExpiryInterval = max(1, round(message.limits.rest_s))
        sent = self._paho.publish(
            message.topic, message.payload, qos=message.qos, retain=message.retain, properties=properties
        )
        # numbers come again: one that was confirmed before this line is put right by the next message that has it
        self._limits.pop(sent.mid, None)
        if message.qos > 0 and message.limits != NONE:
            self._limits[sent.mid] = message.limits

    def _published(self, _client: paho.Client, _data: Any, number: int, _reason: Any, _properties: Any) -> None:
        """Forget until when a message might go; paho holds its messages locked, so nothing is waited for here."""
        self._limits.pop(number, None)

    def _drain(self, client: paho.Client) -> None:
        """Wait a moment for queued QoS 1 messages; paho counts a subscriber's own in flight ones with them."""
        if not self.connected:
            return
        pause = threading.Event()
        for _ in range(40):
            if not client.want_write() and not client._out_messages:
                return
            pause.wait(0.025)


def _acknowledge(client: paho.Client, mid: int, qos: int) -> None:
    if qos > 0:
        client.ack(mid, qos)


def _bare(topic: str) -> str:
    """Return the filter inside a shared subscription ($share/group/filter), or the filter itself."""
    return topic.split("/", 2)[2] if topic.startswith("$share/") else topic
