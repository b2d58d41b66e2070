"""The registry over HTTP: signing in, sites, maps and devices."""

from __future__ import annotations

import json
from dataclasses import asdict
from pathlib import Path
from typing import Any

from django.conf import settings
from django.contrib.auth import login, logout
from django.http import HttpRequest, HttpResponse
from django.middleware.csrf import get_token
from django.utils import timezone
from ninja import File, Form, Router
from ninja.errors import HttpError
from ninja.files import UploadedFile
from ninja.utils import check_csrf

from registry import services
from registry.api.shapes import (
    ApprovedDevice,
    DeviceEdit,
    DeviceEventShape,
    DeviceShape,
    Lifecycle,
    Me,
    NewCredential,
    SignIn,
    SiteShape,
    Topic,
)
from registry.devices.thing_events import call_listeners
from registry.devices.views import device_to_json, site_to_json
from registry.floorplan.map_server import MAX_IMAGE_BYTES, MAX_YAML_BYTES, BadMap
from registry.live.fanout import EVERY_SITE, publish
from registry.models import User
from registry.people.access import require
from registry.people.sign_in import check_sign_in
from vipo_device.descriptions.forms import CONTENT_TYPES, DescriptionForm
from vipo_device.descriptions.reader import write_description
from vipo_device.protocol.description import Pose

router = Router(tags=["registry"])


def sends(*content_types: str) -> dict[str, Any]:
    """Say in the OpenAPI file that a call answers with something else than JSON."""
    return {"responses": {200: {"content": {name: {"schema": {"type": "string"}} for name in content_types}}}}


def signed_in(request: HttpRequest) -> User:
    """Return who asks; the API lets nobody else through."""
    assert isinstance(request.user, User)
    return request.user


@router.get("/me", response=Me, auth=None)
def show_me(request: HttpRequest) -> dict[str, Any]:
    """Say who is signed in; strangers get the token that signing in needs."""
    user = request.user
    person = None
    if isinstance(user, User):
        person = {"id": user.pk, "name": user.display_name, "initials": user.initials, "email": user.email}
    return {"user": person, "csrf": get_token(request), "demo_accounts": _demo_accounts()}


def _demo_accounts() -> list[dict[str, str]]:
    path = Path(settings.VIPO_STATE_DIR) / "demo-accounts.json"
    if not settings.VIPO_DEMO or not path.exists():
        return []
    accounts: list[dict[str, str]] = json.loads(path.read_text())
    return accounts


@router.post("/sign-in", response=Me, auth=None)
def sign_in(request: HttpRequest, body: SignIn) -> dict[str, Any]:
    """Begin a session."""
    if check_csrf(request):
        raise HttpError(403, "The page is out of date. Reload it and sign in again.")
    address = request.META.get("REMOTE_ADDR", "")
    user = check_sign_in(email=body.email, password=body.password, address=address, now=timezone.now())
    login(request, user)
    return show_me(request)


@router.post("/sign-out", response=Me)
def sign_out(request: HttpRequest) -> dict[str, Any]:
    """End the session."""
    logout(request)
    call_listeners()
    publish(EVERY_SITE, {"type": "members"})
    return show_me(request)


@router.get("/sites", response=list[SiteShape])
def list_sites(request: HttpRequest) -> list[dict[str, Any]]:
    """List the sites where the asker is a member."""
    return [site_to_json(site) for site in services.list_sites(user=signed_in(request))]


@router.post("/sites", response={201: SiteShape})
def upload_site(
    request: HttpRequest,
    name: Form[str],
    yaml: File[UploadedFile],
    image: File[UploadedFile | None] = None,
) -> dict[str, Any]:
    """Make a site from a ROS map; the asker becomes its admin."""
    site = services.create_site_from_map(
        name=name,
        yaml=_read_upload(yaml, MAX_YAML_BYTES, "The .yaml file"),
        image=_read_upload(image, MAX_IMAGE_BYTES, "The map's image") if image else None,
        admin=signed_in(request),
    )
    return site_to_json(site)


def _read_upload(file: UploadedFile, most: int, what: str) -> bytes:
    if (file.size or 0) > most:
        raise BadMap(f"{what} has {file.size} bytes; {most} is the most. Choose the map's own files.")
    return bytes(file.read())


@router.get("/sites/{slug}", response=SiteShape)
def show_site(request: HttpRequest, slug: str) -> dict[str, Any]:
    """Show a site."""
    access = require(signed_in(request), slug, "viewer")
    return site_to_json(services.get_site(site=slug, role=access.role))


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
def show_history(request: HttpRequest, slug: str, device_id: str) -> list[dict[str, Any]]:
    """Show what happened to a device, newest first."""
    require(signed_in(request), slug, "viewer")
    events = services.list_device_events(site=slug, device_id=device_id)
    return [{**asdict(e), "at": e.at.isoformat()} for e in events]


@router.get("/sites/{slug}/devices/{device_id}/rdf", openapi_extra=sends(*CONTENT_TYPES.values()))
def show_rdf(request: HttpRequest, slug: str, device_id: str, format: DescriptionForm = "turtle") -> HttpResponse:
    """Send a device's description as `turtle`, `n-triples`, `json-ld`, `td` or the `paper`'s message."""
    require(signed_in(request), slug, "viewer")
    device = services.get_device(site=slug, device_id=device_id)
    text = write_description(device.whole, format, broker=settings.VIPO_BROKER_URL)
    return HttpResponse(text, content_type=f"{CONTENT_TYPES[format]}; charset=utf-8")


@router.post("/sites/{slug}/devices/{device_id}/approve", response=ApprovedDevice)
def approve(request: HttpRequest, response: HttpResponse, slug: str, device_id: str) -> dict[str, Any]:
    """Let a pending device take part, and tell its new key this once."""
    user = signed_in(request)
    require(user, slug, "admin")
    decided = services.approve_device(site=slug, device_id=device_id, by=user, at=timezone.now())
    response["Cache-Control"] = "no-store"
    return {**device_to_json(decided.device), "credential": decided.credential, "taken": decided.taken}


@router.post("/sites/{slug}/devices/{device_id}/reject", response=DeviceShape)
def reject(request: HttpRequest, slug: str, device_id: str) -> dict[str, Any]:
    """Turn a pending device away."""
    user = signed_in(request)
    require(user, slug, "admin")
    return device_to_json(services.reject_device(site=slug, device_id=device_id, by=user, at=timezone.now()))


@router.post("/sites/{slug}/devices/{device_id}/retire", response=DeviceShape)
def retire(request: HttpRequest, slug: str, device_id: str) -> dict[str, Any]:
    """Take an approved device out; its history stays, and its id cannot come back until it is readmitted."""
    user = signed_in(request)
    require(user, slug, "admin")
    return device_to_json(services.retire_device(site=slug, device_id=device_id, by=user, at=timezone.now()))


@router.post("/sites/{slug}/devices/{device_id}/readmit", response=DeviceShape)
def readmit(request: HttpRequest, slug: str, device_id: str) -> dict[str, Any]:
    """Let a retired or rejected device's id come back as a newcomer."""
    user = signed_in(request)
    require(user, slug, "admin")
    return device_to_json(services.readmit_device(site=slug, device_id=device_id, by=user, at=timezone.now()))


@router.post("/sites/{slug}/devices/{device_id}/credential", response=NewCredential)
def rotate(request: HttpRequest, response: HttpResponse, slug: str, device_id: str) -> dict[str, Any]:
    """Give an approved device a new key, told this once; the old one ends."""
    user = signed_in(request)
    require(user, slug, "admin")
    decided = services.rotate_credential(site=slug, device_id=device_id, by=user, at=timezone.now())
    response["Cache-Control"] = "no-store"
    return {"credential": decided.credential, "taken": decided.taken}


@router.delete("/sites/{slug}/devices/{device_id}/credential", response=DeviceShape)
def revoke(request: HttpRequest, slug: str, device_id: str) -> dict[str, Any]:
    """Take an approved device's key away; its connection ends at once."""
    user = signed_in(request)
    require(user, slug, "admin")
    return device_to_json(services.revoke_credential(site=slug, device_id=device_id, by=user, at=timezone.now()))


@router.post("/sites/{slug}/devices/{device_id}/topics/confirm", response=DeviceShape)
def confirm(request: HttpRequest, slug: str, device_id: str, body: Topic) -> dict[str, Any]:
    """Let an approved device be told a method on the topic outside of `vipo/` that it asks for."""
    user = signed_in(request)
    require(user, slug, "admin")
    return device_to_json(
        services.confirm_topic(site=slug, device_id=device_id, topic=body.topic, by=user, at=timezone.now())
    )


@router.post("/sites/{slug}/devices/{device_id}/topics/withdraw", response=DeviceShape)
def withdraw(request: HttpRequest, slug: str, device_id: str, body: Topic) -> dict[str, Any]:
    """Take the confirmation of a topic back; the device asks for it again."""
    user = signed_in(request)
    require(user, slug, "admin")
    return device_to_json(
        services.withdraw_topic(site=slug, device_id=device_id, topic=body.topic, by=user, at=timezone.now())
    )


@router.patch("/sites/{slug}/devices/{device_id}", response=DeviceShape)
def edit(request: HttpRequest, slug: str, device_id: str, body: DeviceEdit) -> dict[str, Any]:
    """Rename a device, or say where it stands."""
    user = signed_in(request)
    require(user, slug, "admin")
    pose = Pose(**body.location.dict()) if body.location else None
    device = services.update_device(
        site=slug, device_id=device_id, name=body.name, pose=pose, by=user, at=timezone.now()
    )
    return device_to_json(device)
