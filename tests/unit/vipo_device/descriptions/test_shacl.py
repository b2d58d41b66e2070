from __future__ import annotations

import pytest
from hypothesis import given, settings

from registry.demo.devices import describe_devices
from tests.kit.files import FIGURE_5
from tests.unit.vipo_device.descriptions.examples import descriptions, linked, turtle
from vipo_device.descriptions.forms import FORMS, BadDescription
from vipo_device.descriptions.reader import read, write_description
from vipo_device.descriptions.shacl import check_rdf, check_reading
from vipo_device.protocol.description import Description

OWN = "vipo/v1/dev/m1/down/a"


@settings(max_examples=10, deadline=None)
@given(descriptions())
def test_what_vipo_writes_keeps_to_the_shapes(description: Description) -> None:
    assert check_rdf(write_description(description).encode()) == ()


def test_the_demos_devices_and_figure_5_keep_to_the_shapes() -> None:
    payloads = [write_description(d, form).encode() for d in describe_devices()[:2] for form in FORMS]
    for payload in (*payloads, FIGURE_5, turtle(), linked()):
        assert check_reading(read(payload), payload) == ()


@pytest.mark.parametrize(
    ("more", "says"),
    [
        ("; a vipo:Robot", "either a vipo:Machine or a vipo:Robot"),
        ("; a vipo:Robot", "must give its vipo:radius"),
        ('; dct:identifier "m2"', "dct:identifier must be given once"),
        ('; dct:title "a", "b"', "dct:title"),
        ("; vipo:location ( 3 4 )", "vipo:location must be given once"),
        ("; vipo:size ( 1 1 1 )", "vipo:size"),
        ("; vipo:capacity 1001", "vipo:capacity"),
        ("; vipo:capacity 1.5", "vipo:capacity"),
        ("; vipo:speed 21", "vipo:speed"),
        ("; vipo:speed -1", "vipo:speed"),
        ("; vipo:speed 1e-310", "vipo:speed"),
        ("; vipo:speed 0.0009", "vipo:speed"),
        ("; vipo:done 7", "vipo:done"),
        ('; vipo:gives "a b"', "vipo:gives"),
        ('; schema:image "javascript:alert(1)"', "schema:image"),
        ('; td:hasActionAffordance [ td:name "a/b" ]', "A method needs a td:name"),
        (
            '; td:hasActionAffordance [ td:name "a" ; vipo:topic "vipo/v1/dev/m2/down/a" ]',
            "under the device's own down/",
        ),
        ('; td:hasActionAffordance [ td:name "a" ], [ td:name "a" ]', "the same td:name"),
        (
            f'; td:hasActionAffordance [ td:name "a" ; vipo:topic "{OWN}" ; vipo:parameters ( [ td:name "b" ; '
            'vipo:type "magic" ] ) ]',
            "A method needs",
        ),
        ('; td:hasPropertyAffordance [ td:name "a" ; vipo:type "magic" ]', "A property needs"),
        ('; td:hasPropertyAffordance [ td:name "a" ; schema:minValue 2 ; schema:maxValue 1 ]', "A property needs"),
        ("; td:hasPropertyAffordance " + ", ".join(f'[ td:name "p{i}" ]' for i in range(65)), "64 properties"),
    ],
)
def test_what_the_shapes_refuse_the_registry_refuses_too(more: str, says: str) -> None:
    payload = turtle(more)
    assert says in " ".join(fault.text for fault in check_rdf(payload))
    with pytest.raises(BadDescription):
        read(payload)
