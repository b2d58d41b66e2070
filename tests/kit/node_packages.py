"""Clients of other people that tests use, written for Node: their packages, as the lock file beside them says."""

from __future__ import annotations

import fcntl
import subprocess
from pathlib import Path

from tests.kit.servers import find_program


def install_packages(folder: Path) -> None:
    """Install the packages that a folder's lock file names, once: test processes that come together wait in turn."""
    modules, locked = folder / "node_modules", folder / "package-lock.json"
    installed = modules / ".installed"
    with locked.open() as lock:
        fcntl.flock(lock, fcntl.LOCK_EX)
        if modules.exists() and installed.exists() and installed.read_text() == locked.read_text():
            return
        npm = [find_program("npm"), "ci", "--no-audit", "--no-fund", "--loglevel=error"]
        subprocess.run(npm, cwd=folder, check=True)
        installed.write_text(locked.read_text())
