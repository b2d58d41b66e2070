"""Updates that take pycrdt down with the process, or keep it busy for minutes, are refused before it sees them."""

from __future__ import annotations

from collections.abc import Iterator

import pytest
from hypothesis import given
from hypothesis import strategies as st
from pycrdt import Array, Doc, Map, Text

from editor.documents.shared_document import ROOTS, BadUpdate, SharedDocument, empty_document, encode_document
from editor.documents.yjs_encoding import BadFrame, encode_integer
from editor.documents.yjs_updates import DEEPEST, MOST_CLIENTS, MOST_NESTED, MOST_PARTS, check_update
from tests.cases.hostile_updates import HOSTILE, anything, change, child, client, shared_map, update
from tests.kit.work import within_processor_time

NAMES = frozenset(root.encode() for root in ROOTS)


@pytest.mark.parametrize("sent", HOSTILE.values(), ids=HOSTILE.keys())
def test_what_no_client_of_a_program_sends_is_refused_at_once(sent: bytes) -> None:
    with within_processor_time(2.0), pytest.raises(BadFrame):
        check_update(sent, NAMES)


@pytest.mark.parametrize(
    "sent",
    {
        "a value": update([client([change(anything(b"\x7e"))])]),
        "nested values": update([client([change(anything(b"\x75\x01" * (DEEPEST - 1) + b"\x7e"))])]),
        "many authors": update([client([change(anything(b"\x7e"))], number=n) for n in range(MOST_CLIENTS)]),
        "many values": update([client([change(anything(b"\x75" + encode_integer(19_000) + b"\x7e" * 19_000))])]),
    }.values(),
)
def test_what_is_within_the_bounds_is_taken_by_both(sent: bytes) -> None:
    check_update(sent, NAMES)
    SharedDocument().apply(sent)


def test_what_real_documents_say_is_taken() -> None:
    document: Doc[object] = Doc()
    for name in ROOTS:
        root = document.get(name, type=Map)
        root["a"] = Map({"text": Text("aä😀"), "list": Array([1, -(2**40), 2.5, True, None, "x", b"y", {"a": [{}]}])})
        root["a"]["text"].insert(1, "more")
        root["a"]["text"].format(0, 2, {"bold": True})
        del root["a"]["list"][0]
        root["b"] = 1
        del root["b"]
    check_update(document.get_update(), NAMES)
    check_update(encode_document({**empty_document(), "steps": {"a": {"kind": "wait", "place": None}}}), NAMES)


def test_shared_parts_do_not_grow_deep_by_many_small_updates() -> None:
    document = SharedDocument()
    half = MOST_NESTED // 2
    for number in range(5):
        document.apply(nested_maps(half, half * number))
    with pytest.raises(BadUpdate, match="too deep"):
        document.apply(nested_maps(half, half * 5))
    assert len(document.to_json()["steps"]) == 1


def nested_maps(number: int, begin: int) -> bytes:
    """Return an update with maps in each other, the first in the one that was made last before."""
    made = [child(shared_map(), begin + each - 1) if begin + each else change(shared_map()) for each in range(number)]
    return update([client(made, clock=begin)])


def pieces() -> Iterator[bytes]:
    yield from (bytes([number]) for number in (0, 1, 2, 7, 8, 0x27, 0x28, 0x75, 0x76, 0x77, 0x7D, 0x7E, 0x80, 0xFF))
    yield from (b"\x05steps", b"\x01a", b"\xff\xff\xff\xff\x0f", b"\xff\xff\xff\xff\xff\xff\xff\x0f")


@given(st.lists(st.sampled_from(sorted(pieces())), max_size=60).map(b"".join))
def test_no_bytes_do_harm_to_a_document(sent: bytes) -> None:
    document = SharedDocument([encode_document({**empty_document(), "steps": {"a": {"kind": "wait"}}})])
    try:
        check_update(sent, NAMES)
        document.apply(sent)
    except (BadFrame, BadUpdate):
        assert set(document.to_json()["steps"]) == {"a"}
    assert SharedDocument([document.encode()]).to_json() == document.to_json()


def test_as_many_parts_as_are_taken_are_read_within_seconds() -> None:
    ranges = b"".join(b"\x01\x01" for _ in range(MOST_PARTS - 2))
    with within_processor_time(6.0):
        check_update(update([], gone=b"\x01\x01" + number_of(MOST_PARTS - 2) + ranges), NAMES)


def number_of(value: int) -> bytes:
    return bytes((value & 0x7F | 0x80, value >> 7 & 0x7F | 0x80, value >> 14))
