"""Where every description is read and written: any form in, the canonical description out, and the other way round."""

from __future__ import annotations

import hashlib
import json
from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from difflib import get_close_matches
from typing import Any

from vipo_device.descriptions.device_triples import describe, list_own_terms
from vipo_device.descriptions.forms import (
    FORMS,
    BadDescription,
    DescriptionForm,
    form_of_json,
    form_of_text,
    is_json,
    plain_text,
    read_json,
    refuse,
)
from vipo_device.descriptions.paper_message import describe_message, write_message
from vipo_device.descriptions.paper_text import read_text
from vipo_device.descriptions.plausibility import find_faults
from vipo_device.descriptions.rdf_reader import read_json_ld, read_turtle
from vipo_device.descriptions.rdf_writer import write_rdf
from vipo_device.descriptions.td_schema import check_thing
from vipo_device.descriptions.thing_description import describe_thing, list_own_keys, write_thing
from vipo_device.descriptions.triples import Triples
from vipo_device.protocol.description import Description, description_to_json
from vipo_device.protocol.faults import Fault, note

PREFIX = "vipo:"
TERMS = frozenset(
    {
        *("location", "size", "deviceClass", "site", "done", "simulated", "gives", "takes", "capacity", "radius"),
        *("speed", "topic", "messageType", "parameters", "type", "options", "required", "pointer"),
    }
)
"""VIPO's own terms in RDF and Thing Descriptions."""


@dataclass(frozen=True, slots=True)
class Reading:
    """What was read: the description, the form it came in, and what was mended or left out on the way."""

    description: Description
    form: DescriptionForm
    notes: tuple[Fault, ...] = ()


def source_hash(payload: bytes) -> str:
    """Return what tells whether a payload was seen before: hashing takes a microsecond, parsing a millisecond."""
    return hashlib.sha256(payload).hexdigest()


def canonical_hash(description: Description) -> str:
    """Return the hash of a description's meaning, the same for every form it comes in."""
    return hash_of_json(description_to_json(description))


def hash_of_json(canonical: Mapping[str, Any]) -> str:
    """Return the hash of a canonical description that is JSON already."""
    body = json.dumps(canonical, sort_keys=True, separators=(",", ":"))
    return hashlib.sha256(body.encode()).hexdigest()


def read(payload: bytes, *, device_id: str | None = None) -> Reading:
    """Read a description in whatever form it is; it must speak of `device_id` when that is given.

    Raises BadDescription.
    """
    text = plain_text(payload)
    reading = _read_json_form(text) if is_json(text) else _read_text_form(text)
    description = reading.description
    if device_id is not None and description.id != device_id:
        refuse("other_id", said=description.id[:64], device=device_id)
    if faults := find_faults(description):
        raise BadDescription(*faults, heading="The description cannot be believed.")
    return reading


def _read_json_form(text: str) -> Reading:
    body = read_json(text)
    form = form_of_json(body)
    if form == "td":
        check_thing(body)
        return Reading(describe_thing(body), form, find_unknown(list_own_keys(body)))
    if form == "paper":
        description, notes = describe_message(body)
        return Reading(description, form, notes)
    return _read_triples(read_json_ld(body), form)


def _read_text_form(text: str) -> Reading:
    form = form_of_text(text)
    if form == "paper":
        message = read_text(text)
        description, notes = describe_message(message.body, message.places, message.notes)
        return Reading(description, form, notes)
    return _read_triples(read_turtle(text), form)


def _read_triples(triples: Triples, form: DescriptionForm) -> Reading:
    return Reading(describe(triples), form, find_unknown(list_own_terms(triples)))


def read_description(payload: bytes, *, device_id: str | None = None) -> Description:
    """Return only the description of a payload. Raises BadDescription."""
    return read(payload, device_id=device_id).description


def write_description(description: Description, form: str = "turtle", *, broker: str = "") -> str:
    """Return a description in a form; `broker` is the address for a Thing's links, such as mqtt://host:1883/.

    The same description always gives the same text. Raises BadDescription for a form that there is not.
    """
    match form:
        case "turtle" | "n-triples" | "json-ld":
            return write_rdf(description, form)
        case "td":
            return write_thing(description, broker)
        case "paper":
            return write_message(description)
    return refuse("no_form", form=form[:20], forms=", ".join(FORMS))


def find_unknown(terms: Iterable[str]) -> tuple[Fault, ...]:
    """Return which of these, such as `vipo:radus`, mean nothing here, in the order of the alphabet; others may."""
    names = {term.removeprefix(PREFIX) for term in terms if term.startswith(PREFIX)} - TERMS
    return tuple(_left_out(name) for name in sorted(names))


def _left_out(name: str) -> Fault:
    like = get_close_matches(name, TERMS, 1)
    if like:
        return note("left_term", key=f"{PREFIX}{name}"[:80], like=f"{PREFIX}{like[0]}")
    return note("left_key", key=f"{PREFIX}{name}"[:80])
