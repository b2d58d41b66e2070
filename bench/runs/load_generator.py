"""The inside of `bench.runs`: makes the hall, starts runs, plays its devices, and measures."""

from __future__ import annotations

import json
import sys
import threading
import time
from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import Any
from uuid import uuid4

import django

django.setup()

from django.conf import settings  # noqa: E402
from django.db import connection  # noqa: E402

from bench.figures import figure, share  # noqa: E402
from bench.flow import TICKS_PER_S, cpu_seconds  # noqa: E402
from bench.hall import SITE, fill_hall  # noqa: E402
from editor.language import plan_to_json  # noqa: E402
from editor.language.expressions.nodes import Constant, PlaceRef  # noqa: E402
from editor.language.plan.instructions import Call, End, Instruction, Plan  # noqa: E402
from execution import services  # noqa: E402
from execution.models import Run  # noqa: E402
from vipo_device.protocol.mqtt_client import MqttClient  # noqa: E402

DEVICES, ROBOTS = 104, 2
ONE_RUN_STEPS, MANY_RUNS, MANY_STEPS = 100, 100, 20
STATE_EVERY_S = 3.0
LIMIT_S = 400.0


def machines() -> list[str]:
    return [f"machine{number:03d}" for number in range(3, DEVICES)]


class Devices:
    """All machines of the hall, which answer that they are done as soon as they are told anything."""

    def __init__(self) -> None:
        self.delays: list[float] = []
        self.done = 0
        self._answered: dict[str, float] = {}
        self._seen: set[str] = set()
        mqtt = settings.VIPO_MQTT
        self._client = MqttClient(
            host=mqtt["host"], port=mqtt["port"], username="server", password=mqtt["password"], client_id="load"
        )
        self._client.subscribe("vipo/v1/dev/+/down/#", 1, self._told)
        self._client.start()
        self._client.wait_connected(20)
        self._ending = threading.Event()
        threading.Thread(target=self._speak, daemon=True).start()

    def _told(self, topic: str, payload: bytes, _retained: bool) -> None:
        at = time.perf_counter()
        device, command = topic.split("/")[3], json.loads(payload)["id"]
        if command not in self._seen:
            self._seen.add(command)
            if device in self._answered:
                self.delays.append((at - self._answered[device]) * 1000)
            self.done += 1
        answer = {"id": command, "st": "DONE"}
        self._answered[device] = time.perf_counter()
        self._client.publish(f"vipo/v1/dev/{device}/up/ack", json.dumps(answer).encode())

    def forget(self) -> None:
        self.delays, self.done, self._answered = [], 0, {}

    def _speak(self) -> None:
        seq = 0
        while not self._ending.wait(STATE_EVERY_S if seq else 0):
            seq += 1
            for name in machines():
                state = {"boot": 1, "seq": seq, "done": True, "props": {"temperature": 20}}
                self._client.publish(f"vipo/v1/dev/{name}/up/state", json.dumps(state).encode())

    def close(self) -> None:
        self._ending.set()
        self._client.stop()


def program(machine: str, steps: int) -> Plan:
    call = Call(PlaceRef(device=machine), "heat", {"value": Constant(1)})
    return Plan((*(Instruction(call, f"s{n}", n) for n in range(steps)), Instruction(End())))


def start(machine: str, steps: int) -> str:
    prepared = services.Prepared(uuid4(), SITE, "Bench", 1, {}, {}, plan_to_json(program(machine, steps)), {})
    return str(services.start_run(prepared=prepared, by="Bench").id)


def cpu(pids: Mapping[str, int]) -> dict[str, float]:
    """Return the processor time of each process; PostgreSQL's with that of its children, also of those that ended."""
    found = {name: cpu_seconds(pid) for name, pid in pids.items()}
    found["postgres"] = sum(cpu_seconds(pid) + _ended(pid) for pid in _tree(pids["postgres"]))
    for status in Path("/proc").glob("[0-9]*/stat"):
        try:
            parent = int(status.read_text().rsplit(")", 1)[1].split()[1])
            if parent in _tree(pids["postgres"]) and int(status.parent.name) not in _tree(pids["postgres"]):
                found["postgres"] += cpu_seconds(int(status.parent.name))
        except (OSError, IndexError):
            continue
    return found


def _ended(pid: int) -> float:
    """Return the processor time of a process's children that have ended."""
    fields = Path(f"/proc/{pid}/stat").read_text().rsplit(")", 1)[1].split()
    return (int(fields[13]) + int(fields[14])) / TICKS_PER_S


def _tree(root: int) -> set[int]:
    """Return the server's own id, and that of its child where somebody else's rights were taken on to start it."""
    children = Path(f"/proc/{root}/task/{root}/children").read_text().split()
    is_wrapped = "postgres" not in Path(f"/proc/{root}/comm").read_text()
    return {root, *(map(int, children) if is_wrapped else ())}


def commits() -> int:
    with connection.cursor() as cursor:
        cursor.execute("SELECT pg_stat_clear_snapshot(), xact_commit FROM pg_stat_database WHERE datname = 'vipo'")
        return int(cursor.fetchone()[1])


def watch(devices: Devices, pids: Mapping[str, int], runs: list[str], steps: int) -> dict[str, Any]:
    """Wait until the runs are over, and return what the steps took that were still to be done."""
    before, wrote, began, earlier = cpu(pids), commits(), time.perf_counter(), devices.done
    while time.perf_counter() - began < LIMIT_S and devices.done < steps:
        time.sleep(0.02)
    took = time.perf_counter() - began
    while time.perf_counter() - began < LIMIT_S and Run.objects.filter(id__in=runs).exclude(status="finished").exists():
        time.sleep(0.2)
    time.sleep(1.5)  # what PostgreSQL counts it says a second later
    used = {name: (after - before[name]) * 1000 / max(devices.done - earlier, 1) for name, after in cpu(pids).items()}
    over = Run.objects.filter(id__in=runs, status="finished").count()
    if over < len(runs) or devices.done != steps:
        print(list(Run.objects.filter(id__in=runs).values("status", "reason")[:3]), devices.done, file=sys.stderr)
        raise RuntimeError("Not every run has ended well, or a command was told twice under another id.")
    cost = {f"{name}_ms": round(used[name], 2) for name in used}
    counted = steps - earlier
    rates = {"rate": counted / took, "commits": (commits() - wrote) / counted}
    return {"delays": sorted(devices.delays), "cost": cost, **rates}


def measure(pids: Mapping[str, int]) -> Iterator[dict[str, object]]:
    devices = Devices()
    time.sleep(2)
    run = [start(machines()[0], 20)]
    watch(devices, pids, run, 20)
    devices.forget()
    found = watch(devices, pids, [start(machines()[0], ONE_RUN_STEPS)], ONE_RUN_STEPS)
    for name, part in (("p50", 0.5), ("p99", 0.99)):
        yield figure(f"one run, done to next command, {name}", share(found["delays"], part), "ms", **found["cost"])
    yield figure("one run", found["rate"], "steps/s", commits_a_step=round(found["commits"], 2))
    devices.forget()
    runs = [start(machine, MANY_STEPS) for machine in machines()[:MANY_RUNS]]
    found = watch(devices, pids, runs, MANY_RUNS * MANY_STEPS)
    for name, part in (("p50", 0.5), ("p99", 0.99)):
        yield figure(f"100 runs, done to next command, {name}", share(found["delays"], part), "ms", **found["cost"])
    yield figure("100 runs of one site", found["rate"], "steps/s", commits_a_step=round(found["commits"], 2))
    devices.close()


def main() -> None:
    if sys.argv[1] == "fill":
        fill_hall(DEVICES, ROBOTS)
        return
    for line in measure(json.loads(sys.argv[2])):
        print(json.dumps(line), flush=True)


if __name__ == "__main__":
    main()
