"""How much room a step takes on the map, roughly: its chip's width follows from what it says."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

from editor.language.document.outline import mapping

HEIGHT_M, LETTER_M, ENDS_M = 0.7, 0.15, 1.7
"""A chip's height, a letter's width, and the room for number, icon and padding."""
LONGEST_SENTENCE, LONGEST = 30, 44
FRAMES = frozenset({"while", "repeat", "for_each", "try"})
"""Kinds whose body stands in a frame below their head."""
_LIKE_ITS_KIND = frozenset({"parallel", "try", "break", "end"})


@dataclass(frozen=True, slots=True)
class Room:
    """Width and height in metres."""

    width_m: float
    height_m: float


def room_of(kind: str, params: Mapping[str, object]) -> Room:
    """Return the room that a step needs; an If's with its condition beside it."""
    if kind == "if":
        return Room(1.4 + 2 * LETTER_M * min(letters(params.get("condition")), 20), 1.4)
    text = min(_letters_shown(kind, params), LONGEST)
    return Room(round(ENDS_M + LETTER_M * text, 2), 1.4 if kind in {"while", "on_event"} else HEIGHT_M)


def _letters_shown(kind: str, params: Mapping[str, object]) -> int:
    match kind:
        case "pick" | "drop" | "pick_and_drop":
            return letters(params.get("quantity")) + letters(params.get("object")) + 3
        case "move":
            return 8 + letters(params.get("to"))
        case "wait":
            return 5 + letters(params.get("until") or params.get("duration"))
        case "operate":
            args = mapping(params.get("args"))
            return letters(params.get("method")) + sum(3 + letters(value) for value in args.values())
        case "call":
            args = mapping(params.get("args"))
            return 12 + sum(len(name) + 4 + letters(value) for name, value in args.items())
        case "ask" | "notify":
            return 7 + min(letters(params.get("question") or params.get("message")), LONGEST_SENTENCE)
        case _ if kind in _LIKE_ITS_KIND:
            return 8
    return 8 + sum(letters(value) for name, value in params.items() if name not in {"role", "starts", "answer"})


def letters(value: object) -> int:
    """Return about how many letters a value is written with."""
    if isinstance(value, Mapping):
        return sum(letters(part) for part in value.values())
    if isinstance(value, list | tuple):
        return sum(2 + letters(part) for part in value)
    return 0 if value is None else len(str(value))
