"""The child processes that check: killed, frozen, too slow, many at once; and none is left when the parent ends."""

from __future__ import annotations

import asyncio
import json
import os
import random
import signal
import subprocess
import sys
from collections.abc import AsyncIterator
from contextlib import asynccontextmanager, suppress
from pathlib import Path
from typing import Any

import pytest
from pycrdt import Doc, Map

from editor.compiling.compilers import CheckFailed, Compilers, Limits
from editor.compiling.job_delta import Wanted
from editor.compiling.workbench import Found
from editor.documents.shared_document import SharedDocument, empty_document
from editor.documents.tasks import Opening
from editor.language import compile_document, compiled_to_json
from editor.language.site.surroundings import Surroundings
from tests.kit.files import ROOT
from tests.kit.waiting import wait_for

Json = dict[str, Any]
NOTHING_AROUND = Surroundings(devices={}, places={})


class Edited:
    """A program that is edited and checked, as a room does it."""

    def __init__(self, name: str, steps: int = 3) -> None:
        self.name = name
        self.document = SharedDocument()
        self.add(steps)

    def add(self, count: int) -> None:
        steps = self.document.to_json()["steps"]
        more = {f"s{number}": _wait(number) for number in range(len(steps), len(steps) + count)}
        self.document.change_to({**empty_document(), "steps": {**steps, **more}})

    async def check(self, compilers: Compilers) -> Found:
        wanted = Wanted(self.name, lambda: self.document, NOTHING_AROUND, lambda: None, lambda _: ())
        return await compilers.check(wanted, lambda: None)

    def whole(self) -> Json:
        return _without_revision(compiled_to_json(compile_document(self.document.to_json(), NOTHING_AROUND)))


def _wait(number: int) -> Json:
    return {"kind": "wait", "place": ["program", "body", f"{number:05}"], "params": {"duration": 5}}


def _without_revision(form: Any) -> Json:
    return {name: value for name, value in json.loads(json.dumps(form)).items() if name != "revision"}


@asynccontextmanager
async def running(**limits: Any) -> AsyncIterator[Compilers]:
    compilers = Compilers(Limits(**limits))
    try:
        yield compilers
    finally:
        pids = compilers.pids
        await compilers.close()
        assert not [pid for pid in pids if _runs(pid)]


def kill_all(compilers: Compilers) -> None:
    """Kill its processes; one that is just ended by itself needs no killing."""
    for pid in compilers.pids:
        with suppress(ProcessLookupError):
            os.kill(pid, signal.SIGKILL)


async def test_a_process_that_is_killed_at_any_moment_costs_no_check() -> None:
    program, chance = Edited("p", 400), random.Random(0)
    async with running(processes=1) as compilers:
        await program.check(compilers)
        for _ in range(12):
            program.add(1)
            checking = asyncio.create_task(program.check(compilers))
            await asyncio.sleep(chance.random() * 0.08)
            kill_all(compilers)
            assert _without_revision((await checking).said) == program.whole()


async def test_a_frozen_process_is_ended_and_the_check_made_in_another() -> None:
    program = Edited("p")
    async with running(processes=1) as compilers:
        await program.check(compilers)
        (frozen,) = compilers.pids
        os.kill(frozen, signal.SIGSTOP)
        program.add(1)
        assert _without_revision((await program.check(compilers)).said) == program.whole()
        assert compilers.pids != [frozen]


async def test_a_program_that_kills_its_process_each_time_is_said_to_break_off_and_the_others_go_on() -> None:
    deadly, other = Edited("deadly", 3000), Edited("other")
    async with running(processes=1) as compilers:
        await other.check(compilers)

        async def go_on_killing() -> None:
            while True:
                await asyncio.sleep(0.1)
                kill_all(compilers)

        killing = asyncio.create_task(go_on_killing())
        with pytest.raises(CheckFailed, match="check_broke_off"):
            await deadly.check(compilers)
        killing.cancel()
        assert _without_revision((await other.check(compilers)).said) == other.whole()
        assert _without_revision((await deadly.check(compilers)).said) == deadly.whole()


async def test_a_check_that_takes_too_long_is_ended_by_the_clock_and_told_so() -> None:
    large, small = Edited("large", 4900), Edited("small")
    async with running(processes=1, check_s=0.1) as compilers:
        await _check_in_time(small, compilers)
        with pytest.raises(CheckFailed, match="check_took_too_long"):
            await large.check(compilers)
        assert _without_revision((await _check_in_time(small, compilers)).said) == small.whole()


async def _check_in_time(program: Edited, compilers: Compilers) -> Any:
    """Check a small program, again where a busy machine took longer than this test allows."""
    for _ in range(30):
        with suppress(CheckFailed):
            return await program.check(compilers)
    raise AssertionError("Not even a small program was checked in time.")


async def test_who_waits_behind_a_long_check_goes_on_before_it_has_ended() -> None:
    large, small = Edited("large", 4900), Edited("small")
    async with running(processes=1, patience_s=0.1) as compilers:
        await small.check(compilers)
        done: list[str] = []

        async def check(program: Edited) -> None:
            found = await program.check(compilers)
            assert _without_revision(found.said) == program.whole()
            done.append(program.name)

        first = asyncio.create_task(check(large))
        await asyncio.sleep(0.02)
        await asyncio.gather(first, check(small))
        assert done == ["small", "large"]
        assert len(compilers.pids) == 2  # one of them for slow programs


async def test_eight_programs_at_once_share_a_few_processes_and_each_stays_where_it_is() -> None:
    programs = [Edited(f"p{number}", 30 + number) for number in range(8)]
    async with running(processes=2) as compilers:
        seen: set[int] = set()
        for _ in range(5):
            found = await asyncio.gather(*(program.check(compilers) for program in programs))
            assert [_without_revision(each.said) for each in found] == [program.whole() for program in programs]
            seen.update(compilers.pids)
            for program in programs:
                program.add(1)
        assert len(seen) == 2


async def test_a_fault_in_a_check_is_told_and_the_process_goes_on() -> None:
    program, other = Edited("p"), Edited("other")
    async with running(processes=1) as compilers:
        await other.check(compilers)
        before = compilers.pids
        of_no_form = Wanted("p", lambda: program.document, NOTHING_AROUND, lambda: 5, lambda _: ())
        with pytest.raises(CheckFailed, match="check_broke_off"):
            await compilers.check(of_no_form, lambda: None)
        assert _without_revision((await other.check(compilers)).said) == other.whole()
        assert compilers.pids == before


async def test_a_document_is_put_together_beside_and_holds_the_same() -> None:
    program = Edited("p", 600)
    pieces = [program.document.encode()]
    for _ in range(5):
        before = program.document.state()
        program.add(1)
        pieces.append(program.document.encode(before))
    async with running(processes=1) as compilers:
        opening = Opening(tuple(pieces), tuple(pieces[1:]))
        opened = await compilers.do(opening)
        assert opened is not None
        document = SharedDocument()
        for piece in opened.slices:
            document.apply_slice(piece)
        assert document.encode() == SharedDocument([opened.update]).encode()
        document.know(opened.update, opened.hashes)
        assert (opened.has_hole, opened.migrated) == (False, False)
        assert document.digest() == SharedDocument(pieces).digest()
        first, second, third = _three_edits()
        torn = await compilers.do(Opening((first, third), (third,)))
        assert torn is not None
        assert torn.has_hole
        sound = await compilers.do(Opening((first, third, second), (third,)))
        assert sound is not None
        assert not sound.has_hole


def _three_edits() -> list[bytes]:
    """Return three updates of one client."""
    document: Doc[Any] = Doc()
    edits: list[bytes] = []
    watching = document.observe(lambda event: edits.append(event.update))
    for number in range(3):
        document.get("steps", type=Map)[f"s{number}"] = Map(_wait(number))
    del watching
    return edits


PARENT = """
import asyncio, signal, django
signal.signal(signal.SIGINT, signal.default_int_handler)  # a shell starts what runs beside it with SIGINT ignored
django.setup()
from tests.integration.editor.compiling.test_child_processes import Edited
from editor.compiling.compilers import Compilers
async def main():
    compilers = Compilers()
    programs = [Edited(f"p{number}") for number in range(4)]
    await asyncio.gather(*(program.check(compilers) for program in programs))
    print(*compilers.pids, flush=True)
    large = Edited("large", 4900)
    while True:
        large.add(1)
        await asyncio.gather(large.check(compilers), *(program.check(compilers) for program in programs))
asyncio.run(main())
"""


@pytest.mark.parametrize("how", [signal.SIGKILL, signal.SIGTERM, signal.SIGINT])
def test_a_parent_that_ends_leaves_no_process_behind(how: signal.Signals) -> None:
    environment = {**os.environ, "DJANGO_SETTINGS_MODULE": "tests.settings"}
    with subprocess.Popen(
        [sys.executable, "-c", PARENT], cwd=ROOT, env=environment, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL
    ) as parent:
        assert parent.stdout is not None
        pids = [int(pid) for pid in parent.stdout.readline().split()]
        assert len(pids) >= 2
        try:
            parent.send_signal(how)
            parent.wait(20)
        finally:
            parent.kill()  # else this test would wait for ever for one that goes on
    wait_for("the processes have ended", lambda: not any(_runs(pid) for pid in pids), every_s=0.05)


def _runs(pid: int) -> bool:
    try:
        return Path(f"/proc/{pid}/stat").read_text().rpartition(")")[2].split()[0] != "Z"
    except OSError:
        return False
