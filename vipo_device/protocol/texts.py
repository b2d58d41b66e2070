"""The one rule for text, whoever sends it: people, programs, devices; pure.

A text is of characters that can be shown. It never holds NUL, which PostgreSQL cannot keep, nor half of a surrogate
pair, which UTF-8 cannot say, nor any other control character, nor the marks that turn the order of what follows round
and so let one name look like another. A line break and a tab are for texts of several lines. What looks the same is
the same: texts are kept in the normal form NFC, with a line break as one character.
"""

from __future__ import annotations

import re
import unicodedata
from collections.abc import Callable, Iterator
from typing import Any

_UNFIT = re.compile(
    "[\0-\x08\x0b-\x1f\x7f-\x9f\u2028-\u202e\u2066-\u2069\ud800-\udfff\ufffe\uffff]"  # tab and line break are fit
)
_NO_LINE = re.compile(f"[\t\n]|{_UNFIT.pattern}")
_LINE_BREAK = re.compile("\r\n?")
Path = tuple[str | int, ...]


def find_unfit(text: str, *, is_line: bool = False) -> str:
    """Return the first character that no text may hold, or no text of one line; empty where there is none."""
    if text.isascii() and text.isprintable():
        return ""
    found = (_NO_LINE if is_line else _UNFIT).search(text)
    return found.group() if found else ""


def refusal_of(text: str, *, is_line: bool = False) -> str:
    """Return why a text is refused and how to mend it, as the end of a sentence; empty where it is fit."""
    character = find_unfit(text, is_line=is_line)
    if not character:
        return ""
    if character in "\t\n\r":
        return "must be one line: take out the line break or tab"
    return f"holds U+{ord(character):04X}, which is no text: take that character out, or type the text anew"


def normal(text: str) -> str:
    """Return a text in its normal form."""
    if text.isascii() and text.isprintable():
        return text
    return unicodedata.normalize("NFC", _LINE_BREAK.sub("\n", text))


def cleaned(text: str) -> str:
    """Return what is left of a text without the characters that no text may hold, in its normal form."""
    if text.isascii() and text.isprintable():
        return text
    return unicodedata.normalize("NFC", _UNFIT.sub("", _LINE_BREAK.sub("\n", text)))


def unfit_texts(value: Any, path: Path = ()) -> Iterator[tuple[Path, str]]:
    """Yield each text within JSON that is not fit, also names of fields, with where it stands."""
    if isinstance(value, str):
        if find_unfit(value):
            yield path, value
    elif isinstance(value, dict):
        for key, inner in value.items():
            if find_unfit(key):
                yield path, key
            yield from unfit_texts(inner, (*path, key))
    elif isinstance(value, list | tuple):
        for position, inner in enumerate(value):
            yield from unfit_texts(inner, (*path, position))


def normal_json(value: Any) -> Any:
    """Return JSON with all its texts in their normal form."""
    return _with_texts(value, normal)


def cleaned_json(value: Any) -> Any:
    """Return JSON with all its texts cleaned, and without what has a name that is no text."""
    return _with_texts(value, cleaned, has_unfit=True)


def _with_texts(value: Any, change: Callable[[str], str], *, has_unfit: bool = False) -> Any:
    if isinstance(value, str):
        return change(value)
    if isinstance(value, dict):
        return {
            normal(key): _with_texts(inner, change, has_unfit=has_unfit)
            for key, inner in value.items()
            if not (has_unfit and find_unfit(key))
        }
    if isinstance(value, list | tuple):
        return [_with_texts(inner, change, has_unfit=has_unfit) for inner in value]
    return value
