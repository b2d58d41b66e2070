"""A paho client that does as little as one can with a state: read its JSON and keep it."""

from __future__ import annotations

import json
import socket
import sys
import threading
import time
from pathlib import Path
from typing import Any

import paho.mqtt.client as paho
from paho.mqtt.enums import CallbackAPIVersion

kept: dict[str, Any] = {}
seen = 0


def take(_client: Any, _data: Any, message: paho.MQTTMessage) -> None:
    global seen
    kept[message.topic] = json.loads(message.payload)
    seen += 1


def tell(path: Path) -> None:
    while True:
        path.write_text(str(seen))
        time.sleep(0.5)


def main() -> None:
    port, password, topic, counter = sys.argv[1:]
    client = paho.Client(CallbackAPIVersion.VERSION2, client_id="bare-loop")
    client.username_pw_set("server", password)
    client.on_socket_open = lambda _c, _d, opened: opened.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)
    client.on_message = take
    client.on_connect = lambda *_: client.subscribe(topic, 1)
    client.on_subscribe = lambda *_: threading.Thread(target=tell, args=(Path(counter),), daemon=True).start()
    client.connect("127.0.0.1", int(port))
    client.loop_forever()


main()
