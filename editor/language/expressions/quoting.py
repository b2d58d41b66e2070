"""Texts as the script writes them."""

from __future__ import annotations

_ESCAPES = {'"': '\\"', "\\": "\\\\", "\n": "\\n", "\r": "\\r", "\t": "\\t"}


def quote(text: str) -> str:
    """Return a text as a Python string in double quotes; what cannot be seen is escaped."""
    if text.isascii() and text.isalnum():
        return f'"{text}"'
    return f'"{escape(text)}"'


def escape(text: str) -> str:
    """Return a text as it stands between double quotes."""
    return "".join(map(_character, text))


def _character(character: str) -> str:
    if character in _ESCAPES:
        return _ESCAPES[character]
    if character.isprintable():
        return character
    code = ord(character)
    return f"\\u{code:04x}" if code < 0x10000 else f"\\U{code:08x}"
