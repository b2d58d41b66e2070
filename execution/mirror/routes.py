"""Measured paces over HTTP: read by whoever may look, taken over and given up by operators."""

from __future__ import annotations

from typing import Any

from django.http import HttpRequest
from ninja import Router

from execution.mirror import calibrations
from execution.mirror.calibrations import method_pace_to_json
from execution.mirror.shapes import MethodPaceShape
from registry.requests import refuses, signed_in
from registry.services import require

router = Router(tags=["execution"])
PACE = "/sites/{slug:site}/devices/{device_id}/paces/{method}"


@router.get("/sites/{slug:site}/devices/{device_id}/paces", response=list[MethodPaceShape])
def list_paces(request: HttpRequest, site: str, device_id: str) -> list[dict[str, Any]]:
    """Return what was measured of each method of a device, beside what its copy took."""
    require(request.user, site, "viewer", "read")
    return [method_pace_to_json(found) for found in calibrations.list_paces(site=site, device_id=device_id)]


@router.put(PACE, response=MethodPaceShape, openapi_extra=refuses(409))
def take_pace(request: HttpRequest, site: str, device_id: str, method: str) -> dict[str, Any]:
    """Let rehearsals and tests take as long for a method as was measured: the median of the newest 30."""
    require(request.user, site, "operator", "run")
    found = calibrations.take_pace(site=site, device_id=device_id, method=method, by=signed_in(request))
    return method_pace_to_json(found)


@router.delete(PACE, response=MethodPaceShape)
def drop_pace(request: HttpRequest, site: str, device_id: str, method: str) -> dict[str, Any]:
    """Let rehearsals and tests take as long for a method as its description says."""
    require(request.user, site, "operator", "run")
    return method_pace_to_json(calibrations.drop_pace(site=site, device_id=device_id, method=method))
