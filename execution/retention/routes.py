"""For admins over HTTP: how long their site keeps what has ended, what takes how many bytes, and what was archived."""

from __future__ import annotations

from typing import Any

from django.http import HttpRequest
from ninja import Router

from execution.models import Archive
from execution.retention.periods import KINDS, default_days, get_keeping, set_keeping
from execution.retention.shapes import RetentionShape, SetKeeping
from execution.retention.usage import list_archives, read_usage
from registry.services import require

router = Router(tags=["execution"])


@router.get("/sites/{slug:site}/retention", response=RetentionShape)
def show_retention(request: HttpRequest, site: str) -> dict[str, Any]:
    """Return the site's times of keeping, how many bytes its histories take by program, and its archive."""
    require(request.user, site, "admin")
    return _retention(site)


@router.put("/sites/{slug:site}/retention", response=RetentionShape)
def set_retention(request: HttpRequest, site: str, body: SetKeeping) -> dict[str, Any]:
    """Choose for how many days the site keeps each kind; what is older then is archived within the next minutes."""
    require(request.user, site, "admin")
    set_keeping(site=site, chosen=body.model_dump(exclude_unset=True))
    return _retention(site)


def _retention(site: str) -> dict[str, Any]:
    keeping, server, usage = get_keeping(site=site), default_days(), read_usage(site=site)
    archives, count, size = list_archives(site=site)
    names = ("name", "runs", "journals", "commands", "rehearsals", "archived")
    return {
        "keeping": [
            {"kind": kind, "days": keeping.days[kind], "chosen": keeping.chosen[kind], "server": server[kind]}
            for kind in KINDS
        ],
        "trouble": keeping.trouble,
        "trouble_at": keeping.trouble_at.isoformat() if keeping.trouble_at else None,
        "programs": [
            {"program": str(key), **{name: getattr(each, name) for name in names}} for key, each in usage.programs
        ],
        "calls": usage.calls,
        "calls_archived": usage.calls_archived,
        "archives": [_archive_to_json(archive) for archive in archives],
        "archive_count": count,
        "archive_bytes": size,
    }


def _archive_to_json(archive: Archive) -> dict[str, Any]:
    times = {name: getattr(archive, name).isoformat() for name in ("first_at", "last_at", "made_at")}
    told = {name: getattr(archive, name) for name in ("kind", "file", "count", "bytes")}
    return {"id": str(archive.pk), **told, **times}
