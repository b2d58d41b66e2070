"""A hall with as many devices as wanted, one run in it, and a count of what its steps ask of the database."""

from __future__ import annotations

import re
import time
from collections.abc import Callable, Iterator, Mapping
from contextlib import contextmanager, nullcontext
from dataclasses import dataclass
from datetime import UTC, datetime
from typing import Any
from uuid import UUID, uuid4

from django.db import connection

from editor.language import plan_to_json
from editor.language.expressions.nodes import Constant, Operation, PlaceRef, Reading
from editor.language.plan.instructions import Call, End, Instruction, Plan, WaitUntil
from execution import database, services
from execution.engine.drive import advance_site
from execution.models import Command
from registry import services as registry
from registry.floorplan.plan import Grid
from registry.models import Device, Site
from vipo_device.descriptions.reader import hash_of_json
from vipo_device.protocol.description import (
    Description,
    MethodSpec,
    ParameterSpec,
    Pose,
    PropertySpec,
    Size,
    description_to_json,
)

SITE = "hall"
OVEN = "machine000"
ROBOTS = 2
CELLS, CELL_M, APART_M = 440, 0.1, 2.4
HOT = Operation(">", (Reading(Constant(OVEN), "temperature"), Constant(50)))
PLAN = Plan(
    (
        Instruction(Call(PlaceRef(device=OVEN), "heat", {"value": Constant(1)}), "heat"),
        Instruction(WaitUntil(HOT, None), "wait"),
        Instruction(End()),
    ),
    reads=((OVEN, "temperature"),),
)


@dataclass
class Count:
    """What was asked of the database: statements, and rows of devices that came back."""

    statements: int = 0
    device_rows: int = 0
    cpu_ms: float = 0.0


def fill_hall(count: int, robots: int = ROBOTS) -> None:
    """Make the hall, with this many approved devices that are there; so many of them are robots."""
    registry.create_site(name="Hall", slug=SITE)
    registry.save_map(site=SITE, grid=Grid(CELLS, CELLS, CELL_M, 0.0, 0.0, bytes(CELLS * CELLS)))
    site = Site.objects.get(slug=SITE)
    Device.objects.bulk_create(approved_row(_describe(number, robots), site) for number in range(count))


def _describe(number: int, robots: int) -> Description:
    robot = 1 <= number <= robots
    name = f"robot{number:03d}" if robot else f"machine{number:03d}"
    row, column = divmod(number, int(CELLS * CELL_M / APART_M))
    methods = ("move", "pick", "drop") if robot else ("heat", "dispense", "accept")
    return Description(
        name, f"Device {number}", "robot" if robot else "machine", "turtlebot" if robot else "oven",
        Pose((column + 0.5) * APART_M, (row + 0.5) * APART_M), Size(0.4, 0.4, 0.4),
        site=SITE, radius_m=0.18 if robot else 0.0, speed_m_s=0.5 if robot else 0.0,
        properties=tuple(PropertySpec(p, "number", "DEG_C", -20, 120) for p in ("temperature", "pressure", "load")),
        methods=tuple(
            MethodSpec(m, f"vipo/v1/dev/{name}/down/{m}", parameters=(ParameterSpec("value", "number"),))
            for m in methods
        ),
    )  # fmt: skip


def approved_row(said: Description, site: Site) -> Device:
    """Return a device that is approved and there, as its description says it."""
    whole = description_to_json(said)
    now = datetime.now(UTC)
    return Device(
        id=said.id, site=site, lifecycle="approved", description=whole, description_hash=hash_of_json(whole),
        online=True, properties={"temperature": 20, "pressure": 1, "load": 0}, last_seen_at=now,
    )  # fmt: skip


def carry_out_run(*, counting: bool = True) -> Mapping[str, Count]:
    """Carry a run out and return what each of its steps took; counting takes processor time itself."""
    _say(20)
    prepared = services.Prepared(uuid4(), SITE, "Heating", 1, {}, {}, plan_to_json(PLAN), {})
    run = services.start_run(prepared=prepared, by="Ada").id
    found = {"a run begins and its command goes out": _measure(counting, lambda: advance_site(SITE))}
    _answer(run)
    found["floor and run hear the answer"] = _measure(counting, lambda: advance_site(SITE, look=False))
    found["there is nothing to do"] = _measure(counting, lambda: advance_site(SITE))
    _say(90)
    found["a reading ends the run"] = _measure(counting, lambda: advance_site(SITE))
    if services.get_run(run_id=run).run.status != "finished":
        raise RuntimeError("The run did not end.")
    advance_site(SITE)
    return found


def _say(temperature: int) -> None:
    said = {"temperature": temperature, "pressure": 1, "load": 0}
    Device.objects.filter(id=OVEN).update(properties=said, last_seen_at=datetime.now(UTC))


def _answer(run: UUID) -> None:
    """Let the machine answer that it is done, and say its state after it."""
    command = Command.objects.get(run=run)
    services.mark_sent(sent={str(command.id): database.now()})
    at = datetime.now(UTC)
    services.record_ack(device=OVEN, command_id=str(command.id), status="DONE", why="", result={}, at=at)
    _say(21)


def _measure(counting: bool, work: Callable[[], object]) -> Count:
    count = Count()
    with connection.execute_wrapper(_Counter(count)) if counting else nullcontext():
        began = time.process_time()
        work()
        count.cpu_ms = (time.process_time() - began) * 1000
    return count


class _Counter:
    """Counts statements; how many devices' rows one reads is asked beside it."""

    def __init__(self, count: Count) -> None:
        self._count = count
        self._asking = False

    def __call__(self, execute: Callable[..., Any], sql: str, params: Any, many: bool, context: Any) -> Any:
        if not self._asking and not re.match(r"SAVEPOINT|RELEASE|BEGIN", sql):
            self._count.statements += 1
            if re.match(r'SELECT (?!.*FOR UPDATE).* FROM "registry_device"', sql):
                with self._ask(), connection.cursor() as cursor:
                    cursor.execute(f"SELECT count(*) FROM ({sql}) AS rows_read", params)
                    self._count.device_rows += cursor.fetchone()[0]
        return execute(sql, params, many, context)

    @contextmanager
    def _ask(self) -> Iterator[None]:
        self._asking = True
        yield
        self._asking = False
