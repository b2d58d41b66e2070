"""Sentences with names in them, and which of them a text is, so that what was written in English is told in others."""

from __future__ import annotations

import re
from collections.abc import Mapping
from functools import cached_property


class Sentences:
    """A table of sentences by their codes, with `{names}` for what differs; the first that fits a text is it."""

    def __init__(self, table: Mapping[str, str]) -> None:
        self.table = table

    def find(self, text: str) -> tuple[str, dict[str, str]] | None:
        """Return the code of a text's sentence and what stands for its names; None where it is none of them."""
        for code, pattern in self._patterns.items():
            if found := pattern.fullmatch(text):
                return code, found.groupdict()
        return None

    @cached_property
    def _patterns(self) -> Mapping[str, re.Pattern[str]]:
        return {code: re.compile(_pattern(sentence), re.DOTALL) for code, sentence in self.table.items()}


def _pattern(sentence: str) -> str:
    """Return the regular expression for a sentence with `{names}` in it."""
    parts = re.split(r"\{(\w+)\}", sentence)
    return "".join(f"(?P<{part}>.+?)" if index % 2 else re.escape(part) for index, part in enumerate(parts))
