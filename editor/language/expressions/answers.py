"""What a question may be answered with, in its normal form, as the document and the script have it."""

from __future__ import annotations

from collections.abc import Mapping

from editor.language.expressions.values import is_number, plain
from editor.language.plan.instructions import AnswerSpec

ANSWER_TYPES = ("boolean", "number", "text", "choice")


def settle_answer(given: Mapping[str, object]) -> AnswerSpec:
    """Return what is said of an answer; what does not belong to its type is left out, nonsense too."""
    kind = given.get("type")
    if kind == "number":
        unit = given.get("unit")
        least, most = _limit(given.get("minimum")), _limit(given.get("maximum"))
        return AnswerSpec("number", unit if isinstance(unit, str) else "", least, most)
    if kind == "choice":
        options = given.get("options")
        listed = options if isinstance(options, list | tuple) else ()
        named = dict.fromkeys(option for option in listed if isinstance(option, str) and option)
        return AnswerSpec("choice", options=tuple(named))
    return AnswerSpec("text" if kind == "text" else "boolean")


def _limit(value: object) -> float | None:
    limit = plain(value)
    return limit if is_number(limit) else None


def answer_to_json(answer: AnswerSpec) -> dict[str, object]:
    """Return what the document says of an answer."""
    said = {"unit": answer.unit or None, "minimum": answer.minimum, "maximum": answer.maximum}
    body = {"type": answer.type, **said, "options": list(answer.options) or None}
    return {name: value for name, value in body.items() if value is not None}
