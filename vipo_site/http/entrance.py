"""What holds before a request is anybody's: where it came from, which pages may open sockets, who reads its forms.

A proxy says in X-Forwarded-For and X-Forwarded-Proto who asked and how. Anybody can write these headers, so they are
read only where the connection comes from an address that VIPO_PROXIES names. Behind this, `REMOTE_ADDR` of a request
and `client` of a socket can be relied on, and `scheme` is what the browser spoke; nobody else reads these headers.
"""

from __future__ import annotations

from collections.abc import Awaitable, Callable, Mapping, Sequence
from functools import partialmethod
from ipaddress import ip_address
from typing import Any
from urllib.parse import SplitResult, urlsplit

from daphne.http_protocol import WebRequest
from django.http.request import split_domain_port, validate_host

from vipo_site.environment import Network

Scope = Mapping[str, Any]
Application = Callable[[Any, Any, Any], Awaitable[None]]
_PORTS = {"http": 80, "https": 443, "ws": 80, "wss": 443}
_PAGE_OF = {"ws": "http", "wss": "https"}


class BehindProxies:
    """Tells the application who asked, as the named proxies say it; without any, as the connection says it."""

    def __init__(self, application: Application, proxies: Sequence[Network]) -> None:
        self._application = application
        self._proxies = proxies

    async def __call__(self, scope: Scope, receive: Any, send: Any) -> None:
        """Pass a request on, with its true origin."""
        client = scope.get("client")
        if client and self._is_named(client[0]):
            scope = {**scope, **self._said_by_proxy(scope)}
        await self._application(scope, receive, send)

    def _said_by_proxy(self, scope: Scope) -> dict[str, Any]:
        said: dict[str, Any] = {}
        hops = [hop.strip() for line in header_lines(scope, b"x-forwarded-for") for hop in line.split(",")]
        # Each proxy adds the address that it saw at the end, so the last one that is no proxy is who asked; what
        # stands before it is what they say of themselves.
        if asked := next((hop for hop in reversed(hops) if not self._is_named(hop)), ""):
            said["client"] = [asked if _is_address(asked) else scope["client"][0], 0]
        schemes = header_lines(scope, b"x-forwarded-proto")
        if schemes and schemes[-1] in ("http", "https"):
            is_socket, is_safe = scope["type"] == "websocket", schemes[-1] == "https"
            said["scheme"] = ("wss" if is_safe else "ws") if is_socket else schemes[-1]
        return said

    def _is_named(self, address: str) -> bool:
        if not _is_address(address):
            return False
        known = ip_address(address)
        known = getattr(known, "ipv4_mapped", None) or known
        return any(known in network for network in self._proxies)


class OwnPagesOnly:
    """Opens sockets for pages of this very address alone: same scheme, host and port, or an origin that was named."""

    def __init__(self, application: Application, hosts: Sequence[str], origins: Sequence[str]) -> None:
        self._application = application
        self._hosts = hosts
        self._origins = frozenset(place for place in (_place(origin) for origin in origins) if place)

    async def __call__(self, scope: Scope, receive: Any, send: Any) -> None:
        """Open the socket, or refuse it as HTTP refuses: 403."""
        if self._may_open(scope):
            await self._application(scope, receive, send)
        else:
            await receive()
            await send({"type": "websocket.close"})

    def _may_open(self, scope: Scope) -> bool:
        origins, hosts = header_lines(scope, b"origin"), header_lines(scope, b"host")
        if len(origins) != 1 or len(hosts) != 1 or not validate_host(split_domain_port(hosts[0])[0], self._hosts):
            return False
        scheme = scope.get("scheme", "ws")
        here = _place(f"{_PAGE_OF.get(scheme, scheme)}://{hosts[0]}")
        there = _place(origins[0])
        return there is not None and (there == here or there in self._origins)


def header_lines(scope: Scope, name: bytes) -> list[str]:
    """Return what the lines of this header say, in their order."""
    return [value.decode("latin-1").strip() for key, value in scope.get("headers", ()) if key.lower() == name]


def _is_address(text: str) -> bool:
    try:
        ip_address(text)
    except ValueError:
        return False
    return True


def _place(origin: str) -> tuple[str, str, int] | None:
    """Return scheme, host and port of an origin; None for what is none."""
    try:
        parts: SplitResult = urlsplit(origin)
        port = parts.port or _PORTS.get(parts.scheme, 0)
    except ValueError:
        return None
    if parts.path or parts.query or parts.fragment or not parts.hostname or parts.username is not None:
        return None
    return parts.scheme, parts.hostname, port


def leave_forms_to_django() -> None:
    """Have Daphne's Twisted hand on forms as they came, since Django reads them.

    By itself Twisted reads each form as e-mail, in the loop that serves everybody (a third of a second for 16 MiB), and
    answers what it cannot read with 400 and not a word, a form without fields too.
    """
    WebRequest.__init__ = partialmethod(WebRequest.__init__, parsePOSTFormSubmission=False)
