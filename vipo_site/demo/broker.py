"""The demo's broker, and which ports of this machine are free."""

from __future__ import annotations

import errno
import os
import socket

from vipo_site.demo.children import HOST, Part


def port_is_free(port: int) -> bool:
    """Tell whether nothing listens on the port of this machine."""
    with socket.socket() as probe:
        probe.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
        try:
            probe.bind((HOST, port))
        except OSError as error:
            if error.errno in {errno.EADDRINUSE, errno.EACCES}:
                return False
            raise
        return True


def any_free_port() -> int:
    """Return a port that nothing listens on."""
    with socket.socket() as probe:
        probe.bind((HOST, 0))
        return int(probe.getsockname()[1])


def start_broker(*, any_port: bool) -> Part:
    """Run the MQTT broker in a thread; with `any_port` on another one if somebody has taken its port meanwhile.

    Raises PortInUse, BrokerFailed.
    """
    from vipo_site.embedded_broker.server import PortInUse
    from vipo_site.embedded_broker.server import start_broker as start

    try:
        handle = start(port=int(os.environ["VIPO_MQTT_PORT"]), host=HOST)
    except PortInUse:
        if not any_port:
            raise
        use_mqtt_port(any_free_port())
        handle = start(port=int(os.environ["VIPO_MQTT_PORT"]), host=HOST)
    return Part("broker", handle.stop)


def use_mqtt_port(port: int) -> None:
    """Let all parts that start from now on find the broker at another port."""
    from django.conf import settings

    os.environ["VIPO_MQTT_PORT"] = str(port)
    settings.VIPO_MQTT["port"] = port
    if "VIPO_BROKER_URL" not in os.environ:
        settings.VIPO_BROKER_URL = f"mqtt://{HOST}:{port}/"
