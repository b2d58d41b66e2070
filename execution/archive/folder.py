"""The folder of the archives: files that appear whole or not at all, and are read from nowhere else."""

from __future__ import annotations

import os
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from io import BytesIO
from pathlib import Path
from typing import BinaryIO

from django.conf import settings

from execution.archive.history_file import UnreadableHistory


def path_of(file: str) -> Path:
    """Return where the file of an archive lies; raises UnreadableHistory if that is outside of the folder."""
    folder = Path(settings.VIPO_ARCHIVE_DIR).resolve()
    path = (folder / file).resolve()
    if not path.is_relative_to(folder) or path == folder:
        raise UnreadableHistory("The file of this archive is not within the archive folder.")
    return path


@contextmanager
def new_file(file: str) -> Iterator[BinaryIO]:
    """Give a file to write; it has its name once all of it is on the disk, and is gone if anything goes wrong.

    Raises:
        OSError: the folder cannot be written, or the disk is full.
    """
    path = path_of(file)
    path.parent.mkdir(parents=True, exist_ok=True, mode=0o700)
    written = path.with_name(path.name + ".part")
    try:
        with written.open("wb") as out:
            written.chmod(0o600)
            yield out
            out.flush()
            os.fsync(out.fileno())
        written.replace(path)
        for folder in path.parents[:3]:
            _sync_folder(folder)
    except BaseException:
        with suppress(OSError):
            written.unlink(missing_ok=True)
        raise


def _sync_folder(folder: Path) -> None:
    number = os.open(folder, os.O_RDONLY)
    try:
        os.fsync(number)
    finally:
        os.close(number)


def remove_file(file: str) -> None:
    """Take a file away that was begun, whether it has its name already or not."""
    path = path_of(file)
    for each in (path, path.with_name(path.name + ".part")):
        with suppress(NotADirectoryError):  # then it was never there
            each.unlink(missing_ok=True)


@contextmanager
def open_part(file: str, offset: int, length: int) -> Iterator[BinaryIO]:
    """Open one section of an archive.

    Raises:
        UnreadableHistory: the file is not there, or cannot be read.
    """
    try:
        with path_of(file).open("rb") as whole:
            whole.seek(offset)
            part = whole.read(length)
    except OSError as error:
        raise UnreadableHistory(f"The archive {file} cannot be read: {error.strerror or error}.") from error
    with BytesIO(part) as opened:
        yield opened
