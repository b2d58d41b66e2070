"""What a child process and its parent say to each other: pickled objects with their length; nothing is a beat."""

from __future__ import annotations

import pickle
import struct
from typing import Any

HEAD = struct.Struct(">Q")
BEAT = HEAD.pack(0)


def encode_frame(said: Any) -> bytes:
    """Return the frame of an object."""
    body = pickle.dumps(said, protocol=pickle.HIGHEST_PROTOCOL)
    return HEAD.pack(len(body)) + body


def decode_body(body: bytes) -> Any:
    """Return the object of a frame's body. Only for what comes by the pipe between a process and its own child."""
    return pickle.loads(body)  # noqa: S301
