"""For operators over HTTP: what waits at a site, what is wrong with VIPO's processes, and for admins all of them."""

from __future__ import annotations

from datetime import datetime
from typing import Any

from django.http import HttpRequest
from ninja import Router

from execution.operations import overview
from execution.operations.findings import find_trouble_at
from execution.operations.shapes import FindingShape, OperationsShape, ProcessesShape
from registry import services as registry
from registry.services import require

router = Router(tags=["execution"])


@router.get("/sites/{slug:site}/operations", response=OperationsShape)
def show_operations(request: HttpRequest, site: str) -> dict[str, Any]:
    """Return what waits at a site, and which commands are overdue."""
    access = require(request.user, site, "operator")
    now = registry.read_time()
    found = overview.read_overview(site=site, now=now)
    count, overdue = overview.list_overdue(site=site, now=now)
    return {
        "queues": [_queue_to_json(queue, now) for queue in found.queues],
        "runs": found.runs,
        "overdue_count": count,
        "overdue": [_overdue_to_json(each, now) for each in overdue],
        "open_alerts": registry.count_open_alerts(site=site, role=access.role),
    }


@router.get("/sites/{slug:site}/findings", response=list[FindingShape])
def list_findings(request: HttpRequest, site: str) -> list[dict[str, Any]]:
    """Return what is wrong now: what stops work, for admins also which process it is and what waits for them."""
    access = require(request.user, site, "operator")
    found = find_trouble_at(site=site)
    told = [finding for finding in found if access.allows("admin") or not finding.args]
    return [{"code": each.code, "severity": each.severity, "text": each.text, "args": dict(each.args)} for each in told]


@router.get("/sites/{slug:site}/processes", response=ProcessesShape)
def list_processes(request: HttpRequest, site: str) -> dict[str, Any]:
    """Return VIPO's processes as they beat, and what waits at all sites; for admins, who see other sites' numbers."""
    require(request.user, site, "admin")
    now = registry.read_time()
    queues = [_queue_to_json(queue, now) for queue in overview.read_overview(now=now).queues]
    tasks = [
        {"name": f"tasks:{name}", "waiting": length, "oldest_s": None}
        for name, length in overview.read_task_queues().items()
    ]
    return {
        "processes": [_process_to_json(process) for process in registry.list_processes()],
        "leases": [_lease_to_json(lease, now) for lease in overview.list_leases()],
        "queues": queues + tasks,
    }


def _queue_to_json(queue: overview.QueueView, now: datetime) -> dict[str, Any]:
    oldest_s = None if queue.oldest_at is None else _seconds(queue.oldest_at, now)
    return {"name": queue.name, "waiting": queue.waiting, "oldest_s": oldest_s}


def _overdue_to_json(command: overview.OverdueView, now: datetime) -> dict[str, Any]:
    return {
        "id": command.id,
        "device": command.device,
        "method": command.method,
        "status": command.status,
        "tries": command.tries,
        "run": command.run,
        "number": command.number,
        "waits_s": _seconds(command.created_at, now),
    }


def _process_to_json(process: registry.ProcessView) -> dict[str, Any]:
    names = ("id", "kind", "name", "machine", "process", "version", "activity", "state", "clock_apart_s")
    told = {name: getattr(process, name) for name in names}
    return told | {"since": process.since.isoformat(), "age_s": round(process.age_s, 1)}


def _lease_to_json(lease: overview.LeaseView, now: datetime) -> dict[str, Any]:
    return {"job": lease.job, "holder": lease.holder, "held_s": round((lease.until - now).total_seconds(), 1)}


def _seconds(since: datetime, now: datetime) -> float:
    return round(max(0.0, (now - since).total_seconds()), 1)
