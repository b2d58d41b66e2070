"""Many people in one room: real y-websocket clients against our server, `@y/websocket-server` and Hocuspocus.

Compression is off on all. The peers keep nothing and check nothing; ours stores and compiles meanwhile. Beside each
time stands how long the server was at work, since the machine's pace swings, and how long the clients were, which
share the machine with it, and how many others wanted the processor (`load`, of the minute before).
"""

from __future__ import annotations

import json
import os
import subprocess
import tempfile
import time
from collections.abc import Iterator
from concurrent.futures import ThreadPoolExecutor
from contextlib import AbstractContextManager
from pathlib import Path
from typing import Any

from bench.blockly import what_is_missing
from bench.figures import figure, share
from bench.rooms.servers import AUTHORS, VIEWERS, Server, ours, peer
from tests.integration.editor.node_clients import MODULES
from tests.kit.servers import find_program

Json = dict[str, Any]
SECONDS, JOINS, SAVES, FLOODS, BESIDE_S = 4, 10, 40, 10, 6
FLOODS_OF = ("texts", "updates", "asks", "states", "presence", "noise", "coming")
REST_S = 6
"""Then the room is closed, since nobody is in it."""
READERS, LARGE = 300, 4_900
"""Of the 5,000 steps that there may be, some are left for those who draw."""


def measure() -> Iterator[dict[str, object]]:
    for seen in _figures():
        yield {**seen, "load": round(os.getloadavg()[0], 1)}


def _figures() -> Iterator[dict[str, object]]:
    with tempfile.TemporaryDirectory() as name:
        for count in (1, 2):
            folder = Path(name) / str(count)
            folder.mkdir()
            yield from _measure_server(ours(folder, count))
    missing = what_is_missing("@hocuspocus/server")
    for each in ("y-websocket", "hocuspocus"):
        if missing:
            yield {"what": f"{each}, the same", "skipped": missing}
        else:
            yield from _measure_server(peer(each))


def _measure_server(running: AbstractContextManager[Server]) -> Iterator[dict[str, object]]:
    with running as server:
        _clients(server, "together", writers=2, readers=0, perSecond=4, seconds=2)  # as one that has been at work
        yield from _editors(server)
        if len(server.webs) > 1:  # of these two it matters how many processes there are; a run shall end soon
            yield from _saves(server)
            return
        yield from _readers(server)
        yield from _joins(server)
        yield from _large(server)
        if server.webs:
            yield from _saves(server)
            yield from _flood(server)
            yield from _beside_floods(server)
            yield from _opening(server)


def _editors(server: Server) -> Iterator[dict[str, object]]:
    seen = _clients(server, "together", writers=30, readers=0, perSecond=10, seconds=SECONDS)
    yield from _delays(server, "30 editors x 10/s", seen)


def _readers(server: Server) -> Iterator[dict[str, object]]:
    seen = _clients(server, "together", writers=1, readers=READERS, perSecond=20, seconds=SECONDS)
    yield from _delays(server, f"{READERS} readers x 20/s", seen)


def _large(server: Server) -> Iterator[dict[str, object]]:
    """Ten pages, of which ours have the site's socket open, and ask for the compiled form."""
    seen = _clients(
        server, "together", writers=10, readers=0, perSecond=4, seconds=SECONDS, steps=LARGE, pages=bool(server.webs)
    )
    what = "10 editors x 4/s on 5,000 steps"
    yield from _delays(server, what, seen)
    if server.webs:
        more = {"server": server.name, "of_the_site": round(seen["site_bytes"])}
        yield figure(f"{what}: compiled form and site to each page for an edit", seen["page_bytes"], "bytes", **more)


def _delays(server: Server, what: str, seen: Json) -> Iterator[dict[str, object]]:
    delays, more = seen["delays_ms"], {"server": server.name, "server_cpu_s": seen["cpu_s"], "seconds": SECONDS,
                                       "clients_cpu_s": round(seen["clients_cpu_s"], 2)}  # fmt: skip
    yield figure(
        f"{what}: updates that arrived", len(delays) / seen["wanted"], "share",
        server=server.name, alike=seen["alike"], joined=seen["joined"], clients=seen["clients"],
    )  # fmt: skip
    yield figure(f"{what}: from an edit to another's screen, p50", share(delays, 0.5), "ms", **more)
    yield figure(f"{what}: from an edit to another's screen, p99", share(delays, 0.99), "ms", **more)


def _joins(server: Server) -> Iterator[dict[str, object]]:
    seen = _clients(server, "joining", steps=2000, rounds=JOINS)
    more = {"server": server.name, "server_cpu_s": seen["cpu_s"], "joins": JOINS}
    yield figure("join of 2,000 steps, p50", share(seen["took_ms"], 0.5), "ms", **more)


def _saves(server: Server) -> Iterator[dict[str, object]]:
    seen = _clients(server, "saving", rounds=SAVES)
    for name, quantile in (("p50", 0.5), ("p95", 0.95)):
        yield figure(f"from an edit to saved, {name}", share(seen["took_ms"], quantile), "ms", server=server.name)


def _flood(server: Server) -> Iterator[dict[str, object]]:
    before = server.memory_mb()
    seen = _clients(server, "flood", rounds=FLOODS, writers=FLOODS)  # somebody else each time: who has flooded waits
    time.sleep(REST_S)
    more = {"server": server.name, "before": round(before), "closed_with": sorted(set(seen["codes"]))}
    yield figure("memory after a flood", server.memory_mb(), "MB", **more)


def _beside_floods(server: Server) -> Iterator[dict[str, object]]:
    """What two people who draw feel of a third, who sends as much of one kind as goes out: somebody else each time."""
    for number, kind in enumerate(("nothing", *FLOODS_OF)):
        room = server.new_room(f"beside {kind}")
        with ThreadPoolExecutor(1) as pool:
            if kind == "nothing":
                flooding = None
            else:
                flooding = pool.submit(
                    _clients, server, "flooding", room, kind=kind, seconds=BESIDE_S + 3, person=AUTHORS - number
                )
                time.sleep(1.5)
            seen = _clients(server, "together", room, writers=2, readers=0, perSecond=10, seconds=BESIDE_S)
            told = flooding.result() if flooding else {"codes": {}, "sent": 0}
        more = {
            "server": server.name,
            "sent": told["sent"],
            "closed_with": told["codes"],
            "server_cpu_s": seen["cpu_s"],
        }
        yield figure(
            f"beside a flood of {kind}: updates that arrived", len(seen["delays_ms"]) / seen["wanted"], "share"
        )
        for name, quantile in (("p50", 0.5), ("p99", 0.99)):
            yield figure(
                f"beside a flood of {kind}: from an edit to another's screen, {name}",
                share(seen["delays_ms"], quantile), "ms", **more,
            )  # fmt: skip
    time.sleep(REST_S)


def _opening(server: Server) -> Iterator[dict[str, object]]:
    """In a process that has not seen the program yet."""
    room, other, web = server.new_room("large"), server.new_room("small"), server.webs[0]
    _clients(server, "only", room, steps=LARGE)
    web.kill()
    web.start()
    server.ports = [web.port]
    seen = _clients(server, "opening", room, other=other, steps=LARGE)
    more = {"server": server.name, "quiet_ms": round(seen["before_ms"], 1), "joined_ms": round(seen["joined_ms"], 1)}
    yield figure("opening 5,000 steps: the loop answers nobody for", seen["blocked_ms"], "ms", **more)


def _clients(server: Server, mode: str, room: str = "", **more: Any) -> Json:
    """Let the clients do their part; return what they saw, and how long the server was at work meanwhile."""
    writers, readers = more.get("writers", 1), more.get("readers", 0)
    viewers = server.people[AUTHORS:]
    first = more.pop("person", 0)
    sessions = server.people[first : first + writers] + [
        viewers[number % VIEWERS] for number in range(readers) if viewers
    ]
    config = {
        "mode": mode, "server": server.name, "ports": server.ports, "path": server.path, "site": "/ws/site/hall",
        "room": room or server.new_room(f"{mode} {more}"[:80]), "sessions": sessions, **more,
    }  # fmt: skip
    command = [find_program("node"), str(Path(__file__).with_name("clients.mjs")), str(MODULES), json.dumps(config)]
    with subprocess.Popen(command, stdout=subprocess.PIPE, text=True) as process:
        assert process.stdout is not None
        at = {}
        said: Any = None
        for line in process.stdout:
            said = json.loads(line)
            if isinstance(said, str):
                at[said] = server.cpu_s()
    if process.returncode:
        raise RuntimeError(f"{server.name}, {mode}: {server.webs[0].story()[-3000:] if server.webs else ''}")
    seen: Json = said
    return {**seen, "cpu_s": round(at["end"] - at["begin"], 2) if at else 0.0}
