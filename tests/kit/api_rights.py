"""What who may do what is tried by: the product's own table of operations, and the addresses that stand beside it.

`registry.people.rights` claims what each operation needs; no operation reads that, each says with `require` what it
needs. So the tests, which ask every operation as everybody, hold one against the other.
"""

from __future__ import annotations

import json
from typing import Any

from registry.people.rights import RIGHTS as RIGHTS
from registry.people.rights import Right as Right
from tests.kit.files import ROOT

OPERATIONS: dict[str, dict[str, dict[str, Any]]] = json.loads((ROOT / "docs" / "openapi.json").read_text())["paths"]
"""Every operation as docs/openapi.json describes it, by its address and method."""


SOCKETS = {
    "ws/site/<slug:slug>": Right("viewer", "session"),
    "ws/program/<uuid:program>": Right("viewer", "session"),
    "ws/wall": Right("wall", "session"),
}
"""Who may open each socket, by its route; only who may draw is heard there, and no token opens one."""
DRAWS = Right("author", "session")
"""Whose changes are taken in a program's room."""
STREAMS = {
    "watch_things": "",
    "watch_value": "",
    "current": "?interval=1000",
    "sample": "?interval=1000",
    "current_of_device": "?interval=1000",
    "sample_of_device": "?interval=1000",
}
"""Operations that answer with a stream, and how they are asked for one; their rights stand in RIGHTS."""
STREAMED = ("text/event-stream", "multipart/x-mixed-replace")
_PERSON = Right("person", "read")
DIRECTORY = {
    "GET /.well-known/wot": Right("anybody", "anybody"),
    **dict.fromkeys(("OPTIONS /things", "OPTIONS /things/{thing}"), Right("anybody", "anybody")),
    **dict.fromkeys(("GET /things", "GET /events", "GET /events/{kind}"), _PERSON),
    **dict.fromkeys(("GET /search/{kind}", "POST /search/{kind}"), _PERSON),
    **dict.fromkeys((f"{method} /things" for method in ("POST", "PUT", "PATCH", "DELETE")), _PERSON),
    **dict.fromkeys((f"{method} /things/{{thing}}" for method in ("POST", "PUT", "DELETE")), _PERSON),
    "GET /things/{thing}": Right("viewer", "read"),
    "PATCH /things/{thing}": Right("admin", "admin"),
}
"""The directory of Things outside of /api; what a person lists and hears there is of their own sites alone.

That nothing is made or searched there is told to every person alike.
"""
