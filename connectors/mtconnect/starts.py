"""The number of a connector's start: VIPO hears nobody whose number is lower than the last one that it heard."""

from __future__ import annotations

import json
import logging
from pathlib import Path

from vipo_device.kit.atomic_file import locked, write_file

log = logging.getLogger(__name__)


def count_start(path: Path, now: int) -> int:
    """Return the number of this start, and keep it; `now`, in seconds, is where the numbers begin.

    The clock alone would not do: one that was ahead and was put right would say a number that was there before.
    """
    try:
        with locked(path):
            number = max(_read_last(path) + 1, now)
            write_file(path, json.dumps({"boot": number}))
    except OSError as error:
        log.warning("%s cannot be kept (%s); if the clock goes back, VIPO will not hear the next start.", path, error)
        number = now
    return number


def _read_last(path: Path) -> int:
    try:
        return int(json.loads(path.read_text())["boot"])
    except FileNotFoundError:
        return -1
    except (ValueError, KeyError, TypeError, OverflowError) as error:
        log.warning("%s cannot be read (%s); the clock says the number of this start.", path, error)
        return -1
