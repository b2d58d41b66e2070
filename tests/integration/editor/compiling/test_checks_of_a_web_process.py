"""A web process and those in which it checks: what the site hears, and what is shown when one is killed."""

from __future__ import annotations

import asyncio
import json
import os
import signal
from datetime import datetime
from pathlib import Path
from typing import Any

from websockets.asyncio.client import connect

from tests.integration.editor.compiling.looker import looking
from tests.kit.web import Web


def children_of(pid: int) -> list[int]:
    """Return the processes that check for a web process."""
    found = []
    for stat in Path("/proc").glob("[0-9]*/stat"):
        try:
            fields, command = stat.read_text().rpartition(")")[2].split(), (stat.parent / "cmdline").read_bytes()
        except OSError:
            continue
        if int(fields[1]) == pid and fields[0] != "Z" and b"editor.compiling.child_process" in command:
            found.append(int(stat.parent.name))
    return found


async def test_the_site_hears_what_lists_show_of_a_program_and_not_the_form(web: Web) -> None:
    program = web.new_program()
    url = f"ws://127.0.0.1:{web.port}/ws/site/hall"
    async with connect(url, additional_headers=web.headers("viewer")) as site, looking(web, program) as ada:
        await ada.add("a")
        await ada.sees("a")
        async with asyncio.timeout(30):
            told: dict[str, Any] = {}
            while (told.get("type"), told.get("program")) != ("checked", program):
                told = json.loads(await site.recv())
    revision = told.pop("revision")
    with web.client("viewer") as viewer:
        listed = next(each for each in viewer.get("/sites/hall/programs").json() if each["id"] == program)
    shown = {key: value for key, value in listed.items() if key not in {"id", "site", "name"}}
    assert shown["kinds"]
    assert datetime.fromisoformat(told["shown"].pop("edited_at")) == datetime.fromisoformat(shown.pop("edited_at"))
    assert told == {"type": "checked", "program": program, "shown": shown}
    assert revision == ada.form["revision"]


async def test_edits_are_shown_though_the_processes_that_check_are_killed_and_they_stay_few(web: Web) -> None:
    assert web.process is not None
    program, names = web.new_program(), [f"s{number}" for number in range(6)]
    async with looking(web, program) as ada:
        for number, name in enumerate(names):
            await ada.add(name)
            await ada.sees(*names[: number + 1])
            assert 1 <= len(children_of(web.process.pid)) <= 5
            for pid in children_of(web.process.pid):
                os.kill(pid, signal.SIGKILL)


def work_s(pid: int) -> float:
    """Return how long a process has computed."""
    fields = Path(f"/proc/{pid}/stat").read_text().rpartition(")")[2].split()
    return (int(fields[11]) + int(fields[12])) / os.sysconf("SC_CLK_TCK")


async def test_a_large_program_is_compiled_for_a_request_beside_the_web_process_and_here_when_that_dies(
    web: Web,
) -> None:
    assert web.process is not None
    program, names = web.new_program(), [f"s{number:04}" for number in range(2000)]

    def ask() -> tuple[str, list[str]]:
        with web.client("author") as client:
            script = client.get(f"/programs/{program}/script").text
            compiled = client.get(f"/programs/{program}/compiled")
            assert compiled.status_code == 200, compiled.text
            return script, compiled.json()["order"]

    async with looking(web, program) as ada:
        await ada.add(*names)
        await ada.sees(*names)
        asked = await asyncio.to_thread(ask)
        children = children_of(web.process.pid)
        before, beside = work_s(web.process.pid), sum(map(work_s, children))
        for _ in range(5):
            assert await asyncio.to_thread(ask) == asked
        here, beside = work_s(web.process.pid) - before, sum(map(work_s, children)) - beside
        for pid in children:
            os.kill(pid, signal.SIGKILL)
        assert await asyncio.to_thread(ask) == asked
    assert (asked[0].count("wait"), asked[1]) == (2000, names)
    assert beside > here, (beside, here)
