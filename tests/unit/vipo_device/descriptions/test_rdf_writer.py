from __future__ import annotations

import json
import socket
from dataclasses import replace
from typing import Any

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from registry.demo.devices import describe_devices
from tests.kit.work import within_processor_time
from vipo_device.descriptions.forms import BadDescription
from vipo_device.descriptions.plausibility import find_faults
from vipo_device.descriptions.reader import canonical_hash, read_description, write_description
from vipo_device.protocol.description import (
    Description,
    MethodSpec,
    ParameterSpec,
    Pose,
    PropertySpec,
    Size,
    description_from_json,
    description_to_json,
)
from vipo_device.protocol.faults import fault

MIXER = Description(
    "mixer1",
    'Paint "Mixer" ä',
    "machine",
    "mixer",
    Pose(14.78, -5.85, 0.57, 1e-7),
    Size(1.35, 1.35, 1.2),
    description="Mixes\npaint",
    image="https://vipo.example/mixer.png",
    site="hall",
    done=False,
    simulated=True,
    gives=("box", "can"),
    takes=("can",),
    properties=(
        PropertySpec("z", "number", "DEG_C", -5.5, 1e30, "Heat"),
        PropertySpec("a", "text", options=("ok", "bad")),
    ),
    methods=(
        MethodSpec("stop", "vipo/v1/dev/mixer1/down/stop"),
        MethodSpec(
            "mixPaint",
            "vipo/v1/dev/mixer1/down/mixPaint",
            "time",
            "Mix paint",
            (
                ParameterSpec("time", "number", "MIN", 1.0, 30.0),
                ParameterSpec("shade", "text", options=("teal",), required=False),
            ),
        ),
    ),
)
TURTLE = """
@prefix vipo: <urn:vipo:ns#> . @prefix td: <https://www.w3.org/2019/wot/td#> .
@prefix dct: <http://purl.org/dc/terms/> .
<urn:vipo:device:m1> a vipo:Machine ; dct:identifier "m1" ; vipo:location ( 1 2 ) ; vipo:size ( 1 1 1 ) %s .
"""


@pytest.mark.parametrize("form", ["turtle", "n-triples", "json-ld"])
def test_a_description_survives_every_form(form: str) -> None:
    for description in (MIXER, *describe_devices()):
        assert read_description(write_description(description, form).encode(), device_id=description.id) == description


def test_the_same_description_gives_the_same_text_and_hash() -> None:
    again = read_description(write_description(MIXER, "n-triples").encode())
    assert write_description(again) == write_description(MIXER)
    assert canonical_hash(again) == canonical_hash(MIXER)
    assert canonical_hash(replace(MIXER, name="other")) != canonical_hash(MIXER)


def test_the_canonical_json_survives_json() -> None:
    assert description_from_json(json.loads(json.dumps(description_to_json(MIXER)))) == MIXER


def test_a_short_description_has_defaults() -> None:
    found = read_description((TURTLE % ' ; td:hasActionAffordance [ td:name "go" ]').encode(), device_id="m1")
    assert found == Description(
        "m1", "m1", "machine", "", Pose(1, 2), Size(1, 1, 1), methods=(MethodSpec("go", "vipo/v1/dev/m1/down/go"),)
    )


def test_json_ld_may_name_our_context() -> None:
    body = {
        "@context": ["urn:vipo:context"],
        "@id": "urn:vipo:device:m1",
        "@type": "vipo:Machine",
        "dct:identifier": "m1",
        "vipo:location": {"@list": [1, 2.5, 0]},
        "vipo:size": {"@list": [1, 1, 1]},
    }
    assert read_description(json.dumps(body).encode()).pose == Pose(1.0, 2.5, 0.0)


@pytest.mark.parametrize(
    "context",
    [
        "https://vipo.example/context",
        "file:///etc/hostname",
        ["urn:vipo:context", "http://127.0.0.1:1/c"],
        {"a": {"@id": "urn:a", "@context": "file:///etc/hostname"}},
    ],
)
def test_no_foreign_context_is_fetched(context: Any, monkeypatch: pytest.MonkeyPatch) -> None:
    calls: list[Any] = []
    monkeypatch.setattr(socket, "create_connection", lambda *a, **k: calls.append(a))
    body = {"@context": context, "@id": "urn:x", "@type": "urn:vipo:ns#Machine"}
    with pytest.raises(BadDescription, match="is not known here"):
        read_description(json.dumps(body).encode())
    with pytest.raises(BadDescription, match="imports"):
        read_description(json.dumps({"@context": {"@import": "http://127.0.0.1:1/c"}}).encode())
    assert calls == []


BOMB = (
    b'<?xml version="1.0"?><!DOCTYPE r ['
    + b"".join(b'<!ENTITY e%d "%s">' % (i, b"&e%d;" % (i - 1) * 10 if i else b"x" * 10) for i in range(12))
    + b"]><rdf:RDF>&e11;</rdf:RDF>"
)


@pytest.mark.parametrize(
    ("payload", "says"),
    [
        (BOMB, "RDF/XML"),
        (b"  <rdf:RDF xmlns:rdf='x'/>", "RDF/XML"),
        (b"\xff\xfe", "not UTF-8"),
        (b"hello there", "is not RDF"),
        (b"", "is empty"),
        (b"{}", "no vipo:Machine"),
        (b"{", "not JSON"),
        (b'{"a":1,"a":2}', "twice"),
        (b"x" * 16385, "16384 is the most"),
        (b"<a:b> <a:c> " + b"[ <a:d> " * 1500, "is not RDF"),
        (b"<a:b> <a:c> " + b"(" * 9000, "is not RDF"),
        (b'<a:b> <a:c> "<x/>"^^<http://www.w3.org/1999/02/22-rdf-syntax-ns#XMLLiteral> .', "XML or HTML"),
        (b'<a:b> <a:c> "a\\u0000b" .', "NUL"),
        ((TURTLE % '; dct:title "a", "b"').encode(), "dct:title more than once"),
        ((TURTLE % "; a vipo:Robot").encode(), "more than one"),
        ((TURTLE % '; vipo:capacity "many"').encode(), "number for vipo:capacity"),
        ((TURTLE % "; vipo:done 7").encode(), "true or false for vipo:done"),
        ((TURTLE % "; vipo:capacity 1e400").encode(), "number for vipo:capacity"),
        ((TURTLE % '; td:hasActionAffordance [ td:name "a/b" ]').encode(), "method name 'a/b'"),
        ((TURTLE % '; td:hasActionAffordance [ td:name "a" ], [ td:name "a" ]').encode(), "names the method 'a' twice"),
        (
            (TURTLE % '; td:hasActionAffordance [ td:name "a" ; vipo:topic "vipo/v1/dev/m2/down/a" ]').encode(),
            "not its own",
        ),
        (
            (TURTLE % '; td:hasActionAffordance [ td:name "a" ; vipo:topic "vipo/v1/dev/m1/down/+" ]').encode(),
            "not its own",
        ),
        ((TURTLE % '; td:hasPropertyAffordance [ td:name "a" ; vipo:type "magic" ]').encode(), "unknown type 'magic'"),
        ((TURTLE % "").replace("( 1 1 1 )", "( 1 1 )").encode(), "vipo:size"),
        ((TURTLE % "").replace("( 1 2 )", "( 1 nan )").encode(), "is not RDF"),
        ((TURTLE % "").replace("( 1 2 )", '( 1 "nan" )').encode(), "number for vipo:location"),
        ((TURTLE % "").replace('"m1"', '"m/1"').encode(), "Its id must be"),
    ],
)
def test_what_cannot_be_believed_is_refused_quickly_and_with_the_reason(payload: bytes, says: str) -> None:
    with pytest.raises(BadDescription, match=says), within_processor_time(2):
        read_description(payload)


def test_a_description_of_another_device_is_refused() -> None:
    with pytest.raises(BadDescription, match="'m1', but it came on the topic of 'm2'"):
        read_description((TURTLE % "").encode(), device_id="m2")


def test_a_list_that_bites_its_tail_ends() -> None:
    text = (TURTLE % "").replace("( 1 2 )", "_:l") + (
        "@prefix rdf: <http://www.w3.org/1999/02/22-rdf-syntax-ns#> . _:l rdf:first 1 ; rdf:rest _:l ."
    )
    with pytest.raises(BadDescription, match="vipo:location"):
        read_description(text.encode())


def test_too_many_methods_are_refused() -> None:
    many = tuple(MethodSpec(f"m{i}", f"vipo/v1/dev/mixer1/down/m{i}") for i in range(65))
    assert find_faults(replace(MIXER, methods=many)) == (fault("many_methods", most=64),)
    assert find_faults(MIXER) == ()


@settings(max_examples=100, deadline=None)
@given(st.data())
def test_a_damaged_description_brings_no_more_than_a_refusal(data: st.DataObject) -> None:
    text = bytearray(write_description(MIXER, data.draw(st.sampled_from(["turtle", "json-ld", "n-triples"]))).encode())
    for _ in range(data.draw(st.integers(1, 4))):
        at = data.draw(st.integers(0, len(text) - 1))
        text[at : at + data.draw(st.integers(0, 5))] = data.draw(st.binary(max_size=4))
    refusals = []
    try:
        read_description(bytes(text))
    except BadDescription as error:
        refusals.append(error.detail)
    assert all(detail.startswith("The description") for detail in refusals)
