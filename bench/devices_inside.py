"""What bench.devices does with VIPO's own functions, in a process that has its settings."""

from __future__ import annotations

import json
import sys
import time
from collections import Counter
from collections.abc import Callable, Iterator, Mapping
from datetime import UTC, datetime, timedelta
from queue import Queue
from threading import Event
from typing import Any
from uuid import UUID, uuid4

import django

django.setup()

from django.core.management import call_command  # noqa: E402 - Django is set up first
from django.db import transaction  # noqa: E402

from bench.flow import device_name  # noqa: E402
from execution.gateway.ingest import Ingester  # noqa: E402
from execution.gateway.queue import Entry  # noqa: E402
from execution.models import Command  # noqa: E402
from registry import services  # noqa: E402
from registry.live import fanout  # noqa: E402
from registry.models import Device  # noqa: E402
from vipo_device.descriptions.reader import write_description  # noqa: E402
from vipo_device.protocol.description import Description, MethodSpec, ParameterSpec, Pose, PropertySpec, Size  # noqa: E402
from vipo_device.protocol.messages import down_topic, up_topic  # noqa: E402
from vipo_device.protocol.mqtt_client import Message, MqttClient  # noqa: E402

SITE = "hall"
NEW_DEVICES = 5000
AT_ONCE = 200
TRIES = range(100)
MILLISECOND = timedelta(milliseconds=1)


def describe(number: int, name: str = "") -> Description:
    own = device_name(number)
    return Description(
        own, name or f"Robot {number}", "robot", "turtlebot", Pose(1.0, 1.0), Size(0.4, 0.4, 0.4),
        site=SITE, radius_m=0.2, speed_m_s=0.5,
        properties=(
            PropertySpec("battery", "number", "PERCENT", 0, 100),
            PropertySpec("temperature", "number", "DEG_C", -20, 120),
        ),
        methods=tuple(
            MethodSpec(verb, f"vipo/v1/dev/{own}/down/{verb}", parameters=(ParameterSpec("value", "number", "NUM"),))
            for verb in ("move", "pick", "drop")
        ),
    )  # fmt: skip


def rate(count: int, work: Callable[[], object]) -> float:
    """Return how many of these are done in a second of this process's own time on one core."""
    began = time.process_time()
    work()
    return count / (time.process_time() - began)


def take_in(payloads: dict[str, bytes]) -> None:
    """Let the gateway's worker take descriptions in as it does: what waits, at most 200 at once."""
    refused: list[str] = []
    acknowledged: list[str] = []
    ingester = Ingester(lambda device, reason, _: refused.append(f"{device}: {reason}"), Counter())
    entries = [
        Entry(Message(up_topic(name, "desc"), payload, False, lambda: acknowledged.append("")), name, "desc")
        for name, payload in payloads.items()
    ]
    for start in range(0, len(entries), AT_ONCE):
        ingester.ingest_all(entries[start : start + AT_ONCE], Event())
    if refused or len(acknowledged) < len(payloads):
        raise RuntimeError(f"{len(acknowledged)} descriptions were acknowledged. {' '.join(refused[:3])}")


def payloads(count: int, name: str = "") -> dict[str, bytes]:
    return {device_name(n): write_description(describe(n, name)).encode() for n in range(count)}


def fill(count: int) -> Iterator[dict[str, object]]:
    call_command("migrate", verbosity=0, interactive=False)
    services.create_site(name="Hall", slug=SITE)
    take_in(payloads(count))
    Device.objects.update(lifecycle="approved")
    yield {"filled": count}


def measure_descriptions(count: int) -> Iterator[dict[str, object]]:
    changed, again = payloads(count, "Renamed"), payloads(count)
    yield {"what": "changed descriptions taken in", "rate": rate(count, lambda: take_in(changed))}
    take_in(again)
    yield {"what": "unchanged descriptions taken in", "rate": rate(count * 10, lambda: find_unchanged(again, 10))}


def find_unchanged(said: dict[str, bytes], rounds: int) -> None:
    """Ask as the gateway does, which takes in what waits, at most 200 at once."""
    names = list(said)
    for _ in range(rounds):
        for start in range(0, len(names), AT_ONCE):
            some = {name: said[name] for name in names[start : start + AT_ONCE]}
            if len(services.find_unchanged(descriptions=some, at=datetime.now(UTC))) < len(some):
                raise RuntimeError("A description that did not change was taken for a new one.")


def measure_delays(port: int, password: str) -> Iterator[dict[str, object]]:
    """Time a stranger's description until browsers are told, and a command's row until it is out and is heard."""
    client = MqttClient(host="127.0.0.1", port=port, username="server", password=password, client_id="bench")
    heard: Queue[tuple[str, float]] = Queue()
    client.subscribe("vipo/v1/dev/+/down/#", 1, lambda topic, _p, _r: heard.put((topic, time.perf_counter())))
    fanout.listen(lambda _slug, message: heard.put((_about(message), time.perf_counter())))
    client.start()
    client.wait_connected(10)
    time.sleep(1)
    new_devices = [_new_device(client, heard, number) for number in TRIES]
    yield {"what": "from a new device's description to the browsers", "ms": new_devices}
    site = Device.objects.values_list("site_id", flat=True)[0]
    asked: dict[UUID, datetime] = {}
    heard_ms = [_ask(heard, site, n, asked) for n in TRIES]
    sent = Command.objects.exclude(sent_at=None).values_list("id", "created_at", "sent_at")
    yield {"what": "from a command, its commit included, to its device", "ms": heard_ms}
    yield {"what": "from a command, its commit included, until it is out", "ms": [_ms(a, b) for _, a, b in sent]}
    yield {"what": "from a command that was asked until it is out", "ms": [_ms(asked[key], b) for key, _, b in sent]}
    client.stop()


def _about(message: Mapping[str, Any]) -> str:
    return str(message["device"]["id"]) if message.get("type") == "device" else ""


def _new_device(client: MqttClient, heard: Queue[tuple[str, float]], number: int) -> float:
    description = describe(NEW_DEVICES + number)
    payload = write_description(description).encode()
    began = time.perf_counter()
    client.publish(up_topic(description.id, "desc"), payload, retain=True)
    return _wait_for(heard, description.id, began)


def _ms(begin: datetime, end: datetime) -> float:
    return (end - begin) / MILLISECOND


def _ask(heard: Queue[tuple[str, float]], site: int, number: int, asked: dict[UUID, datetime]) -> float:
    def note() -> None:
        asked[row.id] = datetime.now(UTC)
        fanout.wake("gateway")

    device, now = device_name(number), datetime.now(UTC)
    row = Command(
        id=uuid4(), site_id=site, device=device, method="pick",
        arguments={"value": 1}, ttl_s=60, position=number, send_after=now, created_at=now,
    )  # fmt: skip
    began = time.perf_counter()
    with transaction.atomic():
        row.save(force_insert=True)
        transaction.on_commit(note)
    return _wait_for(heard, down_topic(device, "pick"), began)


def _wait_for(heard: Queue[tuple[str, float]], wanted: str, began: float) -> float:
    while True:
        what, at = heard.get(timeout=10)
        if what == wanted:
            time.sleep(0.2 + at % 0.1)  # at no fixed distance from the gateway's own look every 0.1 s
            return (at - began) * 1000


def main() -> None:
    what, *arguments = sys.argv[1:]
    chosen: dict[str, Callable[..., Iterator[dict[str, object]]]] = {
        "fill": lambda count: fill(int(count)),
        "describe": lambda count: measure_descriptions(int(count)),
        "delays": lambda port, password: measure_delays(int(port), password),
    }
    for line in chosen[what](*arguments):
        print(json.dumps(line), flush=True)


main()
