"""How long a message and its answer take at QoS 1 through Mosquitto, with Nagle's algorithm off and on.

Server and device are this product's own client in one process; a round is the server's command and the device's answer.
"""

from __future__ import annotations

import tempfile
import threading
import time
from collections.abc import Iterator
from pathlib import Path

from bench.figures import figure, share
from tests.kit.servers import Mosquitto, run_mosquitto
from vipo_device.protocol.mqtt_client import MqttClient

ROUNDS = 200
WORD = "secret"
DOWN, UP = "vipo/v1/dev/oven/down/cure", "vipo/v1/dev/oven/up/ack"


def measure() -> Iterator[dict[str, object]]:
    with tempfile.TemporaryDirectory() as folder, run_mosquitto(Path(folder), {"server": WORD, "oven": WORD}) as broker:
        yield from _rows("as it is", broker)
        yield from _rows("Nagle on in both clients, as paho comes", broker, has_nagle=True)
        broker.stop()
        path = broker.folder / "mosquitto.conf"
        path.write_text(path.read_text().replace("set_tcp_nodelay true", "set_tcp_nodelay false"))
        broker.start()
        yield from _rows("Nagle on in the broker", broker)
        yield from _rows("Nagle on in all three", broker, has_nagle=True)


def _rows(how: str, broker: Mosquitto, *, has_nagle: bool = False) -> Iterator[dict[str, object]]:
    took_ms = _time_rounds(broker, has_nagle=has_nagle)
    for name, quantile in (("p50", 0.5), ("p99", 0.99)):
        facts = {"rounds": ROUNDS, "broker": "Mosquitto, no TLS"}
        yield figure(f"command and answer at QoS 1, {how}, {name}", share(took_ms, quantile), "ms", **facts)


def _time_rounds(broker: Mosquitto, *, has_nagle: bool) -> list[float]:
    answered = threading.Event()
    server = _client("server", broker.port, has_nagle=has_nagle)
    device = _client("oven", broker.device_port, has_nagle=has_nagle)
    device.subscribe(DOWN, 1, lambda _topic, payload, _retained: device.publish(UP, payload))
    server.subscribe(UP, 1, lambda *_said: answered.set())
    for client in (server, device):
        client.start()
        if not client.wait_subscribed(20):
            raise RuntimeError("a client was not let in")
    took_ms = []
    for _ in range(ROUNDS):
        began = time.perf_counter()
        server.publish(DOWN, b'{"id": "one", "v": {}, "ttl_s": 60}')
        if not answered.wait(20):
            raise RuntimeError("no answer came")
        took_ms.append((time.perf_counter() - began) * 1000)
        answered.clear()
    for client in (server, device):
        client.stop()
    return took_ms


def _client(name: str, port: int, *, has_nagle: bool) -> MqttClient:
    client = MqttClient(host="127.0.0.1", port=port, username=name, password=WORD, client_id=name, protocol="5")
    if has_nagle:
        client._paho.on_socket_open = None
    return client
