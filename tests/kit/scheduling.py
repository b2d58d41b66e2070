"""Which tests stay together in one process when several processes run them, and in which order they begin.

A file's tests stay together, and so do files that share something costly. What takes longest begins first, so that at
the end all processes are done at about the same time.
"""

from __future__ import annotations

import os
from typing import Any

import pytest
from xdist.scheduler import LoadFileScheduling  # type: ignore[import-untyped]

SCREENS, SITES = "the browsers of drawing and operating", "the browsers of sites and people"
BROWSERS = {
    "tests/e2e/accounts/": SCREENS,
    "tests/e2e/drawing/": SCREENS,
    "tests/e2e/operators/": SCREENS,
    "tests/e2e/together/": SCREENS,
    "tests/e2e/": SITES,
}
"""Two halves of about the same length, with a demo and a browser each: one of all would end long after the rest.

The second begins when the tests that start many servers are done, beside which both would be too slow for their limits.
"""
TOGETHER = {
    "the demo that nobody ends": (
        "tests/integration/breaking/test_vanishing.py",
        "tests/integration/breaking/test_stop_all.py",
        "tests/integration/breaking/test_hostile_devices.py",
        "tests/integration/breaking/test_hostile_pages.py",
    ),
    "PostgreSQL": (
        "tests/integration/wire/test_served.py",
        "tests/integration/editor/test_two_processes.py",
        "tests/integration/wire/test_described_at_once.py",
    ),
}
FIRST = (
    SCREENS,
    "PostgreSQL",
    "the demo that nobody ends",
    "tests/integration/breaking/test_restart.py",
    "tests/integration/wire/virtual",
    "tests/integration/wire/dashboards",
    "tests/firmware",
    "tests/robot_agent",
    "tests/integration/wire/test_accounts.py",
    "tests/integration/wire/test_sites_apart.py",
    "tests/integration/registry/thing_directory",
    "tests/integration/execution/test_runs.py",
    "tests/integration/registry/test_sparql.py",
    SITES,
    "tests/integration",
)
"""The longest ones, measured with `make test`; those that mostly wait, beside which others compute; then the folders.

What is not named here is short, computes, and comes last: at the end no processor waits.
"""

_GROUPS = {file: name for name, files in TOGETHER.items() for file in files}


def group_of(nodeid: str) -> str:
    """Return what a test stays together with: its file, or a named group of files."""
    file = nodeid.partition("::")[0]
    browsers = next((group for folder, group in BROWSERS.items() if file.startswith(folder)), None)
    return browsers or _GROUPS.get(file, file)


def rank_of(nodeid: str) -> int:
    """Return where a test's group begins."""
    group = group_of(nodeid)
    return next(
        (rank for rank, first in enumerate(FIRST) if group == first or group.startswith(f"{first}/")), len(FIRST)
    )


class Groups(LoadFileScheduling):  # type: ignore[misc]  # xdist has no types
    """Gives whole groups to processes, in the order in which they were collected."""

    def _split_scope(self, nodeid: str) -> str:
        return group_of(nodeid)


@pytest.hookimpl(optionalhook=True)
def pytest_xdist_make_scheduler(config: pytest.Config, log: Any) -> Groups | None:
    """Schedule by groups where files would be scheduled."""
    return Groups(config, log) if config.getvalue("dist") == "loadfile" else None


@pytest.hookimpl(trylast=True)
def pytest_collection_modifyitems(items: list[pytest.Item]) -> None:
    """Put the longest first where several processes run the tests."""
    if "PYTEST_XDIST_WORKER" in os.environ:
        items.sort(key=lambda item: (rank_of(item.nodeid), group_of(item.nodeid)))
