"""Two admins confirm one topic for two devices at the same instant, again and again, on one PostgreSQL.

Prints how often each outcome came, and how often more or less than one device may be told on a topic.
"""

from __future__ import annotations

import json
import sys
import threading
from collections import Counter
from datetime import UTC, datetime

import django

django.setup()

from django.db import connection  # noqa: E402

from registry import services  # noqa: E402
from registry.models import Device, TopicClaim  # noqa: E402
from vipo_device.descriptions.reader import write_description  # noqa: E402
from vipo_device.protocol.description import Description, MethodSpec, Pose, Size  # noqa: E402

ROUNDS, DEVICES = 20, ("mixer1", "mixer2")


def describe(device: str, topics: list[str]) -> None:
    methods = tuple(MethodSpec(f"mix{number}", topic) for number, topic in enumerate(topics))
    said = Description(device, device, "machine", "mixer", Pose(1, 1), Size(1, 1, 1), methods=methods, site="hall")
    payload = write_description(said, "n-triples").encode()
    services.ingest_description(device_id=device, payload=payload, at=datetime.now(UTC))
    Device.objects.filter(pk=device).update(lifecycle="approved")  # without a key, which would want a broker


def confirm_all(device: str, topics: list[str], together: threading.Barrier, came_of_it: Counter[str]) -> None:
    """Confirm each topic for this device, all of this at the instant at which the other admin does so."""
    for topic in topics:
        together.wait(60)
        try:
            services.confirm_topic(site="hall", device_id=device, topic=topic, by=None, at=datetime.now(UTC))
            came_of_it["confirmed"] += 1
        except services.TopicTaken:
            came_of_it["told"] += 1
        except Exception as error:  # noqa: BLE001 - whatever it is, the test is told
            came_of_it[repr(error)] += 1
    connection.close()


def main() -> None:
    services.create_site(name="Hall", slug="hall")
    topics = [f"plant/{number}/start" for number in range(ROUNDS)]
    for device in DEVICES:
        describe(device, topics)
        TopicClaim.objects.all().delete()  # as after a readmission, when nobody holds a topic that both ask for
    together, came_of_it = threading.Barrier(2), Counter[str]()
    admins = [threading.Thread(target=confirm_all, args=(d, topics, together, came_of_it)) for d in DEVICES]
    for admin in admins:
        admin.start()
    for admin in admins:
        admin.join(120)
    granted = Counter(t for d in Device.objects.all() for t in d.granted.values())
    rows = TopicClaim.objects.exclude(confirmed_at=None).count()
    json.dump({"came": came_of_it, "owned_once": list(granted.values()).count(1), "rows": rows}, sys.stdout)


main()
