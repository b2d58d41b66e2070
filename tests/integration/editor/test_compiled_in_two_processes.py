"""Two web processes show one compiled form: checked once, sent as what changed, and never left behind an edit."""

from __future__ import annotations

import asyncio
import signal
import sys
import time
from collections.abc import Iterator
from pathlib import Path

import pytest

from editor.rooms.checks import LEFT_TO_OTHERS_S
from tests.integration.editor.compiling.looker import Looker, looking
from tests.kit.files import ROOT
from tests.kit.processes.forked import run_forked
from tests.kit.programs import operate
from tests.kit.served import served_without_broker
from tests.kit.servers import Redis
from tests.kit.web import Web, environment, prepare

pytestmark = pytest.mark.servers


@pytest.fixture(scope="module")
def pair(
    tmp_path_factory: pytest.TempPathFactory, module_database_url: str, shared_redis: Redis
) -> Iterator[tuple[Web, Web]]:
    folder: Path = tmp_path_factory.mktemp("pair")
    extra = served_without_broker(folder, module_database_url, shared_redis.url)
    extra = {name: value for name, value in extra.items() if name.startswith("VIPO_")}
    made = prepare(folder, extra)
    one, two = (Web(folder, **made, extra=extra) for _ in range(2))
    one.start()
    two.start()
    try:
        yield one, two
    finally:
        one.kill()
        two.kill()


DESCRIBE = """
import time
from dataclasses import replace
from tests.kit.sites import MIXER, describe
print(time.monotonic())
for methods in %s:
    describe(replace(MIXER, methods=tuple(replace(MIXER.methods[0], name=name) for name in methods)))
"""


async def say(web: Web, *methods: tuple[str, ...]) -> float:
    """Let the mixer describe itself in a third process, once with each of these lists of methods; return when."""
    command = [sys.executable, "manage.py", "shell", "--verbosity", "0", "-c", DESCRIBE % (methods,)]
    given = {"cwd": ROOT, "env": environment(web.folder, web.extra), "capture_output": True, "text": True}
    done = await asyncio.to_thread(run_forked, command, **given)
    assert done.returncode == 0, done.stderr
    return float(done.stdout)


async def find(count: int, *lookers: Looker) -> float:
    """Wait until all see so many troubles of the mixer's step; return when."""
    for looker in lookers:
        await looker.finds(lambda looker=looker: len(troubles(looker)) == count)
    return time.monotonic()


def troubles(looker: Looker) -> list[str]:
    return sorted(each["code"] for each in looker.form.get("diagnostics", ()) if each["step"] == "mix")


async def quiet(*lookers: Looker) -> None:
    """Wait until nothing has been sent for longer than one process waits for the other to check; forget the frames."""
    while any(looker.frames for looker in lookers):
        for looker in lookers:
            looker.frames.clear()
        await asyncio.sleep(LEFT_TO_OTHERS_S + 0.5)


async def test_both_show_one_form_and_an_edit_costs_one_check_and_few_bytes(pair: tuple[Web, Web]) -> None:
    program = pair[0].new_program()
    async with looking(pair[0], program) as ada, looking(pair[1], program, "viewer") as eve:
        await ada.add(*(f"s{number:03}" for number in range(300)))
        await ada.sees(*(names := [f"s{number:03}" for number in range(300)]))
        await eve.sees(*names)
        await quiet(ada, eve)
        began = time.monotonic()
        await ada.add("s000a")
        await ada.sees(*names, "s000a")
        await eve.sees(*names, "s000a")
        took_s = time.monotonic() - began
        await asyncio.sleep(LEFT_TO_OTHERS_S + 1)
    assert (len(ada.frames), len(eve.frames)) == (1, 1) or took_s > LEFT_TO_OTHERS_S  # then both may have checked
    assert max(ada.frames + eve.frames) < 1000
    assert ada.form == eve.form
    assert ada.form["numbers"]["s299"] == "301"


async def test_edits_at_both_at_once_are_all_shown_at_both(pair: tuple[Web, Web]) -> None:
    program = pair[0].new_program()
    async with looking(pair[0], program) as ada, looking(pair[1], program, "second") as bob:
        names = []
        for number in range(30):
            await asyncio.gather(ada.add(f"a{number}"), bob.add(f"b{number}"))
            names += [f"a{number}", f"b{number}"]
            await asyncio.sleep(0.01 * (number % 5))
        await ada.sees(*names)
        await bob.sees(*names)
        await quiet(ada, bob)
        assert ada.form == bob.form


async def test_an_edit_whose_process_stops_before_it_has_checked_is_shown_by_the_other(pair: tuple[Web, Web]) -> None:
    program, process = pair[0].new_program(), pair[0].process
    assert process is not None
    names: list[str] = []
    async with looking(pair[0], program) as ada, looking(pair[1], program, "second") as bob:
        for number in range(5):
            names.append(f"s{number}")
            await ada.add(names[-1])
            await bob.has(names[-1])
            process.send_signal(signal.SIGSTOP)
            try:
                await bob.sees(*names)
            finally:
                process.send_signal(signal.SIGCONT)
            await ada.sees(*names)
            await quiet(ada, bob)
            assert ada.form == bob.form


async def test_a_new_description_costs_one_check_and_both_show_what_it_says(pair: tuple[Web, Web]) -> None:
    program = pair[0].new_program()
    await say(pair[0], ("mix",))
    async with looking(pair[0], program) as ada, looking(pair[1], program, "viewer") as eve:
        await ada.draw({"mix": operate("mixer1", "mix")})
        await ada.sees("mix")
        await eve.sees("mix")
        await quiet(ada, eve)
        known = troubles(ada)
        for methods, more in (((), 1), (("mix",), 0)):
            began, seen = await asyncio.gather(say(pair[0], methods), find(len(known) + more, ada, eve))
            await asyncio.sleep(LEFT_TO_OTHERS_S + 1)
            came = len(ada.frames), len(eve.frames)
            assert came == (1, 1) or seen - began > LEFT_TO_OTHERS_S, f"{ada.ends}, {eve.ends}, {ada.form}"
            assert ada.form == eve.form
            await quiet(ada, eve)


async def test_of_descriptions_that_follow_each_other_both_show_the_last_one(pair: tuple[Web, Web]) -> None:
    program = pair[0].new_program()
    async with looking(pair[0], program) as ada, looking(pair[1], program, "viewer") as eve:
        await say(pair[0], ("mix",))
        await ada.draw({"mix": operate("mixer1", "mix")})
        await ada.sees("mix")
        await eve.sees("mix")
        await quiet(ada, eve)
        known = troubles(ada)
        await say(pair[0], *((), ("mix",)) * 10, ())
        await find(len(known) + 1, ada, eve)
        await quiet(ada, eve)
        assert (len(troubles(ada)), ada.form) == (len(known) + 1, eve.form)


async def test_a_description_whose_process_stops_is_looked_at_by_the_other(pair: tuple[Web, Web]) -> None:
    program = pair[0].new_program()
    async with looking(pair[0], program) as ada, looking(pair[1], program, "second") as bob:
        await say(pair[0], ("mix",))
        await ada.draw({"mix": operate("mixer1", "mix")})
        await ada.sees("mix")
        await bob.sees("mix")
        await quiet(ada, bob)
        known = troubles(ada)
        for frozen, other, methods, more in ((0, bob, (), 1), (1, ada, ("mix",), 0)):
            process = pair[frozen].process
            assert process is not None
            process.send_signal(signal.SIGSTOP)
            try:
                await say(pair[0], methods)
                await find(len(known) + more, other)
            finally:
                process.send_signal(signal.SIGCONT)
            await quiet(ada, bob)
            assert (len(troubles(ada)), ada.form) == (len(known) + more, bob.form)
