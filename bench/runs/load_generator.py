"""The inside of `bench.runs`: makes the hall, starts runs, plays its devices, presses stops, and measures."""

from __future__ import annotations

import json
import os
import signal
import subprocess
import sys
import tempfile
import threading
import time
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
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
from bench.peers.subjects import Running, node_red, steps_flow  # noqa: E402
from bench.runs.bare_loop import TOPIC as BARE  # noqa: E402
from bench.runs.stops import Ears  # noqa: E402
from editor.language import plan_to_json  # noqa: E402
from editor.language.expressions.nodes import Constant, PlaceRef  # noqa: E402
from editor.language.plan.instructions import Call, End, Instruction, Plan  # noqa: E402
from execution import services  # noqa: E402
from execution.commands.claim import CLAIM_HOLDS_S  # noqa: E402
from execution.models import Run  # noqa: E402
from vipo_device.protocol.mqtt_client import MqttClient  # noqa: E402

DEVICES, ROBOTS = 104, 2
ONE_RUN_STEPS, MANY_RUNS, MANY_STEPS = 200, 100, 20
LOOP, NODE_RED = "a bare loop", "Node-RED"
EARS, PRESSES, BESIDE, PRESSES_BESIDE = 100, 10, 40, 5
STATE_EVERY_S, IDLE_S = 3.0, 5.0
LIMIT_S = 400.0


def machines() -> list[str]:
    return [f"machine{number:03d}" for number in range(3, DEVICES)]


class Devices:
    """All machines of the hall, which answer that they are done as soon as they are told anything."""

    def __init__(self, topics: str = "vipo/v1/dev") -> None:
        self._topics = topics
        self.delays: list[float] = []
        self.done = 0
        self._answered: dict[str, float] = {}
        self._seen: set[str] = set()
        mqtt = settings.VIPO_MQTT
        self._client = MqttClient(
            host=str(mqtt["host"]),
            port=int(str(mqtt["port"])),
            username="server",
            password=str(mqtt["password"]),
            client_id=f"load {topics}",
        )
        self._client.subscribe(f"{topics}/+/down/#", 1, self._told)
        self._client.start()
        self._client.wait_connected(20)
        self._ending = threading.Event()
        if topics == "vipo/v1/dev":
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
        self._client.publish(f"{self._topics}/{device}/up/ack", json.dumps(answer).encode())

    def begin(self, names: list[str]) -> None:
        """Answer something that nobody has asked, for a peer that answers each answer with a command."""
        for name in names:
            self._client.publish(f"{self._topics}/{name}/up/ack", json.dumps({"id": "", "st": "DONE"}).encode())

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
    took, after = time.perf_counter() - began, cpu(pids)
    while time.perf_counter() - began < LIMIT_S and Run.objects.filter(id__in=runs).exclude(status="finished").exists():
        time.sleep(0.2)
    time.sleep(1.5)  # what PostgreSQL counts it says a second later
    counted = max(steps - earlier, 1)
    used = {name: (seconds - before[name]) * 1000 / counted for name, seconds in after.items()}
    over = Run.objects.filter(id__in=runs, status="finished").count()
    if over < len(runs) or devices.done != steps:
        print(list(Run.objects.filter(id__in=runs).values("status", "reason")[:3]), devices.done, file=sys.stderr)
        raise RuntimeError("Not every run has ended well, or a command was told twice under another id.")
    cost = {f"{name}_ms": round(used[name], 2) for name in used}
    rates = {"rate": counted / took, "commits": (commits() - wrote) / counted}
    return {"delays": sorted(devices.delays), "cost": cost, **rates}


def told(who: str, found: Mapping[str, Any]) -> Iterator[dict[str, object]]:
    """Yield the figures about some runs."""
    for name, part in (("p50", 0.5), ("p99", 0.99)):
        yield figure(f"{who}, done to next command, {name}", share(found["delays"], part), "ms", **found["cost"])
    yield figure(who, found["rate"], "steps/s", commits_a_step=round(found["commits"], 2))


def measure_peer(pids: Mapping[str, int], peer: str, runs: int, steps: int) -> dict[str, Any]:
    """Let a peer give as many devices their commands, over topics of its own; `missing` says why it is not here."""
    devices = Devices(BARE)
    with tempfile.TemporaryDirectory() as folder, _peer(peer, Path(folder), steps) as running:
        try:
            if running.missing:
                return {"missing": running.missing}
            devices.begin(machines()[:runs])
            return watch(devices, {"peer": running.pid, "postgres": pids["postgres"]}, [], runs * steps)
        finally:
            devices.close()


@contextmanager
def _peer(name: str, folder: Path, steps: int) -> Iterator[Running]:
    port, password = int(str(settings.VIPO_MQTT["port"])), str(settings.VIPO_MQTT["password"])
    if name == NODE_RED:
        with node_red(folder, port, password, steps_flow(folder / "seen", port, BARE, steps)) as running:
            yield running
        return
    command = [sys.executable, "-m", "bench.runs.bare_loop", str(port), password, os.environ["VIPO_DATABASE_URL"]]
    with subprocess.Popen([*command, str(steps)], stdout=subprocess.PIPE) as process:
        try:
            assert process.stdout is not None
            process.stdout.readline()  # it hears answers from now on
            yield Running(name, pid=process.pid)
        finally:
            process.kill()


def measure_runs(pids: Mapping[str, int]) -> Iterator[dict[str, object]]:
    """Yield what one run and a hundred take, and beside each what the bare loop takes."""
    devices = Devices()
    time.sleep(2)
    watch(devices, pids, [start(machines()[0], 20)], 20)
    before = cpu(pids)
    time.sleep(IDLE_S)
    idle = {f"{name}_ms": round((seconds - before[name]) * 1000 / IDLE_S, 1) for name, seconds in cpu(pids).items()}
    yield figure("no run, 35 states a second", sum(idle.values()), "ms of processor time a second", **idle)
    for runs, steps in ((1, ONE_RUN_STEPS), (MANY_RUNS, MANY_STEPS)):
        who = "one run" if runs == 1 else f"{runs} runs of one site"
        devices.forget()
        ours = watch(devices, pids, [start(machine, steps) for machine in machines()[:runs]], runs * steps)
        yield from told(who, ours)
        for peer in (LOOP, NODE_RED):
            theirs = measure_peer(pids, peer, runs, steps)
            if "missing" in theirs:
                yield {"what": f"{who}, {peer}", "skipped": theirs["missing"]}
                continue
            yield from told(f"{who}, {peer}", theirs)
            p50 = share(ours["delays"], 0.5) / share(theirs["delays"], 0.5)
            yield figure(f"{who}, done to next command, p50 by that of {peer}", p50, "times")
    devices.close()


def measure_stops(pids: Mapping[str, int]) -> Iterator[dict[str, object]]:
    """Yield how soon a hundred devices hear a stop, and check that no command goes out behind it."""
    services.open_publisher(mqtt=settings.VIPO_MQTT)
    devices, ears = Devices(), Ears(SITE, EARS)
    time.sleep(2)
    yield from _told_of_stops("quiet", [_press(ears, devices) for _ in range(PRESSES)])
    found = []
    for _ in range(PRESSES_BESIDE):
        runs = [start(machine, 1000) for machine in machines()[:BESIDE]]
        seen = devices.done
        while devices.done < seen + 2 * BESIDE:
            time.sleep(0.02)
        found.append(_press(ears, devices))
        for run in runs:
            services.cancel_run(run_id=run, by="Bench")
        while Run.objects.filter(id__in=runs, status__in=Run.OPEN).exists():
            time.sleep(0.1)
    yield from _told_of_stops(f"beside {BESIDE} runs", found)
    os.kill(pids["gateway"], signal.SIGSTOP)  # it holds its connection, so that nobody takes its place
    yield from _told_of_stops("the only gateway frozen", [_press(ears, devices) for _ in range(PRESSES)])
    os.kill(pids["gateway"], signal.SIGCONT)
    services.close_publisher()
    ears.close()
    devices.close()


def _press(ears: Ears, devices: Devices) -> list[float]:
    """Press a stop and reset it; return after how many ms each device has heard it."""
    began = time.perf_counter()
    stop = services.press_stop(site=SITE, by="Bench")
    heard = ears.wait(stop.fence)
    time.sleep(CLAIM_HOLDS_S)  # what was claimed before may be on its way so long; devices refuse it by its fence
    done = devices.done
    time.sleep(0.4)
    if devices.done != done:
        raise RuntimeError("A command has gone out behind a stop.")
    ears.wait(services.reset_stop(site=SITE, by="Bench").fence)
    return [(at - began) * 1000 for at in heard]


def _told_of_stops(how: str, presses: list[list[float]]) -> Iterator[dict[str, object]]:
    """Yield figures over all devices and presses, and over the last device of each press."""
    every = [ms for press in presses for ms in press]
    facts = {"presses": len(presses), "devices": EARS, "worst_ms": round(max(every), 1)}
    for name, part in (("p50", 0.5), ("p99", 0.99)):
        yield figure(f"stop to {EARS} devices, {how}, {name}", share(every, part), "ms", **facts)


def measure(pids: Mapping[str, int]) -> Iterator[dict[str, object]]:
    yield from measure_runs(pids)
    yield from measure_stops(pids)


def main() -> None:
    if sys.argv[1] == "fill":
        fill_hall(DEVICES, ROBOTS)
        return
    for line in measure(json.loads(sys.argv[2])):
        print(json.dumps(line), flush=True)


if __name__ == "__main__":
    main()
