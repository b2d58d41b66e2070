"""The record of what was done at a site, over HTTP: for its admins, in parts, or as a table."""

from __future__ import annotations

from dataclasses import asdict
from datetime import datetime
from typing import Any, Literal

from django.conf import settings
from django.http import HttpRequest, HttpResponse, StreamingHttpResponse
from ninja import Query, Router, Schema

from registry.audit import queries
from registry.audit.codes import Kind
from registry.people.access import require
from registry.people.open_sessions import name_browser
from registry.requests import Asked, PartAsked, as_file, one_by_one, sends, signed_in, tell_rest

router = Router(tags=["registry"])


class AuditShape(Schema):
    """One thing that was done: what (`code` of a `kind`, with the `facts` of its sentence), by whom, and from where.

    `actor` is the name of a person or token or the id of a device; VIPO itself has none. `address`, `browser` and
    `system` are empty where nobody asked over HTTP, or they are not known.
    """

    id: int
    at: datetime
    kind: Kind
    code: str
    actor_kind: Literal["person", "token", "device", "vipo"]
    actor: str
    address: str
    browser: str
    system: str
    facts: dict[str, Any]


class AuditOfKind(Asked):
    """Which kind of deeds is asked for; all of them if none is named."""

    kind: Kind | None = None


class AuditAsked(AuditOfKind, PartAsked):
    """Which part of the record is asked for."""


@router.get("/sites/{slug}/audit", response=list[AuditShape])
def list_audit(
    request: HttpRequest, response: HttpResponse, slug: str, asked: Query[AuditAsked]
) -> list[dict[str, Any]]:
    """List what was done at a site, the newest first; the header `Link` names the next part.

    `X-Total-Count` says how many there are of the kind, `X-Kept-Days` for how long they are kept.
    """
    require(signed_in(request), slug, "admin")
    response["X-Total-Count"] = str(queries.count_audit(site=slug, kind=asked.kind))
    response["X-Kept-Days"] = str(settings.VIPO_AUDIT_DAYS)
    listed = queries.list_audit(site=slug, kind=asked.kind, page=asked.page())
    return [_to_json(view) for view in tell_rest(request, response, listed)]


@router.get("/sites/{slug}/audit.csv", openapi_extra=sends("text/csv"))
def export_audit(request: HttpRequest, slug: str, asked: Query[AuditOfKind]) -> StreamingHttpResponse:
    """Give the record as a table (CSV), the newest first."""
    require(signed_in(request), slug, "admin")
    parts = one_by_one(request, queries.write_table(site=slug, kind=asked.kind))
    return StreamingHttpResponse(parts, content_type="text/csv; charset=utf-8", headers=as_file(f"{slug}-audit.csv"))


def _to_json(view: queries.AuditView) -> dict[str, Any]:
    browser, system = name_browser(view.agent)
    return {**asdict(view), "browser": browser, "system": system}
