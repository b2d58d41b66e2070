"""Bringing devices in, over HTTP: their set-up, a look at a description before it is sent, all of them as RDF."""

from __future__ import annotations

from dataclasses import asdict
from typing import Annotated, Any, Literal

from django.conf import settings
from django.http import HttpRequest, HttpResponse
from django.utils import timezone
from ninja import Router, Schema
from pydantic import Field

from registry import services
from registry.people.access import require
from registry.requests import Asked, Line, ReadLater, Unchecked, file_response, signed_in
from vipo_device.descriptions.forms import BadDescription, DescriptionForm
from vipo_device.descriptions.reader import read, write_description
from vipo_device.protocol.description import description_to_json

router = Router(tags=["registry"])
_SENDS_TURTLE = {"responses": {200: {"content": {"text/turtle": {"schema": {"type": "string"}}}}}}
MOST_CHARACTERS = 65_536
"""More than a description may have, so that the reader says itself what is too long."""


class NewDevice(Asked):
    """The id of a device that will come; `again` gives another key to one that was added and has not come yet."""

    id: Line = Field(max_length=64)
    again: bool = False


class ExpectedDevice(Schema):
    """What a device is set up with; `credential` is its key, told this once, `broker` may be empty."""

    id: str
    site: str
    credential: str
    broker: str


class Door(Schema):
    """A site's new enrolment key, told this once; the one before has ended."""

    site: str
    join_key: str
    broker: str


class DescriptionText(Asked):
    """A description in any form."""

    text: Annotated[str, ReadLater()] = Field(max_length=MOST_CHARACTERS)


class FaultShape(Schema):
    """One thing that is wrong or was mended: a sentence, and where: a line and column from 1 (0: none), or a path.

    `code` and `args` are what the sentence is made of; both are empty where it stands for itself.
    """

    text: str
    line: int
    column: int
    path: str
    code: str
    args: dict[str, str | int | float]


class DescribedMethod(Schema):
    """A method of a description."""

    name: str


class DescribedShape(Schema):
    """The most important of a description: whose it is, and what it can do."""

    id: str
    name: str
    kind: Literal["robot", "machine"]
    methods: list[DescribedMethod]


class LookShape(Schema):
    """What VIPO makes of a description; with `faults` the rest is null or empty.

    `notes` are the sentences of `mended`: what was mended or left out.
    """

    form: DescriptionForm | None
    faults: list[FaultShape]
    notes: list[str]
    mended: list[FaultShape]
    description: Annotated[dict[str, Any] | None, Unchecked(DescribedShape | None)]
    turtle: str


@router.post("/sites/{slug}/newcomers", response={201: ExpectedDevice})
def reserve_device(request: HttpRequest, response: HttpResponse, slug: str, body: NewDevice) -> dict[str, Any]:
    """Reserve an id for a device that will come, and tell its key this once; it still waits for approval then.

    Where it has a key already that is refused (409), and says who made it; with `again` that key ends.
    """
    user = signed_in(request)
    require(user, slug, "admin")
    made = services.reserve_device(site=slug, device_id=body.id.strip(), by=user, at=timezone.now(), again=body.again)
    response["Cache-Control"] = "no-store"
    return asdict(made)


@router.post("/sites/{slug}/join-key", response=Door)
def renew_enrolment_key(request: HttpRequest, response: HttpResponse, slug: str) -> dict[str, Any]:
    """Make a new enrolment key for devices that come to a site, and tell it this once; the old one ends."""
    require(signed_in(request), slug, "admin")
    response["Cache-Control"] = "no-store"
    return {"site": slug, "join_key": services.renew_enrolment_key(site=slug), "broker": str(settings.VIPO_BROKER_URL)}


@router.post("/sites/{slug}/describe", response=LookShape)
def look_at_description(request: HttpRequest, slug: str, body: DescriptionText) -> dict[str, Any]:
    """Say what VIPO would make of a description, and what is wrong with it; nothing is kept."""
    require(signed_in(request), slug, "viewer")
    try:
        reading = read(body.text.encode("utf-8", errors="surrogatepass"))
    except BadDescription as error:
        faults = [asdict(fault) for fault in error.faults]
        return {"form": None, "faults": faults, "notes": [], "mended": [], "description": None, "turtle": ""}
    return {
        "form": reading.form,
        "faults": [],
        "notes": [note.text for note in reading.notes],
        "mended": [asdict(note) for note in reading.notes],
        "description": description_to_json(reading.description),
        "turtle": write_description(reading.description),
    }


@router.get("/sites/{slug}/devices.ttl", openapi_extra=_SENDS_TURTLE)
def export_devices(request: HttpRequest, slug: str) -> HttpResponse:
    """Give the descriptions of all devices of a site as one Turtle file."""
    require(signed_in(request), slug, "viewer")
    text = "\n".join(write_description(device.canonical) for device in services.list_devices(site=slug))
    return file_response(text, f"{slug}-devices.ttl", "text/turtle; charset=utf-8")
