"""What the checks say: one sentence for a person in each language, with a code and its arguments."""

from __future__ import annotations

import dataclasses
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Literal

from editor.language.messages.de import FIX_TEXTS_DE, TEXTS_DE
from editor.language.messages.en import FIX_TEXTS, NOT_NOW, TEXTS
from editor.language.messages.phrases import LANGUAGES, Argument, Language, Refusal, Said, say_argument
from vipo_device.protocol.description import Scalar

Severity = Literal["error", "warning"]
When = Literal["now", "ever"]
TextArguments = Mapping[str, Argument]
_FIXED_WORDS = frozenset({"subject", "wanted", "given", "left", "right", "operator"})
"""Arguments that may be words of the language rather than names of the site."""
_OF_SCRIPTS = frozenset({"found", "instead", "detail"})


@dataclass(frozen=True, slots=True)
class Fix:
    """A change that one click makes: `field` of the step becomes `value`.

    `args.x` is the argument x, `place` and `delete` the step itself, `kind` what sort of step it is, `robot_of` a
    branch that gets a robot of its own, `source.version` the version of a library function.
    """

    label_code: str
    step: str
    field: str
    value: object
    args: TextArguments = dataclasses.field(default_factory=dict)

    @property
    def label(self) -> str:
        """Return the words on the button."""
        return self.label_in("en")

    def label_in(self, language: Language) -> str:
        """Return the words on the button in a language."""
        text = FIX_TEXTS[self.label_code]
        if language == "de":
            text = FIX_TEXTS_DE.get(self.label_code, text)
        return _fill(text, self.args, language)


@dataclass(frozen=True, slots=True)
class Problem:
    """Something that is wrong with a step's field, not yet put into words."""

    code: str
    step: str = ""
    field: str = ""
    args: TextArguments = dataclasses.field(default_factory=dict)
    fix: Fix | None = None
    held: str = ""
    """The id of the device or place of which it is true, where the step has it from a variable."""


@dataclass(frozen=True, slots=True)
class Diagnostic:
    """A problem in words; `line` counts from 1 in the script, `column` is only known for scripts written by hand."""

    code: str
    severity: Severity
    message: str
    step: str = ""
    field: str = ""
    args: TextArguments = dataclasses.field(default_factory=dict)
    line: int | None = None
    fix: Fix | None = None
    column: int | None = None

    @property
    def when(self) -> When:
        """Tell whether it is only now that this is so, or for ever."""
        return "now" if self.code in NOT_NOW else "ever"

    def message_in(self, language: Language) -> str:
        """Return the sentence in a language."""
        return self.message if language == "en" else message_in(self.code, self.args, language)

    @property
    def messages(self) -> dict[str, str]:
        """Return the sentence in every language."""
        return {language: self.message_in(language) for language in LANGUAGES}


def message_in(code: str, args: TextArguments, language: Language) -> str:
    """Return the sentence of a code in a language."""
    text = TEXTS[code][1]
    return _fill(text if language == "en" else TEXTS_DE.get(code, text), args, language)


def _fill(text: str, args: TextArguments, language: Language) -> str:
    return text.format_map({name: _say(name, argument, language) for name, argument in args.items()})


def _say(name: str, argument: Argument, language: Language) -> str:
    if isinstance(argument, str) and language != "en":
        if name in _FIXED_WORDS:
            return Said(argument).say(language)
        if name in _OF_SCRIPTS:
            return Refusal(argument).say(language)
    return say_argument(argument, language)


def put_into_words(problem: Problem, line: int | None, column: int | None = None) -> Diagnostic:
    """Return the diagnostic for a problem that shows at a line of the script."""
    code, args = problem.code, problem.args
    message = message_in(code, args, "en")
    return Diagnostic(
        code, TEXTS[code][0], message, problem.step, problem.field, args, line, problem.fix, column
    )  # fmt: skip


def arguments_to_json(args: TextArguments) -> dict[str, str | int | float]:
    """Return the arguments of a sentence for machines, phrases in English words."""
    return {
        name: argument if isinstance(argument, str | int | float) else argument.say("en")
        for name, argument in args.items()
    }


def fix_value(problem_step: str, field_name: str, value: Scalar) -> Fix:
    """Return the fix that enters a value."""
    shown: Argument = value if isinstance(value, int | float) and not isinstance(value, bool) else str(value)
    return Fix("set_to", problem_step, field_name, value, {"value": shown})


def diagnostic_to_json(diagnostic: Diagnostic) -> dict[str, object]:
    """Return a diagnostic as plain JSON."""
    return {
        "code": diagnostic.code,
        "severity": diagnostic.severity,
        "step": diagnostic.step,
        "field": diagnostic.field,
        "message": diagnostic.message,
        "messages": diagnostic.messages,
        "when": diagnostic.when,
        "args": arguments_to_json(diagnostic.args),
        "line": diagnostic.line,
        "fix": None if diagnostic.fix is None else _fix_to_json(diagnostic.fix),
    }


def _fix_to_json(fix: Fix) -> dict[str, object]:
    return {
        "label": fix.label,
        "labels": {language: fix.label_in(language) for language in LANGUAGES},
        "label_code": fix.label_code,
        "step": fix.step,
        "field": fix.field,
        "value": fix.value,
    }
