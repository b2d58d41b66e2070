"""Ten people who edit one program at the same time: real y-websocket clients against the real server."""

from __future__ import annotations

import json
import subprocess
import tempfile
from collections.abc import Iterator
from pathlib import Path

from bench.figures import figure, share
from tests.integration.editor.node_clients import MODULES
from tests.kit.servers import find_program
from tests.kit.web import Web, prepare

CLIENTS, PER_SECOND, SECONDS = 10, 10, 5


def measure() -> Iterator[dict[str, object]]:
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        web = Web(folder, **prepare(folder, {}))
        web.start()
        try:
            seen = _edit_together(web)
        finally:
            web.kill()
    facts = {"clients": CLIENTS, "updates_per_s": CLIENTS * PER_SECOND, "seconds": SECONDS}
    wanted = CLIENTS * (CLIENTS - 1) * PER_SECOND * SECONDS
    delays = seen["delays_ms"]
    yield figure("updates that reached everybody", len(delays) / wanted, "share", **facts)
    yield figure("documents that are alike at the end", seen["alike"], "documents", **facts)
    for name, quantile in (("p50", 0.5), ("p99", 0.99)):
        yield figure(f"from one person's edit to another's screen, {name}", share(delays, quantile), "ms", **facts)


def _edit_together(web: Web) -> dict[str, list[float]]:
    sessions = [web.sessions["author" if number % 2 else "second"] for number in range(CLIENTS)]
    config = {
        "program": web.new_program(), "port": web.port, "sessions": sessions,
        "perSecond": PER_SECOND, "seconds": SECONDS,
    }  # fmt: skip
    script = Path(__file__).with_name("rooms_clients.mjs")
    done = subprocess.run(
        [find_program("node"), script, str(MODULES), json.dumps(config)], capture_output=True, text=True, timeout=120
    )
    assert done.returncode == 0, f"{done.stderr}\n{web.story()[-3000:]}"
    seen: dict[str, list[float]] = json.loads(done.stdout)
    return seen
