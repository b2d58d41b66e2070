"""What an owner knows of its site, read once and true as long as the epoch of its lease is."""

from __future__ import annotations

import json
import logging
import time
from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field
from datetime import datetime
from hashlib import sha256
from typing import Any
from uuid import UUID
from weakref import WeakValueDictionary

from django.db.models import QuerySet

from editor.language import plan_from_json
from editor.language.plan.instructions import Plan
from execution.engine.inbox import MOST_AT_ONCE
from execution.floor.fold import FloorWork
from execution.floor.layouts import look_at_site, places_from_json
from execution.machine import machine
from execution.machine.at_once import EndsAtOnce
from execution.machine.floor_task import TaskOrder
from execution.machine.needs import Needs, needs_of
from execution.models import FloorState, Run
from execution.runs.fold import RunWork
from execution.traffic import floor
from execution.traffic.kept_places import keep_places
from execution.traffic.layout import Layout
from registry import services as registry

log = logging.getLogger(__name__)
FRESH_S = 0.5
"""What the registry says of a site holds for so long, unless something says that it is another."""
NAMES_KEPT_S = 10.0


@dataclass(frozen=True)
class _Known:
    """A plan, which never changes, with what it needs to know."""

    plan: Plan
    needs: Needs


_plans: WeakValueDictionary[str, _Known] = WeakValueDictionary()
"""Runs of the same program in the same version share their plan."""


@dataclass
class SiteMemory:
    """A site in memory: its open runs, its floor, its layout. `broken` says of runs why they cannot be read.

    `floor` is None where the floor's state cannot be read; `floor_error` says why. `simulated` are the devices whose
    stand-ins are told. `wakes_at` (monotonic seconds) is when something is to be looked at again that was held back.
    `has_more` says that the last turn has left something. `resting` says by run and number of the task until when an
    end is not told that came at once too often (`at_once`).
    """

    slug: str
    site: Any
    epoch: int
    floor: FloorWork | None
    floor_row: FloorState
    floor_error: str = ""
    simulated: frozenset[str] = frozenset()
    runs: dict[str, RunWork] = field(default_factory=dict)
    broken: dict[str, tuple[Run, str]] = field(default_factory=dict)
    last_number: int = 0
    most_at_once: int = MOST_AT_ONCE
    wakes_at: float | None = None
    has_more: bool = False
    floor_written_at: float = 0.0
    at_once: EndsAtOnce = field(default_factory=EndsAtOnce)
    resting: dict[str, dict[int, datetime]] = field(default_factory=dict)
    _plans: dict[str, _Known] = field(default_factory=dict)
    _layout: Layout | None = None
    _kept: tuple[Layout, dict[str, Any], Layout] | None = None
    _looked_at: float = float("-inf")
    _names: dict[str, str | None] = field(default_factory=dict)
    _named_at: float = 0.0

    @property
    def is_watching(self) -> bool:
        """Tell whether news of devices may move something: the floor is active, or a run waits for a reading."""
        return (self.floor is not None and self.floor.is_active) or any(run.row.watches for run in self.runs.values())

    @property
    def is_stale(self) -> bool:
        """Tell whether what the registry said is too old to decide by."""
        return self._layout is None or time.monotonic() - self._looked_at >= FRESH_S

    def look(self) -> tuple[Layout, tuple[registry.PositionView, ...]]:
        """Return the layout and where the devices are as they are now; raises NoMap."""
        layout, devices = look_at_site(self.slug)
        if layout is not self._layout:
            self._names.clear()
        self._layout, self._looked_at = layout, time.monotonic()
        return layout, devices

    @property
    def layout(self) -> Layout:
        """The layout as it was when somebody looked last."""
        assert self._layout is not None
        return self._layout

    def layout_for(self, runs: Mapping[str, RunWork]) -> Layout:
        """Return the layout with the places of open runs as these began with them; `runs` are new in this turn."""
        rows = {key: row for key, (row, _) in self.broken.items()}
        rows |= {key: work.row for key, work in {**self.runs, **runs}.items()}
        began_with = {key: row.places for key, row in rows.items() if row.places}
        if self._kept is None or self._kept[0] is not self.layout or self._kept[1] != began_with:
            known = {key: places_from_json(places) for key, places in began_with.items()}
            self._kept = (self.layout, began_with, keep_places(self.layout, known))
        return self._kept[2]

    @property
    def has_layout(self) -> bool:
        """Tell whether somebody has looked at the site yet, as its floor does and runs alone do not."""
        return self._layout is not None

    def names_of(self, ids: Iterable[str]) -> dict[str, str]:
        """Return what devices are called, by id; what is no device's id is left out."""
        if time.monotonic() - self._named_at > NAMES_KEPT_S:
            self._names.clear()
            self._named_at = time.monotonic()
        wanted = set(ids)
        if unknown := [each for each in wanted if each not in self._names and not self._is_in_layout(each)]:
            found = registry.get_device_names(site=self.slug, ids=unknown)
            self._names |= {each: found.get(each) for each in unknown}
        return {each: name for each in wanted if (name := self._name(each)) is not None}

    def _is_in_layout(self, device: str) -> bool:
        return self._layout is not None and device in self._layout.devices

    def _name(self, device: str) -> str | None:
        if self._layout is not None and device in self._layout.devices:
            return self._layout.devices[device].name
        return self._names.get(device)

    def order_of(self, run: RunWork, task: int) -> TaskOrder | None:
        """Return what a run has asked the floor for under a number, while the floor has it or the run remembers."""
        if task in run.orders:
            return run.orders[task]
        tasks = self.floor.state.tasks if self.floor else ()
        return next((each.order for each in tasks if (each.run, each.number) == (run.id, task)), None)

    def add_runs(self, ids: Iterable[UUID] | None = None) -> list[str]:
        """Read open runs, all of the site or those that were started since; return the ids of those that were new."""
        rows = Run.objects.filter(site=self.site, status__in=Run.OPEN).defer("document", "compiled").order_by("number")
        return self._read(rows if ids is None else rows.filter(id__in=list(ids)))

    def add_started(self, started: Mapping[UUID, int]) -> None:
        """Read runs, with their numbers, that were started since the last look."""
        if started:
            self.add_runs(started)
            self.last_number = max(self.last_number, *started.values())

    def forget_run(self, run: str) -> None:
        """Forget a run, such as one that is over."""
        self.runs.pop(run, None)
        self.broken.pop(run, None)
        self._plans.pop(run, None)
        self.resting.pop(run, None)
        self.at_once.forget(run)

    def mend_run(self, run: str) -> bool:
        """Read a run anew that could not be read; tell whether that worked."""
        self.broken.pop(run, None)
        self.add_runs([UUID(run)])
        return run in self.runs

    def _read(self, rows: QuerySet[Run]) -> list[str]:
        new = []
        for row in rows:
            key = str(row.id)
            self.last_number = max(self.last_number, row.number)
            if key in self.runs or key in self.broken:
                continue
            row.site = self.site
            new.append(key)
            try:
                self.runs[key] = self._work(key, row)
            except Exception as error:  # a plan or a state that cannot be read stops its own run only
                log.exception("Run %s cannot be read.", key)
                self.broken[key] = (row, f"{type(error).__name__}: {error}")
            for name in ("plan", "state"):
                row.__dict__.pop(name, None)
        return new

    def _work(self, key: str, row: Run) -> RunWork:
        digest = sha256(json.dumps(row.plan, sort_keys=True).encode()).hexdigest()
        known = _plans.get(digest)
        if known is None:
            plan = plan_from_json(row.plan)
            known = _plans.setdefault(digest, _Known(plan, needs_of(plan)))
        self._plans[key] = known
        return RunWork(row, known.plan, known.needs, machine.from_json(row.state) if row.state is not None else None)

    def read_floor(self) -> None:
        """Read the floor's row; one that cannot be read is none, and `floor_error` says why."""
        row = FloorState.objects.select_related("site").get(site=self.site)
        self.floor_row, self.floor_error = row, ""
        # After the row: a device is switched together with its epoch, so what is older than that is not written.
        self.simulated = registry.list_simulated_ids(site_id=row.site_id)
        try:
            state = floor.from_json(row.state) if row.state else floor.start(self.look()[0], str(row.namespace))
            self.floor = FloorWork(self.slug, state)
        except registry.NoMap:
            self.floor = None
        except Exception as error:  # the floor's own edge: runs that need no floor go on
            log.exception("The floor of %s cannot be read.", self.slug)
            self.floor, self.floor_error = None, f"{type(error).__name__}: {error}"
        row.__dict__.pop("state", None)


def read_site(slug: str, epoch: int) -> SiteMemory:
    """Read a site's floor and its open runs; raises the registry's NotAMember."""
    site_id = registry.get_site_id(site=slug)
    FloorState.objects.get_or_create(site_id=site_id)
    row = FloorState.objects.select_related("site").defer("state").get(site_id=site_id)
    memory = SiteMemory(slug, row.site, epoch, None, row)
    memory.read_floor()
    last = Run.objects.filter(site_id=site_id).order_by("-number").values_list("number", flat=True).first()
    memory.add_runs()
    # What was started between the two reads has been read, or has a higher number and is read as new.
    memory.last_number = last or 0
    return memory
