"""Where the repository lies, the files of it that many tests read, and a database that many tests begin with."""

from __future__ import annotations

import fcntl
import hashlib
import os
import shutil
import subprocess
import sys
import tempfile
from pathlib import Path

import django

ROOT = Path(__file__).resolve().parents[2]
FIXTURES = ROOT / "tests" / "fixtures"
FIGURE_5 = (FIXTURES / "figure-5.txt").read_bytes()
MIXER_TEXT = (ROOT / "registry" / "demo" / "devices" / "paintMixer03.ttl").read_text()


def describe_mixer(name: str) -> bytes:
    """Return the demo's description of a mixer in Turtle, for a mixer of this name."""
    return MIXER_TEXT.replace("paintMixer03", name).encode()


def link_micropython(state: Path) -> None:
    """Let a state folder begin with this machine's MicroPython, if it has one, to save fetching it."""
    fetched = ROOT / "var" / "micropython"
    if fetched.exists() and not (state / "micropython").exists():
        (state / "micropython").symlink_to(fetched)


def copy_migrated(to: Path) -> None:
    """Make a SQLite database with the product's tables: a copy of one that is kept until a migration changes."""
    kept = ROOT / "var" / "tests"
    kept.parent.mkdir(mode=0o700, exist_ok=True)
    kept.mkdir(exist_ok=True)
    with (kept / "lock").open("w") as lock:
        fcntl.flock(lock, fcntl.LOCK_EX)
        file = kept / f"{_state_of_migrations()}.sqlite3"
        if not file.exists():
            for old in kept.glob("*.sqlite3"):
                old.unlink()
            _make_migrated(file)
        shutil.copy(file, to)


def _state_of_migrations() -> str:
    """Return a name that is another one whenever a migration, Django's too, is."""
    ours = sorted(ROOT.glob("*/migrations/*.py"))
    told = [django.__version__.encode(), *(path.name.encode() + path.read_bytes() for path in ours)]
    return hashlib.sha256(b"\0".join(told)).hexdigest()[:16]


def _make_migrated(file: Path) -> None:
    own = {name: value for name, value in os.environ.items() if not name.startswith(("VIPO_", "DJANGO_"))}
    with tempfile.TemporaryDirectory(dir=file.parent) as state:
        command = [sys.executable, "manage.py", "migrate", "-v0", "--skip-checks"]
        told = {**own, "VIPO_STATE_DIR": state}
        done = subprocess.run(command, cwd=ROOT, env=told, capture_output=True, text=True)
        assert done.returncode == 0, done.stderr
        (Path(state) / "vipo.sqlite3").rename(file)
