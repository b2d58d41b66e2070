"""Asking an agent over HTTP: one address, no redirects, and bounded in bytes and time whatever it sends."""

from __future__ import annotations

import base64
import re
import socket
import ssl
import threading
from collections.abc import Iterator, Mapping
from contextlib import closing, contextmanager, suppress
from dataclasses import dataclass, field
from http.client import HTTPConnection, HTTPException, HTTPResponse, HTTPSConnection
from urllib.parse import quote, unquote, urlencode, urlsplit

from connectors.mtconnect.documents import MOST_BYTES, BadDocument, Document, read_document

LIMIT_S = 20.0
PIECE = 65_536
_HEADER = re.compile(r"([A-Za-z0-9-]{1,64}):[ \t]*([\x21-\x7e][\x20-\x7e]{0,4000})")


class AgentAway(Exception):
    """An agent did not answer as one; the sentence says how."""


class BadAddress(ValueError):
    """An address that cannot be asked; the sentence says why."""


@dataclass(frozen=True, slots=True)
class Address:
    """Where an agent is asked, and the headers that are sent along."""

    host: str
    port: int
    path: str
    tls: ssl.SSLContext | None = None
    headers: Mapping[str, str] = field(default_factory=dict)


def read_address(url: str, *, password: str = "", authority: str = "", headers: str = "") -> Address:
    """Read http://name@host:port/path/ and lines of headers; `authority` is a certificate's file. Raises BadAddress."""
    try:
        parts = urlsplit(url)
        port = parts.port
    except ValueError as error:
        raise BadAddress(f"{url[:80]!r} is no address: {error}.") from error
    if parts.scheme not in {"http", "https"} or not parts.hostname or parts.query or parts.fragment:
        raise BadAddress(f"{url[:80]!r} is not an agent's address; say http://host:5000/ or https://host/path/.")
    sent = _read_headers(headers)
    if parts.username:
        word = f"{unquote(parts.username)}:{password or unquote(parts.password or '')}".encode()
        sent["Authorization"] = f"Basic {base64.b64encode(word).decode()}"
    is_safe = parts.scheme == "https"
    tls = ssl.create_default_context(cafile=authority or None) if is_safe else None
    path = quote(unquote(parts.path)).rstrip("/") + "/"
    return Address(parts.hostname, port or (443 if is_safe else 80), path, tls, sent)


def _read_headers(text: str) -> dict[str, str]:
    found = {}
    for number, line in enumerate(text.splitlines(), 1):
        header = _HEADER.fullmatch(line.strip())
        if line.strip() and header is None:
            raise BadAddress(f"Line {number} of the headers is not `Name: value`.")
        if header is not None:
            found[header[1]] = header[2]
    return found


class Agent:
    """An agent that is asked for documents."""

    def __init__(self, address: Address, limit_s: float = LIMIT_S) -> None:
        self._address, self._limit_s = address, limit_s

    def ask(self, call: str, **query: int) -> Document:
        """Return the answer to `probe`, `current` or `sample`. Raises AgentAway, BadDocument."""
        try:
            return read_document(self._fetch(call, query))
        except (OSError, HTTPException, ValueError) as error:
            raise AgentAway(f"{type(error).__name__}: {error}"[:200]) from error

    def _connection(self) -> HTTPConnection:
        where = self._address
        if where.tls is not None:
            return HTTPSConnection(where.host, where.port, timeout=self._limit_s, context=where.tls)
        return HTTPConnection(where.host, where.port, timeout=self._limit_s)

    def _fetch(self, call: str, query: Mapping[str, int]) -> bytes:
        asked = f"{self._address.path}{call}{'?' if query else ''}{urlencode(query)}"
        headers = {"Accept": "application/xml, text/xml", "Accept-Encoding": "identity", **self._address.headers}
        with closing(self._connection()) as connection:
            connection.connect()
            with _watched(connection.sock, self._limit_s):
                connection.request("GET", asked, headers=headers)
                with connection.getresponse() as response:
                    _check(response)
                    return _read(response)


@contextmanager
def _watched(sock: socket.socket, limit_s: float) -> Iterator[None]:
    """Cut a connection after a time: a server that sends a byte now and then never exceeds a socket's own limit."""
    watchdog = threading.Timer(limit_s, _cut, [sock])
    watchdog.daemon = True
    watchdog.start()
    try:
        yield
    finally:
        watchdog.cancel()


def _cut(sock: socket.socket) -> None:
    with suppress(OSError):
        sock.shutdown(socket.SHUT_RDWR)


def _check(response: HTTPResponse) -> None:
    kind = response.headers.get_content_type()
    if 300 <= response.status < 400:
        raise AgentAway(f"It sends elsewhere (status {response.status}); redirects are not followed.")
    if kind not in {"text/xml", "application/xml"}:
        raise AgentAway(f"It answers with {kind[:60]} (status {response.status}), not with XML.")
    if response.headers.get("Content-Encoding", "identity") != "identity":
        raise AgentAway("It packs its answer, which was not asked for.")


def _read(response: HTTPResponse) -> bytes:
    pieces, size = [], 0
    while piece := response.read1(PIECE):
        pieces.append(piece)
        size += len(piece)
        if size > MOST_BYTES:
            raise BadDocument(f"The document has more than {MOST_BYTES} bytes.")
    if response.length:
        raise AgentAway(f"Its answer breaks off {response.length} bytes before its end.")
    return b"".join(pieces)
