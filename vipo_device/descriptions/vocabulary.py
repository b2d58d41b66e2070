"""VIPO's own terms in RDF and Thing Descriptions, and what people have written in their stead; pure."""

from __future__ import annotations

from collections.abc import Iterable
from difflib import get_close_matches

from vipo_device.protocol.faults import Fault, note

PREFIX = "vipo:"
TERMS = frozenset(
    {
        *("location", "size", "deviceClass", "site", "done", "simulated", "gives", "takes", "capacity", "radius"),
        *("speed", "topic", "messageType", "parameters", "type", "options", "required", "pointer"),
    }
)


def find_unknown(terms: Iterable[str]) -> tuple[Fault, ...]:
    """Return which of these, such as `vipo:radus`, mean nothing here, in the order of the alphabet; others may."""
    names = {term.removeprefix(PREFIX) for term in terms if term.startswith(PREFIX)} - TERMS
    return tuple(_left_out(name) for name in sorted(names))


def _left_out(name: str) -> Fault:
    like = get_close_matches(name, TERMS, 1)
    if like:
        return note("left_term", key=f"{PREFIX}{name}"[:80], like=f"{PREFIX}{like[0]}")
    return note("left_key", key=f"{PREFIX}{name}"[:80])
