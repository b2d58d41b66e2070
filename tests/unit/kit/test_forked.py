"""Processes that tests fork behave as those that are started."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
from collections.abc import Iterator
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import pytest

from tests.kit.processes.forked import ForkedPython, run_forked
from tests.kit.waiting import wait_for

SLEEP = "import time; time.sleep(600)"
SETTINGS = """
from django.conf import settings
from django.db import connection
print(settings.VIPO_STATE_DIR, settings.VIPO_SPEED, connection.settings_dict["NAME"])
"""


def code(text: str) -> list[str]:
    return [sys.executable, "-c", text]


@pytest.fixture
def sleeper() -> Iterator[ForkedPython]:
    process = ForkedPython(code(SLEEP))
    yield process
    process.kill()
    process.wait()


def test_it_has_its_arguments_input_folder_and_environment_and_says_how_it_ended(tmp_path: Path) -> None:
    text = "import os, sys; print(sys.argv[1], sys.stdin.read(), os.getcwd(), os.environ['TOLD']); sys.exit(3)"
    done = run_forked(
        [*code(text), "one"], input="two", capture_output=True, text=True, cwd=tmp_path, env={"TOLD": "three"}
    )
    assert (done.returncode, done.stdout, done.stderr) == (3, f"one two {tmp_path} three\n", "")


def test_what_it_raises_is_told_and_ends_it_with_1() -> None:
    done = run_forked(code("raise ValueError('Grüße')"), capture_output=True, text=True)
    assert (done.returncode, done.stderr.splitlines()[-1]) == (1, "ValueError: Grüße")
    with pytest.raises(subprocess.CalledProcessError):
        run_forked(code("raise SystemExit(2)"), check=True)


def test_each_reads_its_own_settings(tmp_path: Path) -> None:
    for speed in ("2", "5"):
        folder = tmp_path / speed
        folder.mkdir()
        told = {**os.environ, "DJANGO_SETTINGS_MODULE": "vipo_site.settings", "VIPO_SPEED": speed}
        told |= {"VIPO_STATE_DIR": str(folder)}
        done = run_forked(code(SETTINGS), capture_output=True, text=True, env=told, check=True)
        assert done.stdout.split() == [str(folder), f"{speed}.0", str(folder / "vipo.sqlite3")]


def test_it_is_frozen_and_killed_as_any_other(sleeper: ForkedPython) -> None:
    sleeper.send_signal(signal.SIGSTOP)
    stat = Path(f"/proc/{sleeper.pid}/stat")
    wait_for("the frozen process", lambda: stat.read_text().rpartition(")")[2].split()[0] == "T")
    assert sleeper.poll() is None
    with pytest.raises(subprocess.TimeoutExpired):
        sleeper.wait(0.05)
    sleeper.kill()
    assert (sleeper.wait(10), sleeper.poll()) == (-signal.SIGKILL, -signal.SIGKILL)


def test_what_takes_too_long_is_killed() -> None:
    with pytest.raises(subprocess.TimeoutExpired):
        run_forked(code(SLEEP), timeout=0.2)


def test_of_many_that_threads_start_at_once_each_has_its_own_answer() -> None:
    def run(number: int) -> tuple[int, str]:
        done = run_forked(code(f"print({number}); raise SystemExit({number})"), capture_output=True, text=True)
        return done.returncode, done.stdout

    with ThreadPoolExecutor(8) as pool:
        assert list(pool.map(run, range(24))) == [(number, f"{number}\n") for number in range(24)]


def test_of_the_files_of_others_none_is_open_in_it(sleeper: ForkedPython) -> None:
    listing = "import os; print(*(os.readlink(f'/proc/self/fd/{name}') for name in os.listdir('/proc/self/fd')[:-1]))"
    done = run_forked(code(listing), input="", capture_output=True, text=True, check=True)
    assert [each.partition(":")[0] for each in done.stdout.split()] == ["pipe"] * 3


def test_only_this_interpreter_can_be_forked() -> None:
    with pytest.raises(AssertionError, match="this interpreter"):
        ForkedPython(["ps"])
