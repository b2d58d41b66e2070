"""Whose word on where a request came from is believed, and which pages may open sockets."""

from __future__ import annotations

import asyncio
from ipaddress import ip_network
from typing import Any

import pytest

from vipo_site.http.entrance import BehindProxies, OwnPagesOnly

PROXIES = (ip_network("10.0.0.2"), ip_network("fd00::/48"))


def arrive(client: Any, kind: str = "http", **headers: str | list[str]) -> dict[str, Any]:
    """Return how a request comes out behind the entrance that trusts PROXIES."""
    seen: list[dict[str, Any]] = []

    async def inner(scope: dict[str, Any], _receive: Any, _send: Any) -> None:
        seen.append(scope)

    entrance = BehindProxies(inner, PROXIES)  # type: ignore[arg-type]
    lines = [
        (name.replace("_", "-").encode(), line.encode())
        for name, value in headers.items()
        for line in ([value] if isinstance(value, str) else value)
    ]
    scope = {"type": kind, "client": client, "scheme": "ws" if kind == "websocket" else "http", "headers": lines}
    asyncio.run(entrance(scope, None, None))
    return seen[0]


@pytest.mark.parametrize(
    "client", [["203.0.113.9", 5000], ["10.0.0.3", 1], ["127.0.0.1", 1], ["::1", 1], None, ["", 0]]
)
def test_headers_of_strangers_are_not_believed(client: Any) -> None:
    scope = arrive(client, x_forwarded_for="1.2.3.4", x_forwarded_proto="https")
    assert (scope["client"], scope["scheme"]) == (client, "http")


@pytest.mark.parametrize("proxy", ["10.0.0.2", "::ffff:10.0.0.2", "fd00::7"])
def test_a_named_proxy_says_who_asked_and_how(proxy: str) -> None:
    scope = arrive([proxy, 4000], x_forwarded_for="203.0.113.7", x_forwarded_proto="https")
    assert (scope["client"], scope["scheme"]) == (["203.0.113.7", 0], "https")
    socket = arrive([proxy, 4000], "websocket", x_forwarded_for="2001:db8::1", x_forwarded_proto="https")
    assert (socket["client"], socket["scheme"]) == (["2001:db8::1", 0], "wss")


@pytest.mark.parametrize(
    "said", ["1.2.3.4, 203.0.113.7", ["1.2.3.4", "203.0.113.7"], "1.2.3.4, 203.0.113.7, 10.0.0.2", "x, 203.0.113.7"]
)
def test_what_stands_before_the_last_stranger_is_not_believed(said: str | list[str]) -> None:
    assert arrive(["10.0.0.2", 4000], x_forwarded_for=said)["client"] == ["203.0.113.7", 0]


@pytest.mark.parametrize("said", ["", "nonsense", "1.2.3.4, nonsense", "10.0.0.2", "203.0.113.7:80", ","])
def test_an_address_that_is_none_leaves_the_proxys_own(said: str) -> None:
    assert arrive(["10.0.0.2", 4000], x_forwarded_for=said)["client"][0] == "10.0.0.2"


@pytest.mark.parametrize("scheme", ["", "ftp", "HTTPS", "https, http", "javascript"])
def test_a_scheme_that_is_none_is_not_believed(scheme: str) -> None:
    assert arrive(["10.0.0.2", 4000], x_forwarded_proto=scheme)["scheme"] == "http"


def opens(origin: str | list[str] | None, *, host: str = "vipo.example", scheme: str = "wss") -> bool:
    """Tell whether a page of this origin gets a socket."""
    opened: list[dict[str, Any]] = []

    async def inner(scope: dict[str, Any], _receive: Any, _send: Any) -> None:
        opened.append(scope)

    guard = OwnPagesOnly(inner, ["vipo.example", "localhost"], ["https://other.example:8443"])  # type: ignore[arg-type]
    origins = [] if origin is None else [origin] if isinstance(origin, str) else origin
    headers = [(b"host", host.encode()), *((b"origin", line.encode()) for line in origins)]
    sent: list[dict[str, Any]] = []

    async def receive() -> dict[str, Any]:
        return {"type": "websocket.connect"}

    async def send(message: dict[str, Any]) -> None:
        sent.append(message)

    asyncio.run(guard({"type": "websocket", "scheme": scheme, "headers": headers, "path": "/"}, receive, send))
    assert [message["type"] for message in sent] == ([] if opened else ["websocket.close"])
    return bool(opened)


@pytest.mark.parametrize(
    ("origin", "host", "scheme"),
    [
        ("https://vipo.example", "vipo.example", "wss"),
        ("https://vipo.example:443", "vipo.example", "wss"),
        ("https://VIPO.example", "vipo.example:443", "wss"),
        ("http://localhost:8000", "localhost:8000", "ws"),
        ("https://other.example:8443", "vipo.example", "wss"),
    ],
)
def test_a_page_of_this_address_opens_sockets(origin: str, host: str, scheme: str) -> None:
    assert opens(origin, host=host, scheme=scheme)


@pytest.mark.parametrize(
    ("origin", "host", "scheme"),
    [
        ("http://vipo.example", "vipo.example", "wss"),
        ("https://vipo.example:8443", "vipo.example", "wss"),
        ("https://localhost", "vipo.example", "wss"),
        ("http://localhost:3000", "localhost:8000", "ws"),
        ("https://evil.example", "vipo.example", "wss"),
        ("https://evil.example", "evil.example", "wss"),
        ("https://vipo.example.evil.example", "vipo.example", "wss"),
        ("https://vipo.example@evil.example", "vipo.example", "wss"),
        ("https://evil.example@vipo.example", "vipo.example", "wss"),
        ("https://vipo.example:x", "vipo.example", "wss"),
        ("null", "vipo.example", "wss"),
        ("", "vipo.example", "wss"),
        (None, "vipo.example", "wss"),
        (["https://vipo.example", "https://evil.example"], "vipo.example", "wss"),
    ],
)
def test_no_other_page_opens_one(origin: Any, host: str, scheme: str) -> None:
    assert not opens(origin, host=host, scheme=scheme)
