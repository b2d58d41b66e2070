"""Yjs updates put together byte by byte, and those that do harm to who reads them trustingly."""

from __future__ import annotations

from collections.abc import Sequence

from editor.documents.yjs_encoding import encode_integer, encode_sized

FAR = 2**53 - 1
ONE = b"\x7e"
"""The value null."""


def update(clients: Sequence[bytes], gone: bytes = b"\x00", count: int | None = None) -> bytes:
    """Return an update of what these clients did; `gone` are its deletions, `count` how many it says there are."""
    return encode_integer(len(clients) if count is None else count) + b"".join(clients) + gone


def client(changes: Sequence[bytes], number: int = 1, clock: int = 0, count: int | None = None) -> bytes:
    """Return what one client did from a clock on."""
    head = encode_integer(len(changes) if count is None else count) + encode_integer(number) + encode_integer(clock)
    return head + b"".join(changes)


def change(content: bytes, root: bytes = b"steps", key: bytes = b"a") -> bytes:
    """Return a change that writes a key of a root; content begins with its kind."""
    return bytes([content[0] | 0x20, 1]) + encode_sized(root) + encode_sized(key) + content[1:]


def child(content: bytes, parent: int, number: int = 1) -> bytes:
    """Return a change that writes a key of the shared map that a client made at a clock."""
    place = b"\x00" + encode_integer(number) + encode_integer(parent)
    return bytes([content[0] | 0x20]) + place + encode_sized(b"a") + content[1:]


def anything(value: bytes) -> bytes:
    """Return the content that is one value of lib0."""
    return b"\x08\x01" + value


def shared_map() -> bytes:
    """Return the content that is a shared map."""
    return b"\x07\x01"


def _one(content: bytes) -> bytes:
    return update([client([change(content)])])


_HUGE, _OVER = encode_integer(FAR), encode_integer(2**32 - 1)
HOSTILE = {
    "2^53 clients": update([], count=FAR),
    "2^53 changes": update([client([], count=FAR)]),
    "2^28 changes": update([client([], count=2**28)]),
    "a client of 2^53": update([client([change(anything(ONE))], number=2**53)]),
    "a client without end": b"\x01\x01" + b"\xff" * 20 + b"\x00\x00",
    "a clock of 2^53": update([client([change(anything(ONE))], clock=2**53)]),
    "a clock of 2^32": update([client([change(anything(ONE))], clock=2**32 - 1)]),
    "a clock that runs over": update([client([b"\x00" + _OVER, change(anything(ONE)), change(anything(ONE))])]),
    "a clock below nothing": update([client([change(anything(ONE))], clock=2**64 - 1)]),
    "a hundred thousand clients": update([client([change(anything(ONE))], number=n) for n in range(100_000)]),
    "roots that no program has": update([client([change(anything(ONE), root=b"r")])]),
    "deletions of 2^53 clients": update([], gone=_HUGE),
    "2^53 deletions": update([], gone=b"\x01\x01" + _HUGE),
    "a deletion of 2^32": update([], gone=b"\x01\x01\x01\x00" + _OVER),
    "a million deletions": update([], gone=b"\x01\x01" + encode_integer(1_000_000) + b"\x01\x01" * 1_000_000),
    "a text of 2^53": _one(b"\x04" + _HUGE),
    "bytes of 2^53": _one(b"\x03" + _HUGE),
    "2^53 values": _one(b"\x08" + _HUGE),
    "a list of 2^53": _one(anything(b"\x75" + _HUGE)),
    "an object of 2^53": _one(anything(b"\x76" + _HUGE)),
    "lists in lists": _one(anything(b"\x75\x01" * 100_000 + ONE)),
    "objects in objects": _one(anything(b"\x76\x01\x01a" * 100_000 + ONE)),
    "a value that is cut off": _one(anything(b"\x75\x02" + ONE)),
    "a number without end": _one(anything(b"\x7d" + b"\xff" * 20)),
    "a value of no kind": _one(anything(b"\x10")),
    "half a character": _one(b"\x04" + encode_sized(b"\xed\xa0\x80")),
    "a document within": _one(b"\x09" + encode_sized(b"g") + b"\x75\x01" * 100_000 + ONE),
    "a type that no program has": _one(b"\x07\x03" + encode_sized(b"p")),
    "a content of no kind": _one(b"\x1f"),
    "maps in maps": update([client([change(shared_map()), *(child(shared_map(), n) for n in range(10_000))])]),
    "something behind": update([]) + b"\x00",
    "nothing": b"",
}
"""What must be refused before it is read by others, by its name."""
