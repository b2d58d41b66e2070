"""Two gateways' workers on one PostgreSQL, which take in descriptions of the same devices, while people decide on them.

Prints what each worker could not do, and how many descriptions were kept.
"""

from __future__ import annotations

import json
import random
import sys
import threading
from collections import Counter
from collections.abc import Callable
from datetime import UTC, datetime

import django

django.setup()

from django.db import connection  # noqa: E402

from execution.gateway.ingest import Ingester  # noqa: E402
from execution.gateway.queue import Entry  # noqa: E402
from registry import services  # noqa: E402
from registry.models import Device  # noqa: E402
from vipo_device.descriptions.reader import write_description  # noqa: E402
from vipo_device.protocol.description import Description, Pose, Size  # noqa: E402
from vipo_device.protocol.mqtt_client import Message  # noqa: E402

DEVICES, ROUNDS = [f"mixer{number:02}" for number in range(30)], 12


def payload(device: str, name: str) -> bytes:
    said = Description(device, name, "machine", "mixer", Pose(1, 1), Size(1, 1, 1), site="hall")
    return write_description(said, "n-triples").encode()


def describe(worker: str, faults: list[str], acknowledged: Counter[str]) -> None:
    """Let every device speak in every round, in an order of this worker's own."""
    ingester = Ingester(lambda device, reason, _: faults.append(f"{device}: {reason}"), Counter())
    order = random.Random(worker)
    for number in range(ROUNDS):
        entries = [
            Entry(
                Message("", payload(name, f"{worker} {number}"), False, lambda: acknowledged.update([worker])),
                name,
                "desc",
            )
            for name in order.sample(DEVICES, len(DEVICES))
        ]
        ingester.ingest_all(entries, threading.Event())


def decide() -> None:
    """Rename devices and give them their own names back, and take some out, one after the other."""
    for name in DEVICES[::2]:
        for own in (f"Ada's {name}", ""):
            services.update_device(site="hall", device_id=name, name=own, by=None, at=datetime.now(UTC))
    Device.objects.filter(pk__in=DEVICES[::5]).update(lifecycle="retired")


def guarded(work: Callable[[], None], faults: list[str]) -> Callable[[], None]:
    def run() -> None:
        try:
            work()
        except Exception as error:  # noqa: BLE001 - whatever it is, the test is told
            faults.append(repr(error))
        finally:
            connection.close()

    return run


def main() -> None:
    services.create_site(name="Hall", slug="hall")
    faults: list[str] = []
    acknowledged: Counter[str] = Counter()
    describe("first", faults, acknowledged)
    Device.objects.update(lifecycle="approved")
    works = [lambda: describe("one", faults, acknowledged), lambda: describe("two", faults, acknowledged)]
    threads = [threading.Thread(target=guarded(work, faults)) for work in (*works, decide)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    json.dump({"faults": faults, "acknowledged": acknowledged}, sys.stdout)


main()
