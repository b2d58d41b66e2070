"""How connections to a broker are secured, sped up and given up."""

from __future__ import annotations

import socket
import ssl
import struct
from contextlib import suppress
from typing import Any

from vipo_device.protocol.errors import MqttError


def tls_context(authority: str = "") -> ssl.SSLContext:
    """Return a context that checks the broker's certificate, against the file `authority` if one is named."""
    try:
        return ssl.create_default_context(cafile=authority or None)
    except OSError as error:
        raise MqttError(
            f"The certificate authority {authority!r} cannot be read: {error}. Check VIPO_MQTT_CA."
        ) from None


def send_at_once(opened: Any) -> None:
    """Switch Nagle's algorithm off: a message would wait up to 40 ms for a delayed acknowledgement."""
    with suppress(OSError):  # a broker behind something that is not TCP has no such wait
        opened.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)


def drop_unsent(closing: Any) -> None:
    """Let the system forget what it has not sent of a connection; it would go on trying for minutes after its end."""
    with suppress(OSError):
        closing.setsockopt(socket.SOL_SOCKET, socket.SO_LINGER, struct.pack("ii", 1, 0))
