"""Rehearsals as rows: queued by a person, carried out by a worker in a child process, watched in the browser."""

from __future__ import annotations

import json
import subprocess
import sys
from collections.abc import Iterator, Mapping
from datetime import UTC, datetime, timedelta
from pathlib import Path
from typing import Any
from uuid import UUID

from django.db import transaction

from execution import mailbox
from execution.errors import NotFound
from execution.floor.layouts import place_facts
from execution.models import Rehearsal
from execution.rehearsals.child_process import scene_to_json
from execution.runs.programs import Prepared
from execution.views import RehearsalView, view_rehearsal
from registry import services as registry
from simulation.world import Scene

ROOT = Path(__file__).resolve().parents[2]
LOST_AFTER = timedelta(seconds=5)
DEAD_AFTER = timedelta(seconds=60)
DIED = "The process that rehearsed it has died. Start it again."


def start_rehearsal(*, prepared: Prepared, by: str, seed: int = 0, driver: str = "physics") -> RehearsalView:
    """Queue a rehearsal of a program that was checked, in the site as it stands now."""
    job = {"plan": prepared.plan, "scene": _scene(prepared.site, seed), "driver": driver,
           "parameters": dict(prepared.parameters)}  # fmt: skip
    row = Rehearsal.objects.create(
        site_id=registry.get_site_id(site=prepared.site),
        program=prepared.program,
        job=job,
        document=prepared.document,
        compiled=prepared.compiled,
        started_by=by,
        created_at=datetime.now(UTC),
    )
    transaction.on_commit(lambda: mailbox.send_hint(mailbox.REHEARSE, str(row.id)))
    return view_rehearsal(row)


def _scene(site: str, seed: int) -> dict[str, Any]:
    """Return the site as it stands: its approved devices where they are, with what they hold."""
    devices = registry.list_devices(site=site, lifecycle="approved")
    places = [place_facts(place) for place in registry.list_places(site=site)]
    robots = {d.id: d for d in devices if d.kind == "robot"}
    scene = Scene(
        grid=registry.get_map(site=site).grid,
        devices=[d.canonical for d in devices],
        seed=seed,
        poses={name: robot.pose for name, robot in robots.items()},
        carrying={name: robot.carrying for name, robot in robots.items()},
        readings={d.id: {"battery": d.readings["battery"]} for d in robots.values() if "battery" in d.readings},
    )
    return scene_to_json(scene, places)


def get_rehearsal(*, rehearsal_id: UUID | str) -> RehearsalView:
    """Return a rehearsal.

    Raises:
        NotFound: there is none.
    """
    row = Rehearsal.objects.select_related("site").defer("job").filter(id=rehearsal_id).first()
    if row is None:
        raise NotFound("There is no such rehearsal. It may have been deleted with its program.")
    return view_rehearsal(row)


def carry_out(rehearsal_id: str) -> bool:
    """Run a queued rehearsal's child process to its end; False when it is not queued any more."""
    now = datetime.now(UTC)
    queued = Rehearsal.objects.filter(id=rehearsal_id, status=Rehearsal.Status.QUEUED)
    if not queued.update(status=Rehearsal.Status.RUNNING, beat_at=now):
        return False
    row = Rehearsal.objects.select_related("site").get(id=rehearsal_id)
    _publish(row)
    try:
        for line in _run_child(row.job):
            _take_line(row, line)
    finally:
        if row.status == Rehearsal.Status.RUNNING:
            _end(row, "failed", reason=DIED)
    return True


def sweep_rehearsals(now: datetime) -> None:
    """Find rehearsals whose hint was lost, and those whose worker has died."""
    queued = Rehearsal.objects.filter(status=Rehearsal.Status.QUEUED, created_at__lt=now - LOST_AFTER)
    for rehearsal in queued.values_list("id", flat=True):
        mailbox.send_hint(mailbox.REHEARSE, str(rehearsal))
    dead = Rehearsal.objects.filter(status=Rehearsal.Status.RUNNING, beat_at__lt=now - DEAD_AFTER)
    for row in dead.select_related("site"):
        still_dead = Rehearsal.objects.filter(id=row.id, status=Rehearsal.Status.RUNNING)
        still_dead.update(status=Rehearsal.Status.FAILED, reason=DIED)
        row.status = Rehearsal.Status.FAILED
        _publish(row)


def _run_child(job: Mapping[str, Any]) -> Iterator[dict[str, Any]]:
    command = [sys.executable, "-m", "execution.rehearsals.child_process"]
    with subprocess.Popen(  # noqa: S603 - our own module, with our own interpreter
        command, stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True, cwd=ROOT
    ) as child:
        assert child.stdin is not None
        assert child.stdout is not None
        child.stdin.write(json.dumps(job))
        child.stdin.close()
        for line in child.stdout:
            if line.startswith("{"):
                yield json.loads(line)


def _take_line(row: Rehearsal, line: Mapping[str, Any]) -> None:
    if "progress" in line:
        row.progress, row.beat_at = line["progress"], datetime.now(UTC)
        row.save(update_fields=["progress", "beat_at"])
        _publish(row)
    elif "result" in line:
        row.progress, row.result = 1.0, line["result"]
        _end(row, "done")
    else:
        _end(row, "failed", reason=str(line.get("error", ""))[:500])


def _end(row: Rehearsal, status: str, reason: str = "") -> None:
    row.status, row.reason = status, reason
    row.save(update_fields=["status", "reason", "progress", "result"])
    _publish(row)


def _publish(row: Rehearsal) -> None:
    message = {"type": "rehearsal", "id": str(row.id), "status": row.status, "progress": row.progress}
    registry.publish(row.site.slug, message)
