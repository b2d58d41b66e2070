"""An MTConnect agent for tests, that keeps to the standard's protocol and can be made to misbehave; its connector."""

from __future__ import annotations

import threading
import time
from collections.abc import Callable
from contextlib import suppress
from http.server import BaseHTTPRequestHandler, ThreadingHTTPServer
from pathlib import Path
from urllib.parse import parse_qs, urlsplit

from tests.integration.connectors.connector_process import ConnectorProcess
from tests.kit.servers import Mosquitto
from tests.unit.connectors import mtconnect_words as words

Misbehaviour = Callable[["Handler"], None]


class ScriptedAgent:
    """Observations are numbered from 1 in each life; the buffer keeps the last `keeps` of them."""

    def __init__(self, version: str = "1.2", keeps: int = 1000) -> None:
        self.version, self.keeps = version, keeps
        self.instance, self.port = 1, 0
        self.misbehave: Misbehaviour | None = None
        self._said: list[str] = []
        self._lock = threading.Lock()
        self._server: ThreadingHTTPServer | None = None

    def start(self) -> None:
        agent = self

        class Bound(Handler):
            script = agent

        self._server = ThreadingHTTPServer(("127.0.0.1", self.port), Bound)
        self._server.daemon_threads = True
        self.port = self._server.server_address[1]
        threading.Thread(target=self._server.serve_forever, kwargs={"poll_interval": 0.02}, daemon=True).start()

    def stop(self) -> None:
        assert self._server is not None
        self._server.shutdown()
        self._server.server_close()

    def restart(self) -> None:
        """Begin a new life, in which nothing was said."""
        with self._lock:
            self.instance += 1
            self._said.clear()

    def say(self, item: str, text: str, **more: str) -> None:
        with self._lock:
            self._say(item, text, **more)

    def say_at_once(self, *said: tuple[str, str]) -> None:
        """Say all before anybody can ask."""
        with self._lock:
            for item, text in said:
                self._say(item, text)

    def _say(self, item: str, text: str, **more: str) -> None:
        self._said.append(words.told(item, text, len(self._said) + 1, **more))

    def answer(self, call: str, begin: int, count: int) -> tuple[int, bytes]:
        with self._lock:
            following = len(self._said) + 1
            first = max(1, following - self.keeps)
            if call == "probe":
                return 200, words.probe(instance=self.instance, version=self.version)
            if call == "current":
                last = {text.split('dataItemId="')[1].split('"')[0]: text for text in self._said}
                head = words.header(self.instance, first, following, self.keeps)
                return 200, words.streams(*last.values(), head=head, version=self.version)
            if not first <= begin <= following or count > self.keeps:
                return 404, words.refusal("OUT_OF_RANGE", instance=self.instance)
            told = self._said[begin - 1 : begin - 1 + count]
            head = words.header(self.instance, first, following, self.keeps).replace(
                f'nextSequence="{following}"', f'nextSequence="{begin + len(told)}"'
            )
            return 200, words.streams(*told, head=head, version=self.version)


class Handler(BaseHTTPRequestHandler):
    """One question."""

    script: ScriptedAgent

    def do_GET(self) -> None:
        (self.script.misbehave or Handler.reply)(self)

    def reply(self) -> None:
        parts = urlsplit(self.path)
        query = {name: int(values[0]) for name, values in parse_qs(parts.query).items()}
        call = parts.path.rpartition("/")[2]
        status, body = self.script.answer(call, query.get("from", 1), query.get("count", 100))
        self.send(body, status)

    def send(self, body: bytes, status: int = 200, **headers: str) -> None:
        self.send_response(status)
        for name, value in {"Content_Type": "text/xml", "Content_Length": str(len(body)), **headers}.items():
            self.send_header(name.replace("_", "-"), value)
        self.end_headers()
        self.wfile.write(body)

    def drip(self) -> None:
        """Send a byte now and then, for ever."""
        self.send_response(200)
        self.send_header("Content-Type", "text/xml")
        self.end_headers()
        with suppress(OSError):
            while True:
                self.wfile.write(b" ")
                self.wfile.flush()
                time.sleep(0.05)

    def log_message(self, *_: object) -> None:
        """Stay silent."""


class MachineConnector(ConnectorProcess):
    """The connector of the agent's machines."""

    def __init__(self, folder: Path, vipo: Mosquitto, agent: str, more: tuple[str, ...] = ()) -> None:
        super().__init__(folder, vipo, ("mtconnect", "--interval", "0.1", "--agent", agent, *more))
