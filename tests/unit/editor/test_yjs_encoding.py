"""The decoder: what Yjs writes is read, all else is refused, quickly."""

from __future__ import annotations

import pytest
from hypothesis import given
from hypothesis import strategies as st

from editor.documents import yjs_encoding
from editor.rooms import yjs_protocol
from tests.kit.work import count_work

NUMBERS = st.integers(0, 2**53 - 1)


@given(NUMBERS)
def test_numbers_come_back(number: int) -> None:
    reader = yjs_encoding.Reader(yjs_encoding.encode_integer(number))
    assert reader.integer() == number
    reader.end()


@given(st.binary(max_size=300))
def test_no_bytes_make_it_fail_otherwise_than_by_refusing(data: bytes) -> None:
    try:
        message = yjs_protocol.decode_frame(data)
    except yjs_encoding.BadFrame:
        return
    assert isinstance(message, yjs_protocol.Message)


@given(st.dictionaries(NUMBERS, NUMBERS, max_size=20))
def test_state_vectors_come_back(clocks: dict[int, int]) -> None:
    assert yjs_encoding.decode_state_vector(yjs_encoding.encode_state_vector(clocks)) == clocks


@given(st.binary(max_size=100))
def test_sync_messages_come_back(data: bytes) -> None:
    assert yjs_protocol.decode_frame(yjs_protocol.encode_update(data)) == yjs_protocol.Update(data)
    assert yjs_protocol.decode_frame(yjs_protocol.encode_step_2(data)) == yjs_protocol.SyncStep2(data)


def test_awareness_comes_back() -> None:
    entries = (
        yjs_protocol.AwarenessEntry(2**32, 7, {"cursor": [1.5, None], "name": "Ä"}),
        yjs_protocol.AwarenessEntry(1, 0, None),
    )
    assert yjs_protocol.decode_frame(yjs_protocol.encode_awareness(entries)) == yjs_protocol.Awareness(entries)


@pytest.mark.parametrize("byte", [0xFF, 0x80])
def test_a_number_without_end_is_refused_at_once(byte: int) -> None:
    frame = bytes([byte]) * 2_000_000
    with pytest.raises(yjs_encoding.BadFrame, match="longer than 53 bits"), count_work() as work:
        yjs_protocol.decode_frame(frame)
    assert work.lines < 200, "of two million bytes only the first few are looked at"


@pytest.mark.parametrize(
    ("frame", "why"),
    [
        (b"", "ends within a number"),
        (b"\x00\x02\x05ab", "ends before it should"),
        (b"\x03x", "Something follows"),
        (b"\x02\x00\x00", "no message of type 2"),
        (b"\x01\x07\x01\x01\x01\x03NaN", "not JSON"),
        (b"\x01\x06\x01\x01\x01\x021 ", "not a JSON object"),
        (b"\x00\x00\x01\x05", "shorter than it says"),
    ],
)
def test_a_refusal_says_what_is_wrong(frame: bytes, why: str) -> None:
    with pytest.raises(yjs_encoding.BadFrame, match=why):
        yjs_protocol.decode_frame(frame)


def test_what_is_too_large_is_named_with_what_may_be_sent() -> None:
    state = bytes(yjs_protocol.MOST_STATE_VECTOR_BYTES + 1)
    for frame, told in (
        (
            yjs_protocol.encode_step_1(state),
            "The state vector has 524289 bytes; 524288 is the most. Send less at once.",
        ),
        (bytes(yjs_protocol.MOST_FRAME_BYTES + 1), "The message has 10485761 bytes; 10485760 is the most. "),
    ):
        with pytest.raises(yjs_encoding.FrameTooLarge, match=told):
            yjs_protocol.decode_frame(frame)


def test_deep_json_is_refused() -> None:
    deep = b"[" * 60_000
    body = b"\x01\x01\x01" + yjs_encoding.encode_integer(len(deep)) + deep
    with pytest.raises(yjs_encoding.BadFrame, match="not JSON"):
        yjs_protocol.decode_frame(b"\x01" + yjs_encoding.encode_integer(len(body)) + body)
