"""Drives real y-websocket clients in a Node process."""

from __future__ import annotations

import json
import subprocess
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

from tests.kit.files import ROOT
from tests.kit.servers import find_program
from tests.kit.web import Web

MODULES = ROOT / "frontend"


class NodeClients:
    """Sends commands to the Node process and waits for each one's answer."""

    def __init__(self, process: subprocess.Popen[str], web: Web) -> None:
        self._process = process
        self._web = web

    def tell(self, do: str, **command: Any) -> dict[str, Any]:
        assert self._process.stdin is not None
        assert self._process.stdout is not None
        self._process.stdin.write(json.dumps({"do": do, **command}) + "\n")
        self._process.stdin.flush()
        answer: dict[str, Any] = json.loads(self._process.stdout.readline() or '{"ok": false, "error": "node ended"}')
        assert answer.pop("ok"), f"{do}: {answer}\n{self._web.story()[-3000:]}"
        return answer

    def open(self, name: str, person: str = "author", web: Web | None = None, **more: Any) -> dict[str, Any]:
        at = web or self._web
        return self.tell("open", name=name, session=at.sessions[person], port=at.port, **more)


@contextmanager
def node_clients(web: Web, program: str) -> Iterator[NodeClients]:
    with node_process(web, Path(__file__).with_name("node_client.mjs"), program=program) as clients:
        yield clients


@contextmanager
def node_process(web: Web, script: Path, **config: Any) -> Iterator[NodeClients]:
    """Run a script of clients that takes one command a line."""
    node = find_program("node")
    assert (MODULES / "node_modules" / "y-websocket").exists(), "Run `npm ci` in frontend/ first."
    process = subprocess.Popen(
        [node, script, str(MODULES), json.dumps(config)], stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True
    )
    try:
        yield NodeClients(process, web)
    finally:
        assert process.stdin is not None
        process.stdin.close()
        process.wait(10)
        assert process.stdout is not None
        process.stdout.close()
