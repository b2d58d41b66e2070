"""One edit of a large program, seen by somebody else who looks at its script: when it is there, and what was sent."""

from __future__ import annotations

import asyncio
import json
import os
import subprocess
import sys
import tempfile
import time
from collections.abc import Iterator
from pathlib import Path
from typing import Any

from websockets.asyncio.client import ClientConnection, connect

from bench.figures import figure, share
from editor.documents.shared_document import SharedDocument, empty_document
from editor.documents.yjs_encoding import encode_integer
from editor.programs.compiled_patch import apply_patch
from editor.rooms import yjs_protocol
from tests.kit.web import Web, environment, prepare

Json = dict[str, Any]
EDITS = 30
COMPILED = encode_integer(yjs_protocol.COMPILED)


def measure() -> Iterator[dict[str, object]]:
    """Yield figures for programs of a thousand steps and of nearly as many as there may be."""
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        web = Web(folder, **prepare(folder, {}))
        web.start()
        try:
            for count in (1000, 4900):
                yield from _figures(asyncio.run(_edit(web, count)), count)
        finally:
            web.kill()
        for steps, tail, place in ((1000, 0, "rows"), (4700, 0, "rows"), (4700, 8000, "rows"), (4700, 8000, "stream")):
            yield from _figures_inside(folder, steps, tail, place)


def _figures_inside(folder: Path, steps: int, tail: int, place: str) -> Iterator[dict[str, object]]:
    """Yield figures of a room in a process of its own: ten people edit it four times a second and look on."""
    command = [sys.executable, "-m", "bench.rooms_inside", str(steps), str(tail), place]
    done = subprocess.run(command, env=environment(folder, {}), capture_output=True, text=True, check=True)
    seen: Json = json.loads(done.stdout)
    for name, what in (
        ("opened_ms", "opening: until somebody is in the room"),
        ("opening_stall_ms", "opening: the loop stood still at longest"),
        ("opening_stall_computed_ms", "opening: what the process computed in such a time at most"),
        ("edit_stall_ms", "ten editors: the loop stood still at longest"),
        ("edit_stall_computed_ms", "ten editors: what the process computed in such a time at most"),
        ("cpu_ms", "ten editors: the web process's processor time for an edit"),
        ("children_cpu_ms", "ten editors: the child processes' processor time for an edit"),
    ):
        yield figure(what, seen[name], "ms", steps=steps, tail=tail, tail_in=place)


def _figures(seen: Json, steps: int) -> Iterator[dict[str, object]]:
    for name, quantile in (("p50", 0.5), ("p95", 0.95)):
        took = share(seen["delays_ms"], quantile)
        yield figure(f"from one person's edit to another's compiled form, {name}", took, "ms", steps=steps)
    yield figure("the web process at work for an edit", seen["cpu_ms"], "ms", steps=steps)
    yield figure("compiled frames for an edit", len(seen["bytes"]) / EDITS, "frames", steps=steps)
    yield figure("the largest of them", max(seen["bytes"]), "bytes", steps=steps, whole=seen["whole_bytes"])


async def _edit(web: Web, count: int) -> Json:
    program = web.new_program(f"{count} steps")
    async with _join(web, "author", program) as author, _join(web, "viewer", program) as looker:
        document = SharedDocument()
        document.change_to({**empty_document(), "steps": _steps(count)})
        await author.send(yjs_protocol.encode_step_2(document.encode()))
        await looker.send(COMPILED + encode_integer(0))
        form, whole = await _read(looker)
        while len(form["order"]) < count:
            told, whole = await _read(looker)
            form = apply_patch(form, told) if "base" in told else told
        return {"whole_bytes": whole, **await _edit_each(web, author, looker, document)}


async def _edit_each(web: Web, author: ClientConnection, looker: ClientConnection, document: SharedDocument) -> Json:
    """Put in a step, thirty times, at another place each; the next one when the last was seen."""
    delays_ms, sizes = [], []
    began_ms = _cpu_ms(web)
    for number in range(EDITS):
        before, steps = document.state(), document.to_json()["steps"]
        new = _wait(f"s{number * 30 // 10 * 10}", f"zz{number}")
        document.change_to({**document.to_json(), "steps": {**steps, f"new{number}": new}})
        began = time.perf_counter()
        await author.send(yjs_protocol.encode_update(document.encode(before)))
        _, size = await _read(looker)
        delays_ms.append((time.perf_counter() - began) * 1000)
        sizes.append(size)
        await asyncio.sleep(0.3)
    return {"delays_ms": delays_ms, "bytes": sizes, "cpu_ms": (_cpu_ms(web) - began_ms) / EDITS}


def _join(web: Web, person: str, program: str) -> connect:
    return connect(web.socket_url(program), additional_headers=web.headers(person), max_size=None)


async def _read(socket: ClientConnection) -> tuple[Json, int]:
    """Return the next compiled form or patch, and its bytes."""
    async with asyncio.timeout(60):
        while True:
            frame = await socket.recv()
            if isinstance(frame, bytes) and frame.startswith(COMPILED):
                form: Json = json.loads(frame[frame.index(b"{") :])
                return form, len(frame)


def _steps(count: int) -> Json:
    """Return a loop at every tenth step, with nine steps in it."""
    return {
        f"s{number}": _wait(f"s{number // 10 * 10}", f"{number % 10}", number)
        if number % 10
        else {"kind": "repeat", "place": ["program", "body", f"{number:05}"], "params": {"times": 3}}
        for number in range(count)
    }


def _wait(parent: str, order: str, seconds: int = 5) -> Json:
    return {"kind": "wait", "place": [parent, "body", order], "params": {"duration": seconds}}


def _cpu_ms(web: Web) -> float:
    assert web.process is not None
    fields = Path(f"/proc/{web.process.pid}/stat").read_text().rpartition(")")[2].split()
    return (int(fields[11]) + int(fields[12])) * 1000 / os.sysconf("SC_CLK_TCK")
