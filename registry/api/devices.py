"""Devices over HTTP: what they are, what happened to them, and what admins decide about them."""

from __future__ import annotations

from dataclasses import asdict
from datetime import datetime
from typing import Annotated, Any

from django.conf import settings
from django.http import HttpRequest, HttpResponse
from django.utils import timezone
from ninja import Field, Router, Schema

from registry import services
from registry.devices.property_history import MOST_POINTS
from registry.devices.views import OWN_PLACE, NewPlace, device_to_json
from registry.people.access import require
from registry.requests import sends, signed_in
from registry.shapes import (
    ApprovedDevice,
    DeviceEdit,
    DeviceEventShape,
    DeviceShape,
    Lifecycle,
    NewCredential,
    Reading,
    Topic,
)
from vipo_device.descriptions.forms import CONTENT_TYPES, DescriptionForm
from vipo_device.descriptions.reader import write_description
from vipo_device.protocol.description import Pose

router = Router(tags=["registry"])


class PointShape(Schema):
    """A property over the seconds from `at` on in which it last changed: its least, greatest and last value."""

    at: str
    minimum: float | None
    maximum: float | None
    value: Reading


class SeriesShape(Schema):
    """What a property was, oldest first; the first point may lie before `since`: what held until the next."""

    property: str
    unit: str
    since: str
    bucket_s: int
    points: list[PointShape]


@router.get("/sites/{slug}/devices", response=list[DeviceShape])
def list_devices(request: HttpRequest, slug: str, lifecycle: Lifecycle | None = None) -> list[dict[str, Any]]:
    """List a site's devices, also those that wait for approval; retired ones only when asked for by `lifecycle`."""
    require(signed_in(request), slug, "viewer")
    return [device_to_json(device) for device in services.list_devices(site=slug, lifecycle=lifecycle)]


@router.get("/sites/{slug}/devices/{device_id}", response=DeviceShape)
def show_device(request: HttpRequest, slug: str, device_id: str) -> dict[str, Any]:
    """Show a device."""
    require(signed_in(request), slug, "viewer")
    return device_to_json(services.get_device(site=slug, device_id=device_id))


@router.get("/sites/{slug}/devices/{device_id}/events", response=list[DeviceEventShape])
def list_device_events(
    request: HttpRequest, slug: str, device_id: str, limit: Annotated[int, Field(ge=1, le=1000)] = 50
) -> list[dict[str, Any]]:
    """Show what happened to a device, the newest first; no device has a history of more than a thousand lines."""
    require(signed_in(request), slug, "viewer")
    events = services.list_device_events(site=slug, device_id=device_id, limit=limit)
    return [{**asdict(e), "at": e.at.isoformat()} for e in events]


@router.get("/sites/{slug}/devices/{device_id}/rdf", openapi_extra=sends(*CONTENT_TYPES.values()))
def show_rdf(request: HttpRequest, slug: str, device_id: str, format: DescriptionForm = "turtle") -> HttpResponse:
    """Send a device's description as `turtle`, `n-triples`, `json-ld`, `td` or the `paper`'s message."""
    require(signed_in(request), slug, "viewer")
    device = services.get_device(site=slug, device_id=device_id)
    text = write_description(device.whole, format, broker=settings.VIPO_BROKER_URL)
    return HttpResponse(text, content_type=f"{CONTENT_TYPES[format]}; charset=utf-8")


@router.post("/sites/{slug}/devices/{device_id}/approve", response=ApprovedDevice)
def approve_device(request: HttpRequest, response: HttpResponse, slug: str, device_id: str) -> dict[str, Any]:
    """Let a pending device take part, and tell its new key this once."""
    user = signed_in(request)
    require(user, slug, "admin")
    decided = services.approve_device(site=slug, device_id=device_id, by=user, at=timezone.now())
    response["Cache-Control"] = "no-store"
    return {**device_to_json(decided.device), "credential": decided.credential, "taken": decided.taken}


@router.post("/sites/{slug}/devices/{device_id}/reject", response=DeviceShape)
def reject_device(request: HttpRequest, slug: str, device_id: str) -> dict[str, Any]:
    """Turn a pending device away."""
    user = signed_in(request)
    require(user, slug, "admin")
    return device_to_json(services.reject_device(site=slug, device_id=device_id, by=user, at=timezone.now()))


@router.post("/sites/{slug}/devices/{device_id}/retire", response=DeviceShape)
def retire_device(request: HttpRequest, slug: str, device_id: str) -> dict[str, Any]:
    """Take an approved device out; its history stays, and its id cannot come back until it is readmitted."""
    user = signed_in(request)
    require(user, slug, "admin")
    return device_to_json(services.retire_device(site=slug, device_id=device_id, by=user, at=timezone.now()))


@router.post("/sites/{slug}/devices/{device_id}/readmit", response=DeviceShape)
def readmit_device(request: HttpRequest, slug: str, device_id: str) -> dict[str, Any]:
    """Let a retired or rejected device's id come back as a pending device."""
    user = signed_in(request)
    require(user, slug, "admin")
    return device_to_json(services.readmit_device(site=slug, device_id=device_id, by=user, at=timezone.now()))


@router.post("/sites/{slug}/devices/{device_id}/credential", response=NewCredential)
def rotate_credential(request: HttpRequest, response: HttpResponse, slug: str, device_id: str) -> dict[str, Any]:
    """Give an approved device a new key, told this once; the old one ends."""
    user = signed_in(request)
    require(user, slug, "admin")
    decided = services.rotate_credential(site=slug, device_id=device_id, by=user, at=timezone.now())
    response["Cache-Control"] = "no-store"
    return {"credential": decided.credential, "taken": decided.taken}


@router.delete("/sites/{slug}/devices/{device_id}/credential", response=DeviceShape)
def revoke_credential(request: HttpRequest, slug: str, device_id: str) -> dict[str, Any]:
    """Take an approved device's key away; its connection ends at once."""
    user = signed_in(request)
    require(user, slug, "admin")
    return device_to_json(services.revoke_credential(site=slug, device_id=device_id, by=user, at=timezone.now()))


@router.post("/sites/{slug}/devices/{device_id}/topics/confirm", response=DeviceShape)
def confirm_topic(request: HttpRequest, slug: str, device_id: str, body: Topic) -> dict[str, Any]:
    """Let an approved device be told a method on the topic outside of `vipo/` that it asks for."""
    user = signed_in(request)
    require(user, slug, "admin")
    return device_to_json(
        services.confirm_topic(site=slug, device_id=device_id, topic=body.topic, by=user, at=timezone.now())
    )


@router.post("/sites/{slug}/devices/{device_id}/topics/withdraw", response=DeviceShape)
def withdraw_topic(request: HttpRequest, slug: str, device_id: str, body: Topic) -> dict[str, Any]:
    """Take the confirmation of a topic back; the device asks for it again."""
    user = signed_in(request)
    require(user, slug, "admin")
    return device_to_json(
        services.withdraw_topic(site=slug, device_id=device_id, topic=body.topic, by=user, at=timezone.now())
    )


@router.patch("/sites/{slug}/devices/{device_id}", response=DeviceShape)
def edit_device(request: HttpRequest, slug: str, device_id: str, body: DeviceEdit) -> dict[str, Any]:
    """Rename a device, or say where it stands."""
    user = signed_in(request)
    require(user, slug, "admin")
    device = services.update_device(
        site=slug, device_id=device_id, name=body.name, pose=_place_in(body), by=user, at=timezone.now()
    )
    return device_to_json(device)


def _place_in(body: DeviceEdit) -> NewPlace | None:
    if body.location is not None:
        return Pose(**body.location.dict())
    return OWN_PLACE if "location" in body.model_fields_set else None


@router.get("/sites/{slug}/devices/{device_id}/history", response=SeriesShape)
def show_property_history(
    request: HttpRequest,
    slug: str,
    device_id: str,
    property: str,
    since: datetime | None = None,
    points: int = MOST_POINTS,
) -> dict[str, Any]:
    """Show what a property was since a time, at most seven days back, in so many points at most (1 to 500)."""
    require(signed_in(request), slug, "viewer")
    begin = timezone.make_aware(since) if since and timezone.is_naive(since) else since
    found = services.read_history(
        site=slug, device_id=device_id, name=property, since=begin, now=timezone.now(), most=points
    )
    told = [
        {"at": p.at.isoformat(), "minimum": p.minimum, "maximum": p.maximum, "value": p.value} for p in found.points
    ]
    return {
        "property": found.property,
        "unit": found.unit,
        "since": found.since.isoformat(),
        "bucket_s": found.bucket_s,
        "points": told,
    }
