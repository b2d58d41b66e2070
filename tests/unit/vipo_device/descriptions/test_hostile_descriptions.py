"""What must not hurt the registry: each hostile input, in every form that can carry it."""

from __future__ import annotations

import json
import socket
from typing import Any

import pytest

from tests.kit.work import within_processor_time
from tests.unit.vipo_device.descriptions.examples import THING, linked, turtle
from vipo_device.descriptions.forms import BadDescription
from vipo_device.descriptions.json_fields import Fields
from vipo_device.descriptions.reader import read

MESSAGE: dict[str, Any] = {"id": "m1", "location": [1, 2], "size": [1, 1, 1]}


def message(**more: Any) -> bytes:
    return json.dumps({**MESSAGE, **more}).encode()


def thing(**more: Any) -> bytes:
    return json.dumps({**THING, **more}).encode()


def deep(levels: int) -> Any:
    return {"a": deep(levels - 1)} if levels else 1


def methods(count: int) -> dict[str, Any]:
    return {f"m{i}": {"forms": [{"href": f"vipo/v1/dev/m1/down/m{i}"}]} for i in range(count)}


CONTEXTS: tuple[Any, ...] = (
    "https://vipo.example/context",
    "http://127.0.0.1:1/context",
    "file:///etc/hostname",
    ["urn:vipo:context", "file:///etc/hostname"],
    {"a": {"@id": "urn:a", "@context": "http://127.0.0.1:1/"}},
    {"@import": "http://127.0.0.1:1/"},
)
ENTITIES = b"<!DOCTYPE r [" + b"".join(b'<!ENTITY e%d "&e%d;&e%d;">' % (i, i - 1, i - 1) for i in range(1, 40)) + b"]>"
HOSTILE: dict[str, tuple[str, tuple[bytes, ...]]] = {
    "RDF/XML": (
        "RDF/XML",
        (
            b'<?xml version="1.0"?>' + ENTITIES + b"<rdf:RDF>&e39;</rdf:RDF>",
            ENTITIES + b"<rdf:RDF/>",
            b'\xef\xbb\xbf<?xml version="1.0"?><rdf:RDF/>',
            b"# no\n<rdf:RDF>",
        ),
    ),
    "a foreign context": (
        "context",
        (
            *(linked(**{"@context": context}) for context in CONTEXTS),
            linked(inner={"@context": "http://127.0.0.1:1/"}),
            thing(**{"@context": [THING["@context"], "http://127.0.0.1:1/"]}),
            thing(actions={"a": {"@context": "file:///etc/hostname", "forms": [{"href": "x"}]}}),
        ),
    ),
    "more than 16 kB": (
        "16384 is the most",
        (
            turtle("#" * 16384),
            message(description="x" * 16384),
            thing(description="x" * 16384),
            b'id: "m1"\n' + b"# \n" * 6000,
        ),
    ),
    "nesting": (
        "deep",
        (
            turtle("; vipo:a " + "[ vipo:a " * 17 + "1" + "]" * 17),
            turtle("; vipo:a " + "(" * 9000),
            message(value=deep(17)),
            thing(x=deep(17)),
            b"[" + b'{"a":[' * 2500,
            b'id: "m1"\nlocation: ' + b"[" * 5000,
        ),
    ),
    "too many methods": (
        "more than 64",
        (
            turtle("; td:hasActionAffordance " + ", ".join(f'[ td:name "m{i}" ]' for i in range(65))),
            message(methods=[{"name": f"m{i}"} for i in range(65)]),
            thing(actions=methods(65)),
        ),
    ),
    "too many properties": (
        "more than 64",
        (
            turtle("; td:hasPropertyAffordance " + ", ".join(f'[ td:name "p{i}" ]' for i in range(65))),
            message(properties=[{"name": f"p{i}"} for i in range(65)]),
            thing(properties={f"p{i}": {"forms": [{"href": "x"}]} for i in range(65)}),
        ),
    ),
    "not a number": (
        "not RDF|NaN|number",
        (
            turtle("; vipo:capacity NaN"),
            turtle('; vipo:capacity "NaN"^^<http://www.w3.org/2001/XMLSchema#double>'),
            message(capacity=float("nan")),
            thing(**{"vipo:capacity": float("nan")}),
            linked(**{"vipo:capacity": float("nan")}),
            b'id: "m1"\nlocation: [NaN, 1]\nsize: small\n',
        ),
    ),
    "infinity": (
        "Infinity|number|too large",
        (
            turtle("; vipo:speed 1e999"),
            turtle('; vipo:speed "INF"^^<http://www.w3.org/2001/XMLSchema#double>'),
            message(speed=float("inf")),
            thing(**{"vipo:speed": float("-inf")}),
            linked(**{"vipo:speed": float("inf")}),
            message(location=[1, 2]).replace(b"2]", b"1e999]"),
            message(location=[1, 2]).replace(b"2]", b"9" * 400 + b"]"),
        ),
    ),
    "half of a surrogate pair": (
        "surrogate",
        (
            turtle('; dct:title "\\uD800"'),
            turtle('; dct:title "\\U0000DFFF"'),
            message(name="\ud800"),
            thing(title="\udfff"),
            linked(**{"dct:title": "\ud83d"}),
            b'id: "m1"\nname: "\\udc00"\n',
        ),
    ),
    "NUL": (
        "NUL",
        (
            turtle('; dct:title "a\0b"'),
            turtle('; dct:title "a\\u0000b"'),
            message(name="\0"),
            thing(title="\0"),
            linked(**{"dct:title": "\0"}),
            b'id: "m1"\0\n',
        ),
    ),
    "control characters": (
        "control character",
        (
            turtle('; dct:title "\\u202Eevil"'),
            message(name="a\u0007"),
            thing(title="a\nb"),
            linked(**{"dct:description": "\u2066"}),
        ),
    ),
    "a key that comes twice": (
        "twice|more than once",
        (
            turtle('; dct:title "a", "b"'),
            message()[:-1] + b', "id": "m2"}',
            message()[:-1] + b', "ID": "m2"}',
            thing()[:-1] + b', "title": "b"}',
            thing(**{"urn:vipo:ns#size": [2, 2, 2]}),
            linked()[:-1] + b', "dct:identifier": "m2"}',
            b'id: "m1"\nid: "m2"\n',
        ),
    ),
    "somebody else's id": (
        "came on the topic of 'm1'",
        (
            turtle().replace(b'"m1"', b'"m2"'),
            message(id="m2"),
            thing(id="urn:vipo:device:m2"),
            linked(**{"dct:identifier": "m2"}),
            b'id: "m2"\nlocation: [1, 2]\nsize: small\n',
        ),
    ),
    "an image that is no web address": (
        "http://",
        tuple(
            payload
            for address in ("javascript:alert(1)", "file:///etc/passwd", "data:text/html,x", "https://a b")
            for payload in (
                turtle(f'; schema:image "{address}"'),
                message(imgUrl=address),
                thing(**{"schema:image": address}),
                linked(**{"schema:image": address}),
            )
        ),
    ),
    "somebody else's topic": (
        "not its own|use one",
        tuple(
            payload
            for topic in (
                "vipo/v1/dev/m2/down/a",
                "vipo/v1/dev/m1/up/state",
                "vipo/v1/dev/m1/down/+",
                "vipo/v1/dev/m1/down/#",
                "vipo/v1/dev/m1/down/a/b",
                "vipo/v1/site/hall/stop",
            )
            for payload in (
                turtle(f'; td:hasActionAffordance [ td:name "a" ; vipo:topic "{topic}" ]'),
                message(methods=[{"name": "a", "topic_name": topic}]),
                message(methods=[{"name": "a", "topic_name": f"/{topic}"}]),
                thing(actions={"a": {"forms": [{"href": f"mqtt://broker.example/{topic}"}]}}),
                thing(actions={"a": {"forms": [{"href": topic, "mqv:topic": topic}]}}),
            )
        ),
    ),
}
CASES = [
    pytest.param(says, payload, id=f"{name}-{position}")
    for name, (says, payloads) in HOSTILE.items()
    for position, payload in enumerate(payloads)
]


@pytest.mark.parametrize(("says", "payload"), CASES)
def test_hostile_descriptions_are_refused_at_once_and_nothing_is_fetched(
    says: str, payload: bytes, monkeypatch: pytest.MonkeyPatch
) -> None:
    calls: list[Any] = []
    monkeypatch.setattr(socket, "create_connection", lambda *a, **k: calls.append(a))
    monkeypatch.setattr(socket.socket, "connect", lambda *a, **k: calls.append(a))
    with pytest.raises(BadDescription, match=says), within_processor_time(2):
        read(payload, device_id="m1")
    assert calls == []


@pytest.mark.parametrize(
    "payload",
    [
        thing(actions={"\x1b[2J\u202e": {"forms": 3}}),
        thing(properties={"\x1b[2J": {"type": "object", "forms": [{"href": "x"}]}}),
        message(methods=[{"name": "\x1b[2J"}]),
        b"\x1b[2J:a <b> <c> .",
        b'id: "m1"\n\x1b[2J\n',
    ],
)
def test_a_refusal_quotes_nothing_that_a_terminal_obeys(payload: bytes) -> None:
    with pytest.raises(BadDescription) as refusal:
        read(payload)
    assert refusal.value.detail.isprintable()


@pytest.mark.parametrize("payload", [turtle(), message(), thing(), linked()])
def test_what_the_hostile_ones_are_made_of_is_believed(payload: bytes) -> None:
    assert read(payload, device_id="m1").description.pose.y == 2.0


@pytest.mark.parametrize(
    "payload",
    [
        b'"""\\"""' * 2300,
        b"@prefix a: <b> .\n" + b'a:b a:c """' + b"\\" * 16000,
        b'id: "' + b"'\"" * 8000,
        b"{" + b'"a' * 8000,
        b"<a> <b> " + b"." * 16000,
        b"- " * 8000,
        b"id" + b" " * 16000 + b"x",
        b"id: 1\nid" + b" " * 16000 + b"x",
        b"id: 1\nid: " + b"\xe2\x80\x99" * 5000,
        b"id" + b" :" * 8000,
        b"_:a " * 4000,
        b"id: x\nmethods\n" + b" - name: a\n" * 1400,
    ],
)
def test_long_repetitions_take_no_time(payload: bytes) -> None:
    with pytest.raises(BadDescription), within_processor_time(2):
        read(payload)


@pytest.mark.parametrize("number", [10**400, -(10**400), float("inf"), float("nan"), True, "1"])
def test_a_number_that_no_form_may_bring_is_refused_with_its_place(number: Any) -> None:
    with pytest.raises(BadDescription, match="needs a number for speed"):
        Fields({"speed": number}).number("speed")
    with pytest.raises(BadDescription, match="needs a number for capacity"):
        Fields({"capacity": number}).whole("capacity")
    with pytest.raises(BadDescription, match="needs a list of numbers for size"):
        Fields({"size": [1, number]}).numbers("size")
    assert Fields({"speed": 10**300}).number("speed") == 1e300
