"""Descriptions for tests: a small one, and all that find_faults believes, as hypothesis draws them."""

from __future__ import annotations

import json
from typing import Any

from hypothesis import strategies as st

from vipo_device.descriptions.plausibility import find_faults
from vipo_device.protocol.description import (
    SLOWEST_M_S,
    Description,
    MethodSpec,
    ParameterSpec,
    Pose,
    PropertySpec,
    Size,
)
from vipo_device.protocol.messages import down_topic
from vipo_device.protocol.texts import normal

THING: dict[str, Any] = {
    "@context": "https://www.w3.org/2022/wot/td/v1.1",
    "@type": "vipo:Machine",
    "id": "urn:vipo:device:m1",
    "title": "Lamp",
    "securityDefinitions": {"none": {"scheme": "nosec"}},
    "security": "none",
    "vipo:location": [1, 2],
    "vipo:size": [1, 1, 1],
}
"""The smallest Thing Description that is believed."""

IDS = st.from_regex(r"[A-Za-z0-9_.-]{1,20}", fullmatch=True)
NAMES = st.from_regex(r"[A-Za-z_][A-Za-z0-9_]{0,12}", fullmatch=True)
WORDS = st.from_regex(r"[A-Za-z0-9_.-]{1,8}", fullmatch=True)
TEXTS = st.text(st.characters(exclude_categories=["Cc", "Cs", "Zl", "Zp", "Cf", "Cn"]), max_size=12).map(normal)
NUMBERS = st.floats(-1e6, 1e6, allow_nan=False).map(lambda number: number + 0.0)
LENGTHS = st.floats(0.001, 100)
TYPES = st.sampled_from(["number", "text", "boolean", "object", "device", "place", "location"])
UNITS = st.sampled_from(["", "DEG_C", "MIN", "M-PER-SEC", "PERCENT"])
OPTIONS = st.lists(TEXTS.filter(bool), unique=True, max_size=3).map(tuple)
LIMITS = st.one_of(st.just((None, None)), st.tuples(NUMBERS, NUMBERS).map(lambda pair: tuple(sorted(pair))))


@st.composite
def _values(draw: st.DrawFn) -> dict[str, object]:
    low, high = draw(LIMITS)
    return {
        "name": draw(NAMES),
        "type": draw(TYPES),
        "unit": draw(UNITS),
        "minimum": low,
        "maximum": draw(st.sampled_from([None, high])),
        "options": draw(OPTIONS),
    }


PROPERTIES = st.builds(lambda value, title: PropertySpec(**value, title=title), _values(), TEXTS)
PARAMETERS = st.builds(lambda value, required: ParameterSpec(**value, required=required), _values(), st.booleans())


@st.composite
def _methods(draw: st.DrawFn, device_id: str) -> MethodSpec:
    name = draw(NAMES)
    parameters = draw(st.lists(PARAMETERS, max_size=3, unique_by=lambda spec: spec.name))
    message_type = draw(st.sampled_from(["", "time", "object", "location", "other"]))
    return MethodSpec(name, down_topic(device_id, name), message_type, draw(TEXTS), tuple(parameters))


@st.composite
def descriptions(draw: st.DrawFn) -> Description:
    """Draw a description that may be believed."""
    device_id, kind = draw(IDS), draw(st.sampled_from(["machine", "robot"]))
    words = st.lists(WORDS, unique=True, max_size=3).map(sorted).map(tuple)
    found = Description(
        id=device_id,
        name=draw(TEXTS.filter(str.strip)),
        kind=kind,
        device_class=draw(st.one_of(st.just(""), WORDS)),
        pose=Pose(*(draw(NUMBERS) for _ in range(4))),
        size=Size(*(draw(LENGTHS) for _ in range(3))),
        description=draw(st.text(st.sampled_from('aé\n\t"\\:#€ 😀{}<>@'), max_size=20)),
        image=draw(st.sampled_from(["", "https://vipo.example/a.png?b=1#c"])),
        site=draw(st.one_of(st.just(""), WORDS)),
        done=draw(st.booleans()),
        simulated=draw(st.booleans()),
        gives=draw(words),
        takes=draw(words),
        capacity=draw(st.integers(0, 1000)),
        radius_m=draw(st.floats(0.01, 10)) if kind == "robot" else 0.0,
        speed_m_s=draw(st.one_of(st.just(0.0), st.floats(SLOWEST_M_S, 20))),
        properties=tuple(draw(st.lists(PROPERTIES, max_size=3, unique_by=lambda spec: spec.name))),
        methods=tuple(draw(st.lists(_methods(device_id), max_size=3, unique_by=lambda method: method.name))),
    )
    assert find_faults(found) == ()
    return found


PREFIXES = """@prefix vipo: <urn:vipo:ns#> . @prefix td: <https://www.w3.org/2019/wot/td#> .
@prefix dct: <http://purl.org/dc/terms/> . @prefix schema: <https://schema.org/> .
"""


DEVICE = ' <urn:vipo:device:m1> a vipo:Machine ; dct:identifier "m1" ; vipo:location ( 1 2 ) ; vipo:size ( 1 1 1 )'


LINKED: dict[str, Any] = {
    "@context": "urn:vipo:context",
    "@id": "urn:vipo:device:m1",
    "@type": "vipo:Machine",
    "dct:identifier": "m1",
    "vipo:location": {"@list": [1, 2]},
    "vipo:size": {"@list": [1, 1, 1]},
}


def turtle(more: str = "") -> bytes:
    return f"{PREFIXES}{DEVICE} {more} .".encode()


def linked(**more: Any) -> bytes:
    return json.dumps({**LINKED, **more}).encode()
