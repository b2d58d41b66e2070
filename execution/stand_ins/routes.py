"""Stand-ins over HTTP: operators let one speak for a device, and the device itself again."""

from __future__ import annotations

from typing import Any

from django.http import HttpRequest
from ninja import Router

from execution.stand_ins.switches import simulate_device
from registry.requests import refuses, signed_in
from registry.services import device_to_json, require
from registry.shapes import DeviceShape

router = Router(tags=["execution"])
STAND_IN = "/sites/{slug:site}/devices/{device_id}/stand-in"


@router.put(STAND_IN, response=DeviceShape, openapi_extra=refuses(409))
def begin_stand_in(request: HttpRequest, site: str, device_id: str) -> dict[str, Any]:
    """Simulate a device in place of the real one, which is told nothing until that ends."""
    require(request.user, site, "operator", "run")
    return device_to_json(simulate_device(site=site, device_id=device_id, simulated=True, by=signed_in(request)))


@router.delete(STAND_IN, response=DeviceShape, openapi_extra=refuses(409))
def end_stand_in(request: HttpRequest, site: str, device_id: str) -> dict[str, Any]:
    """Use the real device again."""
    require(request.user, site, "operator", "run")
    return device_to_json(simulate_device(site=site, device_id=device_id, simulated=False, by=signed_in(request)))
