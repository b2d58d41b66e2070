"""How lines of the log are written: for people, or as JSON for programs that gather logs. No secrets, no bodies.

A line has these fields and no others, whatever a library hangs on its records: Django's carry the whole request.
"""

from __future__ import annotations

import json
import logging
import os
from datetime import UTC, datetime

from vipo_device.kit.log_ids import NAMES, bound_ids

MOST_CHARACTERS = 8_000


class JsonLines(logging.Formatter):
    """One JSON object a line: time, level, logger, message, process, what it belongs to, and an exception's text."""

    def __init__(self, process: str = "") -> None:
        """`process` is what runs here, such as `gateway`."""
        super().__init__()
        self._process = process

    def format(self, record: logging.LogRecord) -> str:
        """Return the line."""
        at = datetime.fromtimestamp(record.created, UTC).isoformat(timespec="milliseconds")
        told: dict[str, object] = {
            "time": at,
            "level": record.levelname,
            "logger": record.name,
            "message": record.getMessage()[:MOST_CHARACTERS],
            "process": self._process,
            "pid": os.getpid(),
        }
        told.update(bound_ids().items())
        if record.exc_info:
            told["exception"] = self.formatException(record.exc_info)[-MOST_CHARACTERS:]
        return json.dumps(told, ensure_ascii=False)


class TextLines(logging.Formatter):
    """Time, level, logger and message, and in brackets what it belongs to."""

    def __init__(self) -> None:
        """Make lines as people read them."""
        super().__init__("%(asctime)s %(levelname)s %(name)s: %(message)s")

    def formatMessage(self, record: logging.LogRecord) -> str:
        """Return the line without an exception's text."""
        ids = bound_ids()
        bound = " ".join(f"{name}={ids[name]}" for name in NAMES if name in ids)
        line = super().formatMessage(record)
        return f"{line} [{bound}]" if bound else line
