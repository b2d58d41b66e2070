"""Both validators of Thing Descriptions think the same of every Thing, so that the quick one may wave them through."""

from __future__ import annotations

import json
from copy import deepcopy
from typing import Any

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from registry.demo.devices import describe_devices
from vipo_device.descriptions import td_schema
from vipo_device.descriptions.forms import BadDescription
from vipo_device.descriptions.reader import write_description

THINGS = [json.loads(write_description(device, "td")) for device in describe_devices()]
WORDS = [
    "nosec",
    "basic",
    "mqtt",
    "writeProperty",
    "2026-11-22T00:00:00Z",
    "no date",
    "de-AT",
    "/%2",
    "http://[",
    "1e3",
]
VALUES = st.one_of(
    st.none(),
    st.booleans(),
    st.integers(-(2**53), 2**53),
    st.floats(allow_nan=False, allow_infinity=False),
    st.sampled_from(WORDS) | st.text(max_size=5),
    st.sampled_from([[], {}, [1], ["a", "a"], {"scheme": "nosec"}, {"type": "integer", "minimum": 1.0}, [{}]]).map(
        deepcopy
    ),
)
KEYS = st.sampled_from(
    ["@context", "@type", "title", "titles", "forms", "op", "version", "created", "security", "links"]
)


def places(value: Any, path: tuple[Any, ...] = ()) -> list[tuple[Any, ...]]:
    items = value.items() if isinstance(value, dict) else enumerate(value) if isinstance(value, list) else ()
    return [path, *(inner for key, each in items for inner in places(each, (*path, key)))]


@settings(max_examples=200, deadline=None)
@given(thing=st.sampled_from(THINGS), data=st.data())
def test_the_quick_validator_thinks_as_the_thorough_one_does(thing: Any, data: st.DataObject) -> None:
    body = json.loads(json.dumps(thing))
    for _ in range(data.draw(st.integers(1, 2))):
        *path, last = data.draw(st.sampled_from(places(body)[1:]))
        inside: Any = body
        for key in path:
            inside = inside[key]
        kind = data.draw(st.sampled_from(["other", "gone", "more"]))
        if kind == "gone":
            del inside[last]
        elif kind == "more" and isinstance(inside, dict):
            inside[data.draw(KEYS)] = data.draw(VALUES)
        else:
            inside[last] = data.draw(VALUES)
    assert td_schema._quick().is_valid(body) == td_schema._thorough().is_valid(body)


@pytest.mark.parametrize("thing", THINGS[:1])
def test_what_is_wrong_is_said_with_its_path(thing: Any) -> None:
    td_schema.check_thing(thing)
    with pytest.raises(BadDescription, match="no Thing Description") as refusal:
        td_schema.check_thing({**thing, "title": 3, "forms": [{}]})
    assert {fault.path for fault in refusal.value.faults} >= {"/title"}
