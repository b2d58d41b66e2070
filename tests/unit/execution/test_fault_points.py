"""Named points: all of them are in the code, each once, and a file arms one for one process."""

from __future__ import annotations

import ast
import os
import signal
from collections import Counter
from pathlib import Path

import pytest

from execution.fault_points import ARCHIVE_POINTS, DIES_WITH, GATEWAY_POINTS, OWNER_POINTS, fault_point
from tests.kit.files import ROOT


def test_each_point_of_the_lists_is_in_the_code_once_and_no_other() -> None:
    found: Counter[str] = Counter()
    for file in (ROOT / "execution").rglob("*.py"):
        for node in ast.walk(ast.parse(file.read_text())):
            if isinstance(node, ast.Call) and isinstance(node.func, ast.Name) and node.func.id == "fault_point":
                assert isinstance(node.args[0], ast.Constant), file
                found[str(node.args[0].value)] += 1
    assert found == Counter((*OWNER_POINTS, *GATEWAY_POINTS, *ARCHIVE_POINTS))


def pass_points(folder: Path, times: int) -> int:
    """Let a process come to a point so many times; return how it ended, or the signal that stopped it."""
    child = os.fork()
    if child == 0:
        os.environ["VIPO_FAULTS"] = str(folder)
        for _ in range(times):
            fault_point("after_claim")
        os._exit(0)
    _, status = os.waitpid(child, os.WUNTRACED)
    if os.WIFSTOPPED(status):
        os.kill(child, signal.SIGCONT)
        os.waitpid(child, 0)
        return os.WSTOPSIG(status)
    return os.waitstatus_to_exitcode(status)


@pytest.mark.parametrize(
    ("says", "times", "ends"),
    [("kill", 1, DIES_WITH), ("kill 3", 2, 0), ("kill 3", 3, DIES_WITH), ("freeze", 1, signal.SIGSTOP)],
)
def test_a_file_says_what_happens_and_counts_once(tmp_path: Path, says: str, times: int, ends: int) -> None:
    (tmp_path / "after_claim").write_text(says)
    assert pass_points(tmp_path, times) == ends
    assert (tmp_path / "after_claim").exists() == (ends == 0)
    if ends:
        assert pass_points(tmp_path, 5) == 0


def test_other_points_and_processes_that_are_told_of_no_folder_pass(tmp_path: Path) -> None:
    (tmp_path / "before_claim").write_text("kill")
    assert pass_points(tmp_path, 1) == 0
    fault_point("before_claim")
