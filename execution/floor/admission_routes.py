"""Robots that wait before a zone into which people let them, over HTTP."""

from __future__ import annotations

from dataclasses import asdict
from typing import Any

from django.http import HttpRequest
from ninja import Router

from execution.floor import admissions
from execution.shapes import AwaitedAdmission, LetRobotIn
from registry.requests import refuses, signed_in
from registry.services import require

router = Router(tags=["execution"])


@router.get("/sites/{slug:site}/admissions", response=list[AwaitedAdmission])
def list_awaited_admissions(request: HttpRequest, site: str) -> list[dict[str, Any]]:
    """Return which robots wait to be let into which zone of a site."""
    require(signed_in(request), site, "viewer")
    return [asdict(each) for each in admissions.list_awaited(site=site)]


@router.post("/sites/{slug:site}/zones/{zone_id}/admissions", response={204: None}, openapi_extra=refuses(409))
def let_robot_in(request: HttpRequest, site: str, zone_id: str, body: LetRobotIn) -> None:
    """Let a robot that waits before a zone into it, for one visit; it waits anew before the next."""
    require(signed_in(request), site, "operator", "run")
    admissions.let_in(site=site, zone_id=zone_id, robot_id=body.robot)
