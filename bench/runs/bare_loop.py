"""The least that can give a device its next command once it has answered: paho, and one insert for all that has come.

`python -m bench.runs.bare_loop PORT PASSWORD DATABASE_URL STEPS`: whoever answers gets the next of so many commands. It
knows no robots, no floor, no states, no limits of time, and forgets what it was at when it is killed.
"""

from __future__ import annotations

import json
import queue
import socket
import sys
from collections import Counter
from typing import Any
from uuid import uuid4

import paho.mqtt.client as paho
import psycopg
from paho.mqtt.enums import CallbackAPIVersion

TOPIC = "vipo/v1/bare"
_TABLE = "CREATE TABLE IF NOT EXISTS bench_bare (id bigserial PRIMARY KEY, device text, answer text, command text)"
_KEEP = "INSERT INTO bench_bare (device, answer, command) SELECT * FROM unnest(%s::text[], %s::text[], %s::text[])"
answers: queue.Queue[tuple[str, str]] = queue.Queue()


def take(_client: Any, _data: Any, message: paho.MQTTMessage) -> None:
    answers.put((message.topic.split("/")[3], json.loads(message.payload)["id"]))


def subscribe(client: paho.Client, *_more: Any) -> None:
    client.subscribe(f"{TOPIC}/+/up/ack", 1)


def take_all() -> list[tuple[str, str]]:
    """Return what has come, at least one."""
    found = [answers.get()]
    while not answers.empty():
        found.append(answers.get_nowait())
    return found


def main() -> None:
    port, password, url, steps = sys.argv[1:]
    client = paho.Client(CallbackAPIVersion.VERSION2, client_id="bare-runs")
    client.username_pw_set("server", password)
    client.on_socket_open = lambda _c, _d, opened: opened.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)
    client.on_message = take
    client.on_connect = subscribe
    client.on_subscribe = lambda *_: print("ready", flush=True)
    told: Counter[str] = Counter()
    with psycopg.connect(url, autocommit=True) as database:
        database.execute(_TABLE)
        client.connect("127.0.0.1", int(port))
        client.loop_start()
        while True:
            heard = [(device, answer) for device, answer in take_all() if told[device] < int(steps)]
            next_ones = [str(uuid4()) for _ in heard]
            if heard:
                database.execute(_KEEP, (*map(list, zip(*heard, strict=True)), next_ones), prepare=True)
            for (device, _), command in zip(heard, next_ones, strict=True):
                told[device] += 1
                client.publish(f"{TOPIC}/{device}/down/heat", json.dumps({"id": command, "v": {"value": 1}}), qos=1)


if __name__ == "__main__":
    main()
