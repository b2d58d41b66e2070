"""Ctrl-C and the processes that a process starts."""

import asyncio
import signal
import subprocess
import sys

from registry.services import sigint_blocked

ASK = (sys.executable, "-c", "import signal; print(signal.SIGINT in signal.pthread_sigmask(signal.SIG_BLOCK, []))")


def is_blocked_here():
    return signal.SIGINT in signal.pthread_sigmask(signal.SIG_BLOCK, [])


def test_a_child_begins_with_ctrl_c_blocked_and_its_parent_goes_on_without():
    with sigint_blocked():
        child = subprocess.Popen(ASK, stdout=subprocess.PIPE)
    assert not is_blocked_here()
    assert child.communicate()[0] == b"True\n"
    assert subprocess.run(ASK, stdout=subprocess.PIPE, check=True).stdout == b"False\n"


async def spawn(held_up):
    with sigint_blocked():
        child = await asyncio.create_subprocess_exec(*ASK, stdout=subprocess.PIPE)
        await held_up
    return (await child.communicate())[0]


def test_two_that_are_started_at_once_leave_their_parent_with_ctrl_c_in_whichever_order_they_end():
    async def both(first, last):
        loop = asyncio.get_running_loop()
        holds = [loop.create_future(), loop.create_future()]
        tasks = [asyncio.create_task(spawn(hold)) for hold in holds]
        await asyncio.sleep(0)
        assert is_blocked_here()
        for number in (first, last):
            holds[number].set_result(None)
            await tasks[number]
        return [task.result() for task in tasks]

    for order in ((0, 1), (1, 0)):
        assert asyncio.run(both(*order)) == [b"True\n", b"True\n"]
        assert not is_blocked_here()
