"""What the commands of `vipo` share: exit codes, printing, and Django's set-up for those that read the database."""

from __future__ import annotations

import argparse
import json
import os
import sys
from collections.abc import Sequence

import django

from vipo_device.protocol.faults import printable

CLEAN, FAULTY, UNUSABLE, INTERRUPTED = 0, 1, 2, 130


class Unusable(Exception):
    """What was asked for cannot be done; the message says why and how to mend it, `code` says it to programs."""

    code = "unusable"

    def __init__(self, detail: str, code: str = "") -> None:
        super().__init__(detail)
        self.code = code or self.code


def set_up() -> None:
    """Load the apps' models; before this nothing of them can be imported."""
    os.environ.setdefault("DJANGO_SETTINGS_MODULE", "vipo_site.settings")
    django.setup()


def write(line: str) -> None:
    """Print a line of the answer."""
    print(line)  # noqa: T201 - a command line tool speaks by printing


def write_json(body: object) -> None:
    """Print the answer for machines."""
    write(json.dumps(body, ensure_ascii=False, indent=1))


def write_table(rows: Sequence[Sequence[str]]) -> None:
    """Print rows with their columns under each other, without what a terminal would obey."""
    cleaned = [[printable(cell) for cell in row] for row in rows]
    widths = [max(len(row[column]) for row in cleaned) for column in range(len(cleaned[0]))]
    for row in cleaned:
        write("  ".join(cell.ljust(width) for cell, width in zip(row, widths, strict=True)).rstrip())


def complain(line: str) -> int:
    """Print a line about what is wrong, apart from the answer; return the exit code for what cannot be done."""
    print(line, file=sys.stderr)  # noqa: T201 - a command line tool speaks by printing
    return UNUSABLE


def refuse(options: argparse.Namespace, code: str, detail: str, **more: object) -> int:
    """Say why there is no answer, to who asked for JSON as an object as well; return the code for what cannot be done.

    The object has `code` and `detail`, as those of the API have, and `more`.
    """
    if getattr(options, "json", False):
        write_failure(code, detail, **more)
    return complain(detail)


def write_failure(code: str, detail: str, **more: object) -> None:
    """Print why there is no answer, for machines: on one line, since some answers are a JSON object for each line."""
    write(json.dumps({"code": code, "detail": detail, **more}, ensure_ascii=False))


def refuse_seed(seed: int) -> None:
    """Raise Unusable for a seed that the API does not take either."""
    # imported late: most commands need nothing of the simulated world
    from simulation.world import MOST_SEED

    if not 0 <= seed <= MOST_SEED:
        raise Unusable(f"--seed must be a whole number from 0 to {MOST_SEED}.", "bad_option")
