"""A value of one line as Python: `10 min` becomes `quantity(10, "min")`; each character knows where it comes from."""

from __future__ import annotations

import re
from dataclasses import dataclass, field
from typing import Final

from vipo_device.protocol.units import UNITS

_SIGNS: Final = {"≤": "<=", "≥": ">=", "≠": "!=", "\u00d7": "*", "·": "*", "÷": "/", "\u2212": "-", "\u2013": "-"}
_WORDS = sorted({word for unit in UNITS.values() for word in (unit.symbol, *unit.also)}, key=len, reverse=True)
_UNIT = "|".join(re.escape(word) + (r"(?![\w(/])" if word[-1].isalpha() else "") for word in _WORDS)
_NUMBER: Final = re.compile(rf"(?<![\w.])(\d+(?:\.\d+)?(?:[eE][+-]?\d+)?)[ \u00a0\u202f]*({_UNIT})")
_TEXT: Final = re.compile(r"""(?<!\w)([fF]?)("(?:[^"\\]|\\.)*"?|'(?:[^'\\]|\\.)*'?)""")
_EQUALS: Final = re.compile(r"(?<![=!<>])=(?!=)")


@dataclass(slots=True)
class Desugared:
    """Python text, and where each of its characters comes from."""

    text: str = ""
    origins: list[int] = field(default_factory=list)

    def add(self, text: str, origin: int, *, step: int = 0) -> None:
        """Add text that comes from one place, or (`step` 1) from the places behind one another."""
        self.text += text
        self.origins.extend(origin + step * index for index in range(len(text)))

    def origin(self, position: int) -> int:
        """Return where in the line as typed a position of the Python text is."""
        if not self.origins:
            return 0
        return self.origins[position] if position < len(self.origins) else self.origins[-1] + 1


def desugar(line: str) -> Desugared:
    """Return the Python text of a line."""
    result = Desugared()
    _desugar(line, 0, result, '"')
    return result


def _desugar(line: str, start: int, result: Desugared, mark: str) -> None:
    """Rewrite a piece of the line that begins at `start`; `mark` is the quotation mark for units."""
    here = 0
    while here < len(line):
        text = _TEXT.match(line, here)
        number = _NUMBER.match(line, here) if text is None else None
        if text is not None:
            _add_text(text, start, result)
            here = text.end()
        elif number is not None:
            result.add(f"quantity({number[1]}, {mark}{number[2]}{mark})", start + here)
            here = number.end()
        else:
            sign = "==" if _EQUALS.match(line, here) else _SIGNS.get(line[here], line[here])
            result.add(sign, start + here)
            here += 1


def _add_text(found: re.Match[str], start: int, result: Desugared) -> None:
    """Keep a text as it is; what stands in the braces of an f-string is rewritten, too."""
    whole = found[0]
    if not found[1]:
        result.add(whole, start + found.start(), step=1)
        return
    other = "'" if found[2][0] == '"' else '"'
    for piece in re.finditer(r"\{\{|\}\}|\{[^{}]*\}?|[^{}]+|.", whole, re.DOTALL):
        origin = start + found.start() + piece.start()
        if piece[0][0] == "{" and piece[0] != "{{":
            _desugar(piece[0], origin, result, other)
        else:
            result.add(piece[0], origin, step=1)
