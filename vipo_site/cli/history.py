"""`vipo history`: what an archive of runs, rehearsals or calls holds, without a database."""

from __future__ import annotations

import argparse
import json
import stat
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

from execution.archive.history_file import Header, Row, UnreadableHistory, read_sections
from execution.engine.replayed import replay_runs
from vipo_device.protocol.faults import printable
from vipo_site.cli.program_file import UnreadableFile
from vipo_site.cli.terminal import CLEAN, FAULTY, write

WHAT = "Show the runs, rehearsals or calls that a file of the archive holds."
MOST_CHARACTERS = 500


def add_history_arguments(sub: argparse.ArgumentParser) -> None:
    """Say what the command takes."""
    sub.add_argument("file", type=Path, help="a file of the archive folder: ….jsonl.gz")
    sub.add_argument("--id", default="", help="only the run or rehearsal with this id")
    sub.add_argument("--json", action="store_true", help="write JSON lines for machines, each with all that is kept")
    sub.add_argument(
        "--replay", action="store_true", help="carry its runs out again, and say which end in another state"
    )
    sub.set_defaults(run=show_history)


def show_history(options: argparse.Namespace) -> int:
    """Print the file, line by line as it is read; return 0, or 1 where a run that is replayed ends in another state.

    Raises:
        UnreadableFile: it is no archive, or not a whole one; what was printed until then stands in it.
    """
    path: Path = options.file
    found, is_same = 0, True
    try:
        if not stat.S_ISREG(path.stat().st_mode):
            raise UnreadableFile(f"{path} is not a file.")
        with path.open("rb") as file:
            for line, is_as_kept in _replayed(file, options) if options.replay else _shown(file, options):
                write(line)
                found += 1
                is_same = is_same and is_as_kept
    except UnreadableHistory as error:
        raise UnreadableFile(f"{path}: {error}") from error
    except FileNotFoundError as error:
        raise UnreadableFile(f"There is no file {path}.") from error
    except (KeyError, TypeError, ValueError) as error:
        raise UnreadableFile(f"{path}: A line of the file does not have what it should have: {error}.") from error
    if options.id and not found:
        raise UnreadableFile(f"{path} holds nothing with the id {options.id[:64]}.")
    return CLEAN if is_same else FAULTY


def _replayed(file: Any, options: argparse.Namespace) -> Iterator[tuple[str, bool]]:
    for run in replay_runs(file):
        if not options.id or run.header.id == options.id:
            named = f"Run {run.row['number']} of “{run.row['program_name']}” at {run.header.site} ({run.header.id})"
            ends = "ends as it was kept" if run.is_same else "ends in another state than the one that was kept"
            told = f"{len(run.decisions)} inputs, {ends}" if run.is_known else "its inputs were not kept"
            yield printable(f"{named}: {told}")[:MOST_CHARACTERS], run.is_same or not run.is_known


def _shown(file: Any, options: argparse.Namespace) -> Iterator[tuple[str, bool]]:
    return ((line, True) for line in _lines(file, options))


def _lines(file: Any, options: argparse.Namespace) -> Iterator[str]:
    for header, row in read_sections(file):
        if row is None or (options.id and header.id != options.id):
            continue
        if options.json:
            yield json.dumps({"site": header.site, "kind": header.kind, "of": header.id, **row}, ensure_ascii=False)
        elif words := _WORDS.get(row["row"]):
            yield printable(words(row, header)[:MOST_CHARACTERS])


def _run(row: Row, header: Header) -> str:
    end = f"{row['status']}: {row['reason']}" if row["reason"] else row["status"]
    span = f"{row['started_at'] or '-'} to {row['ended_at']}"
    who = f", started by {row['started_by']}" if row["started_by"] else ""
    return f"Run {row['number']} of “{row['program_name']}” at {header.site}, {span}, {end}{who} ({row['id']})"


def _event(row: Row, _header: Header) -> str:
    return f"  {row['t_s']:10.3f} s  {row['text']}"


def _question(row: Row, _header: Header) -> str:
    answer = f"{row['value']!r} by {row['answered_by'] or '-'}" if row["state"] == "answered" else row["state"]
    return f"  asked {row['asked_at']}: {row['text']} - {answer}"


def _command(row: Row, _header: Header) -> str:
    values = ", ".join(f"{name}={value}" for name, value in row["arguments"].items())
    said = f"{row['status']} {row['why']}".rstrip()
    return f"  sent {row['sent_at'] or '-'}: {row['device']}.{row['method']}({values}) - {said}"


def _rehearsal(row: Row, header: Header) -> str:
    named = f"Rehearsal of “{row['program_name']}” at {header.site}"
    return f"{named}, {row['created_at']}, {row['status']} {row['reason']} ({row['id']})"


_WORDS: dict[str, Callable[[Row, Header], str]] = {
    "run": _run,
    "event": _event,
    "question": _question,
    "command": _command,
    "rehearsal": _rehearsal,
}
"""How each kind of row is told; of what is not here `--json` has all."""
