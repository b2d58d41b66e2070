"""Files that are there whole or not at all, and that only one process at a time changes."""

from __future__ import annotations

import fcntl
import os
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path


def write_file(path: Path, text: str, *, private: bool = False) -> None:
    """Replace a file in one piece: who reads it finds the old or the new one. Raises OSError.

    A private file is for its owner's eyes only, and so is its folder where that is made now.
    """
    _make_folder(path.parent, private=private)
    draft = path.with_name(path.name + ".new")
    draft.unlink(missing_ok=True)
    mode = 0o600 if private else 0o666
    with os.fdopen(os.open(draft, os.O_WRONLY | os.O_CREAT | os.O_EXCL, mode), "w") as file:
        file.write(text)
    draft.replace(path)


@contextmanager
def locked(path: Path) -> Iterator[None]:
    """Keep others from changing a private file meanwhile, other processes too; `.lock` beside it is held for that."""
    _make_folder(path.parent, private=True)
    with path.with_suffix(".lock").open("a") as lock:
        fcntl.flock(lock, fcntl.LOCK_EX)
        yield


def _make_folder(folder: Path, *, private: bool) -> None:
    """Make a folder and those above it, unless they are there."""
    folder.mkdir(parents=True, exist_ok=True, mode=0o700 if private else 0o777)
