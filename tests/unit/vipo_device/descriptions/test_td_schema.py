"""What is wrong with a Thing is said in a sentence, with its place; whatever is sent as one."""

from __future__ import annotations

import json
from copy import deepcopy
from typing import Any

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from registry.demo.devices import describe_devices
from tests.kit.programs import paths_in
from vipo_device.descriptions import td_schema
from vipo_device.descriptions.forms import BadDescription
from vipo_device.descriptions.reader import write_description
from vipo_device.protocol.faults import Fault

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


@settings(max_examples=200, deadline=None)
@given(thing=st.sampled_from(THINGS), data=st.data())
def test_a_thing_is_taken_or_told_what_is_wrong_and_where(thing: Any, data: st.DataObject) -> None:
    body = json.loads(json.dumps(thing))
    for _ in range(data.draw(st.integers(1, 2))):
        *path, last = data.draw(st.sampled_from(paths_in(body)[1:]))
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
    faults = faults_of(body)
    assert (faults == ()) is td_schema._validator().is_valid(body)
    assert len(faults) <= td_schema.MOST_FAULTS
    assert {fault.path for fault in faults} <= {pointer(path) for path in paths_in(body)}


def faults_of(thing: Any) -> tuple[Fault, ...]:
    try:
        td_schema.check_thing(thing)
    except BadDescription as refusal:
        return refusal.faults
    return ()


def pointer(path: tuple[Any, ...]) -> str:
    return "".join("/" + str(part).replace("~", "~0").replace("/", "~1") for part in path)


def test_the_schema_refuses_with_a_heading_of_its_own() -> None:
    with pytest.raises(BadDescription, match=r"no Thing Description 1\.1"):
        td_schema.check_thing({**THINGS[0], "title": 3})


@pytest.mark.parametrize(
    ("change", "told"),
    [
        ({"title": 3}, [("/title", "3 is not of type string.")]),
        ({"title": None, "created": True}, [("/created", "True is not of type string."),
                                            ("/title", "None is not of type string.")]),
        ({"forms": [{"op": "readallproperties"}]}, [("/forms/0", "'href' is a required property.")]),
        ({"properties": {"a/b~c": {"forms": []}}}, [("/properties/a~1b~0c/forms", "[] should be non-empty.")]),
        ({"properties": {"a": {}}}, [("/properties/a", "'forms' is a required property."
                                      ' Such as "forms": [{"href": "vipo/v1/dev/<id>/down/<action>"}].')]),
        ({"security": []}, [("/security", "[] should be non-empty.")]),
        ({"@type": 3}, [("/@type", "3 is not valid under any of the given schemas.")]),
        ({"properties": {"a": {"multipleOf": [1], "forms": [{"href": "x"}]}}},
         [("/properties/a/multipleOf", "[1] is not of type 'integer', 'number'.")]),
        ({"securityDefinitions": {"a": {"scheme": "odd", "in": "x" * 200}}},
         [("/securityDefinitions/a", "{'scheme': 'odd', 'in': '" + "x" * 35 + "…" + "x" * 54
           + "'} is not valid under any of the given schemas.")]),
        ({"title": 3, "@type": [4], "x:y": 5, "forms": 6},
         [("/forms", "6 is not of type array."), ("/title", "3 is not of type string."),
          ("/@type/0", "4 is not of type string.")]),
        ({"actions": {"a": {"forms": [{"op": "odd", "href": "x"}]}}},
         [("/actions/a/forms/0/op", "'odd' is not one of invokeaction, queryaction, cancelaction.")]),
    ],
)  # fmt: skip
def test_what_is_wrong_is_said_with_its_path(change: dict[str, Any], told: list[tuple[str, str]]) -> None:
    faults = faults_of({**THINGS[0], **change})
    assert [(fault.path, fault.text.removeprefix("The TD schema says: ")) for fault in faults] == told
