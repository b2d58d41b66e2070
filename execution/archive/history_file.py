"""The form of an archive: gzip, and in it JSON lines; pure, without a database.

Each history (a run, a rehearsal, a day's calls) is a section of its own: a gzip member with a header, its rows, and a
last line that counts them. So any tool that knows gzip reads the whole file, and one section is read without the rest.
A file that ends early, or whose bytes have changed, is found by the count and by gzip's own checksum.
"""

from __future__ import annotations

import gzip
import hashlib
import json
import zlib
from collections.abc import Callable, Iterable, Iterator, Mapping
from dataclasses import dataclass
from typing import Any, BinaryIO, Final

FORMAT: Final = 1
MOST_LINE_BYTES = 64 * 1024 * 1024
MOST_BYTES = 16 * 1024 * 1024 * 1024
"""So much may come out of one file; what is more was not written by VIPO."""
KINDS = ("run", "rehearsal", "calls")
Row = dict[str, Any]
UPGRADES: Mapping[int, Callable[[Row], Row]] = {}
"""From each former format to the next: what a row of it is now. Readers of all formats climb this ladder."""


class UnreadableHistory(Exception):
    """A file is no archive of VIPO, or not a whole one; the message says what is wrong with it."""


@dataclass(frozen=True, slots=True)
class Header:
    """What a section is: of which kind (run, rehearsal, calls), of which site, and its id (calls: the archive's)."""

    kind: str
    site: str
    id: str
    written_at: str


@dataclass(frozen=True, slots=True)
class Written:
    """Where a section lies in its file, how many rows it has, and the SHA-256 of its lines."""

    offset: int
    bytes: int
    rows: int
    digest: str


def write_section(file: BinaryIO, header: Header, rows: Iterable[Row]) -> Written:
    """Append a section to a file that is open for writing; `rows` may be made while they are written."""
    offset, count, digest = file.tell(), 0, hashlib.sha256()
    with gzip.GzipFile(filename="", fileobj=file, mode="wb", compresslevel=6, mtime=0) as packed:

        def write(row: Row) -> None:
            line = json.dumps(row, ensure_ascii=False, separators=(",", ":")).encode() + b"\n"
            digest.update(line)
            packed.write(line)

        named = {"kind": header.kind, "site": header.site, "id": header.id, "written_at": header.written_at}
        write({"vipo": "history", "format": FORMAT, **named})
        for row in rows:
            write(row)
            count += 1
        write({"row": "end", "rows": count})
    return Written(offset, file.tell() - offset, count, digest.hexdigest())


def read_sections(file: BinaryIO) -> Iterator[tuple[Header, Row | None]]:
    """Yield all rows with the header of their section, and None where a section ends, having been found whole.

    Raises:
        UnreadableHistory: with the first thing that is wrong, after what stands before it was yielded.
    """
    header: Header | None = None
    number, rows, is_empty = FORMAT, 0, True
    for line in _lines(file):
        row, is_empty = _parse(line), False
        if header is None:
            header, number = _header(row)
            rows = 0
        elif row.get("row") == "end":
            if row.get("rows") != rows:
                raise UnreadableHistory(f"A section has {rows} rows and says that it has {row.get('rows')!r}.")
            yield header, None
            header = None
        else:
            rows += 1
            yield header, _upgraded(row, number)
    if is_empty:
        raise UnreadableHistory("The file is empty.")
    if header is not None:
        raise UnreadableHistory("The file ends within a section: a part of it is missing.")


def digest_of(file: BinaryIO) -> str:
    """Return the SHA-256 of all lines of a file, read as `read_sections` reads them."""
    digest = hashlib.sha256()
    for line in _lines(file):
        digest.update(line)
    return digest.hexdigest()


def _lines(file: BinaryIO) -> Iterator[bytes]:
    left = MOST_BYTES
    try:
        with gzip.GzipFile(fileobj=file, mode="rb") as packed:
            while line := packed.readline(MOST_LINE_BYTES + 1):
                left -= len(line)
                if len(line) > MOST_LINE_BYTES or left < 0:
                    raise UnreadableHistory("More comes out of the file than VIPO ever writes into one.")
                yield line
    except gzip.BadGzipFile as error:
        raise UnreadableHistory(f"It is not compressed as VIPO's archives are, or was changed: {error}.") from error
    except (EOFError, zlib.error) as error:
        raise UnreadableHistory(f"The file is damaged, or a part of it is missing: {error}.") from error


def _parse(line: bytes) -> Row:
    try:
        row = json.loads(line)
    except (ValueError, RecursionError) as error:
        raise UnreadableHistory("A line of the file is not JSON that can be read.") from error
    if not isinstance(row, dict):
        raise UnreadableHistory("A line of the file is not a JSON object.")
    return row


def _header(row: Row) -> tuple[Header, int]:
    number = row.get("format")
    if row.get("vipo") != "history" or not isinstance(number, int) or isinstance(number, bool) or number < 1:
        raise UnreadableHistory("It is not an archive of VIPO: a section begins without saying what it is.")
    if number > FORMAT:
        raise UnreadableHistory(
            f"It is of format {number}, and this VIPO reads up to format {FORMAT}. Open it with a later VIPO."
        )
    words = [row.get(name) for name in ("kind", "site", "id", "written_at")]
    if not all(isinstance(word, str) for word in words) or row["kind"] not in KINDS:
        raise UnreadableHistory("A section's header does not say of which kind and site it is.")
    return Header(*map(str, words)), number


def _upgraded(row: Row, number: int) -> Row:
    for former in range(number, FORMAT):
        row = UPGRADES[former](row)
    if not isinstance(row.get("row"), str):
        raise UnreadableHistory("A line of the file does not say what it is.")
    return row
