"""What strangers sent, made fit to be shown in one line."""

from __future__ import annotations


def printable(text: str) -> str:
    """Return a text without what a terminal would obey, a log would break at, or a page would hide."""
    return "".join(c if c.isprintable() else "\ufffd" for c in text)
