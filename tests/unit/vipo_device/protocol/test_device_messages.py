from __future__ import annotations

import json
from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st

from tests.kit.work import within_processor_time
from vipo_device.protocol.description import DeviceState, Pose
from vipo_device.protocol.messages import (
    AckMessage,
    BadMessage,
    Presence,
    ack_payload,
    command_payload,
    down_topic,
    is_device_id,
    parse_ack,
    parse_json,
    parse_plain_json,
    parse_presence,
    parse_state,
    presence_payload,
    read_up_topic,
    state_payload,
    up_topic,
)

STATE = {"boot": 1, "seq": 2, "done": True}


def test_what_is_written_is_read_again() -> None:
    state = DeviceState(
        7, 3, False, Pose(1.0, -2.0, 0.5, 0.25), "c-1", {"temperature": 31.2, "quality": "ok", "on": None}
    )
    ack = AckMessage("c-1", "FAILED", "empty", {"left": 0})
    assert parse_state(state_payload(state)) == state
    assert parse_ack(ack_payload(ack)) == ack
    assert parse_presence(presence_payload(Presence(False, 9))) == Presence(False, 9)
    assert json.loads(command_payload("c-2", {"time": 3}, 5.0)) == {"id": "c-2", "v": {"time": 3}, "ttl_s": 5.0}


def test_a_short_state_has_defaults() -> None:
    assert parse_state(b'{"boot":1,"seq":2,"done":true}') == DeviceState(1, 2, True)
    assert parse_state(b'{"boot":1,"seq":2,"done":true,"loc":[1,2,3]}').pose == Pose(1.0, 2.0, 3.0, 0.0)


def test_topics_are_made_and_read() -> None:
    assert up_topic("a.b-1", "state") == "vipo/v1/dev/a.b-1/up/state"
    assert down_topic("a", "mixPaint") == "vipo/v1/dev/a/down/mixPaint"
    assert read_up_topic("vipo/v1/dev/a.b-1/up/state") == ("a.b-1", "state")
    assert read_up_topic("vipo/v1/dev/a/b/up/state") is None
    assert read_up_topic("vipo/v1/dev/a/up/" + "x" * 16) == ("a", "x" * 16)
    assert read_up_topic("vipo/v1/dev/a/up/" + "x" * 17) is None
    assert read_up_topic("vipo/v1/dev/a/down/state") is None
    assert [is_device_id(i) for i in ("a", "A-1_.", "", "a/b", "a+", "x" * 65, "ä", "a\n")] == [True, True] + [
        False
    ] * 6


@pytest.mark.parametrize(
    ("payload", "says"),
    [
        (b"\xff", "not UTF-8"),
        (b"{", "not JSON"),
        (b'{"a":NaN}', "NaN"),
        (b'{"a":-Infinity}', "Infinity"),
        (b'{"a":1e999}', "too large"),
        (b'{"a":9007199254740993}', "too large"),
        (b'{"a":' + b"9" * 5000 + b"}", "too large"),
        (b'{"a":1,"a":2}', "twice"),
        (b'{"a":{"b":1,"b":1}}', "twice"),
        (b'{"a":"\\ud800"}', "surrogate"),
        (b'{"a":"\\u0000"}', "not text"),
        (b'{"\\u0000":1}', "not text"),
        (b"[" * 17 + b"]" * 17, "levels deep"),
        (b"[" * 9000, "levels deep"),
        (b'"' + b"x" * 16384 + b'"', "16384 is the most"),
    ],
)
def test_json_that_two_readers_could_understand_differently_is_refused(payload: bytes, says: str) -> None:
    with pytest.raises(BadMessage, match=says):
        parse_json(payload)


def test_brackets_within_text_are_not_depth() -> None:
    assert parse_json(json.dumps({"a": "[" * 100 + '\\"' + "{" * 100}).encode()) == {"a": "[" * 100 + '\\"' + "{" * 100}


@pytest.mark.parametrize("payload", [b'"' + b'\\"' * 250_000, b'{"a":1,"a":2} "' + b'\\"' * 250_000])
def test_a_text_that_nobody_closes_costs_what_its_length_does(payload: bytes) -> None:
    with within_processor_time(30), pytest.raises(BadMessage):  # each quote looked at from each: half an hour
        parse_plain_json(payload, max_bytes=1_000_000, max_depth=16)


def test_emoji_written_as_a_surrogate_pair_are_text() -> None:
    assert parse_json(b'"\\ud83d\\ude00"') == "\U0001f600"


@pytest.mark.parametrize(
    ("changes", "says"),
    [
        ({"boot": -1}, "`boot`"),
        ({"boot": True}, "`boot`"),
        ({"seq": 1.5}, "`seq`"),
        ({"seq": None}, "`seq`"),
        ({"done": 1}, "`done`"),
        ({"cmd": 4}, "`cmd`"),
        ({"cmd": "x" * 65}, "`cmd`"),
        ({"loc": [1, 2]}, "`loc`"),
        ({"loc": [1, 2, 3, "4"]}, "`loc`"),
        ({"loc": [1, 2, 3, True]}, "`loc`"),
        ({"loc": [1e7, 2, 3, 4]}, "`loc`"),
        ({"props": []}, "`props`"),
        ({"props": {"a": {}}}, "not a plain value"),
        ({"props": {"": 1}}, "not a plain value"),
        ({"props": {"a": "x" * 257}}, "more than 256"),
        ({"props": {str(i): i for i in range(65)}}, "at most 64"),
    ],
)
def test_a_state_that_does_not_fit_is_refused(changes: dict[str, Any], says: str) -> None:
    with pytest.raises(BadMessage, match=says):
        parse_state(json.dumps({**STATE, **changes}).encode())


@pytest.mark.parametrize("payload", [b"{}", b"[]", b'{"id":"","st":"DONE"}', b'{"id":"a","st":"OK"}', b'{"id":"a"}'])
def test_an_answer_that_does_not_fit_is_refused(payload: bytes) -> None:
    with pytest.raises(BadMessage):
        parse_ack(payload)


@pytest.mark.parametrize("payload", [b"{}", b'{"s":"away","boot":1}', b'{"s":"online"}', b'"online"'])
def test_presence_that_does_not_fit_is_refused(payload: bytes) -> None:
    with pytest.raises(BadMessage):
        parse_presence(payload)


@given(st.binary(max_size=200) | st.text(max_size=100).map(str.encode))
def test_no_bytes_bring_more_than_a_refusal(payload: bytes) -> None:
    refused = 0
    for parse in (parse_state, parse_ack, parse_presence):
        try:
            parse(payload)
        except BadMessage:
            refused += 1
    assert refused >= 2
