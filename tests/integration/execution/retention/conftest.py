"""A site, and an archive folder of its own."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest

from tests.kit.sites import make_hall


@pytest.fixture
def hall(db: None) -> str:
    return make_hall()


@pytest.fixture
def folder(settings: Any, tmp_path: Path) -> Path:
    settings.VIPO_ARCHIVE_DIR = tmp_path / "archive"
    settings.VIPO_KEEP_RUNS_DAYS = settings.VIPO_KEEP_CALLS_DAYS = 30
    settings.VIPO_KEEP_REHEARSALS_DAYS = 10
    return tmp_path / "archive"
