"""Renewing the server's key with `deploy/set-up.sh`: what the former one sealed is still read."""

from __future__ import annotations

import shutil
import subprocess
from pathlib import Path

from tests.kit.files import ROOT


def run(site: Path, *arguments: str) -> None:
    command = ["sh", str(site / "deploy" / "set-up.sh"), *arguments]
    done = subprocess.run(command, check=False, capture_output=True, text=True, timeout=120)
    assert done.returncode == 0, done.stderr


def test_a_renewed_key_comes_before_the_former_ones_and_a_renewed_password_alone(tmp_path: Path) -> None:
    shutil.copytree(ROOT / "deploy", tmp_path / "deploy")
    run(tmp_path, "localhost")
    keys, password = tmp_path / "secrets" / "django-key", tmp_path / "secrets" / "redis-password"
    first, before = keys.read_text(), password.read_text()
    run(tmp_path, "localhost")
    assert keys.read_text() == first
    run(tmp_path, "--renew", "django-key")
    run(tmp_path, "--renew", "django-key")
    third, second, kept = keys.read_text().splitlines(keepends=True)
    assert (kept, len({first, second, third}), keys.stat().st_mode & 0o777) == (first, 3, 0o444)
    keys.unlink()
    run(tmp_path, "--renew", "django-key")
    assert len(keys.read_text().splitlines()) == 1
    run(tmp_path, "--renew", "redis-password")
    assert len(password.read_text().splitlines()) == 1
    assert password.read_text() != before
