"""What failed beside other tests is tried once more, alone."""

from __future__ import annotations

import json
import os
import subprocess
import sys
from pathlib import Path

import pytest

from scripts.retry_failed import FAILED, MOST
from tests.kit.files import ROOT

TESTS = "def test_sound(): pass\ndef test_broken(): assert False\n"


def retry(folder: Path, *failed: str) -> subprocess.CompletedProcess[str]:
    (folder / "test_it.py").write_text(TESTS)
    (folder / FAILED).parent.mkdir(parents=True)
    (folder / FAILED).write_text(json.dumps(dict.fromkeys(failed, True)))
    surroundings = {**os.environ, "PYTHONPATH": str(ROOT), "PYTEST_DISABLE_PLUGIN_AUTOLOAD": "1"}
    command = [sys.executable, "-m", "scripts.retry_failed"]
    return subprocess.run(command, cwd=folder, env=surroundings, capture_output=True, text=True, check=False)


@pytest.mark.parametrize(
    ("failed", "code", "last"),
    [
        (["test_it.py::test_sound"], 0, "1 passed"),
        (["test_it.py::test_broken", "test_it.py::test_sound"], 1, "1 failed, 1 passed"),
        ([], 1, "0 tests failed"),
        ([f"test_it.py::test_{number}" for number in range(MOST + 1)], 1, f"{MOST + 1} tests failed"),
    ],
)
def test_only_a_few_are_tried_again_and_what_fails_again_has_failed(
    tmp_path: Path, failed: list[str], code: int, last: str
) -> None:
    tried = retry(tmp_path, *failed)
    assert (tried.returncode, last in tried.stdout.splitlines()[-1]) == (code, True), tried.stdout + tried.stderr
    assert all(name in tried.stdout for name in failed[:MOST]) or len(failed) > MOST
