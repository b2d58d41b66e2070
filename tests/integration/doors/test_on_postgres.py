"""The doors on PostgreSQL, too, which keeps less than SQLite: Django has one database for a process, so in another."""

from __future__ import annotations

import os
import subprocess
import sys

import pytest

from tests.kit.files import ROOT

TRIED = (
    "tests/integration/doors/test_hostile_requests.py",
    "tests/integration/doors/test_unfit_documents.py",
    "tests/integration/registry/test_refusals.py",
    "tests/integration/execution/test_parameters.py",
    "tests/integration/execution/test_questions.py",
)


@pytest.mark.servers
def test_what_comes_in_is_kept_and_refused_on_postgresql_as_on_sqlite(database_url: str) -> None:
    kept = {name: value for name, value in os.environ.items() if not name.startswith("PYTEST_")}
    command = [sys.executable, "-m", "pytest", "-q", "--no-header", "-p", "no:cacheprovider", *TRIED]
    told = {**kept, "VIPO_TEST_DATABASE": database_url}
    done = subprocess.run(command, cwd=ROOT, env=told, capture_output=True, text=True, timeout=1500)
    assert done.returncode == 0, done.stdout[-8000:] + done.stderr[-2000:]
