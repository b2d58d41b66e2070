"""Starts the runs of a game as a web process does; arguments: the game as JSON, and `fill` to make tables and sites.

It starts as many as the standard input has named last, at most `MOST_OPEN` at once, and none twice, also after it was
killed.
"""

from __future__ import annotations

import json
import sys
import threading
import time
from datetime import UTC, datetime

import django

django.setup()

from django.core.management import call_command  # noqa: E402
from django.db import DatabaseError, InterfaceError, connection  # noqa: E402

from editor.language import plan_to_json  # noqa: E402
from editor.language.expressions.nodes import Constant, PlaceRef  # noqa: E402
from editor.language.plan.instructions import Call, End, Instruction, Plan  # noqa: E402
from execution import services  # noqa: E402
from execution.models import Run  # noqa: E402
from registry import services as registry  # noqa: E402
from registry.floorplan.plan import Grid  # noqa: E402
from registry.models import Device, Site  # noqa: E402
from tests.integration.breaking.chaos.hall import PASSWORD, Game, describe  # noqa: E402
from vipo_device.descriptions.reader import hash_of_json  # noqa: E402
from vipo_device.protocol.credentials import broker_hash, secret_hash  # noqa: E402
from vipo_device.protocol.description import description_to_json  # noqa: E402

MOST_OPEN = 60


def fill(game: Game) -> None:
    call_command("migrate", verbosity=0, skip_checks=True)
    for slug in game.slugs:
        registry.create_site(name=slug, slug=slug)
        registry.save_map(site=slug, grid=Grid(120, 60, 0.1, 0.0, 0.0, bytes(120 * 60)))
        for name in game.devices(slug):
            whole = description_to_json(describe(name))
            Device.objects.create(
                id=name, site=Site.objects.get(slug=slug), lifecycle="approved", description=whole,
                credential_hash=secret_hash(PASSWORD), broker_hash=broker_hash(PASSWORD),
                description_hash=hash_of_json(whole), properties={"temperature": 20}, last_seen_at=datetime.now(UTC),
            )  # fmt: skip


def plan_of(game: Game, run: int) -> Plan:
    steps = enumerate(game.steps_of(run))
    calls = (Call(PlaceRef(device=device), "heat", {"value": Constant(value)}) for _, (device, value) in steps)
    return Plan((*(Instruction(call, f"s{number}", number) for number, call in enumerate(calls)), Instruction(End())))


class Load:
    """The runs so far."""

    def __init__(self, game: Game) -> None:
        self._game = game
        self._wanted = 0
        self._started = 0
        self._is_sure = False
        threading.Thread(target=self._read, daemon=True).start()

    def _read(self) -> None:
        for line in sys.stdin:
            self._wanted = int(line)

    def run(self) -> None:
        while self._started < self._game.runs:
            try:
                if self._started >= self._wanted or Run.objects.filter(status__in=Run.OPEN).count() >= MOST_OPEN:
                    time.sleep(0.05)
                else:
                    self._start(self._started)
            except (DatabaseError, InterfaceError, services.NotPossibleNow):
                connection.close()
                self._is_sure = False
                time.sleep(0.2)

    def _start(self, run: int) -> None:
        program = self._game.program_of(run)
        if not self._is_sure and Run.objects.filter(program=program).exists():  # it was written, and nobody was told
            self._started += 1
            return
        self._is_sure = True
        plan = plan_to_json(plan_of(self._game, run))
        prepared = services.Prepared(program, self._game.site_of(run), f"Run {run}", 1, {}, {}, plan, {})
        services.start_run(prepared=prepared, by="Chaos")
        self._started += 1


if __name__ == "__main__":
    told = Game(**json.loads(sys.argv[1]))
    if sys.argv[2:] == ["fill"]:
        fill(told)
    else:
        Load(told).run()
