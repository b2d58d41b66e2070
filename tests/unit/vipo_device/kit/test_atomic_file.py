"""Files that are there whole or not at all."""

from __future__ import annotations

from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import pytest

from vipo_device.kit.atomic_file import locked, write_file


def test_a_file_is_replaced_and_leaves_nothing_beside_it(tmp_path: Path) -> None:
    path = tmp_path / "new" / "memory.json"
    write_file(path, "first")
    path.with_name("memory.json.new").write_text("what a process left that was killed")
    write_file(path, "second")
    assert [(file.name, file.read_text()) for file in path.parent.iterdir()] == [("memory.json", "second")]


def test_a_private_file_is_for_its_owner_only(tmp_path: Path) -> None:
    path = tmp_path / "secrets" / "keys.json"
    write_file(path, "{}", private=True)
    assert [part.stat().st_mode & 0o777 for part in (path, path.parent)] == [0o600, 0o700]
    path.chmod(0o644)
    write_file(path, "{}", private=True)
    assert path.stat().st_mode & 0o777 == 0o600


def test_a_file_that_cannot_be_written_stays_as_it_was(tmp_path: Path) -> None:
    path = tmp_path / "memory.json"
    write_file(path, "first")
    with pytest.raises(UnicodeEncodeError):
        write_file(path, "\ud800")
    assert path.read_text() == "first"


def test_one_at_a_time_changes_a_file(tmp_path: Path) -> None:
    path = tmp_path / "count"
    write_file(path, "0")

    def count(_: int) -> None:
        with locked(path):
            write_file(path, str(int(path.read_text()) + 1))

    with ThreadPoolExecutor(8) as pool:
        list(pool.map(count, range(64)))
    assert path.read_text() == "64"
